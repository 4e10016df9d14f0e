//! Stretch, shear and bend springs: a force along the line between two particles.
//!
//! For a spring (i, j) of rest length L (m), stiffness k (N/m) and damping kd (N·s/m), with
//! `d = x_i - x_j` and `n = d/|d|`:
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

use super::number::Number;
use crate::cloth::Cloth;
use crate::material::{DampingLaw, Limiter, SpringKind};

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

/// Added to squared lengths (m²), for ends that coincide: rounding loses it in all others.
const SHORTEST_SQUARED: f64 = 1e-36;

/// For each metre of rest length (N/m²): far more than any spring has.
const STIFFEST: f64 = 1e30;

/// What the springs of one cloth share.
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
    pub(crate) fn of(cloth: &Cloth) -> Self {
        let material = &cloth.material;
        let is_damped = cloth.springs.iter().any(|spring| spring.damping > 0.0);
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
pub(crate) type Triple<N> = [N; 3];

/// A spring as one of its ends sees it, or several side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull<N> {
    /// Length without force (m); 0 stands for no spring.
    pub(crate) rest_length: N,
    /// Stiffness (N/m).
    pub(crate) stiffness: N,
    /// Damping (N·s/m).
    pub(crate) damping: N,
    /// See [`Law`].
    pub(crate) stiffen_beyond: N,
}

impl<N: Number> Pull<N> {
    /// The force (N) on the other end; `span` (m) and `relative_velocity` (m/s) are this end's less the other's.
    /// The force on this end is its opposite.
    #[inline(always)]
    pub(crate) fn on_other<T: Terms>(
        &self,
        span: Triple<N>,
        relative_velocity: Triple<N>,
    ) -> Triple<N> {
        let ([x, y, z], [u, v, w]) = (span, relative_velocity);
        let one = x.all(1.0);
        // Two sums side by side: a shorter chain to wait for.
        let length = ((x * x + y * y) + (z * z + x.all(SHORTEST_SQUARED))).sqrt();
        // Exact for every spring, whose rest length is 1e-9 m at least; 0 where there is none.
        let most = self.rest_length * x.all(STIFFEST);
        let mut pull = self.stiffness.min(most) * (one - self.rest_length / length);
        if T::STIFFENS {
            let ratio = length / (self.rest_length + x.all(SHORTEST_SQUARED));
            pull = pull * (one + (ratio - one).where_positive(ratio - self.stiffen_beyond));
        }
        if T::DAMPING == Damping::Axial {
            pull = pull + self.damping.min(most) * (u * x + v * y + w * z) / (length * length);
        }
        if T::DAMPING == Damping::Relative {
            let damping = self.damping.min(most);
            [pull * x + damping * u, pull * y + damping * v, pull * z + damping * w]
        } else {
            [pull * x, pull * y, pull * z]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn force_of<T: Terms>(span: [f64; 3], velocity: [f64; 3]) -> [f64; 3] {
        let pull = Pull { rest_length: 2.0, stiffness: 10.0, damping: 0.5, stiffen_beyond: 1.1 };
        pull.on_other::<T>(span, velocity).map(|force| -force)
    }

    #[test]
    fn a_stretched_spring_pulls_by_stiffness_times_elongation() {
        let [x, y, z] = force_of::<Undamped>([0.0, 3.0, 0.0], [0.0; 3]);
        assert!(x == 0.0 && z == 0.0 && (y + 10.0).abs() < 1e-13, "{x} {y} {z}");
    }

    #[test]
    fn ends_that_coincide_feel_no_force() {
        assert!(force_of::<Undamped>([0.0; 3], [0.0; 3]).iter().all(|&force| force == 0.0));
    }

    #[test]
    fn a_rest_length_of_0_stands_for_no_spring() {
        let gap = Pull { rest_length: 0.0, stiffness: 10.0, damping: 0.5, stiffen_beyond: 1.1 };
        let (span, velocity) = ([0.1, 3.0, -1.0], [1.0, 2.0, 3.0]);
        assert!(
            gap.on_other::<RelativelyDampedStiffening>(span, velocity)
                .iter()
                .all(|&force| force == 0.0)
        );
        assert!(
            gap.on_other::<AxiallyDampedStiffening>(span, velocity)
                .iter()
                .all(|&force| force == 0.0)
        );
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
