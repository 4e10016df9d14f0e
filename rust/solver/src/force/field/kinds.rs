//! The laws of the fields: what each does to cloth at a point that moves with v.
//!
//! With s the strength, f what the falloff leaves, r the way from the field's shape, o the way from its location, a its
//! axis, all of length 1 where they are written as e:
//!
//! ```text
//! point       s f e_r            (and 1/r² with the inverse square)
//! wind        s f a
//! vortex      s f |r| e(a x r)                                        from a point
//!             s f (a x o) + (s f)² a x (a x o) - v                    from a plane: what moves with the whirl feels none
//! turbulence  s f noise(x)
//! drag        -f (s |v| + d) v
//! harmonic    -s f (1 - L/|r|) r - 2 d √|s| v
//! magnetic    v x s f e(a x r)   from a point or a line              v x s f a  from a plane
//! ```
//!
//! All but drag and harmonic feel `- flow f v` besides. These are Blender's formulas, by measurement on its cloth.
//!
//! What depends on the velocity is stable at any step of an implicit integrator, since it is evaluated at the step's end
//! and its slope, or more, stands in the matrix: `damping`, and `stiffness` for the harmonic law. The magnetic force has no
//! slope that a symmetric matrix holds: it turns velocities by a limited angle in a step (see [`super::super::fields`]).

use boucle_geometry::Vector;

use super::{Field, FieldKind, FieldShape};

/// What fields do at one place, before they act on an area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::force) struct Push {
    /// In its own direction (N/m²).
    pub(in crate::force) free: Vector,
    /// Along normals alone (N/m²).
    pub(in crate::force) normal: Vector,
    /// Turns velocities: `v x turn` (N·s/m³).
    pub(in crate::force) turn: Vector,
    /// No more than so much slows (N·s/m³).
    pub(in crate::force) damping: f64,
    /// No more than so much holds (N/m³).
    pub(in crate::force) stiffness: f64,
}

/// What a law gives, in parts of the field's pressure.
#[derive(Default)]
struct Effect {
    force: Vector,
    turn: Vector,
    damping: f64,
    stiffness: f64,
}

impl Field {
    /// Adds what the field does at `x` (m) to cloth with the velocity `v` (m/s), which may become faster by `gain` (m/s)
    /// while it acts. `draw` is the random number of a noise of 1.
    pub(in crate::force) fn push(
        &self,
        x: &Vector,
        v: &Vector,
        draw: f64,
        gain: f64,
        sum: &mut Push,
    ) {
        let axis = self.axis.normalize();
        let way = x - self.location;
        let along = way.dot(&axis) * axis;
        let r = match (self.shape, self.kind) {
            (FieldShape::Point, _) => way,
            // A vortex whirls around its axis from a plane as from a line.
            (FieldShape::Line, _) | (FieldShape::Plane, FieldKind::Vortex) => way - along,
            (FieldShape::Plane, _) => along,
        };
        let fade = self.weight * self.falloff.factor(r.norm(), &way, &axis);
        if fade <= 0.0 {
            return;
        }
        let place = Place { r, way, axis, fade, gain };
        let Effect { mut force, turn, mut damping, stiffness } =
            self.effect(&place, x, v, self.noise * draw);
        if !matches!(self.kind, FieldKind::Drag | FieldKind::Harmonic { .. }) {
            force -= self.flow * fade * v;
            damping += self.flow * fade;
        }
        let [free, normal] =
            [1.0 - self.wind_factor, self.wind_factor].map(|part| part * self.pressure);
        sum.free += free * force;
        sum.turn += free * turn;
        sum.normal += normal * (force + v.cross(&turn));
        sum.damping += self.pressure * damping;
        sum.stiffness += self.pressure * stiffness;
    }

    /// The law itself.
    fn effect(&self, place: &Place, x: &Vector, v: &Vector, noise: f64) -> Effect {
        let Place { r, way, axis, fade, gain } = place;
        let strength = self.strength + noise;
        let (s, distance) = (strength * fade, r.norm());
        let force = match self.kind {
            FieldKind::Point { inverse_square } => {
                let square = if inverse_square { distance * distance } else { 1.0 };
                s * unit(r) / square.max(f64::MIN_POSITIVE)
            }
            FieldKind::Wind => s * axis,
            FieldKind::Vortex if self.shape == FieldShape::Point => {
                s * distance * unit(&axis.cross(r))
            }
            FieldKind::Vortex => {
                let whirl = s * axis.cross(way);
                let force = whirl + s * axis.cross(&whirl) - v;
                return Effect { force, damping: 1.0, ..Effect::default() };
            }
            FieldKind::Turbulence { size, is_global } => {
                s * super::noise::turbulence(if is_global { x } else { way }, size)
            }
            FieldKind::Drag => {
                let (speed, linear) = (v.norm(), (self.damping + noise).max(0.0));
                let slope = 2.0 * strength.max(0.0) * (speed + gain) + linear;
                let force = -*fade * (strength * speed + linear) * v;
                return Effect { force, damping: fade * slope, ..Effect::default() };
            }
            FieldKind::Harmonic { rest_length } => {
                let held = if rest_length > 0.0 { r - rest_length * unit(r) } else { *r };
                let damping = 2.0 * (self.damping + noise).max(0.0) * strength.abs().sqrt();
                let force = -s * held - damping * v;
                return Effect { force, damping, stiffness: s.max(0.0), turn: Vector::zeros() };
            }
            FieldKind::Magnetic => {
                let around = match self.shape {
                    FieldShape::Plane => *axis,
                    FieldShape::Point | FieldShape::Line => unit(&axis.cross(r)),
                };
                return Effect { turn: s * around, ..Effect::default() };
            }
        };
        Effect { force, ..Effect::default() }
    }
}

/// Where cloth is, as seen from a field.
struct Place {
    /// From the field's shape (m).
    r: Vector,
    /// From its location (m).
    way: Vector,
    axis: Vector,
    /// What falloff and weight leave.
    fade: f64,
    /// m/s
    gain: f64,
}

/// A vector's direction; nothing for none.
fn unit(vector: &Vector) -> Vector {
    vector.try_normalize(1e-12).unwrap_or_else(Vector::zeros)
}
