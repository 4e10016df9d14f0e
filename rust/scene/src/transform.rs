//! Rigid motions of rest shapes: where a cloth stands, and where its pins go.

use boucle_geometry::Vector;
use nalgebra::Rotation3;

use crate::description::{Keyframe, Transform};

/// A turn about the world's x, then y, then z axis by angles (degrees), then a displacement (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    rotation: Rotation3<f64>,
    location: Vector,
}

impl Motion {
    /// A motion from its displacement (m) and angles (degrees).
    #[must_use]
    pub fn new(location: [f64; 3], rotation_deg: [f64; 3]) -> Self {
        let [x, y, z] = rotation_deg.map(f64::to_radians);
        // nalgebra applies roll (x) first, then pitch (y), then yaw (z).
        let rotation = Rotation3::from_euler_angles(x, y, z);
        Self { rotation, location: Vector::from(location) }
    }

    /// Where a point (m) goes.
    #[must_use]
    pub fn apply(&self, point: &Vector) -> Vector {
        self.rotation * point + self.location
    }
}

impl Transform {
    /// Puts rest positions (m) where the scene wants them: scaled, turned, moved. Without a rotation, none rounds.
    pub fn place(&self, positions: &mut [Vector]) {
        let turns = self.rotation_deg.iter().any(|&angle| angle != 0.0);
        let motion = Motion::new(self.location, self.rotation_deg);
        for position in positions {
            *position *= self.scale;
            if turns {
                *position = motion.apply(position);
            } else {
                *position += motion.location;
            }
        }
    }
}

/// The motion at a frame: location and angles go in straight lines between keyframes, and rest before and after them.
///
/// `None` without keyframes.
#[must_use]
pub fn motion_at(keyframes: &[Keyframe], frame: i32) -> Option<Motion> {
    let after = keyframes.iter().position(|keyframe| keyframe.frame > frame);
    let (before, after) = match after {
        Some(0) => (keyframes.first()?, keyframes.first()?),
        Some(index) => (&keyframes[index - 1], &keyframes[index]),
        None => (keyframes.last()?, keyframes.last()?),
    };
    let span = f64::from(after.frame) - f64::from(before.frame);
    let share = if span > 0.0 { (f64::from(frame) - f64::from(before.frame)) / span } else { 0.0 };
    let mix = |from: [f64; 3], to: [f64; 3]| {
        std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]))
    };
    Some(Motion::new(
        mix(before.location, after.location),
        mix(before.rotation_deg, after.rotation_deg),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: &Vector, b: [f64; 3]) -> bool {
        (a - Vector::from(b)).norm() < 1e-12
    }

    #[test]
    fn angles_turn_about_x_then_y_then_z() {
        let motion = Motion::new([0.0; 3], [90.0, 90.0, 0.0]);
        // y goes to z about x, then z goes to x about y.
        assert!(close(&motion.apply(&Vector::y()), [1.0, 0.0, 0.0]));
        let motion = Motion::new([0.0, 0.0, 5.0], [0.0, 0.0, 90.0]);
        assert!(close(&motion.apply(&Vector::x()), [0.0, 1.0, 5.0]));
    }

    #[test]
    fn a_transform_scales_before_it_turns_and_turns_before_it_moves() {
        let transform =
            Transform { location: [1.0, 0.0, 0.0], rotation_deg: [0.0, 0.0, 90.0], scale: 2.0 };
        let mut positions = [Vector::x()];
        transform.place(&mut positions);
        assert!(close(&positions[0], [1.0, 2.0, 0.0]));
    }

    #[test]
    fn motion_is_straight_between_keyframes_and_rests_outside_them() {
        let keyframe = |frame, height| Keyframe {
            frame,
            location: [0.0, 0.0, height],
            rotation_deg: [0.0; 3],
        };
        let keyframes = [keyframe(10, 1.0), keyframe(20, 3.0)];
        let height =
            |frame| motion_at(&keyframes, frame).expect("keyframes").apply(&Vector::zeros()).z;
        let heights: Vec<f64> = [0, 10, 15, 20, 99].map(height).to_vec();
        assert_eq!(heights, [1.0, 1.0, 2.0, 3.0, 3.0]);
        assert!(motion_at(&[], 1).is_none());
    }
}
