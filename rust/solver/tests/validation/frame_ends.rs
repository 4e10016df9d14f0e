//! Rest lengths and pressures go evenly over a frame: what depends on them holds from its start to its end.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, IntegratorKind, Limiter, Mass, Pressure, Settings, Simulation, SpringMaterial, StepSize,
    Tailoring,
};

use crate::contact_things::colliding;
use crate::sheets::{assert_close, classic, grid_positions, material, run, sheet, simulation};

const SIDE: u32 = 12;
const COUNT: usize = (SIDE * SIDE) as usize;

fn explicit(cloth: Cloth) -> Simulation {
    simulation(cloth, Settings { threads: 1, ..classic() })
}

fn shrunk(cloth: &Cloth, by: f64) -> Cloth {
    let shrink = vec![by; COUNT];
    Cloth { tailoring: Tailoring { shrink, ..Tailoring::default() }, ..cloth.clone() }
}

/// The step that is safe for a frame is that of the end that asks for the shorter one.
#[test]
fn the_safe_step_holds_for_the_rest_lengths_at_both_ends_of_a_frame() {
    // Equation 6 stiffens strong springs; steps must be short for the other limiter where springs are soft.
    for (limiter, strength) in [(Limiter::Stiffen, 100.0), (Limiter::Project, 1.0)] {
        let stiffness = [5.0, 1.0, 0.05].map(|stiffness| strength * stiffness);
        let material = SpringMaterial { limiter, ..material(stiffness) };
        let cloth = sheet([SIDE, SIDE], 0.05, &Mass::Density(0.2), material, &[0, SIDE - 1]);
        let [whole, half] = [0.0, 0.5].map(|by| explicit(shrunk(&cloth, by)).safe_time_step());
        assert!(half < 0.9 * whole, "{limiter:?}: {half}, {whole}");
        for (from, to) in [(0.0, 0.5), (0.5, 0.0)] {
            let mut changing = explicit(shrunk(&cloth, from));
            changing.set_rest(0, None, Some(&[to; COUNT])).expect("a shrink");
            assert_close("the safe step (s)", changing.safe_time_step(), half, 1e-9 * half);
        }
    }
}

/// So it is with a pressure; and with one whose factor grows while its volume shrinks, it is not longer than in between.
#[test]
fn the_safe_step_holds_for_the_pressure_of_all_the_frame() {
    let material = material([50.0, 20.0, 1.0]);
    let (mesh, positions) = crate::pressure::ball(4, 0.5);
    let cloth = crate::sheets::cloth(mesh, positions, &Mass::Density(0.2), material, &[]);
    let of = |[uniform, factor, volume]: [f64; 3]| {
        let pressure =
            Pressure { uniform, factor, target_volume: Some(volume), weights: Vec::new() };
        explicit(Cloth { pressure: Some(pressure), ..cloth.clone() })
    };
    let [low, high] = [[10.0, 1e3, 0.5], [2e3, 1e5, 0.5]];
    let [slow, fast] = [low, high].map(|level| of(level).safe_time_step());
    assert!(fast < 0.5 * slow, "{fast}, {slow}");
    for (from, [uniform, factor, volume]) in [(low, high), (high, low)] {
        let mut changing = of(from);
        changing.set_pressure(0, uniform, factor, Some(volume)).expect("a pressure");
        assert_close("the safe step (s)", changing.safe_time_step(), fast, 1e-9 * fast);
    }
    let mut crossing = of([0.0, 1e3, 5.0]);
    crossing.set_pressure(0, 0.0, 1e5, Some(0.05)).expect("a pressure");
    let between = of([0.0, 0.5 * (1e3 + 1e5), 0.5 * (5.0 + 0.05)]).safe_time_step();
    assert!(crossing.safe_time_step() <= between, "{} {between}", crossing.safe_time_step());
}

/// Shrunk to 0.4, what lies near at rest is let nearer; what grows again must not ask for the whole distance at once.
#[test]
fn contact_distances_grow_with_the_rest_lengths_and_not_before() {
    let material = SpringMaterial { air_damping: 0.002, ..material([500.0, 100.0, 5.0]) };
    let cloth = sheet([SIDE, SIDE], 0.05, &Mass::Density(0.2), material, &[]);
    let small = grid_positions(SIDE, SIDE, 0.4 * 0.05);
    let cloth = cloth.starting_at(small).expect("as many positions");
    let shrink = vec![0.6; COUNT];
    let tailoring = Tailoring { shrink, ..cloth.tailoring.clone() };
    // Thicker than a shrunk edge is long, as the whole one lets it be.
    let cloth = colliding(Cloth { tailoring, ..cloth }, 0.02, 0.3);
    let settings = Settings {
        gravity: Vector::zeros(),
        integrator: IntegratorKind::Bdf2,
        step_size: StepSize::Substeps(8),
        perturbation: 1e-6,
        threads: 1,
        ..Settings::default()
    };
    let mut simulation = simulation(cloth, settings);
    let before = touching(&mut simulation);
    simulation.set_rest(0, None, Some(&[0.0; COUNT])).expect("a shrink");
    assert_eq!(touching(&mut simulation), before, "contacts");
    run(&mut simulation, 24);
    let positions = simulation.positions(0);
    let width = (positions[SIDE as usize - 1] - positions[0]).norm();
    assert_close("width (m)", width, 0.55, 0.01);
}

/// How many contacts the next step would have.
fn touching(simulation: &mut Simulation) -> usize {
    simulation.detect_contacts().expect("a frame").expect("what collides").contacts
}
