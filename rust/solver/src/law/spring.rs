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
//! The same formulas run on one spring or on several side by side: [`Lanes`] is a few `f64`, and every
//! operation is one of IEEE 754's basic ones, never fused, so the bits do not depend on the machine.
//!
//! Source: Provot 1995; axial damping after the course notes of Baraff & Witkin 1997.

use std::ops::{Add, Mul, Sub};

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

/// Several numbers, one for each particle of a block.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<const W: usize>(pub(crate) [f64; W]);

impl<const W: usize> Lanes<W> {
    pub(crate) const ZERO: Self = Self([0.0; W]);

    #[inline(always)]
    pub(crate) fn splat(value: f64) -> Self {
        Self([value; W])
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(std::array::from_fn(|lane| f(self.0[lane])))
    }
}

macro_rules! lanewise {
    ($($trait:ident $method:ident $op:tt;)*) => {$(
        impl<const W: usize> $trait for Lanes<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(std::array::from_fn(|lane| self.0[lane] $op other.0[lane]))
            }
        }
    )*};
}

lanewise! { Add add +; Sub sub -; Mul mul *; }

/// A vector for each particle of a block.
pub(crate) type Vectors<const W: usize> = [Lanes<W>; 3];

#[inline(always)]
fn dot<const W: usize>(a: &Vectors<W>, b: &Vectors<W>) -> Lanes<W> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// One over the square root, within two units in the last place.
///
/// Single precision gives a first value y with `1 - q y²` of order 1e-7, and one step of Halley's method
/// cubes it: a third of the time of a square root and a division in double precision.
#[inline(always)]
fn inverse_root<const W: usize>(square: Lanes<W>) -> Lanes<W> {
    let y = square.map(|q| f64::from(1.0 / (q as f32).sqrt()));
    let r = Lanes::splat(1.0) - square * y * y;
    y + y * r * (Lanes::splat(0.5) + Lanes::splat(0.375) * r)
}

/// The springs from a block of particles to one neighbour each.
pub(crate) struct Block<const W: usize> {
    /// Particle less neighbour (m).
    pub(crate) span: Vectors<W>,
    /// The same of velocity (m/s).
    pub(crate) relative_velocity: Vectors<W>,
    pub(crate) rest_length: Lanes<W>,
    pub(crate) stiffness: Lanes<W>,
    pub(crate) damping: Lanes<W>,
    pub(crate) stiffen_beyond: f64,
}

impl<const W: usize> Block<W> {
    /// Adds the springs' forces (N) on the particles of the block.
    #[inline(always)]
    pub(crate) fn add_force<T: Terms>(&self, force: &mut Vectors<W>) {
        let span = &self.span;
        let squared = dot(span, span)
            .map(|q| if q > SHORTEST_SQUARED { q } else { SHORTEST_SQUARED });
        let inverse_length = inverse_root(squared);
        let mut stiffness = self.stiffness;
        if T::STIFFENS {
            let length = squared * inverse_length;
            let beyond = self.stiffen_beyond;
            stiffness = Lanes(std::array::from_fn(|lane| {
                let ratio = length.0[lane] / self.rest_length.0[lane];
                if ratio > beyond { stiffness.0[lane] * ratio } else { stiffness.0[lane] }
            }));
        }
        let mut pull = stiffness - stiffness * (self.rest_length * inverse_length);
        if T::DAMPING == Damping::Axial {
            let along = dot(&self.relative_velocity, span) * inverse_length * inverse_length;
            pull = pull + self.damping * along;
        }
        for axis in 0..3 {
            force[axis] = force[axis] - pull * span[axis];
            if T::DAMPING == Damping::Relative {
                force[axis] = force[axis] - self.damping * self.relative_velocity[axis];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_root_is_right_to_the_last_places() {
        for exponent in -35..35 {
            for step in 0..50 {
                let square = 10f64.powi(exponent) * (1.0 + 0.18 * f64::from(step));
                let error = (inverse_root(Lanes([square])).0[0] * square.sqrt() - 1.0).abs();
                assert!(error < 5e-16, "{square}: {error}");
            }
        }
    }

    fn force_of<T: Terms>(span: [f64; 3], velocity: [f64; 3]) -> [f64; 3] {
        let block = Block {
            span: span.map(|x| Lanes([x])),
            relative_velocity: velocity.map(|v| Lanes([v])),
            rest_length: Lanes([2.0]),
            stiffness: Lanes([10.0]),
            damping: Lanes([0.5]),
            stiffen_beyond: 1.1,
        };
        let mut force = [Lanes::ZERO; 3];
        block.add_force::<T>(&mut force);
        force.map(|lane| lane.0[0])
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
