//! What changes as the cloth moves: position and velocity of every particle, axis by axis.

use boucle_geometry::Vector;

use crate::aligned::Aligned;
use crate::cloth::FARTHEST;

/// The largest number that anything here may come to: its square, times a mass or a stiffness, is a number still.
pub(crate) const LARGEST: f64 = 1e100;

/// A vector for each particle, stored as three arrays so that neighbours load side by side.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Coordinates(pub(crate) [Aligned; 3]);

impl Coordinates {
    /// Zeros; `first` numbers the arrays, see [`Aligned::zeros`].
    fn zeros(count: usize, first: usize) -> Self {
        Self(std::array::from_fn(|axis| Aligned::zeros(count, first + axis)))
    }

    pub(crate) fn get(&self, particle: usize) -> Vector {
        Vector::from_fn(|axis, _| self.0[axis][particle])
    }

    pub(crate) fn set(&mut self, particle: usize, vector: &Vector) {
        for axis in 0..3 {
            self.0[axis][particle] = vector[axis];
        }
    }

    /// Squared distance between two particles.
    #[inline]
    pub(crate) fn distance_squared(&self, a: u32, b: u32) -> f64 {
        let [x, y, z] = self.0.each_ref().map(|axis| axis[a as usize] - axis[b as usize]);
        x * x + y * y + z * z
    }

    pub(crate) fn copy_from(&mut self, other: &Self) {
        for (axis, source) in self.0.iter_mut().zip(&other.0) {
            axis.copy_from_slice(source);
        }
    }
}

/// Positions (m) and velocities (m/s).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    pub(crate) position: Coordinates,
    pub(crate) velocity: Coordinates,
}

impl State {
    /// All particles at the origin, at rest.
    pub(crate) fn zeros(count: usize) -> Self {
        Self { position: Coordinates::zeros(count, 0), velocity: Coordinates::zeros(count, 3) }
    }

    pub(crate) fn at_rest(positions: &[Vector]) -> Self {
        let mut state = Self::zeros(positions.len());
        for (particle, vector) in positions.iter().enumerate() {
            state.position.set(particle, vector);
        }
        state
    }

    pub(crate) fn len(&self) -> usize {
        self.position.0[0].len()
    }

    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.position.copy_from(&other.position);
        self.velocity.copy_from(&other.velocity);
    }

    /// The first particle that left the finite numbers, or the space in which numbers are fine enough.
    pub(crate) fn first_lost(&self) -> Option<usize> {
        let is_lost = |&particle: &usize| {
            let position = self.position.get(particle);
            position.iter().any(|x| !(x.abs() <= 1e3 * FARTHEST))
                || self.velocity.get(particle).iter().any(|v| !(v.abs() <= LARGEST))
        };
        (0..self.len()).find(is_lost)
    }
}
