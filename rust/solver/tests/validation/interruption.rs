//! A frame that is stopped in its midst leaves no trace.

use std::time::Duration;

use boucle_geometry::Vector;
use boucle_solver::{
    Certificate, Error, IntegratorKind, Settings, Simulation, SpringMaterial, StepSize,
};

use crate::contact_things::{among, ball, colliding, floor, patch, placed};
use crate::determinism::velocity_bits;

/// A sheet that falls on a ball, on a floor and on another.
fn scene(integrator: IntegratorKind, step_size: StepSize) -> Simulation {
    let at = |height: f64| {
        let sheet = patch([16, 16], 0.8, SpringMaterial::default());
        colliding(placed(sheet, |x| x + height * Vector::z()), 0.01, 0.3)
    };
    let colliders = vec![ball(Vector::new(0.02, 0.01, 0.0), 0.25, 0.3), floor(0.3)];
    let settings =
        Settings { integrator, step_size, threads: 2, perturbation: 1e-6, ..Settings::default() };
    among(vec![at(0.28), at(0.34)], colliders, settings)
}

fn run(simulation: &mut Simulation, frames: i32) -> Vec<Certificate> {
    (0..frames).map(|_| simulation.advance().expect("a frame")).collect()
}

#[test]
fn asked_between_two_frames_the_next_does_not_begin_and_the_one_after_that_does() {
    let mut simulation = scene(IntegratorKind::Bdf2, StepSize::Auto);
    run(&mut simulation, 2);
    let before = simulation.checkpoint();
    simulation.interrupter().interrupt();
    assert_eq!(simulation.advance(), Err(Error::Interrupted { frame: 4 }));
    assert_eq!(simulation.frame(), 3);
    assert!(simulation.checkpoint() == before);
    run(&mut simulation, 1);
}

/// Interrupted at moments that chance picks, in every frame, and each time asked anew.
#[test]
fn whatever_was_interrupted_goes_on_with_the_same_bits() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::SymplecticEuler] {
        let mut whole = scene(integrator, StepSize::Auto);
        let certificates = run(&mut whole, 8);
        assert!(certificates.iter().any(|frame| frame.contacts > 20), "little touches");
        let mut stopped = scene(integrator, StepSize::Auto);
        let (interrupter, mut count) = (stopped.interrupter(), 0);
        for expected in &certificates {
            for wait in [0, 300, 1500, 4000] {
                let asked = std::thread::scope(|scope| {
                    let advanced = scope.spawn(|| stopped.advance());
                    std::thread::sleep(Duration::from_micros(wait));
                    interrupter.interrupt();
                    advanced.join().expect("no panic")
                });
                match asked {
                    Err(Error::Interrupted { frame }) => assert_eq!(frame, expected.frame),
                    // It was too late: what it asked for holds for the next frame.
                    outcome => {
                        assert_eq!(outcome.as_ref(), Ok(expected), "{integrator:?}");
                        break;
                    }
                }
                count += 1;
                // The same, from the state that a checkpoint of it holds.
                let mut resumed = scene(integrator, StepSize::Auto);
                resumed.restore(&stopped.checkpoint()).expect("the same scene");
                assert!(resumed.checkpoint() == stopped.checkpoint());
            }
            while stopped.frame() < expected.frame {
                if let Ok(certificate) = stopped.advance() {
                    assert_eq!(certificate, *expected, "{integrator:?}");
                }
            }
        }
        assert!(count > 4, "{integrator:?}: nothing was interrupted");
        drop(stopped.advance());
        run(&mut whole, 2);
        while stopped.frame() < whole.frame() {
            drop(stopped.advance());
        }
        assert!(velocity_bits(&stopped) == velocity_bits(&whole), "{integrator:?}");
    }
}

/// Each of 20 000 steps is a moment to stop at: what is left of the frame would take seconds.
#[test]
fn a_frame_of_many_steps_stops_at_the_next_of_them() {
    let mut simulation = scene(IntegratorKind::Bdf2, StepSize::Substeps(20_000));
    let interrupter = simulation.interrupter();
    let (outcome, waited) = std::thread::scope(|scope| {
        let advanced = scope.spawn(|| simulation.advance());
        std::thread::sleep(Duration::from_millis(100));
        let asked = std::time::Instant::now();
        interrupter.interrupt();
        (advanced.join().expect("no panic"), asked.elapsed())
    });
    assert_eq!(outcome, Err(Error::Interrupted { frame: 2 }));
    assert!(waited < Duration::from_millis(500), "{waited:?}");
}

/// One step is all of this frame, and would go on for many seconds: three sheets that fall through each other are kept apart.
#[test]
fn a_frame_of_one_long_step_stops_in_its_midst() {
    let sheet = |number: u32| {
        let sheet = patch([96, 96], 1.0, SpringMaterial::default());
        let height = 0.05 * f64::from(number + 1);
        let wavy = placed(sheet, |x| x + (height + 0.02 * (25.0 * x.x).sin()) * Vector::z());
        colliding(wavy, 0.004, 0.3)
    };
    let settings = Settings { step_size: StepSize::Substeps(1), threads: 2, ..Settings::default() };
    let mut simulation = among((0..3).map(sheet).collect(), vec![floor(0.3)], settings);
    for (cloth, speed) in [-3.0, -6.0, -10.0].into_iter().enumerate() {
        simulation.set_velocities(cloth, &[Vector::new(0.0, 0.0, speed); 96 * 96]);
    }
    let before = simulation.checkpoint();
    let interrupter = simulation.interrupter();
    let (outcome, waited) = std::thread::scope(|scope| {
        let advanced = scope.spawn(|| simulation.advance());
        std::thread::sleep(Duration::from_millis(300));
        let asked = std::time::Instant::now();
        interrupter.interrupt();
        (advanced.join().expect("no panic"), asked.elapsed())
    });
    assert_eq!(outcome, Err(Error::Interrupted { frame: 2 }));
    assert!(waited < Duration::from_secs(2), "{waited:?}");
    assert!(simulation.checkpoint() == before);
}
