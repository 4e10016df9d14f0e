//! Colliders and cloths that touch them, for the tests of contact.

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Certificate, Cloth, Collider, Collision, Mass, Settings, Shape, Simulation, SpringMaterial,
};

use crate::sheets::{grid_mesh, grid_positions};

/// A collider that keeps nothing free around it.
pub(crate) fn collider(shape: Shape, positions: Vec<Vector>, friction: f64) -> Collider {
    Collider { name: "collider".to_owned(), shape, positions, thickness: 0.0, friction }
}

/// A plane through the origin.
pub(crate) fn plane(normal: Vector, friction: f64) -> Collider {
    collider(Shape::Plane, vec![Vector::zeros(), normal], friction)
}

/// The floor z = 0.
pub(crate) fn floor(friction: f64) -> Collider {
    plane(Vector::z(), friction)
}

pub(crate) fn ball(center: Vector, radius: f64, friction: f64) -> Collider {
    collider(Shape::Sphere { radius }, vec![center], friction)
}

/// The corners of a box: corner i is at the larger end of axis a if bit a of i is set.
pub(crate) fn corners(center: Vector, size: Vector) -> Vec<Vector> {
    let corner = |i: usize| {
        let side = |axis: usize| if i & (1 << axis) == 0 { -0.5 } else { 0.5 };
        center + Vector::from_fn(|axis, _| side(axis) * size[axis])
    };
    (0..8).map(corner).collect()
}

/// A cloth as it is, that collides with everything.
pub(crate) fn colliding(cloth: Cloth, thickness: f64, friction: f64) -> Cloth {
    let collision = Some(Collision { thickness, friction, ..Collision::default() });
    Cloth { collision, ..cloth }
}

/// The same cloth, whose rest shape lies elsewhere.
pub(crate) fn placed(cloth: Cloth, place: impl Fn(&Vector) -> Vector) -> Cloth {
    Cloth { positions: cloth.positions.iter().map(place).collect(), ..cloth }
}

/// A flat grid of 0.2 kg/m² about the origin in the plane z = 0, of a width (m) along x and as even along y.
pub(crate) fn patch([columns, rows]: [u32; 2], width: f64, material: SpringMaterial) -> Cloth {
    let spacing = width / f64::from(columns - 1);
    let middle = Vector::new(width, spacing * f64::from(rows - 1), 0.0) / 2.0;
    let positions = grid_positions(columns, rows, spacing).iter().map(|x| x - middle).collect();
    let mesh = grid_mesh(columns, rows);
    let mass = Mass::Density(0.2);
    Cloth::from_mesh("patch", mesh, positions, &mass, material, Vec::new()).expect("a patch")
}

/// A profile of radii and heights (m) turned about the z axis, open at both ends; `sides` vertices a ring.
pub(crate) fn lathe(sides: u32, profile: &[[f64; 2]]) -> (Mesh, Vec<Vector>) {
    let ring = |&[radius, z]: &[f64; 2]| {
        (0..sides).map(move |side| {
            let angle = std::f64::consts::TAU * f64::from(side) / f64::from(sides);
            Vector::new(radius * angle.cos(), radius * angle.sin(), z)
        })
    };
    let positions: Vec<Vector> = profile.iter().flat_map(ring).collect();
    let faces: Vec<[u32; 4]> = (0..profile.len() as u32 - 1)
        .flat_map(|row| {
            (0..sides).map(move |side| {
                [row, row + 1].map(|row| [row * sides + side, row * sides + (side + 1) % sides])
            })
        })
        .map(|[[a, b], [c, d]]| [a, b, d, c])
        .collect();
    (Mesh::from_faces(positions.len(), &faces).expect("rings"), positions)
}

/// A simulation among colliders.
pub(crate) fn among(
    cloths: Vec<Cloth>,
    colliders: Vec<Collider>,
    settings: Settings,
) -> Simulation {
    Simulation::with_colliders(cloths, colliders, Vec::new(), settings).expect("a simulation")
}

/// Moves on by a frame, which must be whole: finite, free of intersections, within the deformation rate of all cloths by
/// 0.1 percentage points.
#[track_caller]
pub(crate) fn sound_frame(what: &str, simulation: &mut Simulation) -> Certificate {
    let certificate = simulation.advance().expect("a frame");
    let frame = certificate.frame;
    assert_eq!(certificate.intersections, Some(0), "{what}, frame {frame}: intersections");
    let rates = (0..simulation.cloth_count())
        .map(|cloth| simulation.cloth(cloth).material.deformation_rate);
    let most = rates.fold(0.0, f64::max) + 1e-3;
    let strain = certificate.max_strain;
    assert!(strain <= most, "{what}, frame {frame}: a strain of {strain}, allowed are {most}");
    for cloth in 0..simulation.cloth_count() {
        let lost = simulation.positions(cloth).iter().flatten().any(|x| !x.is_finite());
        assert!(!lost, "{what}, frame {frame}: cloth {cloth} is lost");
    }
    certificate
}

/// The mean of positions or velocities.
pub(crate) fn mean(vectors: &[Vector]) -> Vector {
    vectors.iter().sum::<Vector>() / vectors.len() as f64
}
