//! Chains and strips that hang at rest.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, IntegratorKind, Limiter, Mass, Settings, Simulation, SpringMaterial, StepSize,
};

use crate::sheets::{G, assert_close, classic, material, network, run, sheet, simulation, spring};

/// Spring stiffness (N/m) and particle mass (kg) of the chains: each mass draws its spring out by a millimetre.
const STIFFNESS: f64 = 98.1;
const MASS: f64 = 0.01;

/// A pinned particle and `count` more below it, 0.1 m apart, the last of them of a part of the others' mass.
fn chain(count: u32, end_mass: f64) -> Cloth {
    let positions = (0..=count).map(|i| Vector::new(0.0, 0.0, -0.1 * f64::from(i))).collect();
    let springs = (0..count).map(|i| spring([i, i + 1], 0.1, STIFFNESS)).collect();
    let mut masses = vec![MASS; count as usize + 1];
    masses[count as usize] *= end_mass;
    // Critical damping of the slowest motion, w = pi/(2N) sqrt(k/m), damps all others enough.
    let slowest = std::f64::consts::FRAC_PI_2 / f64::from(count) * (STIFFNESS / MASS).sqrt();
    let material = SpringMaterial { air_damping: 2.0 * MASS * slowest, ..material([0.0; 3]) };
    network(positions, springs, masses, &[0], material)
}

/// A simulation under gravity after some seconds.
fn settled(cloth: Cloth, seconds: usize) -> Simulation {
    let settings = Settings {
        gravity: Vector::new(0.0, 0.0, -G),
        fps: 1.0,
        integrator: IntegratorKind::SymplecticEuler,
        step_size: StepSize::Auto,
        threads: 1,
        ..classic()
    };
    let mut simulation = simulation(cloth, settings);
    run(&mut simulation, seconds);
    simulation
}

/// 1e-9 of the tip's drop: 40 e-foldings of the slowest motion have passed, and springs of 0.1 m drawn out by 1 mm
/// or more know their elongation to 1e-11.
#[test]
fn the_tip_of_a_hanging_chain_drops_by_the_sum_of_its_springs_elongations() {
    for count in [1, 5, 20, 40] {
        let n = f64::from(count);
        for (end_mass, sum) in [(1.0, 0.5 * n * (n + 1.0)), (0.5, 0.5 * n * n)] {
            let simulation = settled(chain(count, end_mass), 10);
            let drop = -simulation.positions(0)[count as usize].z - 0.1 * n;
            let expected = MASS * G / STIFFNESS * sum;
            assert_close(&format!("{count} springs"), drop, expected, 1e-9);
        }
    }
}

/// Every spring carries what hangs below it, to the same 1e-9 of the whole.
#[test]
fn each_spring_of_a_hanging_chain_carries_the_weight_below_it() {
    let count = 20_u32;
    let positions = settled(chain(count, 1.0), 10).positions(0);
    for i in 0..count as usize {
        let force = STIFFNESS * ((positions[i] - positions[i + 1]).norm() - 0.1);
        let weight = MASS * G * (f64::from(count) - i as f64);
        assert!((force / weight - 1.0).abs() < 1e-8, "spring {i}: {force} N for {weight} N");
    }
}

/// The tension at a vertex is that of the spring above it, which carries the vertex's own weight, too.
#[test]
fn the_tension_at_a_vertex_is_that_of_its_most_loaded_spring() {
    let count = 20_usize;
    let tension = settled(chain(20, 1.0), 10).vertex_tension(0);
    for (i, &tension) in tension.iter().enumerate() {
        let weight = MASS * G * (count + 1 - i.max(1)) as f64;
        assert_close(&format!("vertex {i}"), f64::from(tension), weight, 1e-6);
    }
}

/// Springs ten times softer would stretch by up to 2; held to 5 % they carry little of the weight themselves. The
/// top edge was 1.3 % off: a step's tensions are those of its last iteration.
#[test]
fn the_tension_of_edges_at_their_limit_is_the_weight_below_them() {
    let count = 20_usize;
    let mut cloth = chain(20, 1.0);
    cloth.springs.iter_mut().for_each(|spring| spring.stiffness *= 0.1);
    cloth.material.limiter = Limiter::Project;
    cloth.material.deformation_rate = 0.05;
    let settings =
        Settings { gravity: Vector::new(0.0, 0.0, -G), threads: 1, ..Settings::default() };
    let mut simulation = simulation(cloth, settings);
    run(&mut simulation, 240);
    let tension = simulation.vertex_tension(0);
    let positions = simulation.positions(0);
    assert!((positions[0] - positions[1]).norm() < 0.1051, "the edge is held");
    for (i, &tension) in tension.iter().enumerate() {
        let weight = MASS * G * (count + 1 - i.max(1)) as f64;
        assert_close(&format!("vertex {i}"), f64::from(tension), weight, 3e-2);
    }
}

/// Two free particles pushed together pull at nothing; an edge that one cloth holds is not told of another.
#[test]
fn slack_springs_have_no_tension_and_cloths_are_told_apart() {
    let pair = |length: f64| {
        let positions = vec![Vector::zeros(), Vector::x() * length];
        network(positions, vec![spring([0, 1], 1.0, 10.0)], vec![1.0; 2], &[0, 1], classic_limit())
    };
    let cloths = vec![pair(0.5), pair(1.25)];
    let settings = Settings { gravity: Vector::zeros(), threads: 1, ..Settings::default() };
    let simulation = Simulation::new(cloths, Vec::new(), settings).expect("a simulation");
    assert_eq!(simulation.vertex_tension(0), [0.0; 2]);
    assert_eq!(simulation.vertex_tension(1), [2.5; 2]);
}

/// A limiter that holds edges, in the material of `sheets::material`.
fn classic_limit() -> SpringMaterial {
    SpringMaterial { limiter: Limiter::Project, ..material([0.0; 3]) }
}

/// Areal density (kg/m²), stiffness (N/m) and length (m) of the strip.
const DENSITY: f64 = 0.2;
const LENGTH: f64 = 1.0;
const STRIP_STIFFNESS: f64 = 50.0;

/// How far (m) the tip and the centre of mass of a hanging strip of four columns drop. Each row carries the mass of
/// the cloth nearest to it: half at the top and at the bottom. Every column stands for a width of one spacing.
fn strip_drops(rows: u32) -> [f64; 2] {
    let spacing = LENGTH / f64::from(rows - 1);
    let mass = DENSITY * spacing * spacing;
    let share = |row: u32| if row == 0 || row == rows - 1 { 0.5 } else { 1.0 };
    let masses: Vec<f64> = (0..4 * rows).map(|i| mass * share(i / 4)).collect();
    let slowest =
        std::f64::consts::FRAC_PI_2 / f64::from(rows - 1) * (STRIP_STIFFNESS / mass).sqrt();
    let material = SpringMaterial {
        air_damping: 2.0 * mass * slowest,
        ..material([STRIP_STIFFNESS, 0.0, 0.0])
    };
    let mut cloth = sheet([4, rows], spacing, &Mass::Each(masses.clone()), material, &[0, 1, 2, 3]);
    for position in &mut cloth.positions {
        *position = Vector::new(position.x, 0.0, -position.y);
    }
    let rest: Vec<f64> = cloth.positions.iter().map(|x| x.z).collect();
    let positions = settled(cloth, 8).positions(0);
    let drop = |i: usize| rest[i] - positions[i].z;
    let total: f64 = masses.iter().sum();
    let mean = (0..masses.len()).map(|i| masses[i] * drop(i)).sum::<f64>() / total;
    [drop(4 * rows as usize - 1), mean]
}

/// The tip of a strip with lumped masses is the continuum's at any resolution, to the rest of the motion; its centre
/// of mass, the mean of u = sigma g/Y (L s - s²/2), is the trapezoidal rule's: off by 1/(4 N²) of itself.
#[test]
fn a_hanging_strip_drops_as_the_continuum_and_converges_at_order_two() {
    let scale = DENSITY * G * LENGTH * LENGTH / STRIP_STIFFNESS;
    let mut errors = Vec::new();
    for rows in [6, 11, 21] {
        let [tip, mean] = strip_drops(rows);
        assert_close(&format!("tip with {rows} rows"), tip, 0.5 * scale, 1e-6);
        errors.push((mean / (scale / 3.0) - 1.0).abs());
    }
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.01, "order {order}, errors {errors:?}");
    }
}
