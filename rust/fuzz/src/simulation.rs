//! Simulations that nobody would make, told what nobody would tell them.

use arbitrary::Unstructured;
use boucle_geometry::Vector;
use boucle_solver::{
    Certificate, Cloth, Collider, Flow, IntegratorKind, LinearSolver, Pressure, Settings, Shape,
    Simulation, StepSize, Wind, WindLaw,
};

use crate::cloth::{any, chance, cloth, mesh, number, one_of, part};
use crate::demands::{accepted, advance, is_light, sound};

/// One or two cloths among colliders, for some frames.
pub(crate) fn random(bytes: &[u8]) {
    let mut source = Unstructured::new(bytes);
    let Some(mut simulation) = made(&mut source) else { return };
    sound(&simulation, &simulation.certificate());
    for _ in 0..3 {
        told(&mut source, &mut simulation);
        if !is_light(&simulation) {
            return;
        }
        let before = simulation.checkpoint();
        let Some(certificate) = advance(&mut simulation) else { return };
        if chance(&mut source, 60) {
            alike(&mut simulation, &before, &certificate);
        }
    }
}

/// What goes on from a checkpoint is what went on without.
fn alike(simulation: &mut Simulation, before: &[u8], certificate: &Certificate) {
    let after = simulation.checkpoint();
    simulation.restore(before).expect("our own checkpoint");
    assert!(simulation.checkpoint() == before, "a checkpoint is not what it was made from");
    if let Some(again) = advance(simulation) {
        assert_eq!(certificate.hash, again.hash, "{certificate:?} {again:?}");
        assert!(simulation.checkpoint() == after, "another state after a restore");
    }
}

fn made(source: &mut Unstructured<'_>) -> Option<Simulation> {
    let settings = settings(source);
    let mut cloths: Vec<Cloth> = vec![cloth(source)?];
    if chance(source, 40) {
        cloths.push(Cloth { name: "other".to_owned(), ..cloth(source)? });
    }
    if chance(source, 30) {
        let pressure = Pressure { uniform: part(source), ..Pressure::default() };
        cloths[0].pressure = Some(pressure);
    }
    let colliders =
        (0..any::<u8>(source) % 3).map(|_| collider(source)).collect::<Option<Vec<_>>>()?;
    let wind = chance(source, 60).then(|| Wind {
        velocity: vector(source, 20.0),
        law: if any(source) {
            WindLaw::Vertex { coefficient: number(source, 1e-6, 1.0) }
        } else {
            WindLaw::Face(Flow::new(number(source, 0.1, 1000.0)))
        },
        ..Wind::default()
    });
    let wind = wind.into_iter().collect();
    accepted(Simulation::with_colliders(cloths, colliders, wind, settings))
}

fn settings(source: &mut Unstructured<'_>) -> Settings {
    Settings {
        integrator: one_of(source, &IntegratorKind::ALL),
        linear_solver: one_of(
            source,
            &[LinearSolver::Auto, LinearSolver::Ldlt, LinearSolver::Multigrid],
        ),
        step_size: match any::<u8>(source) % 5 {
            0 => StepSize::Substeps(u32::from(any::<u8>(source) % 20)),
            1 => StepSize::Seconds(number(source, 1e-4, 0.1)),
            _ => StepSize::Auto,
        },
        allow_unstable: chance(source, 60),
        gravity: if chance(source, 200) { Vector::z() * -9.81 } else { vector(source, 1e3) },
        fps: if chance(source, 200) { 24.0 } else { number(source, 0.5, 1e3) },
        tolerance: number(source, 1e-4, 0.1),
        perturbation: one_of(source, &[0.0, 1e-6, 1e-3]),
        threads: 1,
        ..Settings::default()
    }
}

fn collider(source: &mut Unstructured<'_>) -> Option<Collider> {
    let size = one_of(source, &[0.5, 1e-6, 1e-3, 1e4]);
    let (shape, positions) = match any::<u8>(source) % 5 {
        0 => (Shape::Sphere { radius: number(source, 1e-3, 2.0) }, 1),
        1 => (Shape::Capsule { radius: number(source, 1e-3, 2.0) }, 2),
        2 => (Shape::Plane, 2),
        3 => (Shape::cuboid(), 8),
        _ => {
            let (mesh, positions) = mesh(source)?;
            let shape = Shape::Mesh(mesh);
            return Some(named(source, shape, positions));
        }
    };
    let corner = |index: usize| Vector::from_fn(|axis, _| f64::from(index as u8 >> axis & 1) - 0.5);
    let middle = vector(source, 1.0);
    let positions = (0..positions).map(|index| middle + size * corner(index)).collect();
    Some(named(source, shape, positions))
}

fn named(source: &mut Unstructured<'_>, shape: Shape, positions: Vec<Vector>) -> Collider {
    let thickness = if any(source) { 0.0 } else { number(source, 1e-5, 0.1) };
    Collider { name: "ball".to_owned(), shape, positions, thickness, friction: part(source) }
}

/// A vector of mostly plain numbers up to some size.
fn vector(source: &mut Unstructured<'_>, most: f64) -> Vector {
    Vector::from_fn(|_, _| match any::<u8>(source) {
        0 => number(source, 1e-3, most),
        byte => most * (f64::from(byte) - 128.0) / 128.0,
    })
}

/// Tells a simulation something for its next frame.
fn told(source: &mut Unstructured<'_>, simulation: &mut Simulation) {
    let far = one_of(source, &[0.01, 1.0, 100.0]);
    // What comes here has been looked at by the module: places of the world.
    let moved = |source: &mut Unstructured<'_>, points: &[Vector]| -> Vec<Vector> {
        let way = vector(source, far);
        let way = way.map(|x| if x.is_finite() { x.clamp(-1e3, 1e3) } else { 0.0 });
        points.iter().map(|point| (point + way).map(|x| x.clamp(-1e6, 1e6))).collect()
    };
    match any::<u8>(source) % 12 {
        0 | 1 => {
            let targets = moved(source, &simulation.given(0).positions.clone());
            simulation.set_pin_targets(0, &targets);
        }
        2 => {
            let places = moved(source, &simulation.given(0).positions.clone());
            simulation.set_positions(0, &places);
        }
        3 => {
            let speeds = moved(source, &vec![Vector::zeros(); simulation.given(0).positions.len()]);
            simulation.set_velocities(0, &speeds);
        }
        4 | 5 if simulation.collider_count() > 0 => {
            let targets = moved(source, &simulation.collider(0).positions.clone());
            let _ = accepted(simulation.set_collider_targets(0, &targets));
        }
        6 => {
            let shrink = vec![part(source); simulation.given(0).positions.len()];
            let _ = accepted(simulation.set_rest(0, None, Some(&shrink)));
        }
        7 => {
            let shape = moved(source, &simulation.given(0).positions.clone());
            let _ = accepted(simulation.set_rest(0, Some(&shape), None));
        }
        8 => drop(accepted(simulation.set_gravity(vector(source, 100.0)))),
        9 => {
            let weights = vec![part(source); simulation.given(0).positions.len()];
            let _ = accepted(simulation.set_pin_weights(0, &weights));
        }
        10 => {
            let given = simulation.given(0).positions.clone();
            let held = [0, (given.len() - 1) as u32];
            let targets = moved(source, &[given[0], given[given.len() - 1]]);
            let weights = [part(source), 1.0];
            let _ = accepted(simulation.grab(0, &held, &targets, &weights));
        }
        _ => {}
    }
}
