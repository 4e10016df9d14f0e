//! What changes as the cloth moves: position and velocity of every particle, axis by axis.

use boucle_geometry::Vector;

/// A vector for each particle, stored as three arrays so that neighbours load side by side.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Coordinates(pub(crate) [Vec<f64>; 3]);

impl Coordinates {
    pub(crate) fn zeros(count: usize) -> Self {
        Self(std::array::from_fn(|_| vec![0.0; count]))
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
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct State {
    pub(crate) position: Coordinates,
    pub(crate) velocity: Coordinates,
}

impl State {
    pub(crate) fn at_rest(positions: &[Vector]) -> Self {
        let mut position = Coordinates::zeros(positions.len());
        for (particle, vector) in positions.iter().enumerate() {
            position.set(particle, vector);
        }
        Self { position, velocity: Coordinates::zeros(positions.len()) }
    }

    pub(crate) fn len(&self) -> usize {
        self.position.0[0].len()
    }

    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.position.copy_from(&other.position);
        self.velocity.copy_from(&other.velocity);
    }
}
