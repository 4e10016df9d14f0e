//! Wet cloth: how heavy it becomes, and that its wetness is part of the state.

use boucle_geometry::Vector;
use boucle_solver::{
    Bulk, Cloth, Collider, Flow, Gusts, IntegratorKind, Mass, Settings, Shape, Simulation,
    Turbulence, Water, Wave, Wind, WindLaw,
};

use crate::determinism::velocity_bits;
use crate::sheets::{G, assert_close, in_wind, material, run, sheet};

fn cotton() -> Bulk {
    Bulk { density: 400.0, absorbency: 2.0, soak_time: 2.0, dry_time: Some(1.0), ..Bulk::default() }
}

fn towel(bulk: Bulk, pins: &[u32], height: f64) -> Cloth {
    let springs = material([500.0, 100.0, 10.0]);
    let cloth = sheet([8, 8], 0.1, &Mass::Density(0.3), springs, pins);
    let positions = cloth.positions.iter().map(|x| x + Vector::z() * height).collect();
    Cloth { bulk, positions, ..cloth }
}

fn settings(water: Water) -> Settings {
    Settings { water: Some(water), threads: 1, ..Settings::default() }
}

/// The square root of time, up to what it can hold; then it weighs three times as much and is denser than water: it sinks.
#[test]
fn cloth_floats_soaks_by_the_square_root_of_time_and_sinks() {
    let mut simulation = in_wind(towel(cotton(), &[], 0.0), Vec::new(), settings(Water::default()));
    for frame in 1..=48 {
        run(&mut simulation, 1);
        let expected = (f64::from(frame) / 48.0).sqrt();
        for wetness in simulation.wetness(0) {
            assert_close(&format!("frame {frame}"), wetness, expected, 1e-9);
        }
        if frame == 12 {
            // 0.5 of 2 taken up: 400 (1 + 1) kg/m³ still floats.
            assert!(simulation.positions(0).iter().all(|x| x.z > -0.01));
        }
    }
    run(&mut simulation, 72);
    assert!(simulation.positions(0).iter().all(|x| x.z < -0.05));
    let held = towel(Bulk { absorbency: 0.0, ..cotton() }, &[], 0.0);
    let mut floating = in_wind(held, Vec::new(), settings(Water::default()));
    run(&mut floating, 120);
    assert!(floating.positions(0).iter().all(|x| x.z > -0.01));
    assert!(floating.wetness(0).iter().all(|wetness| wetness.to_bits() == 0));
}

/// Seen from outside: the energy of height of a wet cloth in the air is three times that of the dry one; it dries evenly.
#[test]
fn soaked_cloth_weighs_what_it_has_taken_up_and_dries_again() {
    let pins: Vec<u32> = (0..64).collect();
    let mut simulation =
        in_wind(towel(cotton(), &pins, 0.5), Vec::new(), settings(Water::default()));
    let weight = |simulation: &Simulation| simulation.certificate().potential_energy / (G * 0.5);
    let dry = 0.3 * 0.49;
    assert_close("dry", weight(&simulation), dry, 1e-9);
    simulation.set_water(1.0, Vector::zeros()).expect("water");
    run(&mut simulation, 60);
    simulation.set_water(0.0, Vector::zeros()).expect("water");
    assert!(simulation.wetness(0).iter().all(|wetness| wetness.to_bits() == 1.0_f64.to_bits()));
    run(&mut simulation, 6);
    assert_close("drying", weight(&simulation), dry * (1.0 + 2.0 * 0.75), 1e-9);
    run(&mut simulation, 30);
    assert_close("dry again", weight(&simulation), dry, 1e-9);
}

/// The terminal speed in air of a soaked sheet: `sqrt(2 (1 + a) sigma g/(rho Cd))`. So inertia and weight are both of the wet mass.
#[test]
fn soaked_cloth_falls_as_fast_as_its_weight_says() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::SymplecticEuler] {
        let wind = Wind { velocity: Vector::zeros(), ..Wind::default() };
        let bulk = Bulk { soak_time: 0.1, dry_time: None, ..cotton() };
        let pins: Vec<u32> = (0..64).collect();
        let water = settings(Water { level: 1.0, ..Water::default() });
        let mut simulation =
            in_wind(towel(bulk, &pins, 0.5), vec![wind], Settings { integrator, ..water });
        run(&mut simulation, 6);
        simulation.set_water(-1e5, Vector::zeros()).expect("water");
        simulation.release_pins(0, &pins);
        run(&mut simulation, 120);
        let speed = (2.0 * 3.0 * 0.3 * G / 1.2).sqrt();
        let velocities = simulation.velocities(0);
        let mean = velocities.iter().map(|v| -v.z).sum::<f64>() / 64.0;
        assert_close(&format!("{integrator:?}"), mean, speed, 2e-3);
    }
}

fn ball() -> Collider {
    let shape = Shape::Sphere { radius: 0.3 };
    let positions = vec![Vector::new(-0.6, 0.3, 0.1)];
    Collider { name: "ball".to_owned(), shape, positions, thickness: 0.0, friction: 0.0 }
}

/// A towel that falls through a gusty lee into waves and soaks there, beside a closed pillow.
fn storm(integrator: IntegratorKind, threads: usize) -> Simulation {
    let wave = Wave { amplitude: 0.05, length: 1.0, direction: Vector::new(1.0, 0.4, 0.0) };
    let velocity = Vector::new(0.3, 0.0, 0.0);
    let water = Water { waves: vec![wave], velocity, ..Water::default() };
    let flow = Flow { lift: Some(0.7), friction: 0.02, ..Flow::new(1.2) };
    let wind = Wind {
        velocity: Vector::new(5.0, 1.0, 0.0),
        law: WindLaw::Face(flow),
        gusts: Some(Gusts { strength: 0.5, period: 0.4, seed: 1 }),
        turbulence: Some(Turbulence { intensity: 0.3, size: 0.4, seed: 1 }),
        is_sheltered: true,
        ..Wind::default()
    };
    let Shape::Mesh(mesh) = Shape::cuboid() else { panic!("a box is a mesh") };
    let corner = |i: u32| Vector::from_fn(|axis, _| 0.3 * f64::from(i >> axis & 1));
    let positions = (0..8).map(|i| corner(i) + Vector::new(2.0, 0.0, 0.1)).collect();
    let springs = material([500.0, 500.0, 50.0]);
    let mass = Mass::Density(3.0);
    let pillow = crate::sheets::cloth(mesh, positions, &mass, springs, &[]);
    let towel = Cloth {
        bulk: Bulk { dry_time: Some(5.0), soak_time: 0.5, ..cotton() },
        ..towel(cotton(), &[0], 0.1)
    };
    let settings = Settings { integrator, threads, ..settings(water) };
    let cloths = vec![towel, pillow];
    Simulation::with_colliders(cloths, vec![ball()], vec![wind], settings).expect("a simulation")
}

#[test]
fn a_storm_at_sea_has_the_same_bits_for_any_number_of_threads() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::SymplecticEuler] {
        let bits = |threads| {
            let mut simulation = storm(integrator, threads);
            run(&mut simulation, 10);
            let wetness: Vec<u64> = simulation.wetness(0).iter().map(|w| w.to_bits()).collect();
            (simulation.certificate().hash, velocity_bits(&simulation), wetness)
        };
        let one = bits(1);
        assert!(one.2.iter().any(|bits| *bits != 0));
        for threads in [2, 4] {
            assert!(bits(threads) == one, "{integrator:?}: {threads} threads");
        }
    }
}

#[test]
fn a_storm_at_sea_goes_on_with_the_same_bits_from_a_checkpoint() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::Rk4] {
        let mut whole = storm(integrator, 1);
        let mut checkpoints = Vec::new();
        let blow = |simulation: &mut Simulation| {
            let part = f64::from(simulation.frame());
            let wind = Vector::new(5.0 + 0.3 * part, 1.0, 0.0);
            simulation.set_wind_velocity(0, wind).expect("a wind");
            simulation.set_water(0.01 * part, Vector::x() * 0.03 * part).expect("water");
            run(simulation, 1);
        };
        for _ in 0..8 {
            checkpoints.push(whole.checkpoint());
            blow(&mut whole);
        }
        for (frames, checkpoint) in checkpoints.iter().enumerate().step_by(3) {
            let mut resumed = storm(integrator, 1);
            resumed.restore(checkpoint).expect("its own");
            (frames..8).for_each(|_| blow(&mut resumed));
            assert!(resumed.certificate() == whole.certificate(), "{integrator:?} from {frames}");
            assert!(velocity_bits(&resumed) == velocity_bits(&whole));
            assert_eq!(resumed.checkpoint(), whole.checkpoint());
        }
    }
}
