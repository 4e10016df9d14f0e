//! Sheets, chains and lone springs that the tests simulate, and ways to look at them.

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Bulk, Cloth, IntegratorKind, Limiter, Mass, PinMaterial, Settings, Simulation, Spring,
    SpringKind, SpringMaterial, StepSize, Tailoring, Wind,
};

/// Standard gravity of the tests (m/s²).
pub(crate) const G: f64 = 9.81;

/// Springs of these stiffnesses (N/m), without damping and without a limiter.
pub(crate) fn material(stiffness: [f64; 3]) -> SpringMaterial {
    SpringMaterial { stiffness, limiter: Limiter::None, ..SpringMaterial::default() }
}

/// Quads between rows of vertices; vertex `row * columns + column`.
pub(crate) fn grid_mesh(columns: u32, rows: u32) -> Mesh {
    let faces: Vec<[u32; 4]> = (0..rows - 1)
        .flat_map(|row| (0..columns - 1).map(move |column| row * columns + column))
        .map(|i| [i, i + 1, i + columns + 1, i + columns])
        .collect();
    Mesh::from_faces((columns * rows) as usize, &faces).expect("a grid")
}

/// The vertices of a grid in the plane z = 0, its columns along x and its rows along y.
pub(crate) fn grid_positions(columns: u32, rows: u32, spacing: f64) -> Vec<Vector> {
    (0..columns * rows)
        .map(|i| Vector::new(f64::from(i % columns), f64::from(i / columns), 0.0) * spacing)
        .collect()
}

/// A flat grid with its springs.
pub(crate) fn sheet(
    [columns, rows]: [u32; 2],
    spacing: f64,
    mass: &Mass,
    material: SpringMaterial,
    pins: &[u32],
) -> Cloth {
    let positions = grid_positions(columns, rows, spacing);
    cloth(grid_mesh(columns, rows), positions, mass, material, pins)
}

/// A cloth with the springs of its mesh.
pub(crate) fn cloth(
    mesh: Mesh,
    positions: Vec<Vector>,
    mass: &Mass,
    material: SpringMaterial,
    pins: &[u32],
) -> Cloth {
    Cloth::from_mesh("sheet", mesh, positions, mass, material, pins.to_vec()).expect("a cloth")
}

/// An undamped stretch spring.
pub(crate) fn spring(ends: [u32; 2], rest_length: f64, stiffness: f64) -> Spring {
    Spring { ends, kind: SpringKind::Stretch, rest_length, stiffness, damping: 0.0 }
}

/// Particles joined by springs, without faces.
pub(crate) fn network(
    positions: Vec<Vector>,
    springs: Vec<Spring>,
    masses: Vec<f64>,
    pins: &[u32],
    material: SpringMaterial,
) -> Cloth {
    let (name, pins) = ("network".to_owned(), pins.to_vec());
    Cloth {
        name,
        mesh: Mesh::default(),
        positions,
        springs,
        masses,
        pins,
        pin_weights: Vec::new(),
        pin_material: PinMaterial::default(),
        fabric: None,
        material,
        collision: None,
        tailoring: Tailoring::default(),
        pressure: None,
        bulk: Bulk::default(),
    }
}

/// A mass of 1 kg on a spring of 1 m along x from a pin at the origin. The damping (N·s/m) is the spring's.
pub(crate) fn mass_on_spring(stiffness: f64, damping: f64, material: &SpringMaterial) -> Cloth {
    let spring = Spring { damping, ..spring([0, 1], 1.0, stiffness) };
    let material = SpringMaterial { damping: [damping, 0.0, 0.0], ..material.clone() };
    network(vec![Vector::zeros(), Vector::x()], vec![spring], vec![1.0; 2], &[0], material)
}

/// The paper's integrator, with everything else as by default.
pub(crate) fn classic() -> Settings {
    Settings { integrator: IntegratorKind::SymplecticEuler, ..Settings::default() }
}

/// Frames of one step of h seconds each, taken whether stable or not, without gravity, on one thread.
pub(crate) fn steps_of(h: f64, integrator: IntegratorKind) -> Settings {
    Settings {
        gravity: Vector::zeros(),
        fps: 1.0 / h,
        integrator,
        step_size: StepSize::Substeps(1),
        allow_unstable: true,
        threads: 1,
        ..classic()
    }
}

/// A simulation of one cloth without wind.
pub(crate) fn simulation(cloth: Cloth, settings: Settings) -> Simulation {
    in_wind(cloth, Vec::new(), settings)
}

/// A simulation of one cloth.
pub(crate) fn in_wind(cloth: Cloth, winds: Vec<Wind>, settings: Settings) -> Simulation {
    Simulation::new(vec![cloth], winds, settings).expect("a simulation")
}

/// Moves on by some frames.
pub(crate) fn run(simulation: &mut Simulation, frames: usize) {
    for _ in 0..frames {
        simulation.advance().expect("a frame");
    }
}

/// A simulation whose free vertices have just been let go at these velocities (m/s): pins carry them for a frame.
pub(crate) fn launched(
    cloth: Cloth,
    winds: Vec<Wind>,
    settings: Settings,
    velocities: &[Vector],
) -> Simulation {
    let count = cloth.positions.len() as u32;
    let kept = cloth.pins.clone();
    let duration = 1.0 / settings.fps;
    let targets: Vec<Vector> =
        cloth.positions.iter().zip(velocities).map(|(x, v)| x + v * duration).collect();
    let held = Cloth { pins: (0..count).collect(), ..cloth };
    let mut simulation = in_wind(held, winds, settings);
    simulation.set_pin_targets(0, &targets);
    run(&mut simulation, 1);
    let free: Vec<u32> = (0..count).filter(|vertex| !kept.contains(vertex)).collect();
    simulation.release_pins(0, &free);
    simulation
}

/// The forces (N) on particles at rest in these positions (m): a step from rest changes velocities by h F/m.
pub(crate) fn forces_at(
    cloth: &Cloth,
    winds: &[Wind],
    gravity: Vector,
    positions: &[Vector],
) -> Vec<Vector> {
    let h = 1e-3;
    let settings = Settings { gravity, ..steps_of(h, IntegratorKind::SymplecticEuler) };
    let mut simulation = in_wind(cloth.clone(), winds.to_vec(), settings);
    simulation.set_positions(0, positions);
    run(&mut simulation, 1);
    let velocities = simulation.velocities(0);
    velocities.iter().zip(&cloth.masses).map(|(v, mass)| v * (mass / h)).collect()
}

/// A number in -1 to 1 that looks random and is always the same (the fractional part of a large sine).
pub(crate) fn scattered(index: usize) -> f64 {
    let large = (index as f64 * 12.9898 + 1.0).sin() * 43_758.545_3;
    2.0 * (large - large.floor()) - 1.0
}

/// Positions, each moved by up to `amplitude` (m) along every axis.
pub(crate) fn shaken(positions: &[Vector], amplitude: f64) -> Vec<Vector> {
    let shake = |i: usize| Vector::from_fn(|axis, _| amplitude * scattered(3 * i + axis));
    positions.iter().enumerate().map(|(i, position)| position + shake(i)).collect()
}

/// The largest distance (m) between two lists of points.
pub(crate) fn farthest(a: &[Vector], b: &[Vector]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// Whether a number is that expected, within a part of it.
#[track_caller]
pub(crate) fn assert_close(what: &str, number: f64, expected: f64, tolerance: f64) {
    let error = (number / expected - 1.0).abs();
    assert!(error <= tolerance, "{what}: {number} is not {expected}: off by {error:.2e}");
}
