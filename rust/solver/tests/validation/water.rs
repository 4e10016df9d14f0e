//! Cloth that floats, sinks and drifts: the balance of forces in water.

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Bulk, Cloth, Flow, IntegratorKind, Mass, Settings, Shape, Simulation, Spring, StepSize, Water,
    Wave,
};

use crate::sheets::{
    G, assert_close, cloth, grid_mesh, grid_positions, in_wind, launched, material, run, sheet,
    spring, steps_of,
};

/// Without current, waves and friction.
fn still(level: f64) -> Water {
    Water { level, flow: Flow::new(1000.0), ..Water::default() }
}

fn settings(water: Water) -> Settings {
    Settings { water: Some(water), threads: 1, ..Settings::default() }
}

/// A flat sheet of 0.25 m², of such an areal density (kg/m²) and bulk density (kg/m³).
fn mat(density: f64, bulk: f64) -> Cloth {
    let mass = Mass::Density(density);
    let cloth = sheet([6, 6], 0.1, &mass, material([2000.0, 500.0, 50.0]), &[]);
    Cloth { bulk: Bulk { density: bulk, ..Bulk::default() }, ..cloth }
}

/// The mean height (m) and the largest speed (m/s).
fn height_and_speed(simulation: &Simulation) -> (f64, f64) {
    let positions = simulation.positions(0);
    let height = positions.iter().map(|x| x.z).sum::<f64>() / positions.len() as f64;
    (height, simulation.velocities(0).iter().map(Vector::norm).fold(0.0, f64::max))
}

/// A mat of 10 cm sinks in by its density over that of water, from above and from below.
#[test]
fn a_mat_floats_as_deep_as_its_density_says() {
    for (bulk, start) in [(200.0, 0.0), (200.0, -0.3), (600.0, 0.2), (950.0, -0.1)] {
        let mat = mat(0.1 * bulk, bulk);
        let positions = mat.positions.iter().map(|x| x + Vector::z() * (1.5 + start)).collect();
        let mat = Cloth { positions, ..mat };
        let mut simulation = in_wind(mat, Vec::new(), settings(still(1.5)));
        run(&mut simulation, 480);
        let (height, speed) = height_and_speed(&simulation);
        let depth = 1.5 - (height - 0.05);
        assert_close(&format!("depth of {bulk} kg/m³"), depth, 0.1 * bulk / 1000.0, 0.02);
        assert!(speed < 0.05, "{speed} m/s");
    }
}

/// Thin cloth, whose thickness is half a millimetre: it lies on the water without trembling.
#[test]
fn light_cloth_comes_to_rest_on_the_water() {
    let mat = mat(0.2, 400.0);
    let positions = mat.positions.iter().map(|x| x + Vector::z() * 0.3).collect();
    let mut simulation =
        in_wind(Cloth { positions, ..mat }, Vec::new(), settings(Water::default()));
    run(&mut simulation, 120);
    let (height, speed) = height_and_speed(&simulation);
    // Within the 5 mm over which it takes its place: 0.4 of them under water.
    assert_close("height", height + 1.0, 1.0 + 0.1 * 0.005, 1e-4);
    assert!(speed < 1e-3, "{speed} m/s");
}

/// `sqrt(2 sigma g (1 - rho/rho_b)/(rho Cd))`, face-on.
#[test]
fn a_sheet_that_is_denser_than_water_sinks_at_the_speed_of_the_closed_form() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::SymplecticEuler] {
        for (density, bulk, drag) in [(0.4, 1500.0, 1.0), (2.0, 3000.0, 1.2)] {
            let water = Water { flow: Flow { drag, ..Flow::new(1000.0) }, ..still(10.0) };
            let springs = material([50.0, 10.0, 1.0]);
            let cloth = sheet([6, 6], 0.1, &Mass::Density(density), springs, &[]);
            let cloth = Cloth { bulk: Bulk { density: bulk, ..Bulk::default() }, ..cloth };
            let settings = Settings { integrator, ..settings(water) };
            let mut simulation = in_wind(cloth, Vec::new(), settings);
            run(&mut simulation, 24);
            let speed = (2.0 * density * G * (1.0 - 1000.0 / bulk) / (1000.0 * drag)).sqrt();
            for velocity in simulation.velocities(0) {
                assert_close(&format!("{integrator:?}, {bulk}"), -velocity.z, speed, 1e-3);
            }
        }
    }
}

/// Friction takes a floating sheet along, across its whole length of time: `du/dt = rho Cf/(2 sigma) (u - v)² p`, p what is immersed.
#[test]
fn a_current_carries_a_floating_sheet_along() {
    let flow = Flow { friction: 0.05, ..Flow::new(1000.0) };
    let water = Water { velocity: Vector::new(0.6, -0.3, 0.0), flow, ..Water::default() };
    let mut simulation = in_wind(mat(0.2, 500.0), Vec::new(), settings(water));
    run(&mut simulation, 240);
    for velocity in simulation.velocities(0) {
        let speed = water_speed(&velocity);
        assert_close("speed", speed, 0.6_f64.hypot(0.3), 0.02);
        assert!(velocity.x > 0.0 && velocity.y < 0.0);
    }
}

fn water_speed(velocity: &Vector) -> f64 {
    velocity.x.hypot(velocity.y)
}

/// With v(0) = 0 the gap to the current closes as `1/(1 + U t rho Cf p/(2 sigma))`: wholly under water, without weight.
#[test]
fn friction_closes_the_gap_to_the_current_as_the_closed_form_says() {
    let (density, friction, current) = (0.5, 0.02, 1.0);
    let flow = Flow { friction, ..Flow::new(1000.0) };
    let water = Water { velocity: Vector::x() * current, flow, ..still(5.0) };
    let water = Water { flow, ..water };
    let settings = Settings {
        gravity: Vector::zeros(),
        water: Some(water),
        ..steps_of(1e-4, IntegratorKind::Rk4)
    };
    let cloth = sheet([4, 4], 0.1, &Mass::Density(density), material([2000.0, 500.0, 50.0]), &[]);
    let mut simulation = in_wind(cloth, Vec::new(), settings);
    for steps in [200, 800] {
        run(&mut simulation, steps);
        let t = 1e-4 * f64::from(simulation.frame() - 1);
        let rate = 1000.0 * friction / (2.0 * density);
        let expected = current - current / (1.0 + current * t * rate);
        for velocity in simulation.velocities(0) {
            assert_close("speed", velocity.x, expected, 1e-4);
        }
    }
}

/// A box of 1 x 1 x 0.4 m, all its corners joined by stiff springs. A cube would lie over on a side.
fn raft(mass: f64) -> Cloth {
    let Shape::Mesh(mesh) = Shape::cuboid() else { panic!("a box is a mesh") };
    let corners = |i: u32| {
        let corner = Vector::from_fn(|axis, _| f64::from(i >> axis & 1) - 0.5);
        corner.component_mul(&Vector::new(1.0, 1.0, 0.4))
    };
    let positions: Vec<Vector> = (0..8).map(corners).collect();
    let pairs = (0..8).flat_map(|a| (a + 1..8).map(move |b| [a, b]));
    let springs = pairs.map(|[a, b]| {
        let length = (corners(a) - corners(b)).norm();
        spring([a, b], length, 1e6)
    });
    let springs = springs.collect();
    let body = cloth(mesh, positions, &Mass::PerVertex(mass / 8.0), material([0.0; 3]), &[]);
    Cloth { springs, ..body }
}

/// Archimedes: a box of 1 m² and 120 kg has a draft of 12 cm, one of 300 kg 30 cm.
#[test]
fn a_closed_body_floats_as_deep_as_the_water_that_it_displaces_weighs() {
    for mass in [120.0, 300.0] {
        let mut simulation = in_wind(raft(mass), Vec::new(), settings(still(0.2)));
        run(&mut simulation, 480);
        // Drag by the square of the speed lets small bobbing go on for long: the mean over many periods.
        let mut draft = 0.0;
        for _ in 0..480 {
            run(&mut simulation, 1);
            draft += (0.2 - (height_and_speed(&simulation).0 - 0.2)) / 480.0;
        }
        let (_, speed) = height_and_speed(&simulation);
        assert_close(&format!("draft of {mass} kg"), draft, mass / 1000.0, 0.02);
        assert!(speed < 0.1, "{speed}");
    }
    // Stiffer: 1e6 N/m let the pressure of ten metres take a tenth of its volume.
    let heavy = raft(500.0);
    let stiffer = |spring: &Spring| Spring { stiffness: 1e8, ..*spring };
    let heavy = Cloth { springs: heavy.springs.iter().map(stiffer).collect(), ..heavy };
    let mut sinking = in_wind(heavy, Vec::new(), settings(still(0.2)));
    run(&mut sinking, 120);
    let (height, speed) = height_and_speed(&sinking);
    assert!(height < -3.0);
    // The weight in water on the face that goes ahead and the one behind, each with half of the drag of a sheet.
    let terminal = (2.0 * 100.0 * G / 1000.0_f64).sqrt();
    assert_close("sinking speed", speed, terminal, 0.02);
}

/// Two meshes of which one has a border: only the closed one keeps water out, unless it is told to let it in.
#[test]
fn an_open_body_is_no_hull() {
    let open = |is_hull| {
        let mesh = Mesh::from_faces(4, &[[0, 1, 2, 3]]).expect("a face");
        let positions = grid_positions(2, 2, 1.0);
        let order = [0, 1, 3, 2].map(|i: usize| positions[i]).to_vec();
        let flat = cloth(mesh, order, &Mass::Density(1.0), material([100.0; 3]), &[]);
        let bulk = Bulk { is_hull, ..Bulk::default() };
        Simulation::new(vec![Cloth { bulk, ..flat }], Vec::new(), settings(still(0.0)))
    };
    assert!(open(None).is_ok() && open(Some(false)).is_ok());
    let refused = open(Some(true)).expect_err("it has a border").to_string();
    assert!(refused.contains("hull is true, but its mesh has a border"), "{refused}");
    // Filled with water, what is denser than that sinks.
    let wet = Cloth {
        bulk: Bulk { is_hull: Some(false), density: 2000.0, ..Bulk::default() },
        ..raft(250.0)
    };
    let mut simulation = in_wind(wet, Vec::new(), settings(still(0.2)));
    run(&mut simulation, 48);
    assert!(height_and_speed(&simulation).0 < -0.5);
}

/// Without drag nothing takes energy away: a mat and a box bob, and kinetic energy, weight and water's energy stay as much together.
/// The step's error of the fourth-order rule is below 1e-7; a mat's surface has a kink, which costs more.
#[test]
fn bobbing_without_drag_keeps_its_energy() {
    let idle = Water { flow: Flow { drag: 0.0, ..Flow::new(1000.0) }, ..still(0.0) };
    let settings = Settings {
        gravity: Vector::new(0.0, 0.0, -G),
        water: Some(idle),
        ..steps_of(1e-3, IntegratorKind::Rk4)
    };
    for (body, rise, allowed) in [(mat(50.0, 500.0), 0.12, 1e-3), (raft(160.0), 0.3, 1e-3)] {
        let positions: Vec<Vector> =
            body.positions.iter().map(|x| x + Vector::z() * rise).collect();
        let mass: f64 = body.masses.iter().sum();
        let body = Cloth { positions, ..body };
        let mut simulation = in_wind(body, Vec::new(), settings.clone());
        let energy = |simulation: &Simulation| {
            let certificate = simulation.certificate();
            certificate.kinetic_energy + certificate.potential_energy
        };
        let first = energy(&simulation);
        let mut most_kinetic = 0.0_f64;
        for _ in 0..3000 {
            run(&mut simulation, 1);
            let error = (energy(&simulation) - first).abs() / (mass * G * rise);
            assert!(error < allowed, "{mass} kg, frame {}: {error}", simulation.frame());
            most_kinetic = most_kinetic.max(simulation.certificate().kinetic_energy);
        }
        assert!(most_kinetic > 0.2 * mass * G * rise, "{most_kinetic}");
    }
}

/// What floats follows the surface: over a period its height spans the wave's.
#[test]
fn what_floats_rides_on_the_waves() {
    let wave = Wave { amplitude: 0.2, length: 8.0, direction: Vector::x() };
    let water = Water { waves: vec![wave], ..Water::default() };
    let mut simulation = in_wind(mat(5.0, 200.0), Vec::new(), settings(water));
    run(&mut simulation, 96);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for _ in 0..72 {
        run(&mut simulation, 1);
        let (height, _) = height_and_speed(&simulation);
        (low, high) = (low.min(height), high.max(height));
    }
    assert!((high - low - 0.4).abs() < 0.06, "{low} to {high}");
}

/// Thrown into the water at 20 m/s, with one step a frame: it is only slowed, whatever the step.
#[test]
fn any_step_bears_a_sheet_that_is_thrown_into_the_water() {
    for integrator in
        [IntegratorKind::ImplicitEuler, IntegratorKind::Bdf2, IntegratorKind::SymplecticEuler]
    {
        let step_size = match integrator {
            IntegratorKind::SymplecticEuler => StepSize::Auto,
            _ => StepSize::Substeps(1),
        };
        let start = Settings { integrator, step_size, ..settings(Water::default()) };
        let cloth = sheet([8, 8], 0.1, &Mass::Density(0.2), material([20.0, 5.0, 0.5]), &[]);
        let positions = cloth.positions.iter().map(|x| x + Vector::z() * 2.0).collect();
        let velocities = vec![Vector::new(3.0, 0.0, -20.0); 64];
        let mut simulation = launched(Cloth { positions, ..cloth }, Vec::new(), start, &velocities);
        for frame in 0..96 {
            simulation.advance().expect("a frame");
            let (height, speed) = height_and_speed(&simulation);
            assert!(speed < 32.0, "{integrator:?}, frame {frame}: {speed} m/s");
            assert!(height > -20.0);
        }
        let (_, speed) = height_and_speed(&simulation);
        assert!(speed < 1.0, "{integrator:?}: {speed} m/s at last");
    }
}

#[test]
fn the_level_and_the_current_change_from_frame_to_frame() {
    let mut simulation = in_wind(mat(10.0, 200.0), Vec::new(), settings(Water::default()));
    run(&mut simulation, 48);
    for frame in 0..48 {
        let level = 0.01 * f64::from(frame);
        simulation.set_water(level, Vector::x() * 0.2).expect("water");
        run(&mut simulation, 1);
    }
    run(&mut simulation, 96);
    let (height, _) = height_and_speed(&simulation);
    assert!((height - 0.47).abs() < 0.05, "{height}");
    assert!(simulation.velocities(0)[0].x > 0.003);
    assert!(simulation.set_water(f64::NAN, Vector::zeros()).is_err());
    let dry = Settings { threads: 1, ..Settings::default() };
    let mut dry = in_wind(mat(10.0, 200.0), Vec::new(), dry);
    let refused = dry.set_water(0.0, Vector::zeros()).expect_err("no water").to_string();
    assert!(refused.contains("does not have"), "{refused}");
}

/// The air ends where the water begins.
#[test]
fn wind_does_not_push_what_is_under_water() {
    let wind = boucle_solver::Wind { velocity: Vector::z() * 5.0, ..Default::default() };
    for (level, moves) in [(-1.0, true), (1.0, false)] {
        let idle = Flow { drag: 0.0, ..Flow::new(0.0) };
        let water = Water { flow: idle, ..still(level) };
        let settings = Settings { gravity: Vector::zeros(), ..settings(water) };
        let cloth = cloth(
            grid_mesh(4, 4),
            grid_positions(4, 4, 0.1),
            &Mass::Density(0.2),
            material([50.0; 3]),
            &[],
        );
        let mut simulation = in_wind(cloth, vec![wind.clone()], settings);
        run(&mut simulation, 6);
        assert_eq!(height_and_speed(&simulation).1 > 0.1, moves);
    }
}
