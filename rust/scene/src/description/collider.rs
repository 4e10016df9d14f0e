//! `[[collider]]`: what cloth touches, how it moves.
//!
//! Exactly one of five shapes; or, where meshes are given beside the scene, none.
//!
//! ```toml
//! sphere = { center = [0, 0, 0], radius = 0.5 }
//! plane = { point = [0, 0, 0], normal = [0, 0, 1] }
//! box = { center = [0, 0, 0], size = [1, 1, 1], rotation_deg = [0, 0, 0] }
//! capsule = { a = [0, 0, 0], b = [0, 0, 1], radius = 0.1 }
//! mesh = "body.obj"
//! ```

use boucle_geometry::Vector;
use serde::{Deserialize, Serialize};

use super::choice::Choice;
use super::cloth::{Transform, UpAxis};
use super::collision::{THICKEST, check_friction};
use super::pins::{Keyframe, check_motion};
use super::table;
use crate::error::{Error, Result};
use crate::limits::{self, MAX_LENGTH};

/// Smallest length (m) of a normal or of a capsule: a direction can be told from it.
const SHORTEST: f64 = 1e-9;

/// One collider.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColliderDescription {
    /// What cloths and messages call it; no two colliders share it.
    pub name: String,
    /// A ball.
    #[serde(default, deserialize_with = "table::optional")]
    pub sphere: Option<Sphere>,
    /// The space behind a plane.
    #[serde(default, deserialize_with = "table::optional")]
    pub plane: Option<HalfSpace>,
    /// A box.
    #[serde(default, deserialize_with = "table::optional")]
    pub r#box: Option<Cuboid>,
    /// A ball swept along a line.
    #[serde(default, deserialize_with = "table::optional")]
    pub capsule: Option<Capsule>,
    /// An OBJ file, beside the scene file.
    pub mesh: Option<String>,
    /// Which axis of the OBJ file points up.
    #[serde(default, deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub up: UpAxis,
    /// Where the shape stands.
    #[serde(default, deserialize_with = "table::one")]
    pub transform: Transform,
    /// Coefficient of friction.
    #[serde(default = "default_friction")]
    pub friction: f64,
    /// What is kept free around it (m), beside the cloth's own thickness.
    #[serde(default)]
    pub thickness: f64,
    /// How it moves, as pins do: displacements from where it stands, turned about the world's origin.
    #[serde(default, deserialize_with = "table::list")]
    pub motion: Vec<Keyframe>,
    /// How a mesh deforms: a POINTCACHE2 file with its points, beside the scene file.
    pub cache: Option<String>,
}

/// The friction of a collider that names none: that of cloth.
fn default_friction() -> f64 {
    boucle_solver::Collision::default().friction
}

/// A ball.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Its middle (m).
    pub center: [f64; 3],
    /// m.
    pub radius: f64,
}

/// The space behind a plane.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HalfSpace {
    /// A point of the plane (m).
    pub point: [f64; 3],
    /// Where the free space is, of any length.
    pub normal: [f64; 3],
}

/// A box.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cuboid {
    /// Its middle (m).
    pub center: [f64; 3],
    /// Its whole lengths (m) along its axes.
    pub size: [f64; 3],
    /// Angles (degrees) about x, then y, then z, around its middle.
    #[serde(default)]
    pub rotation_deg: [f64; 3],
}

/// A ball swept along a line.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Capsule {
    /// One end of the line (m).
    pub a: [f64; 3],
    /// The other (m).
    pub b: [f64; 3],
    /// m.
    pub radius: f64,
}

impl ColliderDescription {
    /// The keys of the shapes that it gives.
    #[must_use]
    pub fn shapes(&self) -> Vec<&'static str> {
        let shapes = [
            ("sphere", self.sphere.is_some()),
            ("plane", self.plane.is_some()),
            ("box", self.r#box.is_some()),
            ("capsule", self.capsule.is_some()),
            ("mesh", self.mesh.is_some()),
        ];
        shapes.iter().filter(|(_, is_given)| *is_given).map(|(key, _)| *key).collect()
    }

    pub(super) fn check(&self, at: &str) -> Result<()> {
        if self.name.is_empty() {
            return Err(Error::refuse(&format!("{at}.name"), "\"\"", "a name"));
        }
        let shapes = self.shapes();
        if shapes.len() > 1 {
            let accepted = "one of sphere, plane, box, capsule, mesh";
            let given = shapes.join(" and ");
            return Err(Error::input(format!("{at}: {given}; accepted: {accepted}")));
        }
        if self.mesh.is_none() && self.up != UpAxis::Z {
            return Err(Error::input(format!("{at}.up: accepted only with mesh")));
        }
        if self.mesh.is_none() && self.cache.is_some() {
            return Err(Error::input(format!("{at}.cache: accepted only with mesh")));
        }
        if self.cache.is_some() && !self.motion.is_empty() {
            return Err(Error::input(format!("{at}: motion and cache; accepted: one of the two")));
        }
        self.check_shape(at)?;
        self.transform.check(&format!("{at}.transform"))?;
        check_friction(at, self.friction)?;
        let thickness = 0.0..=THICKEST;
        limits::within(&format!("{at}.thickness"), self.thickness, &thickness, "0 to 100 m")?;
        check_motion(&format!("{at}.motion"), &self.motion)
    }

    fn check_shape(&self, at: &str) -> Result<()> {
        let place = |key: &str, point: &[f64; 3]| {
            limits::vector(&format!("{at}.{key}"), point, MAX_LENGTH, " m")
        };
        let radius =
            |key: &str, radius| limits::above_zero(&format!("{at}.{key}"), radius, THICKEST, " m");
        if let Some(sphere) = &self.sphere {
            place("sphere.center", &sphere.center)?;
            radius("sphere.radius", sphere.radius)?;
        }
        if let Some(plane) = &self.plane {
            place("plane.point", &plane.point)?;
            place("plane.normal", &plane.normal)?;
            let (key, length) = (format!("{at}.plane.normal"), Vector::from(plane.normal).norm());
            far_enough(&key, &plane.normal, length, "a vector with a length")?;
        }
        if let Some(cuboid) = &self.r#box {
            place("box.center", &cuboid.center)?;
            for (axis, &size) in cuboid.size.iter().enumerate() {
                limits::above_zero(&format!("{at}.box.size.{axis}"), size, MAX_LENGTH, " m")?;
            }
            let key = format!("{at}.box.rotation_deg");
            limits::vector(&key, &cuboid.rotation_deg, 1e6, " degrees")?;
        }
        if let Some(capsule) = &self.capsule {
            place("capsule.a", &capsule.a)?;
            place("capsule.b", &capsule.b)?;
            radius("capsule.radius", capsule.radius)?;
            let length = (Vector::from(capsule.b) - Vector::from(capsule.a)).norm();
            let key = format!("{at}.capsule.b");
            far_enough(&key, &capsule.b, length, "another point than a")?;
        }
        Ok(())
    }
}

/// Refuses what has no direction because it has no length (m).
fn far_enough(key: &str, value: &[f64; 3], length: f64, accepted: &str) -> Result<()> {
    if length > SHORTEST { Ok(()) } else { Err(Error::refuse(key, format!("{value:?}"), accepted)) }
}
