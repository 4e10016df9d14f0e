//! The same input gives the same bits with contact, for any number of threads and after a checkpoint in the midst of it.

use boucle_geometry::Vector;
use boucle_solver::{Certificate, Collider, IntegratorKind, Settings, Simulation, SpringMaterial};

use crate::contact_things::{among, ball, colliding, corners, patch, placed};
use crate::determinism::velocity_bits;

fn settings(integrator: IntegratorKind, threads: usize) -> Settings {
    Settings { integrator, threads, perturbation: 1e-6, ..Settings::default() }
}

/// A sheet that falls on a ball at 3 m/s, and on itself below.
fn sheet_on_ball(integrator: IntegratorKind, threads: usize) -> Simulation {
    let sheet = placed(patch([20, 20], 1.0, SpringMaterial::default()), |x| x + 0.32 * Vector::z());
    let sheet = colliding(sheet, 0.012, 0.3);
    let ball = ball(Vector::new(0.02, 0.01, 0.0), 0.25, 0.3);
    let mut simulation = among(vec![sheet], vec![ball], settings(integrator, threads));
    simulation.set_velocities(0, &[-3.0 * Vector::z(); 400]);
    simulation
}

/// A sheet that falls on another, which is held by two corners, and both on a box that moves up and to the side.
fn two_sheets(integrator: IntegratorKind, threads: usize) -> Simulation {
    let mut lower = colliding(patch([18, 18], 0.8, SpringMaterial::default()), 0.01, 0.3);
    lower.pins = vec![0, 17];
    let turned = |x: &Vector| Vector::new(0.8 * x.x - 0.6 * x.y, 0.6 * x.x + 0.8 * x.y, 0.03);
    let upper = placed(patch([14, 14], 0.5, SpringMaterial::default()), turned);
    let upper = colliding(upper, 0.01, 0.3);
    let places = corners(Vector::new(0.0, 0.0, -0.2), Vector::new(0.3, 0.3, 0.3));
    let cuboid = crate::contact_things::collider(boucle_solver::Shape::cuboid(), places, 0.5);
    among(vec![lower, upper], vec![cuboid], settings(integrator, threads))
}

/// Moves all colliders along, and on by a frame.
fn advance(simulation: &mut Simulation) -> Certificate {
    let way = Vector::new(0.01, 0.0, 0.005) * f64::from(simulation.frame());
    for number in 0..simulation.collider_count() {
        let Collider { positions, .. } = simulation.collider(number);
        let targets: Vec<Vector> = positions.iter().map(|x| x + way).collect();
        simulation.set_collider_targets(number, &targets).expect("as many targets");
    }
    simulation.advance().expect("a frame")
}

/// A scene on so many threads.
type Scene = fn(IntegratorKind, usize) -> Simulation;

const SCENES: [(&str, Scene); 2] = [("sheet on ball", sheet_on_ball), ("two sheets", two_sheets)];

#[test]
fn what_touches_has_the_same_bits_with_one_two_three_four_and_eight_threads() {
    for (what, scene) in SCENES {
        for integrator in [IntegratorKind::Bdf2, IntegratorKind::SymplecticEuler] {
            let bits = |threads| {
                let mut simulation = scene(integrator, threads);
                let certificates: Vec<_> = (0..8).map(|_| advance(&mut simulation)).collect();
                (certificates, velocity_bits(&simulation))
            };
            let one = bits(1);
            assert!(one.0.iter().any(|frame| frame.contacts > 20), "{what}: little touches");
            for threads in [2, 3, 4, 8] {
                assert!(bits(threads) == one, "{what}, {integrator:?}: {threads} threads");
            }
        }
    }
}

#[test]
fn a_checkpoint_in_the_midst_of_contact_goes_on_with_the_same_bits() {
    for (what, scene) in SCENES {
        for integrator in
            [IntegratorKind::Bdf2, IntegratorKind::ImplicitEuler, IntegratorKind::Verlet]
        {
            let mut whole = scene(integrator, 1);
            let mut checkpoints = Vec::new();
            for _ in 0..8 {
                checkpoints.push(whole.checkpoint());
                advance(&mut whole);
            }
            let last = whole.certificate();
            assert!(last.contacts > 0, "{what}: nothing touches");
            for bytes in [0, 4, 7].map(|frame: usize| &checkpoints[frame]) {
                let mut resumed = scene(integrator, 2);
                resumed.restore(bytes).expect("the same scene");
                assert!(&resumed.checkpoint() == bytes, "{what}, {integrator:?}");
                while resumed.frame() < whole.frame() {
                    advance(&mut resumed);
                }
                assert_eq!(resumed.certificate(), last, "{what}, {integrator:?}");
                assert!(velocity_bits(&resumed) == velocity_bits(&whole), "{what}, {integrator:?}");
            }
        }
    }
}

/// The colliders, too, are back where they were.
#[test]
fn a_simulation_among_colliders_restored_to_its_own_past_repeats_it() {
    let mut simulation = two_sheets(IntegratorKind::Bdf2, 1);
    for _ in 0..3 {
        advance(&mut simulation);
    }
    let early = simulation.checkpoint();
    let certificates = |simulation: &mut Simulation| -> Vec<Certificate> {
        (0..4).map(|_| advance(simulation)).collect()
    };
    let first = certificates(&mut simulation);
    simulation.restore(&early).expect("its own checkpoint");
    assert_eq!(certificates(&mut simulation), first);
}
