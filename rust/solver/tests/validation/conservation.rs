//! What a free sheet keeps: momentum, angular momentum, and energy up to its swing.

use boucle_geometry::Vector;
use boucle_solver::{DampingLaw, IntegratorKind, Mass, Simulation, SpringMaterial};

use crate::sheets::{grid_positions, launched, material, run, scattered, sheet, steps_of};

/// Momentum (kg·m/s), angular momentum (kg·m²/s) about the origin, and the sums of the sizes of their parts.
struct Momentum {
    linear: Vector,
    angular: Vector,
    linear_size: f64,
    angular_size: f64,
}

fn momentum(simulation: &Simulation) -> Momentum {
    let masses = simulation.cloth(0).masses.iter();
    let moving = simulation.positions(0).into_iter().zip(simulation.velocities(0));
    let parts: Vec<(Vector, Vector)> =
        masses.zip(moving).map(|(m, (x, v))| (v * *m, x.cross(&v) * *m)).collect();
    Momentum {
        linear: parts.iter().map(|part| part.0).sum(),
        angular: parts.iter().map(|part| part.1).sum(),
        linear_size: parts.iter().map(|part| part.0.norm()).sum(),
        angular_size: parts.iter().map(|part| part.1.norm()).sum(),
    }
}

/// A crumpling, turning, drifting sheet of uneven masses without gravity, let go after a frame. Steps of h seconds.
fn tumbling(integrator: IntegratorKind, material: SpringMaterial, h: f64) -> Simulation {
    let n = 12;
    let masses: Vec<f64> = (0..n * n).map(|i| 0.02 + 0.01 * scattered(i as usize)).collect();
    let cloth = sheet([n, n], 0.1, &Mass::Each(masses), material, &[]);
    let spin = Vector::new(0.7, -0.4, 2.0);
    let velocities: Vec<Vector> = grid_positions(n, n, 0.1)
        .iter()
        .enumerate()
        .map(|(i, x)| {
            let shake = Vector::from_fn(|axis, _| 0.3 * scattered(7 * i + axis));
            spin.cross(x) + shake + Vector::new(0.5, 0.2, -0.1)
        })
        .collect();
    launched(cloth, Vec::new(), steps_of(h, integrator), &velocities)
}

/// Drift over 1000 steps of h seconds, relative to the sum of the parts' sizes: linear and angular.
fn drift(integrator: IntegratorKind, material: SpringMaterial, h: f64) -> [f64; 2] {
    let mut simulation = tumbling(integrator, material, h);
    let before = momentum(&simulation);
    run(&mut simulation, 1000);
    let after = momentum(&simulation);
    [
        (after.linear - before.linear).norm() / before.linear_size,
        (after.angular - before.angular).norm() / before.angular_size,
    ]
}

fn springs() -> SpringMaterial {
    material([500.0, 100.0, 5.0])
}

/// A tenth of a second in steps so small that even forward Euler gains little energy: 1e-10 a second is 1e-11.
#[test]
fn a_free_sheet_keeps_its_momentum_under_every_rule_and_damping() {
    let damping = [0.05, 0.02, 0.01];
    let axial = DampingLaw::Axial;
    let materials = [
        springs(),
        SpringMaterial { damping, ..springs() },
        SpringMaterial { damping, damping_law: axial, ..springs() },
    ];
    for integrator in IntegratorKind::ALL {
        // Implicit rules round a velocity to that of a position over the step.
        let h = if IntegratorKind::EXPLICIT.contains(&integrator) { 1e-4 } else { 1e-2 };
        for material in &materials {
            let [linear, _] = drift(integrator, material.clone(), h);
            assert!(linear < 1e-11, "{integrator:?}: {linear:e} in 0.1 s");
        }
    }
}

#[test]
fn a_free_sheet_keeps_its_angular_momentum_under_symplectic_rules() {
    let rules = [IntegratorKind::SymplecticEuler, IntegratorKind::Verlet, IntegratorKind::Leapfrog];
    for integrator in rules {
        let [_, angular] = drift(integrator, springs(), 1e-3);
        assert!(angular < 1e-10, "{integrator:?}: {angular:e} a second");
    }
}

/// Forces along the springs keep it: 1e-10 holds for rules whose kick sees the positions that it acts at.
#[test]
fn axial_damping_keeps_angular_momentum_and_relative_damping_brakes_the_spin() {
    let damped = SpringMaterial { damping: [0.05, 0.02, 0.01], ..springs() };
    let axial = SpringMaterial { damping_law: DampingLaw::Axial, ..damped.clone() };
    let [_, kept] = drift(IntegratorKind::SymplecticEuler, axial, 1e-3);
    assert!(kept < 1e-10, "{kept:e} a second");
    let [_, braked] = drift(IntegratorKind::SymplecticEuler, damped, 1e-3);
    assert!(braked > 1e-3, "{braked:e} a second");
}

/// Verlet's energy swings by about (w h)²/4, here 3 %, of what the fast modes hold; forward Euler's grows without end.
#[test]
fn an_undamped_sheet_keeps_its_energy_up_to_a_swing_and_a_damped_one_loses_it() {
    let energy = |simulation: &Simulation| {
        let certificate = simulation.certificate();
        certificate.kinetic_energy + certificate.potential_energy
    };
    let mut verlet = tumbling(IntegratorKind::Verlet, springs(), 1e-3);
    let before = energy(&verlet);
    run(&mut verlet, 2000);
    assert!((energy(&verlet) / before - 1.0).abs() < 0.03, "{} of {before}", energy(&verlet));
    let damped = SpringMaterial { damping: [0.05, 0.02, 0.01], ..springs() };
    let mut damped = tumbling(IntegratorKind::Verlet, damped, 1e-3);
    let mut last = energy(&damped);
    for _ in 0..20 {
        run(&mut damped, 50);
        let now = energy(&damped);
        assert!(now < last, "a damped sheet gained energy: {last} to {now} J");
        last = now;
    }
}
