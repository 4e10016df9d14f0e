//! From the colliders of a description to points, and to where these are at each frame.

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{Collider, Shape};
use xxhash_rust::xxh3::Xxh3;

use crate::description::{ColliderDescription, Keyframe};
use crate::error::{Error, Result};
use crate::samples::Samples;
use crate::transform::{Motion, motion_at};

/// A collider as it stands, before any motion.
#[derive(Clone, Debug)]
pub struct RestCollider {
    /// What its points are joined to.
    pub shape: Shape,
    /// Its points (m), in world space.
    pub positions: Vec<Vector>,
    /// Where a cache puts its points at each frame.
    pub samples: Option<Samples>,
}

impl RestCollider {
    /// A mesh that does not deform, put where the description says.
    ///
    /// # Errors
    /// [`Error::Input`] when it has no faces.
    pub fn of_mesh(
        mesh: Mesh,
        mut positions: Vec<Vector>,
        description: &ColliderDescription,
    ) -> Result<Self> {
        if mesh.face_count() == 0 {
            let name = &description.name;
            let accepted = "accepted: a mesh with at least one face";
            return Err(Error::input(format!("collider \"{name}\" has no faces; {accepted}")));
        }
        description.transform.place(&mut positions);
        Ok(Self { shape: Shape::Mesh(mesh), positions, samples: None })
    }

    /// A sphere, plane, box or capsule; `None` for a mesh, which is elsewhere.
    #[must_use]
    pub fn of_numbers(description: &ColliderDescription) -> Option<Self> {
        let transform = &description.transform;
        let (shape, mut positions) = if let Some(sphere) = &description.sphere {
            let radius = transform.scale * sphere.radius;
            (Shape::Sphere { radius }, vec![Vector::from(sphere.center)])
        } else if let Some(plane) = &description.plane {
            let point = Vector::from(plane.point);
            // Of unit length after the transform.
            let normal = Vector::from(plane.normal).normalize() / transform.scale;
            (Shape::Plane, vec![point, point + normal])
        } else if let Some(capsule) = &description.capsule {
            let radius = transform.scale * capsule.radius;
            (Shape::Capsule { radius }, vec![Vector::from(capsule.a), Vector::from(capsule.b)])
        } else {
            let cuboid = description.r#box.as_ref()?;
            let motion = Motion::new(cuboid.center, cuboid.rotation_deg);
            let corner = |index: usize| {
                let end = |axis: usize| if index >> axis & 1 == 1 { 0.5 } else { -0.5 };
                let corner = std::array::from_fn(|axis| end(axis) * cuboid.size[axis]);
                motion.apply(&Vector::from(corner))
            };
            (Shape::cuboid(), (0..8).map(corner).collect())
        };
        transform.place(&mut positions);
        Some(Self { shape, positions, samples: None })
    }

    /// Adds everything that the result depends on, beside the description, to a digest.
    pub(crate) fn feed(&self, hash: &mut Xxh3) {
        hash.update(&(self.positions.len() as u64).to_le_bytes());
        for number in self.positions.iter().flatten() {
            hash.update(&number.to_le_bytes());
        }
        if let Shape::Mesh(mesh) = &self.shape {
            for face in mesh.faces() {
                hash.update(&(face.len() as u64).to_le_bytes());
                for corner in face {
                    hash.update(&corner.to_le_bytes());
                }
            }
        }
        if let Some(samples) = &self.samples {
            samples.feed(hash);
        }
    }
}

/// How one collider moves.
#[derive(Clone, Debug)]
pub(crate) struct ColliderTrack {
    motion: Vec<Keyframe>,
    samples: Option<Samples>,
    /// Its points (m) where it stands; empty where it does not move.
    rest: Vec<Vector>,
}

impl ColliderTrack {
    /// The collider at the scene's first frame, and how it moves from there.
    pub(crate) fn new(
        description: &ColliderDescription,
        rest: RestCollider,
        first_frame: i32,
    ) -> (Collider, Self) {
        let moves = !description.motion.is_empty();
        let track = Self {
            motion: description.motion.clone(),
            samples: rest.samples,
            rest: if moves { rest.positions.clone() } else { Vec::new() },
        };
        let collider = Collider {
            name: description.name.clone(),
            shape: rest.shape,
            positions: track.at(first_frame).unwrap_or(rest.positions),
            thickness: description.thickness,
            friction: description.friction,
        };
        (collider, track)
    }

    /// Where the points are at a frame (m); `None` if the scene does not move them.
    pub(crate) fn at(&self, frame: i32) -> Option<Vec<Vector>> {
        if let Some(samples) = &self.samples {
            return Some(samples.at(frame));
        }
        let motion = motion_at(&self.motion, frame)?;
        Some(self.rest.iter().map(|point| motion.apply(point)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::Scene;

    const CLOTH: &str = "[[cloth]]\nname = \"a\"\ngrid = { size = [1, 1], vertices = [2, 2] }\n";

    fn described(keys: &str) -> ColliderDescription {
        let text = format!("{CLOTH}[[collider]]\nname = \"thing\"\n{keys}\n");
        Scene::from_toml(&text, &[]).expect(keys).collider.remove(0)
    }

    fn rest(keys: &str) -> RestCollider {
        RestCollider::of_numbers(&described(keys)).expect("a shape of numbers")
    }

    fn close(a: &Vector, b: [f64; 3]) -> bool {
        (a - Vector::from(b)).norm() < 1e-12
    }

    #[test]
    fn a_transform_scales_radii_too() {
        let transform = "transform = { scale = 2, location = [1, 0, 0] }";
        let ball = rest(&format!("sphere = {{ center = [0, 0, 3], radius = 0.5 }}\n{transform}"));
        assert_eq!(ball.shape, Shape::Sphere { radius: 1.0 });
        assert!(close(&ball.positions[0], [1.0, 0.0, 6.0]));
        let capsule = "capsule = { a = [0, 0, 0], b = [0, 0, 1], radius = 0.25 }";
        let capsule = rest(&format!("{capsule}\n{transform}"));
        assert_eq!(capsule.shape, Shape::Capsule { radius: 0.5 });
        assert!(close(&capsule.positions[1], [1.0, 0.0, 2.0]));
    }

    #[test]
    fn a_plane_has_a_second_point_a_metre_in_front() {
        let plane = rest(
            "plane = { point = [0, 0, 1], normal = [0, 0, 9] }\n\
             transform = { scale = 3, rotation_deg = [0, 90, 0] }",
        );
        assert_eq!(plane.shape, Shape::Plane);
        assert!(close(&plane.positions[0], [3.0, 0.0, 0.0]));
        assert!(close(&plane.positions[1], [4.0, 0.0, 0.0]));
    }

    #[test]
    fn the_corners_of_a_box_are_in_the_order_that_its_faces_ask_for() {
        let cuboid =
            rest("box = { center = [0, 0, 5], size = [2, 4, 6], rotation_deg = [0, 0, 90] }");
        assert_eq!(cuboid.shape, Shape::cuboid());
        // x goes to y, y to -x.
        assert!(close(&cuboid.positions[0], [2.0, -1.0, 2.0]));
        assert!(close(&cuboid.positions[1], [2.0, 1.0, 2.0]));
        assert!(close(&cuboid.positions[2], [-2.0, -1.0, 2.0]));
        assert!(close(&cuboid.positions[4], [2.0, -1.0, 8.0]));
        let Shape::Mesh(mesh) = &cuboid.shape else { panic!("a box is a mesh") };
        for face in 0..6 {
            let middle: Vector =
                mesh.face(face).iter().map(|&v| cuboid.positions[v as usize]).sum();
            let outward = mesh.vector_area(face, &cuboid.positions);
            assert!(outward.dot(&(middle / 4.0 - Vector::new(0.0, 0.0, 5.0))) > 0.0, "{face}");
        }
    }

    #[test]
    fn a_collider_is_at_the_first_frame_where_its_motion_says_and_moves_as_pins_do() {
        let described = described(
            "sphere = { center = [1, 0, 0], radius = 0.5 }\nmotion = [{ frame = 0 }, \
             { frame = 10, location = [0, 0, 2], rotation_deg = [0, 0, 180] }]",
        );
        let rest = RestCollider::of_numbers(&described).expect("a ball");
        let (collider, track) = ColliderTrack::new(&described, rest, 5);
        assert!(close(&collider.positions[0], [0.0, 1.0, 1.0]));
        let at = |frame| track.at(frame).expect("it moves")[0];
        assert!(close(&at(0), [1.0, 0.0, 0.0]));
        assert!(close(&at(99), [-1.0, 0.0, 2.0]));
    }

    #[test]
    fn a_collider_without_motion_is_left_alone() {
        let described = described("sphere = { center = [1, 0, 0], radius = 0.5 }");
        let rest = RestCollider::of_numbers(&described).expect("a ball");
        let (collider, track) = ColliderTrack::new(&described, rest, 5);
        assert!(close(&collider.positions[0], [1.0, 0.0, 0.0]));
        assert!(track.at(6).is_none());
        assert!((collider.friction - 0.3).abs() < 1e-15 && collider.thickness.abs() < 1e-15);
    }
}
