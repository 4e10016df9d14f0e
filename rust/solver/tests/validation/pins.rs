//! Pins go where they are told, and leave with the velocity they have.

use boucle_geometry::Vector;
use boucle_solver::{Cloth, IntegratorKind, Limiter, Mass, Settings, SpringMaterial};

use crate::lying::{self, Hung, lying_sheet};
use crate::sheets::{classic, farthest, material, network, run, sheet, simulation};

fn curtain(limiter: Limiter) -> Cloth {
    let material =
        SpringMaterial { limiter, damping: [0.02, 0.01, 0.005], ..material([100.0, 20.0, 2.0]) };
    sheet([7, 7], 0.1, &Mass::Density(0.3), material, &[0, 3, 6])
}

fn settings(integrator: IntegratorKind) -> Settings {
    Settings { integrator, threads: 1, ..classic() }
}

#[test]
fn pins_are_exactly_on_their_targets_at_the_end_of_every_frame() {
    let limiters = [Limiter::None, Limiter::Stiffen, Limiter::Provot, Limiter::Project];
    for integrator in IntegratorKind::ALL {
        for limiter in limiters {
            let cloth = curtain(limiter);
            let mut targets = cloth.positions.clone();
            let mut simulation = simulation(cloth, settings(integrator));
            for frame in 1..=6 {
                for target in &mut targets {
                    *target += Vector::new(0.003, -0.001 * f64::from(frame), 0.002);
                }
                simulation.set_pin_targets(0, &targets);
                run(&mut simulation, 1);
                let positions = simulation.positions(0);
                for pin in [0, 3, 6] {
                    let (got, wanted) = (positions[pin], targets[pin]);
                    let is_same = (0..3).all(|axis| got[axis].to_bits() == wanted[axis].to_bits());
                    assert!(is_same, "{integrator:?}, {limiter:?}: {got:?} is not {wanted:?}");
                }
            }
        }
    }
}

#[test]
fn pins_without_new_targets_stay_where_they_are() {
    let cloth = curtain(Limiter::None);
    let rest = cloth.positions.clone();
    let mut simulation = simulation(cloth, settings(IntegratorKind::SymplecticEuler));
    run(&mut simulation, 12);
    for pin in [0, 3, 6] {
        assert_eq!(simulation.positions(0)[pin], rest[pin]);
    }
}

/// Pins at 0.24 m/s, then let go without gravity: they keep to their line. A frame's division and multiplication
/// round by 1e-15.
#[test]
fn a_released_pin_flies_on_with_the_velocity_it_had() {
    for integrator in IntegratorKind::ALL {
        let rest = vec![Vector::zeros(), Vector::x()];
        let cloth = network(rest.clone(), Vec::new(), vec![1.0; 2], &[0, 1], material([0.0; 3]));
        let settings = Settings { gravity: Vector::zeros(), ..settings(integrator) };
        let mut simulation = simulation(cloth, settings);
        let moved = |frames: f64| {
            rest.iter().map(|x| x + Vector::new(0.0, 0.01, -0.004) * frames).collect::<Vec<_>>()
        };
        simulation.set_pin_targets(0, &moved(1.0));
        run(&mut simulation, 1);
        simulation.release_pins(0, &[1]);
        run(&mut simulation, 10);
        let expected = [moved(1.0)[0], moved(11.0)[1]];
        let error = farthest(&simulation.positions(0), &expected);
        assert!(error < 1e-13, "{integrator:?}: {error} m");
    }
}

/// The free end of a spring sees its pin move over the frame, not jump at its start or end: pulled along by a pin at
/// constant speed V, it lags as x = V (t - sin(w t)/w). The fourth-order rule is exact to 1e-9 here.
#[test]
fn pins_move_in_a_straight_line_at_constant_speed_within_a_frame() {
    let cloth = crate::sheets::mass_on_spring(100.0, 0.0, &material([0.0; 3]));
    let rest = cloth.positions.clone();
    let settings = Settings {
        gravity: Vector::zeros(),
        fps: 2.0,
        step_size: boucle_solver::StepSize::Substeps(1000),
        ..settings(IntegratorKind::Rk4)
    };
    let mut simulation = simulation(cloth, settings);
    simulation.set_pin_targets(0, &[rest[0] + Vector::x() * 0.01, rest[1]]);
    run(&mut simulation, 1);
    let expected = 1.0 + 0.02 * (0.5 - (10.0_f64 * 0.5).sin() / 10.0);
    assert!((simulation.positions(0)[1].x - expected).abs() < 1e-11);
}

/// A curtain gathered to one point: springs between pins that coincide have no direction, and take none.
#[test]
fn pins_may_meet_in_one_point() {
    for integrator in [IntegratorKind::ImplicitEuler, IntegratorKind::Bdf2] {
        let material =
            SpringMaterial { stiffness: [1000.0, 200.0, 10.0], ..SpringMaterial::default() };
        let side = 12;
        let mut curtain =
            simulation(lying_sheet(side, Hung::Edge, material), lying::settings(integrator));
        let place = curtain.positions(0)[(side * side - side) as usize];
        for frame in 0..24 {
            curtain.set_pin_targets(0, &vec![place; (side * side) as usize]);
            let certificate = curtain.advance().expect("a frame");
            assert!(certificate.kinetic_energy.is_finite(), "frame {frame}");
        }
        let positions = curtain.positions(0);
        assert!(positions[(side * side - side) as usize..].iter().all(|pin| *pin == place));
    }
}
