//! Wind on faces worked out by hand: its direction, its size, and where it blows.

use boucle_geometry::{Aabb, Mesh, Vector};
use boucle_solver::{
    Cloth, Flow, IntegratorKind, Mass, Region, Settings, Simulation, StepSize, Wind, WindLaw,
};

use crate::sheets::{cloth, forces_at, grid_mesh, launched, material, run, steps_of};

/// Two unit squares that share the edge from (1, 0, 0) to (1, 1, 0): one flat, its normal along z, one upright, its
/// normal along -x.
fn corner() -> Cloth {
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
        [1.0, 1.0, 1.0],
    ];
    still(grid_mesh(3, 2), &positions)
}

/// A cloth of vertices of 1 kg whose springs are without force.
fn still(mesh: Mesh, positions: &[[f64; 3]]) -> Cloth {
    let positions = positions.iter().map(|&position| position.into()).collect();
    cloth(mesh, positions, &Mass::PerVertex(1.0), material([0.0; 3]), &[])
}

fn wind(velocity: [f64; 3], law: WindLaw, region: Region) -> Wind {
    Wind { velocity: velocity.into(), law, region, ..Wind::default() }
}

/// The forces (N) of some winds on a cloth at rest; 1e-12 is rounding.
#[track_caller]
fn assert_forces(cloth: &Cloth, winds: &[Wind], expected: &[[f64; 3]]) {
    let forces = forces_at(cloth, winds, Vector::zeros(), &cloth.positions);
    for (vertex, (force, &expected)) in forces.iter().zip(expected).enumerate() {
        let error = (force - Vector::from(expected)).norm();
        assert!(error < 1e-12, "vertex {vertex}: {force:?} is not {expected:?}");
    }
}

const CLASSIC: WindLaw = WindLaw::Vertex { coefficient: 0.02 };
const PRESSURE: WindLaw = WindLaw::Face(Flow::new(1.2));

/// u = (1, 2, 3): along z it is 3, along -x it is -1, along the mean normal (-1, 0, 1)/√2 of the fold 2/√2, so that
/// the force there is 0.02 · 2/√2 · (-1, 0, 1)/√2.
#[test]
fn the_classic_wind_pushes_each_vertex_along_its_mean_normal() {
    let (flat, upright, fold) = ([0.0, 0.0, 0.06], [0.02, 0.0, 0.0], [-0.02, 0.0, 0.02]);
    let blow = wind([1.0, 2.0, 3.0], CLASSIC, Region::Everywhere);
    assert_forces(&corner(), &[blow], &[flat, fold, upright, flat, fold, upright]);
}

/// Half of 1.2 kg/m³ times 1 m² times the square of 3 or -1 m/s: 5.4 N along z and 0.6 N along x, a quarter of each
/// face's on each of its corners.
#[test]
fn pressure_pushes_each_face_and_its_corners_share_it() {
    let (flat, upright, fold) = ([0.0, 0.0, 1.35], [0.15, 0.0, 0.0], [0.15, 0.0, 1.35]);
    let blow = wind([1.0, 2.0, 3.0], PRESSURE, Region::Everywhere);
    assert_forces(&corner(), &[blow], &[flat, fold, upright, flat, fold, upright]);
}

/// A triangle of 1/2 m²: half of 1.2 times 1/2 times 4 is 1.2 N, 0.4 N a corner, and the other way from behind.
#[test]
fn pressure_pushes_a_triangle_by_its_area_from_either_side() {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for faces in [[[0, 1, 2]], [[0, 2, 1]]] {
        let mesh = Mesh::from_faces(3, &faces).expect("a triangle");
        let triangle = still(mesh, &positions);
        for sign in [1.0, -1.0] {
            let blow = wind([5.0, 0.0, 2.0 * sign], PRESSURE, Region::Everywhere);
            assert_forces(&triangle, &[blow], &[[0.0, 0.0, 0.4 * sign]; 3]);
            let classic = wind([5.0, 0.0, 2.0 * sign], CLASSIC, Region::Everywhere);
            assert_forces(&triangle, &[classic], &[[0.0, 0.0, 0.04 * sign]; 3]);
        }
    }
}

#[test]
fn wind_along_a_sheet_does_not_push_it() {
    let flat = still(
        grid_mesh(2, 2),
        &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]],
    );
    for law in [CLASSIC, PRESSURE] {
        assert_forces(&flat, &[wind([7.0, -3.0, 0.0], law, Region::Everywhere)], &[[0.0; 3]; 4]);
    }
}

/// The box holds the fold's vertices, the one at (1, 0, 0) on its surface, and no others.
#[test]
fn a_box_of_wind_pushes_the_vertices_inside_it_alone() {
    let region =
        Region::Box(Aabb { min: Vector::new(0.5, 0.0, -1.0), max: Vector::new(1.5, 1.5, 0.5) });
    let (none, fold) = ([0.0; 3], [-0.02, 0.0, 0.02]);
    let classic = wind([1.0, 2.0, 3.0], CLASSIC, region.clone());
    assert_forces(&corner(), &[classic], &[none, fold, none, none, fold, none]);
    let fold = [0.15, 0.0, 1.35];
    let pressure = wind([1.0, 2.0, 3.0], PRESSURE, region);
    assert_forces(&corner(), &[pressure], &[none, fold, none, none, fold, none]);
}

#[test]
fn a_region_of_vertices_is_pushed_alone_and_winds_add_up() {
    let (none, flat, upright) = ([0.0; 3], [0.0, 0.0, 0.06], [0.02, 0.0, 0.0]);
    let first = wind([1.0, 2.0, 3.0], CLASSIC, Region::Vertices(vec![0, 5]));
    assert_forces(
        &corner(),
        std::slice::from_ref(&first),
        &[flat, none, none, none, none, upright],
    );
    let second = wind([1.0, 2.0, 3.0], PRESSURE, Region::Vertices(vec![5]));
    let both = [0.17, 0.0, 0.0];
    assert_forces(&corner(), &[first, second], &[flat, none, none, none, none, both]);
}

/// Of two cloths each has its own wind, on all of it or on some vertices; what each feels is what it feels alone.
#[test]
fn a_wind_of_one_cloth_leaves_the_others_alone() {
    // One linear system for both is solved as exactly as one for each.
    for (integrator, law, allowed) in [
        (IntegratorKind::Bdf2, CLASSIC, 1e-3),
        (IntegratorKind::Bdf2, PRESSURE, 1e-3),
        (IntegratorKind::SymplecticEuler, CLASSIC, 1e-12),
        (IntegratorKind::SymplecticEuler, PRESSURE, 1e-12),
    ] {
        let winds = [([3.0, 1.0, 2.0], None), ([-2.0, 5.0, 1.0], Some(vec![0, 1, 4]))];
        let settings = || Settings {
            integrator,
            step_size: StepSize::Substeps(8),
            gravity: Vector::zeros(),
            threads: 1,
            ..Settings::default()
        };
        let blow = |number: usize, cloth: u32| {
            let (velocity, vertices) = winds[number].clone();
            wind(velocity, law, Region::Cloth(cloth, vertices))
        };
        let cloths = vec![corner(), corner()];
        let mut both = Simulation::new(cloths, vec![blow(0, 0), blow(1, 1)], settings())
            .expect("a simulation");
        run(&mut both, 3);
        for number in 0..2 {
            let mut alone = Simulation::new(vec![corner()], vec![blow(number, 0)], settings())
                .expect("a simulation");
            run(&mut alone, 3);
            let moved = alone.velocities(0).iter().map(Vector::norm).fold(0.0, f64::max);
            assert!(moved > 1e-3, "{number} feels nothing");
            for (one, other) in both.positions(number).iter().zip(alone.positions(0)) {
                assert!((one - other).norm() < allowed * moved, "{integrator:?}: {number}");
            }
        }
        let nobody = Simulation::new(vec![corner()], vec![blow(0, 1)], settings());
        assert!(nobody.is_err_and(|error| error.to_string().contains("the cloth of a wind is 1")));
    }
}

/// A step of forward Euler from a velocity v: the wind acts by u - v. What moves with the wind feels none.
#[test]
fn wind_acts_by_its_velocity_relative_to_the_cloth() {
    let u = Vector::new(1.0, 2.0, 3.0);
    let h = 1e-3;
    // Along z: 3 less 1, 3 and 5 m/s of the cloth's own.
    let cases = [(1.0, 0.04, 0.6 * 4.0 / 4.0), (3.0, 0.0, 0.0), (5.0, -0.04, -0.6 * 4.0 / 4.0)];
    for (own, classic, pressure) in cases {
        for (law, expected) in [(CLASSIC, classic), (PRESSURE, pressure)] {
            let flat = still(
                grid_mesh(2, 2),
                &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]],
            );
            let blow = Wind { velocity: u, law, region: Region::Everywhere, ..Wind::default() };
            let settings = steps_of(h, IntegratorKind::ForwardEuler);
            let velocities = [Vector::new(0.0, 0.0, own); 4];
            let mut simulation = launched(flat, vec![blow], settings, &velocities);
            run(&mut simulation, 1);
            for velocity in simulation.velocities(0) {
                let force = (velocity.z - own) / h;
                assert!((force - expected).abs() < 1e-9, "{law:?} at {own} m/s: {force} N");
            }
        }
    }
}
