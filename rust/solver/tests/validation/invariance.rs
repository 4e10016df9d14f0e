//! The same scene turned, moved, mirrored or renumbered moves the same.

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Cloth, DampingLaw, Flow, IntegratorKind, Limiter, Mass, Region, Settings, SpringMaterial, Wind,
    WindLaw,
};
use nalgebra::{Matrix3, Rotation3};

use crate::sheets::{
    classic, cloth, farthest, grid_mesh, grid_positions, in_wind, material, run, scattered, shaken,
};

/// A change of the scene: x becomes `turn * x + shift`.
struct Change {
    what: &'static str,
    turn: Matrix3<f64>,
    shift: Vector,
}

fn changes() -> Vec<Change> {
    let axis = nalgebra::Unit::new_normalize(Vector::new(0.3, -0.8, 0.5));
    let (still, none) = (Matrix3::identity(), Vector::zeros());
    let mirror = Matrix3::from_diagonal(&Vector::new(-1.0, 1.0, 1.0));
    vec![
        Change { what: "turned", turn: Rotation3::from_axis_angle(&axis, 1.1).into(), shift: none },
        Change { what: "moved", turn: still, shift: Vector::new(1.3, -2.1, 0.7) },
        Change { what: "mirrored", turn: mirror, shift: none },
    ]
}

impl Change {
    fn nothing() -> Self {
        Self { what: "", turn: Matrix3::identity(), shift: Vector::zeros() }
    }

    fn position(&self, x: &Vector) -> Vector {
        self.turn * x + self.shift
    }
}

/// A grid whose every other square is cut in two.
fn mixed_mesh(n: u32) -> Mesh {
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for square in grid_mesh(n, n).faces() {
        let [a, b, c, d] = [0, 1, 2, 3].map(|corner| square[corner]);
        if a % 2 == 0 {
            faces.push(square.to_vec());
        } else {
            faces.extend([vec![a, b, c], vec![a, c, d]]);
        }
    }
    Mesh::from_faces((n * n) as usize, &faces).expect("a mesh")
}

/// One of the scenes that are compared.
#[derive(Clone)]
struct Scene {
    what: &'static str,
    material: SpringMaterial,
    wind: WindLaw,
    integrator: IntegratorKind,
}

fn scenes() -> Vec<Scene> {
    let (classic, pressure) =
        (WindLaw::Vertex { coefficient: 0.002 }, WindLaw::Face(Flow::new(1.2)));
    let springs = SpringMaterial { damping: [0.02, 0.01, 0.005], ..material([200.0, 50.0, 5.0]) };
    let axial = SpringMaterial { damping_law: DampingLaw::Axial, ..springs.clone() };
    let with = |limiter| SpringMaterial { limiter, deformation_rate: 0.02, ..springs.clone() };
    let (euler, rk4) = (IntegratorKind::SymplecticEuler, IntegratorKind::Rk4);
    let scene = |what, material, wind, integrator| Scene { what, material, wind, integrator };
    vec![
        scene("relative damping", springs.clone(), classic, euler),
        scene("axial damping", axial, pressure, rk4),
        scene("stiffen", with(Limiter::Stiffen), classic, IntegratorKind::Verlet),
        scene("provot", with(Limiter::Provot), pressure, euler),
        scene("project", with(Limiter::Project), classic, euler),
    ]
}

/// The shape of a scene after 24 frames: a crumpled sheet of 1 m of quads and triangles, hung by two corners.
fn final_positions(scene: &Scene, change: &Change) -> Vec<Vector> {
    let n = 13;
    let flat = grid_positions(n, n, 1.0 / 12.0);
    let rest: Vec<Vector> = shaken(&flat, 0.01).iter().map(|x| change.position(x)).collect();
    let pins = [n * (n - 1), n * n - 1];
    let cloth = cloth(mixed_mesh(n), rest, &Mass::Density(0.2), scene.material.clone(), &pins);
    final_positions_of(cloth, None, scene, change)
}

fn final_positions_of(
    cloth: Cloth,
    start: Option<&[Vector]>,
    scene: &Scene,
    change: &Change,
) -> Vec<Vector> {
    let velocity = change.turn * Vector::new(0.5, 1.0, 2.0);
    let wind = Wind { velocity, law: scene.wind, region: Region::Everywhere, ..Wind::default() };
    let settings = Settings {
        gravity: change.turn * Vector::new(0.0, -9.81, 0.0),
        integrator: scene.integrator,
        threads: 1,
        ..classic()
    };
    let mut simulation = in_wind(cloth, vec![wind], settings);
    if let Some(start) = start {
        simulation.set_positions(0, start);
    }
    run(&mut simulation, 24);
    simulation.positions(0)
}

/// Relative to the cloth's size of 1 m.
#[track_caller]
fn assert_moves_the_same(scene: &Scene) {
    let plain = final_positions(scene, &Change::nothing());
    for change in changes() {
        let expected: Vec<Vector> = plain.iter().map(|x| change.position(x)).collect();
        let error = farthest(&final_positions(scene, &change), &expected);
        assert!(error < 1e-9, "{}, {}: off by {error:e} m", scene.what, change.what);
    }
}

#[test]
fn a_turned_moved_or_mirrored_scene_moves_the_same() {
    scenes().iter().filter(|scene| scene.what != "project").for_each(assert_moves_the_same);
}

#[test]
fn a_turned_moved_or_mirrored_scene_moves_the_same_under_the_projecting_limiter() {
    scenes().iter().filter(|scene| scene.what == "project").for_each(assert_moves_the_same);
}

/// On a regular grid many edges are equally far from the pins, but for rounding: it must not choose their order.
#[test]
fn a_turned_moved_or_mirrored_regular_grid_moves_the_same_under_every_limiter() {
    let n = 13;
    let pins = [n * (n - 1), n * n - 1];
    for scene in &scenes() {
        let final_positions = |change: &Change| {
            let flat = grid_positions(n, n, 1.0 / 12.0);
            let [rest, start] = [flat.clone(), shaken(&flat, 0.01)]
                .map(|shape| shape.iter().map(|x| change.position(x)).collect::<Vec<_>>());
            let (mass, material) = (Mass::Density(0.2), scene.material.clone());
            let cloth = cloth(grid_mesh(n, n), rest, &mass, material, &pins);
            final_positions_of(cloth, Some(&start), scene, change)
        };
        let plain = final_positions(&Change::nothing());
        for change in changes() {
            let expected: Vec<Vector> = plain.iter().map(|x| change.position(x)).collect();
            let error = farthest(&final_positions(&change), &expected);
            assert!(error < 1e-9, "{}, {}: off by {error:e} m", scene.what, change.what);
        }
    }
}

/// A grid numbered row by row is computed along its diagonals in memory, one numbered at random is gathered. Limiters
/// take springs in order of their numbers, so they are left out.
#[test]
fn a_renumbered_cloth_moves_the_same() {
    let n = 13_u32;
    let count = (n * n) as usize;
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| scattered(a).total_cmp(&scattered(b)));
    // Vertex i of the grid is vertex number[i] of the renumbered cloth.
    let mut number = vec![0_u32; count];
    for (new, &old) in order.iter().enumerate() {
        number[old] = new as u32;
    }
    let flat = shaken(&grid_positions(n, n, 1.0 / 12.0), 0.01);
    let pins = [n * (n - 1), n * n - 1];
    let renumbered = |vertex: u32| number[vertex as usize];
    let faces: Vec<Vec<u32>> =
        grid_mesh(n, n).faces().map(|face| face.iter().map(|&i| renumbered(i)).collect()).collect();
    let mesh = Mesh::from_faces(count, &faces).expect("a mesh");
    let rest: Vec<Vector> = order.iter().map(|&old| flat[old]).collect();
    for scene in scenes().iter().filter(|scene| !["provot", "project"].contains(&scene.what)) {
        let (material, mass) = (&scene.material, Mass::Density(0.2));
        let grid = cloth(grid_mesh(n, n), flat.clone(), &mass, material.clone(), &pins);
        let other =
            cloth(mesh.clone(), rest.clone(), &mass, material.clone(), &pins.map(renumbered));
        let plain = final_positions_of(grid, None, scene, &Change::nothing());
        let moved = final_positions_of(other, None, scene, &Change::nothing());
        let expected: Vec<Vector> = order.iter().map(|&old| plain[old]).collect();
        let error = farthest(&moved, &expected);
        assert!(error < 1e-9, "{}: off by {error:e} m", scene.what);
    }
}
