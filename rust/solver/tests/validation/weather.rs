//! Winds that lift, blow in gusts, are turbulent, and are kept off by colliders.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, Collider, Flow, Gusts, IntegratorKind, Mass, Settings, Shape, Simulation, StepSize,
    Turbulence, Wind, WindLaw,
};

use crate::sheets::{
    G, assert_close, cloth, forces_at, grid_mesh, grid_positions, in_wind, material, run, sheet,
    steps_of,
};

const SOFT: [f64; 3] = [50.0, 10.0, 1.0];

fn by_face(velocity: Vector, flow: Flow) -> Wind {
    Wind { velocity, law: WindLaw::Face(flow), ..Wind::default() }
}

/// A sheet of 1 m² that leans against a wind along x by an angle of attack.
fn leaning(degrees: f64) -> Cloth {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let positions = grid_positions(6, 6, 0.2);
    let positions = positions.iter().map(|x| Vector::new(x.x * cos, x.y, -x.x * sin)).collect();
    cloth(grid_mesh(6, 6), positions, &Mass::Density(0.2), material(SOFT), &[])
}

/// `1/2 rho A w²` times Cd sin a along the wind and times Cl sin a cos a across it: Keckeisen's laws; 1e-9 is rounding.
#[test]
fn an_inclined_sheet_feels_the_drag_and_lift_of_the_closed_forms() {
    let flow = Flow { drag: 1.17, lift: Some(0.9), ..Flow::new(1.2) };
    for degrees in [10.0, 30.0, 60.0, 90.0_f64] {
        let leaning = leaning(degrees);
        let blow = by_face(Vector::x() * 7.0, flow);
        let forces = forces_at(&leaning, &[blow], Vector::zeros(), &leaning.positions);
        let total: Vector = forces.iter().sum();
        let (sin, cos) = degrees.to_radians().sin_cos();
        let pressure = 0.5 * 1.2 * 49.0;
        assert_close("drag", total.x, pressure * 1.17 * sin, 1e-9);
        assert!((total.z - pressure * 0.9 * sin * cos).abs() < 1e-9, "{degrees}: {total:?}");
        assert!(total.y.abs() < 1e-9);
    }
}

/// Friction alone: a wind along a sheet drags it by 1/2 rho Cf A w².
#[test]
fn a_wind_along_a_sheet_drags_it_by_friction() {
    let flow = Flow { friction: 0.02, ..Flow::new(1.2) };
    let flat = leaning(0.0);
    let forces =
        forces_at(&flat, &[by_face(Vector::x() * 7.0, flow)], Vector::zeros(), &flat.positions);
    let total: Vector = forces.iter().sum();
    assert_close("friction", total.x, 0.5 * 1.2 * 0.02 * 49.0, 1e-9);
}

/// `sqrt(2 m g/(rho Cd A))`, by every kind of step. Implicit ones begin each from free fall, and what two iterations leave of that is
/// half a percent.
#[test]
fn a_falling_sheet_reaches_the_speed_at_which_drag_carries_it() {
    for integrator in
        [IntegratorKind::Bdf2, IntegratorKind::ImplicitEuler, IntegratorKind::SymplecticEuler]
    {
        for lift in [None, Some(1.5)] {
            let flow = Flow { drag: 1.3, lift, ..Flow::new(1.2) };
            let cloth = sheet([6, 6], 0.1, &Mass::Density(0.2), material(SOFT), &[]);
            let settings = Settings { integrator, threads: 1, ..Settings::default() };
            let mut falling = in_wind(cloth, vec![by_face(Vector::zeros(), flow)], settings);
            run(&mut falling, 72);
            let is_explicit = integrator == IntegratorKind::SymplecticEuler;
            let allowed = if is_explicit { 1e-3 } else { 1e-2 };
            let terminal = (2.0 * 0.2 * G / (1.2 * 1.3)).sqrt();
            for velocity in falling.velocities(0) {
                assert_close("terminal speed", -velocity.z, terminal, allowed);
            }
        }
    }
}

/// At its middle a gust that is drawn as strong as any: forces grow as the square of 1 + strength at the most, and no less than
/// those of the mean wind.
#[test]
fn gusts_press_as_the_square_of_their_speed() {
    let flat = leaning(90.0);
    let gusts = Gusts { strength: 0.6, period: 0.5, seed: 2 };
    let blow = Wind { gusts: Some(gusts), ..by_face(Vector::x() * 4.0, Flow::new(1.2)) };
    let held = Cloth { pins: (0..36).collect(), ..flat.clone() };
    // Seen by one free vertex in the middle among pins, without springs.
    let lone = Cloth { pins: (0..36).filter(|&vertex| vertex != 14).collect(), ..held };
    let lone = Cloth { springs: Vec::new(), ..lone };
    let h = 1e-2;
    let mut simulation = in_wind(lone, vec![blow], steps_of(h, IntegratorKind::SymplecticEuler));
    let (mut before, mut forces) = (Vector::zeros(), Vec::new());
    let mass = 0.2 * 0.04;
    for _ in 0..400 {
        run(&mut simulation, 1);
        let now = simulation.velocities(0)[14];
        forces.push((now - before).norm() * mass / h);
        before = Vector::zeros();
        simulation.set_velocities(0, &[Vector::zeros(); 36]);
        simulation.set_positions(0, &flat.positions);
    }
    let plain = 0.5 * 1.2 * 16.0 * 0.04;
    let (least, most) =
        forces.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &x| (a.min(x), b.max(x)));
    assert!(least >= plain * (1.0 - 1e-6) && least < plain * 1.01, "{least} of {plain}");
    assert!(most < plain * 1.6 * 1.6 && most > plain * 1.3 * 1.3, "{most} of {plain}");
}

/// Turbulence that a wind carries along: with no eddy at all, and with eddies, the sheet drifts the same way but not alike.
#[test]
fn turbulence_shakes_a_sheet_and_its_seed_chooses_how() {
    let end = |turbulence: Option<Turbulence>| {
        let flag = sheet([8, 8], 0.1, &Mass::Density(0.2), material([200.0, 50.0, 5.0]), &[0, 56]);
        let blow = Wind { turbulence, ..by_face(Vector::new(4.0, 0.5, 0.3), Flow::new(1.2)) };
        let settings = Settings { threads: 1, ..Settings::default() };
        let mut simulation = in_wind(flag, vec![blow], settings);
        run(&mut simulation, 24);
        simulation.positions(0)
    };
    let with = |intensity, seed| end(Some(Turbulence { intensity, size: 0.5, seed }));
    let steady = end(None);
    let apart = |other: Vec<Vector>| crate::sheets::farthest(&steady, &other);
    assert!(apart(with(0.0, 1)) < 1e-12);
    assert!(apart(with(0.3, 1)) > 0.01);
    assert!(crate::sheets::farthest(&with(0.3, 1), &with(0.3, 2)) > 0.01);
}

fn wall() -> Collider {
    let corners = |i: u32| {
        let bit = |axis: u32| f64::from(i >> axis & 1);
        Vector::new(-1.0 - 0.2 * bit(0), 4.0 * bit(1) - 1.5, 4.0 * bit(2) - 2.5)
    };
    let positions = (0..8).map(corners).collect();
    Collider {
        name: "wall".to_owned(),
        shape: Shape::cuboid(),
        positions,
        thickness: 0.0,
        friction: 0.0,
    }
}

/// A wall of 4 m upwind: at rest in its lee nothing moves at all; without shelter, or with the wind from the other side, it does.
#[test]
fn cloth_behind_a_collider_feels_nothing() {
    for (speed, is_sheltered, moves) in [(8.0, true, false), (8.0, false, true), (-8.0, true, true)]
    {
        let turbulence = Some(Turbulence { intensity: 0.2, size: 0.5, seed: 1 });
        let wind = by_face(Vector::x() * speed, Flow::new(1.2));
        let wind = Wind { is_sheltered, turbulence, ..wind };
        let upright = leaning(90.0);
        let settings = Settings { gravity: Vector::zeros(), threads: 1, ..Settings::default() };
        let cloths = vec![upright.clone()];
        let mut simulation = Simulation::with_colliders(cloths, vec![wall()], vec![wind], settings)
            .expect("a simulation");
        run(&mut simulation, 12);
        let way = crate::sheets::farthest(&upright.positions, &simulation.positions(0));
        assert!((way > 0.1) == moves && (moves || way < 1e-12), "{speed}, {is_sheltered}: {way}");
    }
}

/// Half a sheet in the lee: as much less force as faces feel less wind.
#[test]
fn a_sheet_that_stands_half_in_the_lee_feels_half_the_wind() {
    let edge = Collider {
        positions: wall().positions.iter().map(|x| x - Vector::y() * 2.0).collect(),
        ..wall()
    };
    let upright = leaning(90.0);
    let settings = steps_of(1e-3, IntegratorKind::SymplecticEuler);
    let total = |is_sheltered| {
        let wind = by_face(Vector::x() * 8.0, Flow::new(1.2));
        let winds = vec![Wind { is_sheltered, ..wind }];
        let (cloths, walls) = (vec![upright.clone()], vec![edge.clone()]);
        let mut simulation = Simulation::with_colliders(cloths, walls, winds, settings.clone())
            .expect("a simulation");
        run(&mut simulation, 1);
        let pushes = simulation.velocities(0).into_iter().zip(&upright.masses);
        pushes.map(|(v, mass)| v.x * mass / 1e-3).sum::<f64>()
    };
    assert_close("in the open", total(false), 0.5 * 1.2 * 64.0, 1e-9);
    // The edge of the wall stands at y = 0.5, in the middle of a row of faces: two rows of five feel all of it, one the half of its
    // speed.
    assert_close("half in the lee", total(true), 0.45 * 0.5 * 1.2 * 64.0, 1e-9);
}

/// Lift is no damping: it may hand energy to cloth; but at any step of an implicit rule it stays bounded.
#[test]
fn long_steps_bear_a_gale_that_lifts() {
    let flow = Flow { drag: 1.0, lift: Some(2.0), friction: 0.05, ..Flow::new(1.2) };
    let gusts = Some(Gusts { strength: 1.0, period: 0.3, seed: 5 });
    let wind = Wind { gusts, ..by_face(Vector::new(30.0, 3.0, 5.0), flow) };
    let flag = sheet([8, 8], 0.1, &Mass::Density(0.1), material([500.0, 100.0, 5.0]), &[0, 56]);
    let settings = Settings { step_size: StepSize::Substeps(1), threads: 1, ..Settings::default() };
    let mut simulation = in_wind(flag, vec![wind], settings);
    for _ in 0..96 {
        run(&mut simulation, 1);
        let fastest = simulation.velocities(0).iter().map(Vector::norm).fold(0.0, f64::max);
        assert!(fastest < 200.0, "{fastest} m/s");
    }
}
