//! Integrators on x'' = -w² x: one mass on a spring, as the simulation moves it.

use boucle_geometry::Vector;
use boucle_solver::{Error, IntegratorKind, Simulation};
use nalgebra::{Matrix2, Vector2};

use crate::reference::{INTEGRATORS, Table};
use crate::sheets::{assert_close, mass_on_spring, material, simulation, steps_of};

/// A mass of 1 kg on a spring of 1 N/m along x, so that w = 1/s and a step of z seconds is z radians.
struct Oscillator {
    simulation: Simulation,
    amplitude: f64,
}

impl Oscillator {
    fn new(kind: IntegratorKind, z: f64, amplitude: f64) -> Self {
        let cloth = mass_on_spring(1.0, 0.0, &material([1.0, 0.0, 0.0]));
        let mut simulation = simulation(cloth, steps_of(z, kind));
        simulation.set_positions(0, &[Vector::zeros(), Vector::x() * (1.0 + amplitude)]);
        Self { simulation, amplitude }
    }

    /// Elongation and speed, in units of the first elongation.
    fn state(&self) -> Vector2<f64> {
        let elongation = self.simulation.positions(0)[1].x - 1.0;
        Vector2::new(elongation, self.simulation.velocities(0)[1].x) / self.amplitude
    }

    fn step(&mut self) -> Vector2<f64> {
        self.simulation.advance().expect("a step");
        self.state()
    }

    /// The energy after each of some steps, in units of the first.
    fn energies(&mut self, steps: usize) -> Vec<f64> {
        (0..steps).map(|_| self.step().norm_squared()).collect()
    }
}

/// The matrix by which a step multiplies (x, v), found from two steps a quarter of a period apart.
fn measured_matrix(kind: IntegratorKind, z: f64) -> Matrix2<f64> {
    let mut oscillator = Oscillator::new(kind, z, 0.05);
    let mut states = vec![oscillator.state()];
    let quarter = (1..1000).find(|&i| i as f64 * z >= std::f64::consts::FRAC_PI_2);
    let quarter: usize = quarter.expect("a step of 0.01 or more");
    states.extend((0..=quarter).map(|_| oscillator.step()));
    let before = Matrix2::from_columns(&[states[0], states[quarter]]);
    let after = Matrix2::from_columns(&[states[1], states[quarter + 1]]);
    after * before.try_inverse().expect("two directions")
}

/// The integrators that a row of the table is about.
fn kinds(name: &str) -> &'static [IntegratorKind] {
    match name {
        "forward_euler" => &[IntegratorKind::ForwardEuler],
        "symplectic_euler" => &[IntegratorKind::SymplecticEuler],
        "velocity_verlet" => &[IntegratorKind::Verlet, IntegratorKind::Leapfrog],
        "rk2_midpoint" => &[IntegratorKind::Midpoint],
        "rk4" => &[IntegratorKind::Rk4],
        _ => &[],
    }
}

/// The table has ten digits; a force is right to 3e-14 of 1 m, that is 1e-12 of the elongation, and a period to
/// that over z.
#[test]
fn every_rule_has_the_energy_factor_and_the_period_of_the_table() {
    let mut count = 0;
    for row in Table::of(INTEGRATORS).rows() {
        let z = row.number("z");
        for &kind in kinds(row.text("integrator")) {
            let matrix = measured_matrix(kind, z);
            let what = format!("{kind:?}, z = {z}");
            let factor = matrix.determinant();
            assert_close(&what, factor, row.number("energy_factor_per_step"), 1e-10);
            let angle = (0.5 * matrix.trace() / factor.sqrt()).acos();
            assert_close(&what, z / angle, row.number("period_ratio"), 1e-9);
            count += 1;
        }
    }
    assert_eq!(count, 36, "six rules at six steps");
}

/// The table has eight digits. Rows whose energy grows by more than 1e5 are left out: the mass would pass its pin.
#[test]
fn a_thousand_steps_leave_the_energy_of_the_table() {
    let mut count = 0;
    for row in Table::of(INTEGRATORS).rows() {
        let final_energy = row.number("energy_ratio_1000steps");
        let kind = kinds(row.text("integrator")).first().copied();
        let Some(kind) = kind.filter(|_| final_energy < 1e5) else { continue };
        let z = row.number("z");
        let energies = Oscillator::new(kind, z, 1e-3).energies(1000);
        let least = energies.iter().copied().fold(f64::INFINITY, f64::min);
        let most = energies.iter().copied().fold(0.0, f64::max);
        let what = format!("{kind:?}, z = {z}");
        assert_close(&what, energies[999], final_energy, 1e-6);
        assert_close(&what, least, row.number("energy_min"), 1e-6);
        assert_close(&what, most, row.number("energy_max"), 1e-6);
        count += 1;
    }
    assert_eq!(count, 25);
}

/// Extremes are met to 1e-4 when thousands of steps fall all over the period: energy is flat at its extremes.
#[test]
fn the_energy_of_symplectic_rules_swings_by_the_closed_form() {
    for z in [0.1_f64, 0.37, 0.9, 1.7] {
        let cases = [
            (IntegratorKind::SymplecticEuler, (1.0 + 0.5 * z) / (1.0 - 0.5 * z)),
            (IntegratorKind::Verlet, 1.0 / (1.0 - 0.25 * z * z)),
            (IntegratorKind::Leapfrog, 1.0 / (1.0 - 0.25 * z * z)),
        ];
        for (kind, expected) in cases {
            let energies = Oscillator::new(kind, z, 1e-2).energies(5000);
            let least = energies.iter().copied().fold(f64::INFINITY, f64::min);
            let most = energies.iter().copied().fold(0.0, f64::max);
            assert_close(&format!("{kind:?}, z = {z}"), most / least, expected, 1e-4);
        }
    }
}

/// Halving the step divides the error after ten radians by 2 to the order; the next term of the error's series is
/// the tolerance, a few hundredths at these steps.
#[test]
fn every_rule_converges_at_its_order() {
    let error = |kind, steps: u32| {
        let mut oscillator = Oscillator::new(kind, 10.0 / f64::from(steps), 0.1);
        let end = (0..steps).map(|_| oscillator.step()).last().expect("steps");
        (end - Vector2::new(10f64.cos(), -(10f64.sin()))).norm()
    };
    let cases = [
        (IntegratorKind::ForwardEuler, 1.0),
        (IntegratorKind::SymplecticEuler, 1.0),
        (IntegratorKind::Verlet, 2.0),
        (IntegratorKind::Leapfrog, 2.0),
        (IntegratorKind::Midpoint, 2.0),
        (IntegratorKind::Rk4, 4.0),
    ];
    for (kind, expected) in cases {
        let order = (error(kind, 800) / error(kind, 1600)).log2();
        assert!((order - expected).abs() < 0.03, "{kind:?} is of order {order}");
    }
}

/// At 0.98 of the limit symplectic energies swing by a factor of 99, elongations by 10; 20 leaves room for the start.
#[test]
fn bounded_rules_stay_bounded_below_their_limit_and_diverge_above_it() {
    let cases = [
        (IntegratorKind::SymplecticEuler, 2.0),
        (IntegratorKind::Verlet, 2.0),
        (IntegratorKind::Leapfrog, 2.0),
        (IntegratorKind::Rk4, 8f64.sqrt()),
    ];
    for (kind, limit) in cases {
        let mut below = Oscillator::new(kind, 0.98 * limit, 1e-3);
        let farthest = (0..10_000).map(|_| below.step().x.abs()).fold(0.0, f64::max);
        assert!(farthest < 20.0, "{kind:?}: {farthest}");
        assert!(diverges(kind, 1.02 * limit), "{kind:?}");
    }
}

#[test]
fn forward_euler_and_the_midpoint_rule_diverge_at_a_quarter_of_the_others_limit() {
    assert!(diverges(IntegratorKind::ForwardEuler, 0.5));
    assert!(diverges(IntegratorKind::Midpoint, 0.5));
}

/// From an elongation of a thousand rest lengths, where it matters little that the mass passes its pin.
fn diverges(kind: IntegratorKind, z: f64) -> bool {
    let mut oscillator = Oscillator::new(kind, z, 1e3);
    let first_error = (0..10_000).find_map(|_| oscillator.simulation.advance().err());
    matches!(first_error, Some(Error::Diverged { vertex: 1, .. }))
}
