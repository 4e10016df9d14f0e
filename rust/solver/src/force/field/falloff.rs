//! How a field fades with the distance from it.
//!
//! ```text
//! f(s) = 1                          nearer than min
//!      = (1 + s - min)^-power       from there on
//!      = 0                          farther than max
//!
//! sphere  f(distance from the field's shape)
//! tube    f(way along the axis) f_radial(distance from the axis)
//! cone    f(way along the axis) f_radial(angle from the axis in degrees)
//! ```
//!
//! These are Blender's formulas, by measurement on its cloth.

use boucle_geometry::Vector;

/// Along what a field fades.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FalloffShape {
    /// The distance, all around.
    #[default]
    Sphere,
    /// The way along the axis and the distance from it.
    Tube,
    /// The way along the axis and the angle from it.
    Cone,
}

/// On which side of the plane across its axis a field acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// On both.
    #[default]
    Both,
    /// In front, where the axis points.
    Positive,
    /// Behind.
    Negative,
}

/// How a field fades along one measure: metres, or degrees around a cone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Range {
    /// 0 for not at all.
    pub power: f64,
    /// Nearer, it is at its full strength.
    pub min: Option<f64>,
    /// Farther, it is nothing.
    pub max: Option<f64>,
}

impl Range {
    /// The part that is left at a distance.
    fn factor(&self, distance: f64) -> f64 {
        if self.max.is_some_and(|max| distance > max) {
            return 0.0;
        }
        let min = self.min.unwrap_or(0.0);
        if self.power == 0.0 || distance < min {
            return 1.0;
        }
        (1.0 + distance - min).powf(-self.power)
    }
}

/// How a field fades.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Falloff {
    /// Along what.
    pub shape: FalloffShape,
    /// On which side.
    pub side: Side,
    /// Of the sphere, or along the axis of tube and cone.
    pub distance: Range,
    /// Across the axis of tube and cone.
    pub radial: Range,
}

impl Falloff {
    /// The part of a field that is left at a distance (m) from its shape and a way (m) from its location, for a unit axis.
    pub(super) fn factor(&self, distance: f64, way: &Vector, axis: &Vector) -> f64 {
        let along = way.dot(axis);
        match self.side {
            Side::Positive if along < 0.0 => return 0.0,
            Side::Negative if along > 0.0 => return 0.0,
            _ => {}
        }
        match self.shape {
            FalloffShape::Sphere => self.distance.factor(distance),
            FalloffShape::Tube => {
                let radius = (way - along * axis).norm();
                self.distance.factor(along.abs()) * self.radial.factor(radius)
            }
            FalloffShape::Cone => {
                let across = (way - along * axis).norm();
                let angle = across.atan2(along).to_degrees();
                self.distance.factor(along.abs()) * self.radial.factor(angle)
            }
        }
    }
}
