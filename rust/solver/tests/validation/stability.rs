//! The largest stable step of spring lattices, and the step that `auto` picks.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, DampingLaw, Error, IntegratorKind, Mass, Settings, Simulation, SpringMaterial, StepSize,
};
use nalgebra::Matrix2;

use crate::reference::{LATTICES, Table};
use crate::sheets::{classic, farthest, material, shaken, sheet, simulation};

/// Stiffness (N/m) of a lattice of particles of 1 kg: w is of order 100/s, and frames are long enough to be accepted.
const STIFFNESS: f64 = 1e4;

/// How far (m) particles are moved at the start: so little that springs of 1 m stay linear.
const SHAKE: f64 = 1e-9;

const BOUNDED: [IntegratorKind; 4] = [
    IntegratorKind::SymplecticEuler,
    IntegratorKind::Verlet,
    IntegratorKind::Leapfrog,
    IntegratorKind::Rk4,
];

/// A free lattice of 16 x 16 particles, 1 m apart.
fn lattice(material: SpringMaterial) -> Cloth {
    sheet([16, 16], 1.0, &Mass::PerVertex(1.0), material, &[])
}

fn lattice_material([stretch, shear, bend]: [f64; 3]) -> SpringMaterial {
    material([stretch * STIFFNESS, shear * STIFFNESS, bend * STIFFNESS])
}

/// How far (m) a shaken cloth gets from rest over some steps; infinity if it diverges.
fn excursion(cloth: &Cloth, integrator: IntegratorKind, h: f64, steps: u32) -> f64 {
    let substeps = steps.min(100);
    let settings = Settings {
        gravity: Vector::zeros(),
        fps: 1.0 / (h * f64::from(substeps)),
        integrator,
        step_size: StepSize::Substeps(substeps),
        allow_unstable: true,
        threads: 1,
        ..classic()
    };
    let mut simulation = simulation(cloth.clone(), settings);
    simulation.set_positions(0, &shaken(&cloth.positions, SHAKE));
    let mut most = 0.0_f64;
    for _ in 0..steps / substeps {
        match simulation.advance() {
            Ok(_) => most = most.max(farthest(&simulation.positions(0), &cloth.positions)),
            Err(Error::Diverged { .. }) => return f64::INFINITY,
            Err(error) => panic!("{error}"),
        }
    }
    most
}

fn auto(cloth: Cloth, integrator: IntegratorKind) -> Simulation {
    let settings = Settings { integrator, fps: 1.0, threads: 1, ..classic() };
    simulation(cloth, settings)
}

/// The step (s) that `auto` picks.
fn auto_step(cloth: &Cloth, integrator: IntegratorKind) -> f64 {
    1.0 / f64::from(auto(cloth.clone(), integrator).substeps())
}

#[track_caller]
fn assert_auto_is_between_half_and_all_of(bound: f64, cloth: &Cloth, kind: IntegratorKind) {
    let part = auto_step(cloth, kind) / bound;
    assert!((0.5..=1.0).contains(&part), "{kind:?}: auto takes {part} of the bound {bound} s");
}

/// Just below the limit the fastest mode swings ten times as far as it is pushed; a thousand times is bounded. Above
/// it Runge-Kutta may end in a crumpled lattice, whose slow motions it damps, that tumbles at some metres.
#[test]
fn ten_thousand_steps_stay_bounded_below_the_lattices_limit_and_diverge_above_it() {
    for row in Table::of(LATTICES).rows() {
        let cloth = lattice(lattice_material(["ks", "kd", "kb"].map(|name| row.number(name))));
        let w = (row.number("lambda_max_16x16_free") * STIFFNESS).sqrt();
        for kind in BOUNDED {
            let limit = if kind == IntegratorKind::Rk4 { 8f64.sqrt() } else { 2.0 };
            let what = format!("{}, {kind:?}", row.text("springs"));
            let below = excursion(&cloth, kind, 0.98 * limit / w, 10_000);
            assert!(below < 1e3 * SHAKE, "{what}: {below} m at 0.98");
            let above = excursion(&cloth, kind, 1.02 * limit / w, 10_000);
            let has_diverged =
                if kind == IntegratorKind::Rk4 { above > 1.0 } else { above.is_infinite() };
            assert!(has_diverged, "{what}: {above} m at 1.02");
        }
    }
}

#[test]
fn auto_takes_between_half_and_all_of_the_lattices_limit() {
    for row in Table::of(LATTICES).rows() {
        let cloth = lattice(lattice_material(["ks", "kd", "kb"].map(|name| row.number(name))));
        let w = (row.number("lambda_max_16x16_free") * STIFFNESS).sqrt();
        for kind in BOUNDED {
            let limit = if kind == IntegratorKind::Rk4 { 8f64.sqrt() } else { 2.0 };
            assert_auto_is_between_half_and_all_of(limit / w, &cloth, kind);
        }
    }
}

/// A step of an integrator on x'' = -w² x - c x', written once more, with w = 1.
fn oscillator_step(kind: IntegratorKind, c: f64, h: f64, [x, v]: [f64; 2]) -> [f64; 2] {
    let a = |x: f64, v: f64| -x - c * v;
    let rate = |[x, v]: [f64; 2]| [v, a(x, v)];
    let along = |[p, q]: [f64; 2], h: f64| [x + h * p, v + h * q];
    match kind {
        IntegratorKind::ForwardEuler => along(rate([x, v]), h),
        IntegratorKind::SymplecticEuler => {
            let v = v + h * a(x, v);
            [x + h * v, v]
        }
        IntegratorKind::Verlet => {
            let u = v + 0.5 * h * a(x, v);
            let x = x + h * u;
            [x, u + 0.5 * h * a(x, u)]
        }
        IntegratorKind::Leapfrog => {
            let y = x + 0.5 * h * v;
            let v = v + h * a(y, v);
            [y + 0.5 * h * v, v]
        }
        IntegratorKind::ImplicitEuler | IntegratorKind::Bdf2 => unreachable!("no limit"),
        IntegratorKind::Midpoint => along(rate(along(rate([x, v]), 0.5 * h)), h),
        IntegratorKind::Rk4 => {
            let k1 = rate([x, v]);
            let k2 = rate(along(k1, 0.5 * h));
            let k3 = rate(along(k2, 0.5 * h));
            let k4 = rate(along(k3, h));
            along([0, 1].map(|i| (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0), h)
        }
    }
}

/// The largest stable step (s) of x'' = -w² x - c x', where every smaller step is stable too.
fn oscillator_limit(kind: IntegratorKind, w: f64, c: f64) -> f64 {
    let is_stable = |z: f64| {
        let columns =
            [[1.0, 0.0], [0.0, 1.0]].map(|start| oscillator_step(kind, c / w, z, start).into());
        let eigenvalues = Matrix2::from_columns(&columns).complex_eigenvalues();
        eigenvalues.iter().all(|value| value.norm() <= 1.0)
    };
    let first_unstable = (1..100_000).map(|i| f64::from(i) * 1e-4).find(|&z| !is_stable(z));
    first_unstable.expect("a limit") / w
}

/// Axial dampers beside springs of proportional stiffness damp every mode of the lattice by c = w² kd/k. They leave
/// springs that turn undamped, so that `auto` has no step for rules that need damping.
#[test]
fn axial_damping_lowers_the_lattices_limit_as_the_oscillators_say_and_auto_follows() {
    let row = Table::of(LATTICES);
    let row = row.rows().last().expect("bend = 0.2");
    let w = (row.number("lambda_max_16x16_free") * STIFFNESS).sqrt();
    // Twice the damping ratio of the fastest mode.
    for strength in [0.5, 1.0] {
        let mut material = lattice_material(["ks", "kd", "kb"].map(|name| row.number(name)));
        material.damping = material.stiffness.map(|stiffness| stiffness * strength / w);
        material.damping_law = DampingLaw::Axial;
        let cloth = lattice(material);
        for kind in IntegratorKind::EXPLICIT {
            let limit = oscillator_limit(kind, w, strength * w);
            let below = excursion(&cloth, kind, 0.98 * limit, 2000);
            assert!(below < 1e3 * SHAKE, "{kind:?}, {strength}: {below} m at 0.98");
            let above = excursion(&cloth, kind, 1.02 * limit, 10_000);
            assert!(above > 1e3 * SHAKE, "{kind:?}, {strength}: {above} m at 1.02");
            if BOUNDED.contains(&kind) {
                assert_auto_is_between_half_and_all_of(limit, &cloth, kind);
            }
        }
    }
}

/// The largest step (s) that stays bounded for 2000 steps, found by trying, to a percent.
fn tried_limit(cloth: &Cloth, kind: IntegratorKind, longest: f64) -> f64 {
    let (mut bounded, mut unbounded) = (0.0, longest);
    assert!(excursion(cloth, kind, longest, 2000) > 1e3 * SHAKE, "{longest} s is bounded");
    while unbounded - bounded > 0.01 * unbounded {
        let middle = 0.5 * (bounded + unbounded);
        let is_bounded = excursion(cloth, kind, middle, 2000) < 1e3 * SHAKE;
        *if is_bounded { &mut bounded } else { &mut unbounded } = middle;
    }
    bounded
}

#[test]
fn auto_takes_between_half_and_all_of_the_limit_with_relative_and_air_damping() {
    let w = (8.0 * STIFFNESS).sqrt();
    for (spring_damping, air_damping) in [(0.3 / w, 0.0), (1.0 / w, 0.0), (0.0, 0.5 * w)] {
        let mut material = lattice_material([1.0, 1.0, 0.2]);
        material.damping = material.stiffness.map(|stiffness| stiffness * spring_damping);
        material.air_damping = air_damping;
        let cloth = lattice(material);
        for kind in BOUNDED {
            let limit = tried_limit(&cloth, kind, 3.2 / w);
            assert_auto_is_between_half_and_all_of(limit, &cloth, kind);
        }
    }
}

/// Masses a hundred times lighter than others, pins, triangles: what the lattice does not show.
#[test]
fn auto_takes_between_half_and_all_of_the_limit_of_an_uneven_cloth() {
    let faces: Vec<[u32; 3]> = (0..11 * 11)
        .map(|i| i / 11 * 12 + i % 11)
        .flat_map(|i| [[i, i + 1, i + 13], [i, i + 13, i + 12]])
        .collect();
    let mesh = boucle_geometry::Mesh::from_faces(144, &faces).expect("triangles");
    let flat = crate::sheets::grid_positions(12, 12, 1.0);
    let uneven: Vec<Vector> =
        shaken(&flat, 0.2).iter().map(|x| Vector::new(x.x, x.y, 0.0)).collect();
    let masses = (0..144).map(|i| 10f64.powf(crate::sheets::scattered(i))).collect();
    let material = lattice_material([1.0, 0.5, 0.2]);
    let cloth = crate::sheets::cloth(mesh, uneven, &Mass::Each(masses), material, &[0, 11]);
    for kind in BOUNDED {
        let limit = tried_limit(&cloth, kind, 0.03);
        assert_auto_is_between_half_and_all_of(limit, &cloth, kind);
    }
}
