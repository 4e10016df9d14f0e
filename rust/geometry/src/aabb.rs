//! Axis-aligned boxes.

use crate::Vector;

/// An axis-aligned box (m), its faces included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: Vector,
    /// The corner with the largest coordinates.
    pub max: Vector,
}

impl Aabb {
    /// Whether a point lies in the box or on its surface.
    #[must_use]
    pub fn contains(&self, point: &Vector) -> bool {
        (0..3).all(|axis| self.min[axis] <= point[axis] && point[axis] <= self.max[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_holds_its_corners_and_nothing_beyond_them() {
        let unit = Aabb { min: Vector::zeros(), max: Vector::repeat(1.0) };
        assert!(unit.contains(&unit.min) && unit.contains(&unit.max));
        assert!(!unit.contains(&Vector::new(0.5, 1.0 + 1e-12, 0.5)));
        assert!(!unit.contains(&Vector::new(f64::NAN, 0.5, 0.5)));
    }
}
