//! Free fall, pendulums, the first swing of a hanging strip, damped springs.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, DampingLaw, IntegratorKind, Mass, Settings, Simulation, SpringMaterial, StepSize,
};

use crate::reference::{CHAINS, Table};
use crate::sheets::{
    G, assert_close, classic, farthest, launched, mass_on_spring, material, network, run, sheet,
    simulation, spring, steps_of,
};

/// 1e-12 of the fall: the rounding of a thousand additions. The springs are soft, for forward Euler to keep their
/// rounding small too.
#[test]
fn a_free_cloth_falls_as_each_rule_says_and_keeps_its_shape() {
    let (h, steps) = (1e-3, 1000_u16);
    let n = f64::from(steps);
    let exact = 0.5 * G * (n * h).powi(2);
    let cases = [
        (IntegratorKind::Verlet, exact),
        (IntegratorKind::Leapfrog, exact),
        (IntegratorKind::Midpoint, exact),
        (IntegratorKind::Rk4, exact),
        (IntegratorKind::SymplecticEuler, 0.5 * G * h * h * n * (n + 1.0)),
        (IntegratorKind::ForwardEuler, 0.5 * G * h * h * n * (n - 1.0)),
    ];
    for (kind, expected) in cases {
        let cloth = sheet([8, 8], 0.125, &Mass::Density(0.2), material([5.0, 1.0, 0.05]), &[]);
        let rest = cloth.positions.clone();
        let settings = Settings { gravity: Vector::new(0.0, 0.0, -G), ..steps_of(h, kind) };
        let mut simulation = simulation(cloth, settings);
        run(&mut simulation, usize::from(steps));
        let positions = simulation.positions(0);
        assert_close(&format!("{kind:?}"), -positions[0].z, expected, 1e-12);
        let fallen: Vec<Vector> = rest.iter().map(|x| x - Vector::z() * expected).collect();
        assert!(farthest(&positions, &fallen) < 1e-11, "{kind:?} bends the falling cloth");
    }
}

/// The time (s) between the first and the last of some passages of a signal through zero upwards, and how many
/// periods that is; times between samples by a straight line.
fn mean_period(samples: &[f64], h: f64) -> f64 {
    let passages: Vec<f64> = samples
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0)
        .map(|(i, pair)| h * (i as f64 - pair[0] / (pair[1] - pair[0])))
        .collect();
    let (first, last) = (passages.first().expect("a passage"), passages.last().expect("one"));
    (last - first) / (passages.len() - 1) as f64
}

/// What a quantity is after each frame.
fn record(simulation: &mut Simulation, frames: usize, of: impl Fn(&Simulation) -> f64) -> Vec<f64> {
    let mut samples = vec![of(simulation)];
    for _ in 0..frames {
        run(simulation, 1);
        samples.push(of(simulation));
    }
    samples
}

/// The weight draws the spring out by 1e-4 of its length at rest, by 3e-4 at the bottom of a swing from 90°: half of
/// that is its effect on the period. The closed form is for a rigid rod.
#[test]
fn a_pendulum_on_a_stiff_spring_swings_with_the_period_of_its_amplitude() {
    for (degrees, ratio) in [(30.0_f64, 1.017_409), (90.0, 1.180_341)] {
        let angle = degrees.to_radians();
        let bob = Vector::new(angle.sin(), 0.0, -angle.cos());
        let cloth = network(
            vec![Vector::zeros(), bob],
            vec![spring([0, 1], 1.0, 1e4 * G)],
            vec![1.0; 2],
            &[0],
            material([0.0; 3]),
        );
        let settings = Settings {
            gravity: Vector::new(0.0, 0.0, -G),
            fps: 200.0,
            integrator: IntegratorKind::Rk4,
            threads: 1,
            ..classic()
        };
        let mut simulation = simulation(cloth, settings);
        let swing = record(&mut simulation, 2000, |now| now.positions(0)[1].x);
        let expected = ratio * std::f64::consts::TAU / G.sqrt();
        assert_close(&format!("{degrees}°"), mean_period(&swing, 1.0 / 200.0), expected, 5e-4);
    }
}

/// The first mode of a hanging chain of equal masses and links: the sideways forces of the masses, in proportion to
/// their displacement, tilt each link by what hangs below it; repeated, only the slowest mode remains.
fn first_mode(count: usize) -> Vec<f64> {
    let mut mode = vec![1.0; count];
    for _ in 0..60 {
        let mut sideways = 0.0;
        let mut tilts = vec![0.0; count];
        for i in (0..count).rev() {
            sideways += mode[i];
            tilts[i] = sideways / (count - i) as f64;
        }
        let mut x = 0.0;
        for (displacement, tilt) in mode.iter_mut().zip(&tilts) {
            x += tilt;
            *displacement = x;
        }
        let tip = mode[count - 1];
        for displacement in &mut mode {
            *displacement /= tip;
        }
    }
    mode
}

/// A chain of 1 m and 1 kg, its links so long at rest that weight draws them out to equal lengths, by 1e-4 at most.
fn hanging_chain(count: usize) -> (Cloth, Vec<Vector>) {
    let link = 1.0 / count as f64;
    let stiffness = G / (1e-4 * link);
    let hanging: Vec<Vector> =
        (0..=count).map(|i| Vector::new(0.0, 0.0, -link * i as f64)).collect();
    let springs = (0..count).map(|i| {
        let tension = G * (count - i) as f64 / count as f64;
        spring([i as u32, i as u32 + 1], link - tension / stiffness, stiffness)
    });
    let masses = vec![1.0 / count as f64; count + 1];
    let cloth = network(hanging.clone(), springs.collect(), masses, &[0], material([0.0; 3]));
    let mode = first_mode(count);
    let swung = (1..=count).map(|i| hanging[i] + Vector::x() * (1e-3 * mode[i - 1]));
    (cloth, std::iter::once(hanging[0]).chain(swung).collect())
}

/// Elongations of 1e-4 and angles of 1e-3 change the frequency by less than 1e-4; the chains differ from each other
/// by 7e-3 and from the continuum by 5e-3 and more.
#[test]
fn the_first_swing_of_a_hanging_strip_has_the_chains_frequency() {
    let table = Table::of(CHAINS);
    let first = table.rows().next().expect("the first mode");
    for (count, column) in [(20, "omega_N20_endmass_full"), (50, "omega_N50_endmass_full")] {
        let (cloth, swung) = hanging_chain(count);
        let settings = Settings {
            gravity: Vector::new(0.0, 0.0, -G),
            fps: 500.0,
            integrator: IntegratorKind::Verlet,
            threads: 1,
            ..classic()
        };
        let mut simulation = simulation(cloth, settings);
        simulation.set_positions(0, &swung);
        let swing = record(&mut simulation, 2500, |now| now.positions(0)[count].x);
        let w = std::f64::consts::TAU / mean_period(&swing, 1.0 / 500.0) / G.sqrt();
        assert_close(&format!("{count} masses"), w, first.number(column), 1e-4);
    }
}

/// Largest values between passages through zero, each from the parabola through the three samples around it.
fn peaks(samples: &[f64]) -> Vec<f64> {
    samples
        .windows(3)
        .filter(|s| s[1] > 0.0 && s[1] >= s[0] && s[1] > s[2])
        .map(|s| s[1] + (s[2] - s[0]).powi(2) / (8.0 * (2.0 * s[1] - s[0] - s[2])))
        .collect()
}

/// The fourth-order rule at 1/200 of a period is exact to 1e-8, and a parabola finds the peak to 1e-6 of it.
#[test]
fn a_damped_spring_has_the_logarithmic_decrement_of_its_damping_ratio() {
    use std::f64::consts::TAU;
    let (w, amplitude) = (TAU, 0.01);
    for ratio in [0.02, 0.1, 0.3] {
        let c = 2.0 * ratio * w;
        let expected = TAU * ratio / (1.0 - ratio * ratio).sqrt();
        let undamped = material([0.0; 3]);
        let cases = [
            ("relative", c, undamped.clone()),
            ("axial", c, SpringMaterial { damping_law: DampingLaw::Axial, ..undamped.clone() }),
            ("air", 0.0, SpringMaterial { air_damping: c, ..undamped.clone() }),
        ];
        for (what, spring_damping, material) in cases {
            let cloth = mass_on_spring(w * w, spring_damping, &material);
            let mut simulation = simulation(cloth, steps_of(1.0 / 200.0, IntegratorKind::Rk4));
            simulation.set_positions(0, &[Vector::zeros(), Vector::x() * (1.0 + amplitude)]);
            let swing = record(&mut simulation, 700, |now| now.positions(0)[1].x - 1.0);
            let peaks = peaks(&swing);
            let decrement = (peaks[0] / peaks[1]).ln();
            assert_close(&format!("{what}, {ratio}"), decrement, expected, 1e-5);
        }
    }
}

/// A mass that moves across its spring: the whole of its speed is damped by the relative law, none by the axial.
/// The spring turns by 1e-4 rad a step and is drawn out by the square of that, which is the tolerance.
#[test]
fn only_the_relative_law_damps_a_turning_spring() {
    let h = 1e-3;
    for (law, expected) in [(DampingLaw::Relative, -0.3 * 0.1), (DampingLaw::Axial, 0.0)] {
        let material = SpringMaterial { damping_law: law, ..material([0.0; 3]) };
        let cloth = mass_on_spring(1.0, 0.3, &material);
        let settings = Settings {
            step_size: StepSize::Substeps(1),
            ..steps_of(h, IntegratorKind::ForwardEuler)
        };
        let across = [Vector::zeros(), Vector::y() * 0.1];
        let mut simulation = launched(cloth, Vec::new(), settings, &across);
        let before = simulation.velocities(0)[1];
        run(&mut simulation, 1);
        let acceleration = (simulation.velocities(0)[1] - before) / h;
        assert!((acceleration.y - expected).abs() < 1e-5, "{law:?}: {acceleration:?}");
    }
}
