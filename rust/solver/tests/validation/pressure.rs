//! Pressure: the gradient of a volume, no force on a closed cloth as a whole, balloons at the volume that balances.

use std::collections::BTreeMap;

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Cloth, IntegratorKind, Limiter, Mass, Pressure, Settings, Simulation, SpringMaterial, StepSize,
};

use crate::sheets::{assert_close, cloth, forces_at, run, shaken, sheet, simulation};

/// The faces of a cube of `n` x `n` quads a side, every third cut into triangles, blown up to a ball of a radius (m).
pub(crate) fn ball(n: i32, radius: f64) -> (Mesh, Vec<Vector>) {
    let mut number_of = BTreeMap::new();
    let mut positions = Vec::new();
    let mut vertex = |place: [i32; 3]| {
        *number_of.entry(place).or_insert_with(|| {
            let x = Vector::from(place.map(|x| f64::from(2 * x - n) / f64::from(n)));
            positions.push(radius * x.normalize());
            positions.len() as u32 - 1
        })
    };
    let mut faces = Vec::new();
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, n)]) {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut corner = |[a, b]: [i32; 2]| {
                let mut place = [0; 3];
                (place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3]) = (side, i + a, j + b);
                vertex(place)
            };
            let [a, b, c, d] = [[0, 0], [1, 0], [1, 1], [0, 1]].map(&mut corner);
            let quad = if side == n { [a, b, c, d] } else { [d, c, b, a] };
            if (i + j) % 3 == 0 {
                faces.extend([vec![quad[0], quad[1], quad[2]], vec![quad[0], quad[2], quad[3]]]);
            } else {
                faces.push(quad.to_vec());
            }
        }
    }
    (Mesh::from_faces(positions.len(), &faces).expect("a ball"), positions)
}

fn balloon(n: i32, stiffness: f64, pressure: Pressure) -> Cloth {
    let (mesh, positions) = ball(n, 0.5);
    let material = SpringMaterial {
        stiffness: [stiffness, 0.5 * stiffness, 0.0],
        limiter: Limiter::None,
        air_damping: 0.01,
        ..SpringMaterial::default()
    };
    let cloth = cloth(mesh, positions, &Mass::Density(0.2), material, &[]);
    Cloth { pressure: Some(pressure), ..cloth }
}

/// Volume within triangles around the middle of each face, by the divergence theorem.
fn volume(mesh: &Mesh, positions: &[Vector]) -> f64 {
    let of_face = |corners: &[u32]| {
        let corners: Vec<Vector> = corners.iter().map(|&c| positions[c as usize]).collect();
        let middle = corners.iter().sum::<Vector>() / corners.len() as f64;
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).map(|(a, b)| middle.dot(&a.cross(b)) / 6.0).sum::<f64>()
    };
    mesh.faces().map(of_face).sum()
}

fn weightless(integrator: IntegratorKind, step_size: StepSize) -> Settings {
    Settings { gravity: Vector::zeros(), integrator, step_size, threads: 1, ..Settings::default() }
}

/// Central differences of 1e-5 m lose 1e-10 of the force.
#[test]
fn the_force_is_pressure_times_the_gradient_of_the_volume() {
    let p = 30.0;
    let cloth = balloon(4, 0.0, Pressure { uniform: p, ..Pressure::default() });
    let cloth = Cloth { material: SpringMaterial { air_damping: 0.0, ..cloth.material }, ..cloth };
    let positions = shaken(&cloth.positions, 0.05);
    let forces = forces_at(&cloth, &[], Vector::zeros(), &positions);
    for (vertex, force) in forces.iter().enumerate() {
        let gradient = Vector::from_fn(|axis, _| {
            let [after, before] = [1e-5, -1e-5].map(|step| {
                let mut moved = positions.clone();
                moved[vertex][axis] += step;
                volume(&cloth.mesh, &moved)
            });
            (after - before) / 2e-5
        });
        assert!((force - p * gradient).norm() < 1e-6 * p, "{vertex}: {force:?}, {gradient:?}");
    }
    let total: Vector = forces.iter().sum();
    assert!(total.norm() < 1e-9 * p, "a closed cloth is pushed by {total:?} N as a whole");
}

#[test]
fn an_open_sheet_feels_the_pressure_on_its_area_along_its_normals() {
    let sheet = sheet([4, 3], 0.5, &Mass::Density(1.0), SpringMaterial::default(), &[]);
    let weights = (0..12).map(|vertex| if vertex % 4 == 0 { 0.0 } else { 0.5 }).collect();
    for (weights, expected) in [(Vec::new(), 7.0 * 1.5), (weights, 7.0 * 1.25 * 0.5)] {
        let pressure = Pressure { uniform: 7.0, weights, ..Pressure::default() };
        let cloth = Cloth { pressure: Some(pressure), ..sheet.clone() };
        let forces = forces_at(&cloth, &[], Vector::zeros(), &cloth.positions);
        let total: Vector = forces.iter().sum();
        assert_close("force (N)", total.z, expected, 1e-9);
        assert!(total.xy().norm() < 1e-9);
    }
}

/// A soft balloon goes to the volume at which the filling balances the air; 5 % is what its springs hold back.
#[test]
fn a_balloon_comes_to_its_target_volume_by_any_steps() {
    let target = 1.0;
    for (integrator, step_size, factor) in [
        (IntegratorKind::Bdf2, StepSize::Auto, 2e3),
        (IntegratorKind::Bdf2, StepSize::Substeps(2), 2e4),
        (IntegratorKind::ImplicitEuler, StepSize::Substeps(3), 2e3),
        (IntegratorKind::SymplecticEuler, StepSize::Auto, 2e3),
    ] {
        let pressure = Pressure { factor, target_volume: Some(target), ..Pressure::default() };
        let mut simulation =
            simulation(balloon(6, 20.0, pressure), weightless(integrator, step_size));
        let start = simulation.volume(0).expect("a volume");
        assert!((0.4..0.53).contains(&start), "a ball of half a metre holds {start} m³");
        run(&mut simulation, 48);
        let end = simulation.volume(0).expect("a volume");
        assert!((end - target).abs() < 0.05 * target, "{integrator:?} {factor}: {end} m³");
        let positions = simulation.positions(0);
        assert_close("volume", volume(&simulation.cloth(0).mesh, &positions), end, 1e-12);
        let middle: Vector = positions.iter().sum::<Vector>() / positions.len() as f64;
        assert!(middle.norm() < 1e-3, "it has gone to {middle:?}");
    }
}

#[test]
fn more_pressure_makes_a_larger_balloon_and_none_keeps_its_size() {
    let mut last = 0.0;
    for uniform in [0.0, 50.0, 200.0, 400.0] {
        let pressure = Pressure { uniform, ..Pressure::default() };
        let settings = weightless(IntegratorKind::Bdf2, StepSize::Auto);
        let mut simulation = simulation(balloon(6, 300.0, pressure), settings);
        let start = simulation.volume(0).expect("a volume");
        run(&mut simulation, 36);
        let end = simulation.volume(0).expect("a volume");
        assert!(end > last && end.is_finite(), "{uniform} N/m²: {end} m³ after {last} m³");
        if uniform == 0.0 {
            assert_close("volume", end, start, 1e-6);
        }
        last = end;
    }
}

/// 1000 N/m² would burst the springs; the limiter holds every edge, and with it the volume below 1.1³ of that at rest.
#[test]
fn the_limiter_holds_a_balloon_that_its_springs_would_not() {
    let pressure = Pressure { uniform: 1000.0, ..Pressure::default() };
    let cloth = balloon(6, 300.0, pressure);
    let material = SpringMaterial { limiter: Limiter::Project, ..cloth.material };
    let settings = weightless(IntegratorKind::Bdf2, StepSize::Auto);
    let mut simulation = simulation(Cloth { material, ..cloth }, settings);
    let start = simulation.volume(0).expect("a volume");
    for _ in 0..12 {
        run(&mut simulation, 1);
        assert!(simulation.certificate().max_strain < 0.1006, "{:?}", simulation.certificate());
    }
    let end = simulation.volume(0).expect("a volume");
    assert!((1.2..1.34).contains(&(end / start)), "{start} m³ became {end} m³");
}

/// Work of the pressure goes into springs and motion, all of it but for the error of fine steps.
#[test]
fn energy_counts_what_the_filling_gives() {
    let pressure =
        Pressure { uniform: 20.0, factor: 100.0, target_volume: Some(0.6), ..Pressure::default() };
    let cloth = balloon(4, 300.0, pressure);
    let cloth = Cloth { material: SpringMaterial { air_damping: 0.0, ..cloth.material }, ..cloth };
    let settings = weightless(IntegratorKind::Rk4, StepSize::Substeps(60));
    let mut simulation = simulation(cloth, settings);
    let energy = |simulation: &Simulation| {
        let certificate = simulation.certificate();
        [certificate.kinetic_energy, certificate.kinetic_energy + certificate.potential_energy]
    };
    let [_, start] = energy(&simulation);
    let mut most = 0.0_f64;
    for _ in 0..12 {
        run(&mut simulation, 1);
        let [kinetic, whole] = energy(&simulation);
        most = most.max(kinetic);
        assert!((whole - start).abs() < 1e-3 * most.max(0.1), "{whole} J after {start} J");
    }
    assert!(most > 0.3, "it hardly moves: {most} J");
}

#[test]
fn pressure_follows_what_it_is_set_to_and_a_checkpoint_goes_on_bit_equal() {
    let pressure = || Pressure { uniform: 0.0, factor: 500.0, ..Pressure::default() };
    let settings = || weightless(IntegratorKind::Bdf2, StepSize::Auto);
    let mut whole = simulation(balloon(5, 100.0, pressure()), settings());
    let mut checkpoint = Vec::new();
    for frame in 0..8 {
        if frame == 4 {
            checkpoint = whole.checkpoint();
        }
        whole.set_pressure(0, 40.0 * f64::from(frame), 500.0, None).expect("a pressure");
        run(&mut whole, 1);
    }
    let mut resumed = simulation(balloon(5, 100.0, pressure()), settings());
    resumed.restore(&checkpoint).expect("a checkpoint");
    for frame in 4..8 {
        resumed.set_pressure(0, 40.0 * f64::from(frame), 500.0, None).expect("a pressure");
        run(&mut resumed, 1);
    }
    assert_eq!(whole.certificate().hash, resumed.certificate().hash);
    let settings = Settings { threads: 3, ..settings() };
    let mut threaded = simulation(balloon(5, 100.0, pressure()), settings);
    for frame in 0..8 {
        threaded.set_pressure(0, 40.0 * f64::from(frame), 500.0, None).expect("a pressure");
        run(&mut threaded, 1);
    }
    assert_eq!(whole.certificate().hash, threaded.certificate().hash);
}

#[test]
fn a_pressure_out_of_its_domain_is_refused() {
    for (pressure, expected) in [
        (Pressure { uniform: f64::NAN, ..Pressure::default() }, "pressure uniform (N/m²) is NaN"),
        (Pressure { factor: -1.0, ..Pressure::default() }, "pressure factor (N/m²) is -1"),
        (
            Pressure { target_volume: Some(-1.0), ..Pressure::default() },
            "pressure target_volume (m³) is -1",
        ),
        (Pressure { weights: vec![1.0], ..Pressure::default() }, "1 weights of pressure are given"),
    ] {
        let cloth = balloon(2, 10.0, pressure);
        let error = Simulation::new(vec![cloth], Vec::new(), Settings::default());
        let error = error.expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}");
    }
}
