//! Fabric that creases and rubs as it bends: energy, checkpoints, threads, rest shapes, and a strip that clamps bend.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, Fabric, IntegratorKind, Mass, Settings, Simulation, SpringMaterial, StepSize, Warp,
};

use crate::fabric::{assert_energy_never_grows, energy, of_fabric};
use crate::sheets::{assert_close, grid_mesh, grid_positions, run, scattered};

/// A fabric that does both.
fn yielding() -> Fabric {
    Fabric {
        stretch: [800.0, 500.0],
        compression: [200.0; 2],
        shear: 40.0,
        bend: [1e-4, 5e-5],
        yield_curvature: Some(10.0),
        hardening: 0.1,
        bend_hysteresis: 1e-3,
        damping_ratio: [0.0; 3],
        warp: Warp::Along(Vector::y()),
    }
}

/// A spinning sheet that crumples, without gravity.
fn tumbling(fabric: Fabric, settings: &Settings) -> Simulation {
    let n = 14;
    let positions = grid_positions(n, n, 0.03);
    let cloth = of_fabric(grid_mesh(n, n), positions.clone(), &Mass::Density(0.2), fabric);
    let settings = Settings { gravity: Vector::zeros(), ..settings.clone() };
    let mut simulation = Simulation::new(vec![cloth], Vec::new(), settings).expect("a simulation");
    let spin = Vector::new(0.7, -0.4, 2.0);
    let thrown = positions.iter().enumerate();
    let thrown = thrown
        .map(|(i, x)| spin.cross(x) + Vector::from_fn(|axis, _| 0.3 * scattered(7 * i + axis)));
    simulation.set_velocities(0, &thrown.collect::<Vec<_>>());
    simulation
}

fn by(integrator: IntegratorKind, step_size: StepSize) -> Settings {
    Settings { integrator, step_size, threads: 1, ..Settings::default() }
}

#[test]
fn the_energy_of_a_free_sheet_that_creases_and_rubs_never_grows() {
    for integrator in [IntegratorKind::ImplicitEuler, IntegratorKind::Bdf2] {
        let mut simulation = tumbling(yielding(), &by(integrator, StepSize::Auto));
        assert_energy_never_grows(&mut simulation, integrator);
    }
}

/// What an elastic sheet keeps, up to the swing of Verlet's steps, creases and friction take out of it; near the bound of
/// the safe step, which counts the stiffness of friction, nothing bursts.
#[test]
fn explicit_steps_lose_energy_to_creases_and_friction_and_are_stable() {
    let settings = |step| by(IntegratorKind::Verlet, step);
    let soft = Fabric { yield_curvature: Some(1.0), bend_hysteresis: 5e-3, ..yielding() };
    let safe = tumbling(soft.clone(), &settings(StepSize::Auto)).safe_time_step();
    let elastic = Fabric { yield_curvature: None, bend_hysteresis: 0.0, ..soft.clone() };
    let longer = tumbling(elastic, &settings(StepSize::Auto)).safe_time_step();
    assert!(safe < longer, "{safe} s beside {longer} s");
    for (part, most) in [(0.98, 1.5), (0.3, 0.97)] {
        let mut simulation = tumbling(soft.clone(), &settings(StepSize::Seconds(part * safe)));
        let first = energy(&simulation);
        run(&mut simulation, 24);
        let ratio = energy(&simulation) / first;
        assert!((0.1..most).contains(&ratio), "at {part} of the safe step: {ratio}");
    }
}

#[test]
fn creased_cloth_goes_on_from_a_checkpoint_by_the_same_bits() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::Verlet] {
        let settings = || by(integrator, StepSize::Auto);
        let mut whole = tumbling(yielding(), &settings());
        run(&mut whole, 10);
        let bytes = whole.checkpoint();
        run(&mut whole, 5);
        let mut resumed = tumbling(yielding(), &settings());
        resumed.restore(&bytes).expect("a whole checkpoint");
        assert_eq!(resumed.checkpoint(), bytes);
        run(&mut resumed, 5);
        assert_eq!(resumed.certificate().hash, whole.certificate().hash, "{integrator:?}");
        assert_eq!(resumed.checkpoint(), whole.checkpoint());
        let mut other = tumbling(Fabric { hardening: 0.2, ..yielding() }, &settings());
        other.restore(&bytes).expect_err("of another fabric");
    }
}

#[test]
fn creased_cloth_moves_by_the_same_bits_on_any_number_of_threads() {
    let hash = |threads: usize| {
        let n = 60;
        let positions = grid_positions(n, n, 0.02);
        let fabric = Fabric { yield_curvature: Some(2.0), bend: [2e-4; 2], ..yielding() };
        let mut cloth = of_fabric(grid_mesh(n, n), positions, &Mass::Density(0.2), fabric);
        cloth.pins = vec![n * (n - 1), n * n - 1];
        let settings = Settings { threads, ..Settings::default() };
        let mut simulation =
            Simulation::new(vec![cloth], Vec::new(), settings).expect("a simulation");
        run(&mut simulation, 6);
        simulation.certificate().hash
    };
    let one = hash(1);
    assert!([2, 3, 4].into_iter().all(|threads| hash(threads) == one));
}

/// A strip of so many cells of 1 cm along x, in the plane z = 0, held by its two outer columns at both ends.
fn clamped(fabric: Fabric, integrator: IntegratorKind) -> Simulation {
    let (columns, rows) = (CELLS + 1, 4);
    let positions = grid_positions(columns, rows, CELL);
    let mut cloth = of_fabric(grid_mesh(columns, rows), positions, &Mass::Density(0.2), fabric);
    let is_held = |i: &u32| !(2..CELLS - 1).contains(&(i % columns));
    cloth.pins = (0..columns * rows).filter(is_held).collect();
    thick(&mut cloth);
    let cloth = cloth.starting_at(rolled(START)).expect("a start");
    let still = Settings { gravity: Vector::zeros(), perturbation: 0.0, ..Settings::default() };
    let settings = Settings { integrator, threads: 1, ..still };
    Simulation::new(vec![cloth], Vec::new(), settings).expect("a simulation")
}

const CELLS: u32 = 16;
const CELL: f64 = 0.01;
/// The curvature (1/m) of the strip at first: a flat one would crumple between clamps that come nearer.
const START: f64 = 3.0;

/// Air in which a cloth comes to rest within a fraction of a second.
fn thick(cloth: &mut Cloth) {
    let mean = cloth.masses.iter().sum::<f64>() / cloth.masses.len() as f64;
    cloth.material = SpringMaterial { air_damping: 20.0 * mean, ..cloth.material.clone() };
}

/// Where clamps are that roll the strip to a polygon of some curvature (1/m), whose sides are as long as its cells.
fn rolled(curvature: f64) -> Vec<Vector> {
    let turn = curvature * CELL;
    let radius = if turn > 0.0 { 0.5 * CELL / (0.5 * turn).sin() } else { 0.0 };
    let roll = |x: &Vector| {
        let angle = turn * (x.x / CELL - 0.5 * f64::from(CELLS));
        Vector::new(radius * angle.sin(), x.y, radius * (1.0 - angle.cos()))
    };
    grid_positions(CELLS + 1, 4, CELL).iter().map(roll).collect()
}

/// The mean curvature (1/m) of the middle half: the angle between its end cells over its length.
fn curvature(simulation: &Simulation) -> f64 {
    let x = simulation.positions(0);
    let [low, high] = [CELLS / 4, 3 * CELLS / 4].map(|c| {
        let way = x[c as usize + 1] - x[c as usize - 1];
        way.z.atan2(way.x)
    });
    (high - low) / (0.5 * f64::from(CELLS) * CELL)
}

/// Bends a strip by its clamps to a curvature (1/m) and on to another, lets it go there, and tells the curvature that its
/// middle had first and that it has at rest. One that is let go in a sharp bend breaks as dry spaghetti does: waves from
/// both ends bend its middle further (Audoly & Neukirch 2005).
fn bent(simulation: &mut Simulation, most: f64, then: f64) -> [f64; 2] {
    let mut turn = |from: f64, to: f64| {
        for step in 1..=72 {
            simulation.set_pin_targets(0, &rolled(from + (to - from) * f64::from(step) / 72.0));
            run(simulation, 1);
        }
        curvature(simulation)
    };
    let bent = turn(START, most);
    turn(most, then);
    simulation.release_pins(0, &simulation.cloth(0).pins.clone());
    run(simulation, 48);
    [bent, curvature(simulation)]
}

/// Only creases: beyond a bound of 10 /m.
fn creasing() -> Fabric {
    Fabric { hardening: 0.0, bend_hysteresis: 0.0, bend: [1e-4; 2], ..yielding() }
}

#[test]
fn a_strip_that_clamps_bend_and_let_go_keeps_what_is_beyond_the_bound() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::Verlet] {
        let [_, left] = bent(&mut clamped(creasing(), integrator), 8.0, START);
        assert!(left.abs() < 1e-3, "{left} /m");
        let [most, left] = bent(&mut clamped(creasing(), integrator), 20.0, 10.0);
        assert_close("curvature (1/m)", left, most - 10.0, 0.01);
    }
}

/// A rest shape that comes and goes bends the cloth with its creases, and makes none itself while the cloth lags behind it by
/// less than the bound.
#[test]
fn creases_go_with_a_rest_shape_that_changes() {
    let mut simulation = clamped(creasing(), IntegratorKind::Bdf2);
    let [_, left] = bent(&mut simulation, 20.0, 10.0);
    for (shape, more) in [(Some(rolled(4.0)), 4.0), (None, 0.0)] {
        simulation.set_rest(0, shape.as_deref(), None).expect("a rest shape");
        run(&mut simulation, 72);
        assert_close("curvature (1/m)", curvature(&simulation), left + more, 0.01);
    }
}

#[test]
fn a_frame_that_is_lost_leaves_creases_as_they_were() {
    let safe = tumbling(yielding(), &by(IntegratorKind::Verlet, StepSize::Auto)).safe_time_step();
    let settings = by(IntegratorKind::Verlet, StepSize::Seconds(2.5 * safe));
    let mut simulation = tumbling(yielding(), &Settings { allow_unstable: true, ..settings });
    let before = simulation.checkpoint();
    simulation.advance().expect_err("it bursts");
    assert!(simulation.checkpoint() == before);
}
