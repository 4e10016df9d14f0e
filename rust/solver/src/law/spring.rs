//! Stretch, shear and bend springs: a force along the line between two particles.
//!
//! For a spring (i, j) of rest length L (m), stiffness k (N/m) and damping kd (N·s/m), with
//! d = x_i - x_j and n = d/|d|:
//!
//! ```text
//! F_i = k (L - |d|) n                          (N)
//!     - kd (v_i - v_j)                         relative damping (the paper), or
//!     - kd ((v_i - v_j)·n) n                   axial damping (the course exercise)
//! E   = 1/2 k (|d| - L)²                       (J)
//! k   = k0 |d|/L  beyond the allowed length    equation 6 of the paper, limiter "stiffen"
//! ```
//!
//! Ends that coincide have no direction and feel no spring force.
//!
//! Source: Provot 1995; axial damping after the course notes of Baraff & Witkin 1997.

use boucle_geometry::Vector;

use crate::material::{DampingLaw, Limiter, SpringKind, SpringMaterial};

/// A spring between two particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// The two particles, smaller first.
    pub ends: [u32; 2],
    /// What it resists.
    pub kind: SpringKind,
    /// Length without force (m).
    pub rest_length: f64,
    /// Stiffness (N/m).
    pub stiffness: f64,
    /// Damping (N·s/m).
    pub damping: f64,
}

impl Spring {
    /// The vector from the second end to the first (m).
    #[must_use]
    pub fn span(&self, positions: &[Vector]) -> Vector {
        positions[self.ends[0] as usize] - positions[self.ends[1] as usize]
    }
}

/// Shortest squared length (m²) with a direction; below it a spring is taken as this long.
const SHORTEST_SQUARED: f64 = 1e-36;

/// What the springs of one material share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Law {
    pub(crate) damping: Damping,
    /// Ratio of length to rest length beyond which equation 6 stiffens; infinite if it does not.
    pub(crate) stiffen_beyond: f64,
}

/// Which relative velocity is damped, if any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Damping {
    None,
    Relative,
    Axial,
}

impl Law {
    pub(crate) fn of(material: &SpringMaterial) -> Self {
        let is_damped = material.damping.iter().any(|&damping| damping > 0.0);
        let damping = match material.damping_law {
            _ if !is_damped => Damping::None,
            DampingLaw::Relative => Damping::Relative,
            DampingLaw::Axial => Damping::Axial,
        };
        let stiffen_beyond = match material.limiter {
            Limiter::Stiffen => 1.0 + material.deformation_rate,
            _ => f64::INFINITY,
        };
        Self { damping, stiffen_beyond }
    }

    /// Energy at a ratio r of length to rest length, for each unit of stiffness times squared rest length: the
    /// integral of the force, `(r - 1)²/2`, and beyond the allowed ratio that of `r (r - 1)`.
    pub(crate) fn energy(&self, ratio: f64) -> f64 {
        let soft = |r: f64| 0.5 * (r - 1.0) * (r - 1.0);
        let stiff = |r: f64| r * r * (r / 3.0 - 0.5);
        if ratio > self.stiffen_beyond {
            let allowed = self.stiffen_beyond;
            soft(allowed) + stiff(ratio) - stiff(allowed)
        } else {
            soft(ratio)
        }
    }

    /// Stiffness (N/m) of a spring at a ratio of length to rest length: equation 6.
    pub(crate) fn stiffness_at(&self, stiffness: f64, ratio: f64) -> f64 {
        if ratio > self.stiffen_beyond { stiffness * ratio } else { stiffness }
    }
}

/// Which terms a kernel computes: known when it is compiled.
pub(crate) trait Terms: Copy {
    const DAMPING: Damping;
    const STIFFENS: bool;
}

macro_rules! terms {
    ($($name:ident: $damping:ident, $stiffens:literal;)*) => {$(
        #[derive(Clone, Copy)]
        pub(crate) struct $name;
        impl Terms for $name {
            const DAMPING: Damping = Damping::$damping;
            const STIFFENS: bool = $stiffens;
        }
    )*};
}

terms! {
    Undamped: None, false;
    RelativelyDamped: Relative, false;
    AxiallyDamped: Axial, false;
    UndampedStiffening: None, true;
    RelativelyDampedStiffening: Relative, true;
    AxiallyDampedStiffening: Axial, true;
}

/// A vector, one number an axis.
pub(crate) type Triple = [f64; 3];

#[inline(always)]
fn dot(a: Triple, b: Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A spring as one of its ends sees it. Only IEEE 754's basic operations and no branches, for the compiler to run it
/// on many springs side by side: the bits do not depend on how many, nor on the machine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull {
    /// Length without force (m).
    pub(crate) rest_length: f64,
    /// Stiffness (N/m).
    pub(crate) stiffness: f64,
    /// Damping (N·s/m).
    pub(crate) damping: f64,
    /// See [`Law`].
    pub(crate) stiffen_beyond: f64,
}

impl Pull {
    /// Squared length (m²) of a span (m), never 0.
    #[inline(always)]
    pub(crate) fn squared_length(span: Triple) -> f64 {
        let squared = dot(span, span);
        if squared > SHORTEST_SQUARED { squared } else { SHORTEST_SQUARED }
    }

    /// One over the length (1/m), in single precision: [`Pull::on_other`] makes it double.
    #[inline(always)]
    pub(crate) fn rough_inverse_length(squared_length: f32) -> f32 {
        1.0 / squared_length.sqrt()
    }

    /// The force (N) on the other end; `span` (m) and `relative_velocity` (m/s) are this end's less the other's.
    /// The force on this end is its opposite.
    #[inline(always)]
    pub(crate) fn on_other<T: Terms>(
        &self,
        span: Triple,
        squared_length: f64,
        rough_inverse_length: f32,
        relative_velocity: Triple,
    ) -> Triple {
        let inverse_length = refined(squared_length, rough_inverse_length);
        let mut stiffness = self.stiffness;
        if T::STIFFENS {
            let ratio = squared_length * inverse_length / self.rest_length;
            stiffness *= if ratio > self.stiffen_beyond { ratio } else { 1.0 };
        }
        let mut pull = stiffness * (1.0 - self.rest_length * inverse_length);
        match T::DAMPING {
            Damping::Axial => {
                let speed = dot(relative_velocity, span) * inverse_length;
                pull += self.damping * speed * inverse_length;
                span.map(|d| pull * d)
            }
            Damping::Relative => std::array::from_fn(|axis| {
                pull * span[axis] + self.damping * relative_velocity[axis]
            }),
            Damping::None => span.map(|d| pull * d),
        }
    }
}

/// One over the square root, to 3e-14, from its value in single precision.
///
/// The rough y leaves `1 - q y²` of order 1e-7, and a step of Newton's method squares it: less work than a square
/// root and a division in double precision.
#[inline(always)]
fn refined(square: f64, rough: f32) -> f64 {
    let y = f64::from(rough);
    y * (1.5 - 0.5 * square * y * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_root_is_right_to_fourteen_digits() {
        for exponent in -35..35 {
            for step in 0..50 {
                let square = 10f64.powi(exponent) * (1.0 + 0.18 * f64::from(step));
                let rough = Pull::rough_inverse_length(square as f32);
                let error = (refined(square, rough) * square.sqrt() - 1.0).abs();
                assert!(error < 3e-14, "{square}: {error}");
            }
        }
    }

    fn force_of<T: Terms>(span: [f64; 3], velocity: [f64; 3]) -> [f64; 3] {
        let pull = Pull { rest_length: 2.0, stiffness: 10.0, damping: 0.5, stiffen_beyond: 1.1 };
        let squared = Pull::squared_length(span);
        let rough = Pull::rough_inverse_length(squared as f32);
        pull.on_other::<T>(span, squared, rough, velocity).map(|force| -force)
    }

    #[test]
    fn a_stretched_spring_pulls_by_stiffness_times_elongation() {
        assert_eq!(force_of::<Undamped>([0.0, 3.0, 0.0], [0.0; 3]), [0.0, -10.0, 0.0]);
    }

    #[test]
    fn ends_that_coincide_feel_no_force() {
        assert_eq!(force_of::<Undamped>([0.0; 3], [0.0; 3]), [0.0; 3]);
    }

    #[test]
    fn relative_damping_opposes_all_motion_and_axial_only_that_along_the_spring() {
        let velocity = [1.0, 2.0, 0.0];
        let relative = force_of::<RelativelyDamped>([0.0, 2.0, 0.0], velocity);
        let axial = force_of::<AxiallyDamped>([0.0, 2.0, 0.0], velocity);
        for (force, expected) in [(relative, [-0.5, -1.0, 0.0]), (axial, [0.0, -1.0, 0.0])] {
            for axis in 0..3 {
                assert!((force[axis] - expected[axis]).abs() < 1e-14, "{force:?}");
            }
        }
    }

    #[test]
    fn equation_six_multiplies_the_stiffness_by_the_ratio_of_lengths() {
        let force = force_of::<UndampedStiffening>([0.0, 3.0, 0.0], [0.0; 3]);
        assert!((force[1] + 10.0 * 1.5 * 1.0).abs() < 1e-13, "{force:?}");
        let below = force_of::<UndampedStiffening>([0.0, 2.1, 0.0], [0.0; 3]);
        assert!((below[1] + 1.0).abs() < 1e-13, "{below:?}");
    }
}
