//! Forces against the gradient of the energy that certificates state, law by law; equation 6 value by value.

use boucle_geometry::Vector;
use boucle_solver::{Cloth, IntegratorKind, Limiter, Mass, SpringMaterial};

use crate::sheets::{
    assert_close, cloth, forces_at, grid_mesh, grid_positions, mass_on_spring, material, shaken,
    sheet, simulation, steps_of,
};

/// A sheet bent, sheared and drawn out in places, by up to a third of its springs.
fn crumpled(material: SpringMaterial) -> (Cloth, Vec<Vector>) {
    let cloth = sheet([5, 4], 0.3, &Mass::PerVertex(0.05), material, &[]);
    let positions = shaken(&cloth.positions, 0.06);
    (cloth, positions)
}

/// The opposite of the gradient of the potential energy (N), by central differences.
fn energy_slopes(cloth: &Cloth, gravity: Vector, positions: &[Vector]) -> Vec<Vector> {
    let e = 1e-5;
    let settings = steps_of(1.0, IntegratorKind::SymplecticEuler);
    let settings = boucle_solver::Settings { gravity, ..settings };
    let mut simulation = simulation(cloth.clone(), settings);
    let mut energy_with = |vertex: usize, axis: usize, shift: f64| {
        let mut moved = positions.to_vec();
        moved[vertex][axis] += shift;
        simulation.set_positions(0, &moved);
        simulation.certificate().potential_energy
    };
    let mut slope =
        |vertex, axis| (energy_with(vertex, axis, -e) - energy_with(vertex, axis, e)) / (2.0 * e);
    (0..positions.len()).map(|vertex| Vector::from_fn(|axis, _| slope(vertex, axis))).collect()
}

/// The error of a central difference over 1e-5 m is of order 1e-10 / 0.3² of the force.
#[test]
fn every_law_pushes_down_the_slope_of_its_energy() {
    let stiffen = |rate| SpringMaterial {
        limiter: Limiter::Stiffen,
        deformation_rate: rate,
        ..material([500.0, 100.0, 20.0])
    };
    let weight = Vector::new(1.0, -2.0, -9.81);
    let cases = [
        ("stretch", material([500.0, 0.0, 0.0]), Vector::zeros()),
        ("shear", material([0.0, 100.0, 0.0]), Vector::zeros()),
        ("bend", material([0.0, 0.0, 20.0]), Vector::zeros()),
        ("gravity", material([0.0; 3]), weight),
        ("all", material([500.0, 100.0, 20.0]), weight),
        ("equation 6", stiffen(0.1), weight),
        ("equation 6 at once", stiffen(0.0), weight),
    ];
    for (what, material, gravity) in cases {
        let (cloth, positions) = crumpled(material);
        let forces = forces_at(&cloth, &[], gravity, &positions);
        let slopes = energy_slopes(&cloth, gravity, &positions);
        let largest = forces.iter().map(Vector::norm).fold(0.0, f64::max);
        assert!(largest > 0.1, "{what}: the test sees no force");
        let error = crate::sheets::farthest(&forces, &slopes) / largest;
        assert!(error < 1e-6, "{what}: force and slope differ by {error:e}");
    }
}

/// Equation 6 as printed: `k L/L0` beyond the allowed length, k up to it. Ratios are right to 1e-14.
#[test]
fn equation_six_multiplies_the_stiffness_by_the_ratio_of_lengths_beyond_the_allowed_one() {
    let stiffen = SpringMaterial { limiter: Limiter::Stiffen, ..material([0.0; 3]) };
    let cases = [
        (0.5, 500.0),
        (1.0, 500.0),
        (1.0999, 500.0),
        (1.1001, 550.05),
        (1.2, 600.0),
        (2.5, 1250.0),
    ];
    for (ratio, expected) in cases {
        let cloth = mass_on_spring(500.0, 0.0, &stiffen);
        let positions = [Vector::zeros(), Vector::x() * ratio];
        let forces = forces_at(&cloth, &[], Vector::zeros(), &positions);
        let mut simulation = simulation(cloth, steps_of(1.0, IntegratorKind::SymplecticEuler));
        simulation.set_positions(0, &positions);
        let stiffness = simulation.spring_stiffness(0)[0];
        assert_close(&format!("stiffness at {ratio}"), stiffness, expected, 1e-12);
        assert!((forces[1].x + expected * (ratio - 1.0)).abs() < 1e-9, "{ratio}: {forces:?}");
    }
}

#[test]
fn other_limiters_leave_the_stiffness_as_it_is() {
    for limiter in [Limiter::None, Limiter::Provot, Limiter::Project] {
        let material = SpringMaterial { limiter, ..material([0.0; 3]) };
        let cloth = mass_on_spring(500.0, 0.0, &material);
        let mut simulation = simulation(cloth, steps_of(1.0, IntegratorKind::SymplecticEuler));
        simulation.set_positions(0, &[Vector::zeros(), Vector::x() * 3.0]);
        assert_eq!(simulation.spring_stiffness(0)[0].to_bits(), 500f64.to_bits());
    }
}

/// A spring's own coefficient counts, as its own stiffness does, whatever its cloth's material says.
#[test]
fn a_spring_damps_by_its_own_coefficient() {
    let mut cloth = mass_on_spring(1.0, 0.3, &material([0.0; 3]));
    cloth.material.damping = [0.0; 3];
    let settings = steps_of(1e-3, IntegratorKind::ForwardEuler);
    let velocities = [Vector::zeros(), Vector::x()];
    let mut simulation = crate::sheets::launched(cloth, Vec::new(), settings, &velocities);
    crate::sheets::run(&mut simulation, 1);
    // Elongated by one step of 1 mm, damped at 1 m/s: a = -0.001 - 0.3 m/s².
    let acceleration = (simulation.velocities(0)[1].x - 1.0) / 1e-3;
    assert!((acceleration + 0.301).abs() < 1e-6, "{acceleration} m/s²");
}

/// Areal density: each face shares its mass among its corners. A cell of 0.3 m and 2 kg/m² weighs 0.18 kg.
#[test]
fn a_sheet_weighs_its_density_times_its_area() {
    let of = |columns, rows| {
        let mesh = grid_mesh(columns, rows);
        let positions = grid_positions(columns, rows, 0.3);
        cloth(mesh, positions, &Mass::Density(2.0), material([1.0; 3]), &[]).masses
    };
    assert_close("all", of(5, 4).iter().sum(), 12.0 * 0.18, 1e-14);
    assert_close("corner", of(5, 4)[0], 0.045, 1e-14);
    assert_close("side", of(5, 4)[1], 0.09, 1e-14);
    assert_close("inside", of(5, 4)[6], 0.18, 1e-14);
}
