//! Scenes of the literature: the course assignment's curtains and the numpy demonstration's.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, IntegratorKind, Limiter, Mass, Region, Settings, Simulation, SpringMaterial, StepSize,
    Wind, WindLaw,
};

use crate::plain::Plain;
use crate::sheets::{classic, farthest, in_wind, material, run, sheet, simulation};

/// The numpy demonstration: 14 x 14 particles, one spring constant, a wind on the lower corner far from x = 0.
fn demonstration() -> Plain {
    Plain {
        n: 14,
        spacing: 0.2,
        stiffness: [8.0; 3],
        mass: 0.01,
        air_damping: 0.05,
        gravity: Vector::new(0.0, -4.0, 0.0),
        wind_velocity: Vector::new(0.5, 0.0, 3.0),
        wind_coefficient: 0.02,
        is_blown: |column, row| column >= 10 && row < 4,
        pins: vec![13 * 14, 14 * 14 - 1],
    }
}

/// The same in the solver, in its own steps of 0.01 s, which its stability bound must accept.
fn demonstration_in_the_solver(plain: &Plain) -> Simulation {
    let material = SpringMaterial { air_damping: plain.air_damping, ..material(plain.stiffness) };
    let n = plain.n;
    let cloth = sheet([n, n], plain.spacing, &Mass::PerVertex(plain.mass), material, &plain.pins);
    let blown = (0..n * n).filter(|i| (plain.is_blown)(i % n, i / n));
    let wind = Wind {
        velocity: plain.wind_velocity,
        law: WindLaw::Vertex { coefficient: plain.wind_coefficient },
        region: Region::Vertices(blown.collect()),
        ..Wind::default()
    };
    let settings = Settings {
        gravity: plain.gravity,
        fps: 10.0,
        integrator: IntegratorKind::SymplecticEuler,
        step_size: StepSize::Seconds(0.01),
        threads: 1,
        ..classic()
    };
    in_wind(cloth, vec![wind], settings)
}

/// Rounding of 1e-16 grows with the cloth's motion: 1e-11 m after two seconds of it.
#[test]
fn the_numpy_demonstration_moves_as_the_plain_method_does() {
    let plain = demonstration();
    let mut simulation = demonstration_in_the_solver(&plain);
    let mut tenths = 0;
    for frames in [1, 9, 10] {
        run(&mut simulation, frames);
        tenths += frames as u32;
        let expected = plain.run(0.01, 10 * tenths);
        let error = farthest(&simulation.positions(0), &expected);
        assert!(error < 1e-9, "after {tenths} tenths of a second: {error:e} m");
    }
}

/// Vertices of the demonstration and where they are after two seconds: `tests/native/test_scene_files.py` expects
/// the same of `tests/scenes/numpy_demo.toml`.
const AFTER_TWO_SECONDS: [(usize, [f64; 3]); 3] = [
    (0, [-0.029_236_6, -0.285_243_6, -0.000_407_3]),
    (13, [2.191_530_9, -0.058_801_5, 0.907_303_8]),
    (90, [1.192_957_4, 0.871_240_1, -0.006_641_3]),
];

#[test]
fn the_numpy_demonstration_is_where_its_scene_file_is_expected_to_be() {
    let plain = demonstration();
    let mut simulation = demonstration_in_the_solver(&plain);
    run(&mut simulation, 20);
    let positions = simulation.positions(0);
    for (vertex, expected) in AFTER_TWO_SECONDS {
        let error = (positions[vertex] - Vector::from(expected)).norm();
        assert!(error < 1e-6, "vertex {vertex}: {:?}", positions[vertex]);
    }
}

/// z = 0.90: stable. Air damping at 5/s leaves no motion after 30 s; the blown corner stands downwind.
#[test]
fn the_numpy_demonstration_comes_to_rest_downwind() {
    let plain = demonstration();
    let mut simulation = demonstration_in_the_solver(&plain);
    run(&mut simulation, 300);
    let certificate = simulation.certificate();
    assert!(certificate.kinetic_energy < 1e-9, "{} J", certificate.kinetic_energy);
    let positions = simulation.positions(0);
    assert!(positions[13].z > 0.05, "the blown corner stands at {} m", positions[13].z);
    assert!(positions.iter().all(|x| x.norm() < 10.0));
    for &pin in &plain.pins {
        assert_eq!(positions[pin as usize], simulation.cloth(0).positions[pin as usize]);
    }
}

/// The course's cloth: 50 x 50 points on a square metre, 150 kg shared among them, bend springs of 0.2 ks. Its
/// damping takes 0.2 % of the velocity each step: an air damping of 0.002 m/h.
fn course_cloth(ks: f64, pins: &[u32], limiter: Limiter) -> Cloth {
    let material = SpringMaterial {
        limiter,
        deformation_rate: 0.10,
        air_damping: 0.002 * 0.06 * 2700.0,
        ..material([ks, ks, 0.2 * ks])
    };
    sheet([50, 50], 1.0 / 49.0, &Mass::PerVertex(0.06), material, pins)
}

/// The course's cloth after some seconds of Verlet steps of 1/2700 s: accepted, for w h = 0.302 at ks = 5000 N/m.
fn hung(ks: f64, pins: &[u32], limiter: Limiter, seconds: usize) -> Simulation {
    let settings = Settings {
        gravity: Vector::new(0.0, 0.0, -9.8),
        fps: 30.0,
        integrator: IntegratorKind::Verlet,
        step_size: StepSize::Seconds(1.0 / 2700.0),
        threads: 1,
        ..classic()
    };
    let mut simulation = simulation(course_cloth(ks, pins, limiter), settings);
    run(&mut simulation, 30 * seconds);
    simulation
}

const TWO_CORNERS: [u32; 2] = [0, 49];
const FOUR_CORNERS: [u32; 4] = [0, 49, 2450, 2499];

/// How far (m) the lowest point hangs below the pins.
fn sag(simulation: &Simulation) -> f64 {
    -simulation.positions(0).iter().map(|x| x.z).fold(0.0, f64::min)
}

/// The limiter promises the deformation rate to 0.1 percentage points at frame ends. Left and right mirror each
/// other: the cloth starts flat and the limiter takes edges in an order that tells them apart by that much.
#[test]
fn the_courses_curtain_on_two_corners_ends_within_its_deformation_rate() {
    let simulation = hung(5000.0, &TWO_CORNERS, Limiter::Project, 4);
    let strain = simulation.certificate().max_strain;
    assert!(strain <= 0.101, "{strain}");
    let positions = simulation.positions(0);
    let lowest = sag(&simulation);
    assert!((0.9..1.5).contains(&lowest), "it hangs {lowest} m down");
    let uneven = (positions[2450].z - positions[2499].z).abs();
    assert!(uneven < 0.01, "its lower corners differ by {uneven} m");
}

#[test]
fn the_courses_sheet_on_four_corners_ends_within_its_deformation_rate() {
    let simulation = hung(5000.0, &FOUR_CORNERS, Limiter::Project, 4);
    let strain = simulation.certificate().max_strain;
    assert!(strain <= 0.101, "{strain}");
    let (lowest, middle) = (sag(&simulation), -simulation.positions(0)[25 * 50 + 25].z);
    assert!(middle > 0.95 * lowest && (0.1..0.8).contains(&lowest), "{lowest} m, {middle} m");
}

/// Sags (m) at four stiffnesses after 2 s, in which damping at 5.4/s brings them within a millimetre of rest.
fn sags(pins: &[u32]) -> [f64; 4] {
    [50.0, 500.0, 5000.0, 50_000.0].map(|ks| sag(&hung(ks, pins, Limiter::Project, 2)))
}

#[test]
fn sag_from_two_corners_falls_as_the_springs_stiffen_from_50_to_50000() {
    let sags = sags(&TWO_CORNERS);
    assert!(sags.windows(2).all(|pair| pair[0] > pair[1] + 1e-3), "{sags:?}");
}

#[test]
fn sag_from_four_corners_falls_as_the_springs_stiffen_from_50_to_50000() {
    let sags = sags(&FOUR_CORNERS);
    assert!(sags.windows(2).all(|pair| pair[0] > pair[1] + 1e-3), "{sags:?}");
}
