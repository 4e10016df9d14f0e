//! The implicit integrators: their closed forms, what they hold, and how little they add.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, Error, IntegratorKind, Limiter, Mass, Settings, Simulation, SpringMaterial, StepSize,
};

use crate::lying::{Hung, PROMISE, limited, lying_sheet, settings};
use crate::sheets::{
    G, assert_close, grid_mesh, grid_positions, mass_on_spring, run, simulation, steps_of,
};

const IMPLICIT: [IntegratorKind; 2] = [IntegratorKind::ImplicitEuler, IntegratorKind::Bdf2];

/// z = w h of 0.5: the amplitude of a mass on a spring falls by 1/sqrt(1 + z²) a step. Moves are f32: 1e-5.
#[test]
fn implicit_euler_damps_an_oscillator_by_its_closed_form() {
    let material = SpringMaterial { limiter: Limiter::None, ..SpringMaterial::default() };
    let (stiffness, h) = (25.0, 0.1);
    let spring = mass_on_spring(stiffness, 0.0, &material);
    let mut mass = simulation(spring, steps_of(h, IntegratorKind::ImplicitEuler));
    mass.set_positions(0, &[Vector::zeros(), Vector::new(1.1, 0.0, 0.0)]);
    let energy = |mass: &Simulation| {
        let certificate = mass.certificate();
        certificate.kinetic_energy + certificate.potential_energy
    };
    let mut last = energy(&mass);
    for step in 0..20 {
        run(&mut mass, 1);
        let now = energy(&mass);
        assert_close(&format!("step {step}"), now / last, 1.0 / (1.0 + 0.25), 1e-4);
        last = now;
    }
}

/// The same mass under BDF2 follows x'' = -w² x in its own two-step formula, begun by implicit Euler.
#[test]
fn bdf2_follows_its_own_formula_on_an_oscillator() {
    let material = SpringMaterial { limiter: Limiter::None, ..SpringMaterial::default() };
    let (w_squared, h) = (25.0, 0.1);
    let spring = mass_on_spring(w_squared, 0.0, &material);
    let mut mass = simulation(spring, steps_of(h, IntegratorKind::Bdf2));
    mass.set_positions(0, &[Vector::zeros(), Vector::new(1.1, 0.0, 0.0)]);
    let step = |base: f64, velocity: f64, h: f64| {
        let x = (base + h * velocity) / (1.0 + h * h * w_squared);
        [x, (x - base) / h]
    };
    let mut before = [0.1, 0.0];
    let mut now = step(0.1, 0.0, h);
    for number in 0..20 {
        run(&mut mass, 1);
        let x = mass.positions(0)[1].x - 1.0;
        assert!((x - now[0]).abs() < 1e-6, "step {number}: {x} is not {}", now[0]);
        let [base, velocity] = [0, 1].map(|i| (4.0 * now[i] - before[i]) / 3.0);
        before = now;
        now = step(base, velocity, 2.0 / 3.0 * h);
    }
}

/// The parabola is within the formulas' reach: BDF2 falls as a point does but for its first step, g h²/2 too low.
#[test]
fn a_free_sheet_falls_as_a_point_does() {
    for integrator in IMPLICIT {
        let (steps, h) = (48, 1.0 / 96.0);
        let positions = grid_positions(5, 5, 0.1);
        let mesh = grid_mesh(5, 5);
        let free = Cloth::from_mesh(
            "free",
            mesh,
            positions.clone(),
            &Mass::Density(0.2),
            limited(0.1),
            Vec::new(),
        );
        let settings = Settings { gravity: Vector::new(0.0, 0.0, -G), ..steps_of(h, integrator) };
        let mut sheet = simulation(free.expect("a sheet"), settings);
        run(&mut sheet, steps);
        let time = steps as f64 * h;
        let fallen = 0.5 * G * time * time;
        let excess = match integrator {
            IntegratorKind::ImplicitEuler => 0.5 * G * h * time,
            _ => 0.5 * G * h * h,
        };
        for (now, rest) in sheet.positions(0).iter().zip(&positions) {
            let error = (rest.z - now.z) - fallen;
            assert!((error - excess).abs() < excess, "{integrator:?}: {error} m, {excess} m");
            assert!((now.x - rest.x).abs() < 1e-9, "{integrator:?}");
        }
    }
}

#[test]
fn no_edge_exceeds_the_rate_by_more_than_a_tenth_of_a_point() {
    for (side, frames) in [(32, 72), (64, 36)] {
        for hung in [Hung::Corner, Hung::Corners, Hung::Edge] {
            for rate in [0.05, 0.10] {
                let mut sheet = simulation(
                    lying_sheet(side, hung, limited(rate)),
                    settings(IntegratorKind::Bdf2),
                );
                for _ in 0..frames {
                    let certificate = sheet.advance().expect("a frame");
                    let over = certificate.max_strain - rate;
                    let frame = certificate.frame;
                    assert!(
                        over <= PROMISE,
                        "{side}², {hung:?}, frame {frame}: {over} over {rate}"
                    );
                }
            }
        }
    }
}

/// Energy at the start is 0. BDF2 may gain by its truncation while cloth snaps taut, far below what it loses later.
#[test]
fn a_falling_and_swinging_sheet_loses_energy_and_bdf2_loses_less() {
    let lost = IMPLICIT.map(|integrator| {
        let material = SpringMaterial { limiter: Limiter::None, ..limited(0.1) };
        let sheet = lying_sheet(32, Hung::Edge, material);
        let mut sheet = simulation(sheet, settings(integrator));
        let energies = (0..48).map(|_| {
            let certificate = sheet.advance().expect("a frame");
            certificate.kinetic_energy + certificate.potential_energy
        });
        let energies: Vec<f64> = energies.collect();
        let most = energies.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert!(most < 0.02, "{integrator:?} gains {most} J");
        -energies[47]
    });
    assert!(lost[1] < 0.6 * lost[0], "implicit Euler loses {} J, BDF2 {} J", lost[0], lost[1]);
}

#[test]
fn a_finer_tolerance_takes_more_steps_and_comes_nearer() {
    let ends = [2e-2, 5e-3, 1e-3].map(|tolerance| {
        let settings = Settings { tolerance, ..settings(IntegratorKind::Bdf2) };
        let mut sheet = simulation(lying_sheet(24, Hung::Edge, limited(0.1)), settings);
        let substeps: u32 = (0..24).map(|_| sheet.advance().expect("a frame").substeps).sum();
        (substeps, sheet.positions(0))
    });
    let fine = Settings { step_size: StepSize::Substeps(64), ..settings(IntegratorKind::Bdf2) };
    let mut reference = simulation(lying_sheet(24, Hung::Edge, limited(0.1)), fine);
    run(&mut reference, 24);
    let reference = reference.positions(0);
    let errors = ends.clone().map(|(_, end)| {
        let squares = end.iter().zip(&reference).map(|(a, b)| (a - b).norm_squared());
        (squares.sum::<f64>() / end.len() as f64).sqrt()
    });
    let substeps = ends.map(|(substeps, _)| substeps);
    assert!(substeps[0] < substeps[1] && substeps[1] < substeps[2], "{substeps:?}");
    assert!(errors[2] < errors[0], "{errors:?} m");
}

#[test]
fn a_tolerance_out_of_range_is_refused_by_name() {
    for tolerance in [0.0, -1.0, f64::NAN, 2.0] {
        let settings = Settings { tolerance, ..Settings::default() };
        let error = Simulation::new(Vec::new(), Vec::new(), settings).expect_err("refused");
        assert!(matches!(&error, Error::OutOfDomain { quantity, .. } if quantity == "tolerance"));
    }
}
