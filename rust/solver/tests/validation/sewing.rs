//! Seams: they close, with no more force than they may, and stay closed; strain, limiters and contact leave them alone.

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Cloth, Collision, IntegratorKind, Limiter, Mass, Settings, Sewing, Simulation, SpringKind,
    SpringMaterial,
};

use crate::sheets::{assert_close, cloth, forces_at, grid_mesh, grid_positions, run, simulation};

const N: u32 = 8;
const SPACING: f64 = 0.1;

/// Two square panels side by side, apart by a gap (m), whose near edges are sewn together.
fn panels(gap: f64, sewing: &Sewing) -> Cloth {
    let one = grid_positions(N, N, SPACING);
    let width = f64::from(N - 1) * SPACING + gap;
    let positions: Vec<Vector> =
        one.iter().copied().chain(one.iter().map(|x| x + width * Vector::x())).collect();
    let faces: Vec<Vec<u32>> = [0, N * N]
        .into_iter()
        .flat_map(|base| {
            let move_up = move |face: &[u32]| face.iter().map(|vertex| vertex + base).collect();
            grid_mesh(N, N).faces().map(move_up).collect::<Vec<Vec<u32>>>()
        })
        .collect();
    let mesh = Mesh::from_faces(positions.len(), &faces).expect("two panels");
    let seams = (0..N).map(|row| [row * N + N - 1, N * N + row * N]).collect();
    let material = SpringMaterial { air_damping: 0.001, ..SpringMaterial::default() };
    let cloth = cloth(mesh, positions, &Mass::Density(0.2), material, &[]);
    let Sewing { force_max, weld_distance, .. } = *sewing;
    cloth.sewn(Sewing { seams, force_max, weld_distance }).expect("a sewn cloth")
}

fn still() -> Settings {
    Settings { gravity: Vector::zeros(), threads: 1, ..Settings::default() }
}

fn widest(simulation: &Simulation) -> f64 {
    simulation.seam_gaps(0).into_iter().fold(0.0, f64::max)
}

#[test]
fn seams_are_springs_of_their_own_that_no_certificate_counts() {
    let cloth = panels(0.3, &Sewing::default());
    let seams = cloth.springs.iter().filter(|spring| spring.kind == SpringKind::Sewing);
    assert_eq!(seams.count(), N as usize);
    let simulation = simulation(cloth, still());
    let certificate = simulation.certificate();
    assert!(certificate.max_strain.abs() < 1e-9 && certificate.max_shear_strain.abs() < 1e-9);
    assert!(simulation.overstretched_edges(0).is_empty());
    assert!(simulation.vertex_strain(0).iter().all(|strain| strain.abs() < 1e-6));
    // 1/2 k d² of each seam.
    let expected = 0.5 * 500.0 * 0.09 * f64::from(N);
    assert_close("energy (J)", certificate.potential_energy, expected, 1e-6);
}

#[test]
fn seams_close_and_the_cloth_stays_where_it_is_as_a_whole() {
    for (integrator, force_max, frames) in [
        (IntegratorKind::Bdf2, 0.0, 24),
        (IntegratorKind::Bdf2, 0.05, 48),
        (IntegratorKind::ImplicitEuler, 0.05, 48),
        (IntegratorKind::SymplecticEuler, 0.05, 48),
    ] {
        let cloth = panels(0.3, &Sewing { force_max, ..Sewing::default() });
        let masses = cloth.masses.clone();
        let middle = |positions: &[Vector]| {
            let moments = positions.iter().zip(&masses).map(|(x, mass)| *mass * x);
            moments.sum::<Vector>() / masses.iter().sum::<f64>()
        };
        let before = middle(&cloth.positions);
        let mut simulation = simulation(cloth, Settings { integrator, ..still() });
        assert!(widest(&simulation) > 0.29);
        run(&mut simulation, frames);
        let gap = widest(&simulation);
        assert!(gap < 0.01 * SPACING, "{integrator:?} {force_max} N: {gap} m");
        assert!(simulation.certificate().max_strain < 0.1006);
        // Seams without a limit snap: single precision then loses a tenth of a millimetre.
        assert!((middle(&simulation.positions(0)) - before).norm() < 5e-4);
    }
}

#[test]
fn a_seam_pulls_with_no_more_than_its_largest_force() {
    for (force_max, expected) in [(0.0, 150.0), (2.0, 2.0), (1000.0, 150.0)] {
        let cloth = panels(0.3, &Sewing { force_max, ..Sewing::default() });
        let material = SpringMaterial { limiter: Limiter::None, ..cloth.material };
        let cloth = Cloth { material, ..cloth };
        let forces = forces_at(&cloth, &[], Vector::zeros(), &cloth.positions);
        assert_close("force (N)", forces[N as usize - 1].x, expected, 1e-6);
        assert_close("force (N)", forces[(N * N) as usize].x, -expected, 1e-6);
    }
}

/// With collisions, thick for its edges: what a seam joins meets, and nothing passes through anything.
#[test]
fn sewn_ends_meet_though_the_cloth_is_thick() {
    // What lies in the next rows holds back what is almost as thick as its edges are long: a part of an edge is left.
    for (thickness, left) in [(0.01, 0.001), (0.04, 0.1)] {
        let collision = Some(Collision { thickness, ..Collision::default() });
        let sewing = Sewing { force_max: 0.1, ..Sewing::default() };
        let cloth = Cloth { collision, ..panels(0.3, &sewing) };
        let mut simulation = simulation(cloth, still());
        for _ in 0..48 {
            run(&mut simulation, 1);
            assert_eq!(simulation.certificate().intersections, Some(0));
        }
        let gap = widest(&simulation);
        assert!(gap < left * SPACING, "thickness {thickness} m: {gap} m");
    }
}

/// A tube: one sheet whose two edges are sewn, rolled up as it starts. It closes and stands.
#[test]
fn a_rolled_sheet_closes_to_a_tube() {
    let (columns, rows) = (24, 6);
    let radius = f64::from(columns - 1) * 0.05 / std::f64::consts::TAU;
    let rolled = grid_positions(columns, rows, 0.05).into_iter().map(|x| {
        let angle = 0.9 * x.x / radius;
        Vector::new(radius * angle.cos(), radius * angle.sin(), x.y)
    });
    let seams = (0..rows).map(|row| [row * columns, row * columns + columns - 1]).collect();
    let mass = Mass::Density(0.2);
    let flat = cloth(
        grid_mesh(columns, rows),
        grid_positions(columns, rows, 0.05),
        &mass,
        SpringMaterial { air_damping: 0.001, ..SpringMaterial::default() },
        &[],
    );
    let tube = flat
        .starting_at(rolled.collect())
        .and_then(|tube| tube.sewn(Sewing { seams, force_max: 0.5, weld_distance: 0.002 }));
    let collision = Some(Collision { thickness: 0.01, ..Collision::default() });
    let mut simulation = simulation(Cloth { collision, ..tube.expect("a tube") }, still());
    run(&mut simulation, 36);
    assert!(widest(&simulation) < 1e-3, "{} m", widest(&simulation));
    assert_eq!(simulation.welded_seams(), rows as usize);
    assert_eq!(simulation.certificate().intersections, Some(0));
}

/// 2 N pull the panels apart: what a limited seam cannot hold, a welded one does, and after a checkpoint as well.
#[test]
fn what_is_welded_stays_joined() {
    let sewing = |weld_distance| Sewing { force_max: 0.02, weld_distance, ..Sewing::default() };
    let make = |weld_distance| {
        let cloth = panels(0.02, &sewing(weld_distance));
        // The far edges are pinned, and pull away once the seams have met.
        let pins = (0..N).flat_map(|row| [row * N, N * N + row * N + N - 1]).collect();
        simulation(Cloth { pins, ..cloth }, still())
    };
    let apart = |simulation: &mut Simulation, frame: u32| {
        let cloth = simulation.cloth(0);
        let far = (0.02 / 24.0) * f64::from(frame.min(24)) - 0.025;
        let aside = |i: usize| if i < (N * N) as usize { -far } else { far };
        let targets: Vec<Vector> =
            cloth.positions.iter().enumerate().map(|(i, x)| x + aside(i) * Vector::x()).collect();
        simulation.set_pin_targets(0, &targets);
        run(simulation, 1);
    };
    let mut gaps = Vec::new();
    for weld_distance in [0.0, 0.005] {
        let mut whole = make(weld_distance);
        for frame in 0..12 {
            apart(&mut whole, if frame < 6 { 0 } else { frame });
        }
        let checkpoint = whole.checkpoint();
        let go_on = |simulation: &mut Simulation| {
            for frame in 12..72 {
                apart(simulation, 2 * frame);
            }
        };
        go_on(&mut whole);
        let mut resumed = make(weld_distance);
        resumed.restore(&checkpoint).expect("a checkpoint");
        go_on(&mut resumed);
        assert_eq!(whole.certificate().hash, resumed.certificate().hash);
        gaps.push((widest(&whole), whole.welded_seams()));
    }
    assert!(gaps[0].1 == 0 && gaps[1].1 == N as usize, "{gaps:?}");
    assert!(gaps[1].0 < 1e-3 && gaps[0].0 > 5.0 * gaps[1].0, "{gaps:?}");
}

#[test]
fn seams_that_cannot_be_are_refused() {
    let plain = panels(0.3, &Sewing::default());
    let bare = Cloth { springs: plain.springs.clone(), ..plain.clone() };
    for (seam, expected) in [
        ([3, 3], "a seam joins vertices 3 and 3; accepted: two of the 128 vertices"),
        ([0, 500], "a seam joins vertices 0 and 500"),
        ([0, 1], "which an edge of a face joins"),
    ] {
        let error = bare.clone().sewn(Sewing { seams: vec![seam], ..Sewing::default() });
        let error = error.expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}");
    }
    let material = SpringMaterial { limiter: Limiter::Stiffen, ..plain.material.clone() };
    let error = Simulation::new(vec![Cloth { material, ..plain }], Vec::new(), still());
    assert!(error.expect_err("stiffen").to_string().contains("accepted: another limiter"));
}
