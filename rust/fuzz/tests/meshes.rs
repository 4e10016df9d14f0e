//! Meshes of every bad kind, by every integrator: a frame, or one line.

use boucle_fuzz::{accepted, advance};
use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Cloth, Collider, Collision, Fabric, IntegratorKind, Mass, Settings, Shape, Simulation,
    SpringMaterial,
};

type Made = (Vec<Vec<u32>>, Vec<Vector>);

/// A sheet of 4 by 4 vertices and 1 m.
fn sheet() -> Made {
    let at = |vertex: u32| Vector::new(f64::from(vertex % 4), 0.0, f64::from(vertex / 4)) / 3.0;
    let quads = (0..11).filter(|vertex| vertex % 4 < 3);
    let faces = quads.flat_map(|v| [vec![v, v + 1, v + 5], vec![v, v + 5, v + 4]]).collect();
    (faces, (0..16).map(at).collect())
}

/// The sheet with its positions changed.
fn moved(change: impl Fn(usize, Vector) -> Vector) -> Made {
    let (faces, positions) = sheet();
    let positions = positions.into_iter().enumerate().map(|(vertex, at)| change(vertex, at));
    (faces, positions.collect())
}

/// The sheet with more faces.
fn joined(more: &[[u32; 3]]) -> Made {
    let (mut faces, positions) = sheet();
    faces.extend(more.iter().map(|face| face.to_vec()));
    (faces, positions)
}

/// What is bad about a mesh, and whether springs of it can be simulated all the same.
fn meshes() -> Vec<(&'static str, Made, bool)> {
    let inverted = {
        let (mut faces, positions) = sheet();
        faces.iter_mut().step_by(3).for_each(|face| face.reverse());
        (faces, positions)
    };
    let apart = {
        let (faces, positions) = sheet();
        let corners = faces.iter().flatten().map(|&vertex| positions[vertex as usize]);
        (
            (0..faces.len() as u32).map(|f| vec![3 * f, 3 * f + 1, 3 * f + 2]).collect(),
            corners.collect(),
        )
    };
    let copied = {
        let (faces, positions) = sheet();
        let again = faces.iter().map(|face| face.iter().map(|vertex| vertex + 16).collect());
        let faces: Vec<Vec<u32>> = faces.iter().cloned().chain(again).collect();
        (faces, positions.iter().chain(&positions).copied().collect())
    };
    vec![
        ("nothing", sheet(), true),
        ("a third page at an edge", joined(&[[0, 1, 15], [0, 1, 10]]), true),
        ("two fans at a vertex", joined(&[[0, 15, 11]]), true),
        ("faces the other way round", inverted, true),
        (
            "every face twice",
            joined(&sheet().0.iter().map(|f| [f[0], f[1], f[2]]).collect::<Vec<_>>()),
            true,
        ),
        ("two sheets in one place", copied, true),
        ("triangles that hang together nowhere", apart, true),
        (
            "a face without area",
            moved(|v, at| if v == 5 { Vector::new(0.5, 0.0, 0.5) } else { at }),
            true,
        ),
        (
            "two vertices in one place",
            moved(|v, at| if v == 5 { Vector::zeros() } else { at }),
            false,
        ),
        ("all in one place", moved(|_, _| Vector::repeat(0.25)), false),
        ("all in one line", moved(|_, at| Vector::new(at.x + 4.0 * at.z, 0.0, 0.0)), false),
        ("needles", moved(|_, at| Vector::new(at.x, 0.0, 1e-5 * at.z)), true),
        ("thinner needles", moved(|_, at| Vector::new(at.x, 0.0, 1e-8 * at.z)), true),
        // Each of its vertices is lighter than what is accepted.
        ("a sheet of a micrometer", moved(|_, at| 1e-6 * at), false),
        ("a sheet of ten kilometers", moved(|_, at| 1e4 * at), true),
        ("a sheet far away", moved(|_, at| at + Vector::repeat(9e5)), true),
        ("a sheet beyond the world", moved(|_, at| at + Vector::repeat(2e6)), false),
        ("no number", moved(|v, at| if v == 7 { Vector::repeat(f64::NAN) } else { at }), false),
    ]
}

fn simulation(
    (faces, positions): &Made,
    integrator: IntegratorKind,
    fabric: bool,
    collides: bool,
) -> Option<Simulation> {
    let mesh = Mesh::from_faces(positions.len(), faces).expect("faces of three vertices");
    let (mass, material) = (Mass::Density(0.2), SpringMaterial::default());
    let cloth = Cloth::from_mesh("sheet", mesh, positions.clone(), &mass, material, vec![12, 15]);
    let mut cloth = accepted(cloth)?;
    if fabric {
        cloth = accepted(cloth.of_fabric(Fabric::default()))?;
    }
    cloth.collision = collides.then(Collision::default);
    let ball = Collider {
        name: "ball".to_owned(),
        shape: Shape::Sphere { radius: 0.2 },
        positions: vec![Vector::new(0.5, 0.0, -0.1)],
        thickness: 0.0,
        friction: 0.3,
    };
    let settings = Settings { integrator, threads: 1, ..Settings::default() };
    accepted(Simulation::with_colliders(vec![cloth], vec![ball], Vec::new(), settings))
}

/// Frames that were reached of a mesh, of springs and of fabric, without and with contact.
fn frames(made: &Made, integrator: IntegratorKind) -> [u32; 4] {
    [(false, false), (false, true), (true, false), (true, true)].map(|(fabric, collides)| {
        let Some(mut simulation) = simulation(made, integrator, fabric, collides) else { return 0 };
        (0..3).take_while(|_| advance(&mut simulation).is_some()).count() as u32
    })
}

#[test]
fn bad_meshes_are_simulated_or_refused_in_one_line_by_every_integrator() {
    for (what, made, is_simulated) in meshes() {
        for integrator in IntegratorKind::ALL {
            let reached = frames(&made, integrator);
            eprintln!("{what}, {}: {reached:?}", integrator.name());
            // Explicit integrators may need more steps than are allowed.
            if !is_simulated {
                assert_eq!(reached, [0; 4], "{what}, {}", integrator.name());
            } else if integrator == IntegratorKind::Bdf2 {
                assert_eq!(reached[0], 3, "{what}: springs without contact");
            }
        }
    }
}
