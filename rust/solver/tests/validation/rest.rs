//! Rest lengths other than those of the start: a rest shape, shrink, both changing from frame to frame.

use boucle_geometry::Vector;
use boucle_solver::{
    Certificate, Cloth, IntegratorKind, Limiter, Mass, Settings, Simulation, SpringKind,
    SpringMaterial, StepSize, Tailoring,
};

use crate::sheets::{
    assert_close, cloth, farthest, grid_mesh, grid_positions, material, run, sheet, simulation,
};

const SIDE: u32 = 9;

fn still(integrator: IntegratorKind, step_size: StepSize) -> Settings {
    Settings { gravity: Vector::zeros(), integrator, step_size, threads: 1, ..Settings::default() }
}

fn damped() -> SpringMaterial {
    SpringMaterial { damping: [0.05; 3], air_damping: 0.002, ..material([50.0, 20.0, 2.0]) }
}

/// Edge lengths (m) of a simulation's cloth, by their springs.
fn mean_strain(simulation: &Simulation) -> f64 {
    simulation.certificate().p99_strain
}

fn width(simulation: &Simulation) -> f64 {
    let positions = simulation.positions(0);
    (positions[SIDE as usize - 1] - positions[0]).norm()
}

#[test]
fn a_cloth_that_starts_from_another_shape_comes_to_its_rest_shape() {
    let rest = sheet([SIDE, SIDE], 0.1, &Mass::Density(0.2), damped(), &[]);
    let start: Vec<Vector> = rest.positions.iter().map(|x| 1.2 * x).collect();
    let cloth = rest.clone().starting_at(start.clone()).expect("a start");
    assert_eq!((&cloth.springs, &cloth.masses), (&rest.springs, &rest.masses));
    let settings = still(IntegratorKind::Bdf2, StepSize::Auto);
    let mut simulation = simulation(cloth, settings);
    assert_eq!(simulation.positions(0), start);
    assert_close("strain", simulation.certificate().max_strain, 0.2, 1e-12);
    run(&mut simulation, 48);
    assert!(simulation.certificate().max_strain.abs() < 0.01);
    assert_close("width (m)", width(&simulation), 0.8, 0.01);
}

#[test]
fn the_limiter_holds_a_start_that_is_stretched_too_far_within_a_frame() {
    let limited = SpringMaterial { limiter: Limiter::Project, ..damped() };
    let rest = sheet([SIDE, SIDE], 0.1, &Mass::Density(0.2), limited, &[0, SIDE - 1]);
    let start: Vec<Vector> =
        rest.positions.iter().map(|x| Vector::new(x.x, 2.0 * x.y, x.z)).collect();
    let cloth = rest.starting_at(start).expect("a start");
    let mut simulation = simulation(cloth, Settings { threads: 1, ..Settings::default() });
    run(&mut simulation, 1);
    assert!(simulation.certificate().max_strain < 0.1006, "{:?}", simulation.certificate());
    run(&mut simulation, 12);
    assert!(simulation.certificate().max_strain < 0.1006, "{:?}", simulation.certificate());
}

/// Blender's law: the geometric mean of both ends' factors.
#[test]
fn every_spring_shrinks_by_the_geometric_mean_of_its_ends() {
    let cloth = sheet([3, 3], 0.1, &Mass::Density(0.2), SpringMaterial::default(), &[]);
    let shrink: Vec<f64> = (0..9).map(|vertex| 0.1 * f64::from(vertex) - 0.2).collect();
    let tailoring = Tailoring { shrink: shrink.clone(), ..Tailoring::default() };
    let shrunk = simulation(Cloth { tailoring, ..cloth.clone() }, Settings::default());
    for (spring, given) in shrunk.cloth(0).springs.iter().zip(&cloth.springs) {
        let [a, b] = spring.ends.map(|end| 1.0 - shrink[end as usize]);
        let expected = given.rest_length * (a * b).sqrt();
        assert_close("rest length (m)", spring.rest_length, expected, 1e-15);
    }
}

/// Every integrator, every limiter: a free sheet that is told to shrink by a fifth is a fifth smaller in the end, strained by
/// nothing, and the limiter keeps to the lengths of each frame.
#[test]
fn a_sheet_that_shrinks_or_grows_over_some_frames_has_its_new_size() {
    for (integrator, limiter) in [
        (IntegratorKind::Bdf2, Limiter::Project),
        (IntegratorKind::Bdf2, Limiter::Stiffen),
        (IntegratorKind::ImplicitEuler, Limiter::Provot),
        (IntegratorKind::SymplecticEuler, Limiter::Project),
        (IntegratorKind::Rk4, Limiter::Provot),
    ] {
        for shrink in [0.2, -0.3] {
            let material = SpringMaterial { limiter, ..damped() };
            let cloth = sheet([SIDE, SIDE], 0.1, &Mass::Density(0.2), material, &[]);
            let mut simulation = simulation(cloth, still(integrator, StepSize::Auto));
            for frame in 1..=10 {
                let now = vec![shrink * f64::from(frame) / 10.0; (SIDE * SIDE) as usize];
                simulation.set_rest(0, None, Some(&now)).expect("a shrink");
                run(&mut simulation, 1);
                let rest = simulation.cloth(0).springs[0].rest_length;
                assert_close("rest length (m)", rest, 0.1 * (1.0 - now[0]), 1e-12);
                if limiter == Limiter::Project {
                    assert!(simulation.certificate().max_strain < 0.1006, "{integrator:?}");
                }
            }
            run(&mut simulation, 48);
            let what = format!("width (m), {integrator:?} {limiter:?}");
            assert_close(&what, width(&simulation), 0.8 * (1.0 - shrink), 0.01);
            assert!(mean_strain(&simulation).abs() < 0.02, "{integrator:?} {limiter:?}");
        }
    }
}

/// A hanging sheet whose rest lengths are set to what they already are moves bit for bit as one that is left alone.
#[test]
fn rest_lengths_that_do_not_change_change_no_bit() {
    let material = SpringMaterial { limiter: Limiter::Project, ..damped() };
    let cloth = sheet([SIDE, SIDE], 0.1, &Mass::Density(0.2), material, &[0, SIDE - 1]);
    let run_all = |shape: Option<&[Vector]>, sets: bool| {
        let mut simulation =
            simulation(cloth.clone(), Settings { threads: 1, ..Settings::default() });
        for _ in 0..6 {
            if sets {
                let none = vec![0.0; (SIDE * SIDE) as usize];
                simulation.set_rest(0, shape, Some(&none)).expect("a shape");
            }
            run(&mut simulation, 1);
        }
        simulation.certificate().hash
    };
    assert_eq!(run_all(None, false), run_all(Some(&cloth.positions), true));
    assert_eq!(run_all(None, false), run_all(None, true));
}

/// A rest shape that is bent and stretched: rest lengths are those of each frame's shape, and a sheet that is free follows it.
#[test]
fn a_rest_shape_that_moves_is_followed() {
    let cloth = sheet([SIDE, SIDE], 0.1, &Mass::Density(0.2), damped(), &[]);
    let shape_at = |part: f64| -> Vec<Vector> {
        let wide = |x: &Vector| Vector::new(x.x * (1.0 + 0.5 * part), x.y, 0.0);
        cloth.positions.iter().map(wide).collect()
    };
    let mut simulation = simulation(cloth.clone(), still(IntegratorKind::Bdf2, StepSize::Auto));
    for frame in 1..=12 {
        let shape = shape_at(f64::from(frame) / 12.0);
        simulation.set_rest(0, Some(&shape), None).expect("a shape");
        run(&mut simulation, 1);
        for spring in &simulation.cloth(0).springs {
            let [a, b] = spring.ends.map(|end| shape[end as usize]);
            assert_close("rest length (m)", spring.rest_length, (a - b).norm(), 1e-12);
        }
    }
    run(&mut simulation, 48);
    assert_close("width (m)", width(&simulation), 1.2, 0.01);
}

#[test]
fn a_checkpoint_within_a_change_goes_on_bit_equal_for_any_threads() {
    let n = 24;
    let make = |threads| {
        let material = SpringMaterial { limiter: Limiter::Project, ..damped() };
        let positions = grid_positions(n, n, 0.05);
        let cloth = cloth(grid_mesh(n, n), positions, &Mass::Density(0.2), material, &[0, n - 1]);
        let shrink = vec![0.1; (n * n) as usize];
        let cloth = Cloth { tailoring: Tailoring { shrink, ..Tailoring::default() }, ..cloth };
        simulation(cloth, Settings { threads, ..Settings::default() })
    };
    let step = |simulation: &mut Simulation, frame: u32| {
        let count = (n * n) as usize;
        let now: Vec<f64> =
            (0..count).map(|i| 0.1 + 0.02 * f64::from(frame) * (i % 7) as f64 / 7.0).collect();
        simulation.set_rest(0, None, Some(&now)).expect("a shrink");
        if frame == 5 {
            // Limiters are made anew from changed lengths.
            simulation.release_pins(0, &[0]);
        }
        run(simulation, 1);
    };
    let mut whole = make(1);
    let mut checkpoints = Vec::new();
    for frame in 1..=8 {
        checkpoints.push(whole.checkpoint());
        step(&mut whole, frame);
    }
    let lengths: Vec<f64> = whole.cloth(0).springs.iter().map(|s| s.rest_length).collect();
    for (from, threads) in [(1, 1), (4, 3), (7, 2)] {
        let mut resumed = make(threads);
        resumed.restore(&checkpoints[from - 1]).expect("a checkpoint");
        for frame in from..=8 {
            step(&mut resumed, frame as u32);
        }
        assert_eq!(
            whole.certificate(),
            Certificate { iterations: whole.certificate().iterations, ..resumed.certificate() }
        );
        let resumed: Vec<f64> = resumed.cloth(0).springs.iter().map(|s| s.rest_length).collect();
        assert_eq!(lengths, resumed);
    }
    // The same simulation goes back, too.
    whole.restore(&checkpoints[0]).expect("a checkpoint");
    for frame in 1..=8 {
        step(&mut whole, frame);
    }
    assert_eq!(whole.cloth(0).springs.iter().map(|s| s.rest_length).collect::<Vec<_>>(), lengths);
}

#[test]
fn a_shrunk_cloth_is_as_thick_as_its_edges_let_it_be() {
    // Half as large, with a thickness of 0.4 of its old edges: what lies near at rest must be let nearer.
    let collision = Some(boucle_solver::Collision { thickness: 0.02, ..Default::default() });
    let cloth = Cloth { collision, ..sheet([SIDE, SIDE], 0.1, &Mass::Density(0.2), damped(), &[]) };
    let mut simulation = simulation(cloth, still(IntegratorKind::Bdf2, StepSize::Auto));
    for frame in 1..=20 {
        let now = vec![0.6 * f64::from(frame) / 20.0; (SIDE * SIDE) as usize];
        simulation.set_rest(0, None, Some(&now)).expect("a shrink");
        run(&mut simulation, 1);
    }
    run(&mut simulation, 48);
    assert_close("width (m)", width(&simulation), 0.32, 0.02);
    let flat: Vec<Vector> =
        simulation.positions(0).iter().map(|x| Vector::new(x.x, x.y, 0.0)).collect();
    assert!(farthest(&simulation.positions(0), &flat) < 1e-3, "it has left its plane");
}

#[test]
fn a_rest_shape_or_shrink_that_does_not_fit_is_refused() {
    let cloth = sheet([3, 3], 0.1, &Mass::Density(0.2), SpringMaterial::default(), &[]);
    let error = cloth.clone().starting_at(vec![Vector::zeros()]).expect_err("one position");
    assert!(error.to_string().contains("starts from 1 positions; accepted: 9"), "{error}");
    let mut simulation = simulation(cloth, Settings::default());
    for (shape, shrink, expected) in [
        (Some(vec![Vector::zeros(); 2]), None, "2 rest positions are given; accepted: 9"),
        (None, Some(vec![0.5; 3]), "3 numbers of shrink are given; accepted: 9 or none"),
        (None, Some(vec![1.0; 9]), "vertex 0 shrinks by 1; accepted: -10 to 0.99"),
    ] {
        let error = simulation.set_rest(0, shape.as_deref(), shrink.as_deref());
        let error = error.expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}");
    }
    assert!(simulation.cloth(0).springs.iter().all(|s| s.kind != SpringKind::Sewing));
}

#[test]
fn a_pin_that_goes_leaves_the_rest_lengths_as_they_are() {
    for limiter in [Limiter::None, Limiter::Stiffen, Limiter::Provot, Limiter::Project] {
        let material = SpringMaterial { limiter, ..damped() };
        let cloth = sheet([SIDE, SIDE], 0.1, &Mass::Density(0.2), material, &[0, SIDE - 1]);
        let tailoring = Tailoring { shrink: vec![0.3; 81], ..Tailoring::default() };
        let shrunk = Cloth { tailoring, ..cloth };
        let mut simulation = simulation(shrunk, still(IntegratorKind::Bdf2, StepSize::Auto));
        let before = simulation.cloth(0).springs.clone();
        simulation.release_pins(0, &[0]);
        assert_eq!(simulation.cloth(0).springs, before, "{limiter:?}");
    }
}
