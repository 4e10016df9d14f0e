//! Sheets that fall through air.

use boucle_geometry::Vector;
use boucle_solver::{
    Flow, IntegratorKind, Mass, Settings, Simulation, SpringMaterial, Wind, WindLaw,
};

use crate::sheets::{G, assert_close, classic, in_wind, launched, material, run, sheet, steps_of};

const DOWN: Vector = Vector::new(0.0, 0.0, -G);

/// The speeds (m/s) at which all vertices of a flat falling sheet agree.
#[track_caller]
fn falling_speed(simulation: &Simulation) -> f64 {
    let velocities = simulation.velocities(0);
    let speed = -velocities[0].z;
    assert!(velocities.iter().all(|v| (v + Vector::z() * speed).norm() < 1e-9 * speed));
    speed
}

fn still_air(air_density: f64) -> Wind {
    Wind {
        velocity: Vector::zeros(),
        law: WindLaw::Face(Flow::new(air_density)),
        ..Wind::default()
    }
}

/// The fourth-order rule at a hundredth of the time constant is exact to 1e-10.
#[test]
fn viscous_air_brings_a_falling_sheet_to_weight_over_damping_with_mass_over_damping() {
    let (mass, damping) = (0.01, 0.1);
    let (terminal, time_constant) = (mass * G / damping, mass / damping);
    let material = SpringMaterial { air_damping: damping, ..material([50.0, 10.0, 1.0]) };
    let cloth = sheet([6, 6], 0.1, &Mass::PerVertex(mass), material, &[]);
    let settings = Settings { gravity: DOWN, ..steps_of(1e-3, IntegratorKind::Rk4) };
    let mut simulation = in_wind(cloth, Vec::new(), settings);
    for time_constants in 1..=5 {
        run(&mut simulation, 100);
        let t = 0.1 * f64::from(time_constants);
        let expected = terminal * (1.0 - (-t / time_constant).exp());
        assert_close(&format!("{t} s"), falling_speed(&simulation), expected, 1e-9);
    }
    run(&mut simulation, 2500);
    assert_close("at last", falling_speed(&simulation), terminal, 1e-9);
}

/// With a drag coefficient of 1: `v = v_t tanh(g t/v_t)`. The rule's error as above.
#[test]
fn a_flat_sheet_falls_through_air_to_the_speed_whose_pressure_carries_it() {
    let (density, air_density) = (0.2, 1.2);
    let terminal = (2.0 * density * G / air_density).sqrt();
    let cloth = sheet([6, 6], 0.1, &Mass::Density(density), material([50.0, 10.0, 1.0]), &[]);
    let settings = Settings { gravity: DOWN, ..steps_of(1e-3, IntegratorKind::Rk4) };
    let mut simulation = in_wind(cloth, vec![still_air(air_density)], settings);
    for tenths in 1..=5 {
        run(&mut simulation, 100);
        let t = 0.1 * f64::from(tenths);
        let expected = terminal * (G * t / terminal).tanh();
        assert_close(&format!("{t} s"), falling_speed(&simulation), expected, 1e-9);
    }
    run(&mut simulation, 4000);
    assert_close("at last", falling_speed(&simulation), terminal, 1e-9);
}

/// Soft springs allow long steps; a gale or a dense medium then damps faster than the springs move. Without gravity
/// a piece of cloth is never faster than the flow that carries it, but for its springs' recoil: twice is room.
#[test]
fn auto_steps_bear_a_gale_and_a_dense_flow() {
    for (speed, air_density) in [(50.0, 1.2), (2.0, 1000.0)] {
        let wind = Wind {
            velocity: Vector::new(0.3, 0.2, 1.0) * speed,
            law: WindLaw::Face(Flow::new(air_density)),
            ..Wind::default()
        };
        let cloth = sheet([8, 8], 0.1, &Mass::Density(0.1), material([1.0, 0.5, 0.1]), &[]);
        let settings = Settings { gravity: Vector::zeros(), threads: 1, ..classic() };
        let mut simulation = in_wind(cloth, vec![wind.clone()], settings);
        for frame in 0..48 {
            let result = simulation.advance();
            assert!(result.is_ok(), "{speed} m/s, {air_density} kg/m³: {result:?}");
            let velocities = simulation.velocities(0);
            let fastest = velocities.iter().map(Vector::norm).fold(0.0, f64::max);
            assert!(fastest < 2.0 * wind.velocity.norm(), "frame {frame}: {fastest} m/s");
        }
    }
}

/// Thrown down at forty times its terminal speed, as nothing at rest announces.
#[test]
fn auto_steps_bear_a_sheet_that_is_thrown_through_a_dense_medium() {
    let cloth = sheet([8, 8], 0.1, &Mass::Density(0.1), material([1.0, 0.5, 0.1]), &[]);
    let settings = Settings { gravity: DOWN, threads: 1, ..classic() };
    let velocities = vec![Vector::new(0.0, 0.0, -2.0); 64];
    let mut simulation = launched(cloth, vec![still_air(1000.0)], settings, &velocities);
    for _ in 0..48 {
        simulation.advance().expect("a frame");
        let fastest = simulation.velocities(0).iter().map(Vector::norm).fold(0.0, f64::max);
        assert!(fastest <= 2.0, "{fastest} m/s");
    }
}
