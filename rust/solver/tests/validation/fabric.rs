//! The fabric model: cantilevers beside the heavy elastica, conservation, and the same bits on any number of threads.

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Cloth, Fabric, IntegratorKind, Limiter, Mass, Settings, Simulation, SpringMaterial, StepSize,
    Warp,
};

use crate::reference::{ELASTICA, Table};
use crate::sheets::{grid_mesh, grid_positions, run, scattered};

/// A cloth of fabric without a limiter.
pub(crate) fn of_fabric(mesh: Mesh, positions: Vec<Vector>, mass: &Mass, fabric: Fabric) -> Cloth {
    let material = SpringMaterial { limiter: Limiter::None, ..SpringMaterial::default() };
    let made = Cloth::from_mesh("sheet", mesh, positions, mass, material, Vec::new());
    made.and_then(|cloth| cloth.of_fabric(fabric)).expect("a cloth of fabric")
}

/// A strip of which the part left of x = 0 is clamped, so many cells long and wide; inner vertices are moved by `jitter`
/// cells, and one of the diagonals of each quad is an edge, in turns.
fn strip(free: u32, wide: u32, cell: f64, jitter: f64) -> (Mesh, Vec<Vector>) {
    let clamped = 2;
    let columns = free + clamped + 1;
    let quads = grid_mesh(columns, wide + 1);
    let triangles: Vec<[u32; 3]> = quads
        .faces()
        .enumerate()
        .flat_map(|(i, q)| {
            if i % 2 == 0 {
                [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]
            } else {
                [[q[0], q[1], q[3]], [q[1], q[2], q[3]]]
            }
        })
        .collect();
    let positions: Vec<Vector> = grid_positions(columns, wide + 1, cell)
        .iter()
        .enumerate()
        .map(|(i, x)| {
            let (c, r) = (i as u32 % columns, i as u32 / columns);
            let is_inner = c > clamped && c + 1 < columns && r > 0 && r < wide;
            let shift =
                |k: usize| if is_inner { jitter * cell * scattered(2 * i + k) } else { 0.0 };
            x + Vector::new(shift(0) - f64::from(clamped) * cell, shift(1), 0.0)
        })
        .collect();
    (Mesh::from_faces(positions.len(), &triangles).expect("a strip"), positions)
}

/// How far the tip of a cantilever hangs, as a part of its length, at `gamma = density g L³/B`.
fn droop(gamma: f64, jitter: f64, warp: Vector) -> f64 {
    let (length, cells, bend, density) = (0.3, 30, 2e-4, 0.2);
    let cell = length / f64::from(cells);
    let (mesh, positions) = strip(cells, 8, cell, jitter);
    let fabric = Fabric {
        stretch: [5e3; 2],
        compression: [5e3; 2],
        shear: 2.5e3,
        bend: [bend; 2],
        damping_ratio: [0.02, 0.02, 0.5],
        warp: Warp::Along(warp),
        ..Fabric::default()
    };
    let gravity = gamma * bend / (density * length.powi(3));
    let mut cloth = of_fabric(mesh, positions, &Mass::Density(density), fabric);
    let rest = cloth.positions.clone();
    cloth.pins = (0..rest.len() as u32).filter(|&i| rest[i as usize].x < 1e-9).collect();
    let slowest = 3.516 / length.powi(2) * (bend / density).sqrt();
    // Half of critical for a particle of the mean mass.
    let mean = cloth.masses.iter().sum::<f64>() / cloth.masses.len() as f64;
    cloth.material.air_damping = slowest * mean;
    let settings = Settings {
        gravity: Vector::new(0.0, 0.0, -gravity),
        integrator: IntegratorKind::ImplicitEuler,
        threads: 1,
        ..Settings::default()
    };
    let mut simulation = Simulation::new(vec![cloth], Vec::new(), settings).expect("a simulation");
    run(&mut simulation, 240);
    let bent = simulation.positions(0);
    let tip: Vec<f64> = bent
        .iter()
        .zip(&rest)
        .filter(|(_, rest)| (rest.x - length).abs() < 1e-9)
        .map(|(x, _)| -x.z / length)
        .collect();
    tip.iter().sum::<f64>() / tip.len() as f64
}

#[test]
fn a_cantilever_droops_as_the_heavy_elastica_on_any_mesh() {
    for row in Table::of(ELASTICA).rows() {
        let (gamma, expected) = (row.number("Gamma"), row.number("H_over_L"));
        if ![1.0, 10.0].contains(&gamma) {
            continue;
        }
        for (jitter, warp, tolerance) in
            [(0.0, Vector::new(1.0, 1.0, 0.0), 0.025), (0.35, Vector::y(), 0.05)]
        {
            let got = droop(gamma, jitter, warp);
            let error = (got / expected - 1.0).abs();
            assert!(error < tolerance, "gamma {gamma}, jitter {jitter}: {got}, not {expected}");
        }
    }
}

/// A crumpled, spinning, drifting sheet of fabric without gravity.
fn tumbling(integrator: IntegratorKind, step_size: StepSize) -> Simulation {
    let n = 14;
    let positions = grid_positions(n, n, 0.03);
    let fabric = Fabric {
        stretch: [800.0, 500.0],
        compression: [200.0; 2],
        shear: 40.0,
        bend: [1e-4, 5e-5],
        damping_ratio: [0.0; 3],
        warp: Warp::Along(Vector::y()),
        ..Fabric::default()
    };
    let cloth = of_fabric(grid_mesh(n, n), positions.clone(), &Mass::Density(0.2), fabric);
    let settings = Settings {
        gravity: Vector::zeros(),
        integrator,
        step_size,
        threads: 1,
        ..Settings::default()
    };
    let mut simulation = Simulation::new(vec![cloth], Vec::new(), settings).expect("a simulation");
    let spin = Vector::new(0.7, -0.4, 2.0);
    let velocities: Vec<Vector> = positions
        .iter()
        .enumerate()
        .map(|(i, x)| spin.cross(x) + Vector::from_fn(|axis, _| 0.3 * scattered(7 * i + axis)))
        .collect();
    simulation.set_velocities(0, &velocities);
    simulation
}

pub(crate) fn energy(simulation: &Simulation) -> f64 {
    let certificate = simulation.certificate();
    certificate.kinetic_energy + certificate.potential_energy
}

/// Over five seconds.
pub(crate) fn assert_energy_never_grows(simulation: &mut Simulation, integrator: IntegratorKind) {
    let mut last = energy(simulation);
    for frame in 0..120 {
        run(simulation, 1);
        let now = energy(simulation);
        assert!(now <= last * (1.0 + 1e-3), "{integrator:?}, frame {frame}: {last} J, {now} J");
        last = now;
    }
}

#[test]
fn the_energy_of_a_free_sheet_of_fabric_never_grows() {
    for integrator in [IntegratorKind::ImplicitEuler, IntegratorKind::Bdf2] {
        assert_energy_never_grows(&mut tumbling(integrator, StepSize::Auto), integrator);
    }
}

/// Verlet keeps the energy of undamped motion up to a swing of `1/(1 - z²/4)`, a tenth at most at a third of the safe step.
#[test]
fn explicit_steps_of_fabric_are_stable_and_keep_the_energy() {
    let safe = tumbling(IntegratorKind::Verlet, StepSize::Auto).safe_time_step();
    for (part, tolerance) in [(0.98, 0.5), (0.3, 0.03)] {
        let mut simulation = tumbling(IntegratorKind::Verlet, StepSize::Seconds(part * safe));
        let first = energy(&simulation);
        run(&mut simulation, 24);
        let ratio = energy(&simulation) / first;
        assert!((ratio - 1.0).abs() < tolerance, "at {part} of the safe step: {ratio}");
    }
}

#[test]
fn a_free_sheet_of_fabric_keeps_its_momentum() {
    let mut simulation = tumbling(IntegratorKind::ImplicitEuler, StepSize::Auto);
    let momentum = |simulation: &Simulation| {
        let masses = simulation.cloth(0).masses.clone();
        let moving = simulation.positions(0).into_iter().zip(simulation.velocities(0));
        masses.iter().zip(moving).fold([Vector::zeros(); 2], |sum, (m, (x, v))| {
            [sum[0] + *m * v, sum[1] + *m * x.cross(&v)]
        })
    };
    let size: f64 = simulation
        .velocities(0)
        .iter()
        .zip(&simulation.cloth(0).masses)
        .map(|(v, m)| m * v.norm())
        .sum();
    let [linear, _] = momentum(&simulation);
    run(&mut simulation, 24);
    let drift = (momentum(&simulation)[0] - linear).norm() / size;
    assert!(drift < 1e-10, "{drift:e}");
}

#[test]
fn fabric_moves_by_the_same_bits_on_any_number_of_threads() {
    let hash = |threads: usize| {
        let n = 60;
        let positions = grid_positions(n, n, 0.02);
        let mut cloth =
            of_fabric(grid_mesh(n, n), positions, &Mass::Density(0.2), Fabric::default());
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

/// Triangles, some of which are wound the other way.
fn some_turned(mesh: &Mesh, seed: usize) -> Mesh {
    let faces: Vec<Vec<u32>> = mesh
        .faces()
        .enumerate()
        .map(|(i, f)| if scattered(i + seed) > 0.0 { vec![f[0], f[2], f[1]] } else { f.to_vec() })
        .collect();
    Mesh::from_faces(mesh.vertex_count(), &faces).expect("the same faces")
}

/// The forces (N) of a fabric, bent and stretched by chance, which has a shape of its own at rest and yields.
fn forces_of(mesh: Mesh, rest: &[Vector]) -> Vec<Vector> {
    let fabric = Fabric {
        bend: [2e-3, 1e-3],
        yield_curvature: Some(3.0),
        bend_hysteresis: 1e-3,
        warp: Warp::Along(Vector::new(1.0, 0.3, 0.2)),
        ..Fabric::default()
    };
    let cloth = of_fabric(mesh, rest.to_vec(), &Mass::Density(0.2), fabric);
    let bent: Vec<Vector> = rest
        .iter()
        .map(|x| {
            x + Vector::new(0.0, 0.02 * (9.0 * x.x).sin(), 0.05 * (20.0 * x.x + 7.0 * x.y).sin())
        })
        .collect();
    crate::sheets::forces_at(&cloth, &[], Vector::zeros(), &crate::sheets::shaken(&bent, 1e-3))
}

fn assert_same_forces(a: &[Vector], b: &[Vector]) {
    let size = a.iter().map(nalgebra::Matrix::norm).fold(0.0, f64::max);
    let error = crate::sheets::farthest(a, b);
    assert!(size > 1e-3 && error < 1e-8 * size, "{error:e} of {size:e} N");
}

/// Which side of a face is up is a matter of where it is looked at from.
#[test]
fn fabric_bends_alike_whichever_way_its_faces_are_wound() {
    let (mesh, positions) = strip(12, 6, 0.05, 0.3);
    let curved: Vec<Vector> =
        positions.iter().map(|x| x + Vector::z() * 0.05 * (10.0 * x.x).sin()).collect();
    for rest in [&positions, &curved] {
        let forces = forces_of(mesh.clone(), rest);
        for seed in [0, 1000, 2000] {
            assert_same_forces(&forces, &forces_of(some_turned(&mesh, seed), rest));
        }
    }
}

/// No winding of a Moebius strip is the same everywhere.
#[test]
fn a_moebius_strip_bends_alike_whichever_way_its_faces_are_wound() {
    let (around, across) = (48_u32, 4_u32);
    let vertex = |i: u32, j: u32| if i < around { i * across + j } else { across - 1 - j };
    let faces: Vec<[u32; 3]> = (0..around)
        .flat_map(|i| (0..across - 1).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b] = [vertex(i, j), vertex(i, j + 1)];
            let [c, d] = [vertex(i + 1, j + 1), vertex(i + 1, j)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let mesh = Mesh::from_faces((around * across) as usize, &faces).expect("a strip");
    let places = (0..around * across).map(|number| {
        let angle = std::f64::consts::TAU * f64::from(number / across) / f64::from(around);
        let (sine, cosine) = angle.sin_cos();
        let out = 0.05 * (f64::from(number % across) - 1.5);
        let radius = 0.5 + out * (0.5 * angle).cos();
        Vector::new(radius * cosine, radius * sine, out * (0.5 * angle).sin())
    });
    let rest: Vec<Vector> = places.collect();
    let forces = forces_of(mesh.clone(), &rest);
    for seed in [0, 1000, 2000] {
        assert_same_forces(&forces, &forces_of(some_turned(&mesh, seed), &rest));
    }
}
