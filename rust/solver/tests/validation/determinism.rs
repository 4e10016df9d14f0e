//! The same input gives the same bits: for any number of threads, and after a checkpoint.

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Cloth, DampingLaw, Error, Flow, IntegratorKind, Limiter, Mass, Region, Settings, Simulation,
    SpringMaterial, StepSize, Wind, WindLaw,
};

use crate::sheets::{
    classic, cloth, grid_mesh, grid_positions, material, run, scattered, shaken, sheet,
};

/// Materials that differ in the terms of their law.
fn materials() -> Vec<SpringMaterial> {
    let springs = material([0.3, 0.1, 0.02]);
    let damping = [1e-3, 5e-4, 2e-4];
    vec![
        springs.clone(),
        SpringMaterial { damping, limiter: Limiter::Provot, ..springs.clone() },
        SpringMaterial { damping, damping_law: DampingLaw::Axial, ..springs.clone() },
        SpringMaterial { damping, limiter: Limiter::Stiffen, ..springs.clone() },
        SpringMaterial { limiter: Limiter::Project, deformation_rate: 0.02, ..springs },
    ]
}

/// A sheet of several chunks of particles, crumpled, hung by two corners.
fn large(material: SpringMaterial) -> Cloth {
    let n = 50;
    let positions = shaken(&grid_positions(n, n, 0.02), 0.002);
    let mass = Mass::Density(0.2);
    cloth(grid_mesh(n, n), positions, &mass, material, &[n * (n - 1), n * n - 1])
}

/// Triangles in random order of vertices: springs that lie nowhere in particular.
fn scrambled(material: SpringMaterial) -> Cloth {
    let n = 36_u32;
    let mut order: Vec<u32> = (0..n * n).collect();
    order.sort_by(|&a, &b| scattered(a as usize).total_cmp(&scattered(b as usize)));
    let mut positions = vec![Vector::zeros(); order.len()];
    for (old, x) in shaken(&grid_positions(n, n, 0.02), 0.002).iter().enumerate() {
        positions[order[old] as usize] = x + Vector::z() * 0.5;
    }
    let mut faces = Vec::new();
    for square in grid_mesh(n, n).faces() {
        let [a, b, c, d] = [0, 1, 2, 3].map(|corner| order[square[corner] as usize]);
        faces.extend([[a, b, c], [a, c, d]]);
    }
    let mesh = Mesh::from_faces(order.len(), &faces).expect("triangles");
    cloth(mesh, positions, &Mass::Density(0.2), material, &[order[0]])
}

fn winds() -> Vec<Wind> {
    let velocity = Vector::new(1.0, 0.5, 2.0);
    let classic = WindLaw::Vertex { coefficient: 1e-4 };
    let pressure = WindLaw::Face(Flow::new(1.2));
    let corner = Region::Vertices((0..300).collect());
    [(classic, corner), (pressure, Region::Everywhere)]
        .map(|(law, region)| Wind { velocity, law, region, ..Wind::default() })
        .to_vec()
}

/// Two cloths in two winds.
fn scene(material: &SpringMaterial, settings: &Settings) -> Simulation {
    let cloths = vec![large(material.clone()), scrambled(material.clone())];
    Simulation::new(cloths, winds(), settings.clone()).expect("a simulation")
}

fn settings(integrator: IntegratorKind, threads: usize) -> Settings {
    // For rules without a stable step too: what matters is the bits.
    let step_size = StepSize::Substeps(20);
    Settings { integrator, step_size, allow_unstable: true, threads, ..classic() }
}

#[test]
fn one_two_three_four_and_eight_threads_give_the_same_bits() {
    let [first, ..] = IntegratorKind::ALL;
    let every_rule = IntegratorKind::ALL.map(|integrator| (integrator, materials().remove(1)));
    let every_material = materials().into_iter().map(|material| (first, material));
    for (integrator, material) in every_rule.into_iter().chain(every_material) {
        let bits = |threads| {
            let mut simulation = scene(&material, &settings(integrator, threads));
            run(&mut simulation, 1);
            (simulation.certificate().hash, velocity_bits(&simulation))
        };
        let one = bits(1);
        for threads in [2, 3, 4, 8] {
            assert!(bits(threads) == one, "{integrator:?}, {material:?}: {threads} threads");
        }
    }
}

pub(crate) fn velocity_bits(simulation: &Simulation) -> Vec<u64> {
    (0..simulation.cloth_count())
        .flat_map(|cloth| simulation.velocities(cloth))
        .flat_map(|velocity| [velocity.x, velocity.y, velocity.z].map(f64::to_bits))
        .collect()
}

#[test]
fn the_same_run_twice_gives_the_same_certificate() {
    for material in materials() {
        let certificate = || {
            let mut simulation = scene(&material, &settings(IntegratorKind::SymplecticEuler, 2));
            run(&mut simulation, 2);
            simulation.certificate()
        };
        assert_eq!(certificate(), certificate());
    }
}

/// A curtain whose left pin is carried along and let go halfway, in a wind.
fn curtain(material: &SpringMaterial, settings: &Settings) -> Simulation {
    let cloth = sheet([9, 9], 0.1, &Mass::Density(0.2), material.clone(), &[0, 4, 8]);
    let classic = WindLaw::Vertex { coefficient: 1e-3 };
    let velocity = Vector::new(1.0, 0.5, 2.0);
    let wind = Wind { velocity, law: classic, region: Region::Everywhere, ..Wind::default() };
    Simulation::new(vec![cloth], vec![wind], settings.clone()).expect("a simulation")
}

/// What the outside does before each frame, by its number.
fn advance_curtain(simulation: &mut Simulation) {
    let along = Vector::new(0.004, 0.0, 0.003) * f64::from(simulation.frame());
    let targets: Vec<Vector> = simulation.cloth(0).positions.iter().map(|x| x + along).collect();
    simulation.set_pin_targets(0, &targets);
    if simulation.frame() == 5 {
        simulation.release_pins(0, &[0]);
    }
    simulation.advance().expect("a frame");
}

#[test]
fn a_restored_checkpoint_goes_on_with_the_same_bits() {
    for integrator in IntegratorKind::ALL {
        for material in materials() {
            let settings = settings(integrator, 1);
            let mut whole = curtain(&material, &settings);
            let mut checkpoints = Vec::new();
            for _ in 0..8 {
                checkpoints.push(whole.checkpoint());
                advance_curtain(&mut whole);
            }
            // At rest, with a pin on its way, just before and after it is let go.
            for bytes in [0, 3, 4, 5].map(|frame: usize| &checkpoints[frame]) {
                let mut resumed = curtain(&material, &Settings { threads: 2, ..settings.clone() });
                resumed.restore(bytes).expect("the same scene");
                assert_eq!(&resumed.checkpoint(), bytes);
                while resumed.frame() < whole.frame() {
                    advance_curtain(&mut resumed);
                }
                let what = format!("{integrator:?}, {material:?}");
                assert!(resumed.certificate() == whole.certificate(), "{what}");
                assert!(velocity_bits(&resumed) == velocity_bits(&whole), "{what}");
            }
        }
    }
}

#[test]
fn a_simulation_restored_to_its_own_past_repeats_it() {
    let material = SpringMaterial { limiter: Limiter::Project, ..material([100.0, 20.0, 2.0]) };
    let settings =
        Settings { step_size: StepSize::Auto, ..settings(IntegratorKind::SymplecticEuler, 1) };
    let mut simulation = curtain(&material, &settings);
    (0..3).for_each(|_| advance_curtain(&mut simulation));
    let early = simulation.checkpoint();
    (0..4).for_each(|_| advance_curtain(&mut simulation));
    let certificate = simulation.certificate();
    simulation.restore(&early).expect("its own checkpoint");
    assert_eq!(simulation.frame(), 4);
    (0..4).for_each(|_| advance_curtain(&mut simulation));
    assert_eq!(simulation.certificate(), certificate);
}

#[test]
fn a_checkpoint_of_another_scene_is_refused_and_changes_nothing() {
    let springs = material([100.0, 20.0, 2.0]);
    let stepped = settings(IntegratorKind::SymplecticEuler, 1);
    let bytes = curtain(&springs, &stepped).checkpoint();
    let others = [
        curtain(&material([101.0, 20.0, 2.0]), &stepped),
        curtain(&springs, &settings(IntegratorKind::Verlet, 1)),
        curtain(&springs, &Settings { gravity: Vector::zeros(), ..stepped.clone() }),
    ];
    for mut other in others {
        advance_curtain(&mut other);
        let before = other.certificate();
        assert!(matches!(other.restore(&bytes), Err(Error::BadCheckpoint(_))));
        assert_eq!(other.certificate(), before);
    }
}
