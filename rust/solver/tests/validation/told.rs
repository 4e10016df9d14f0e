//! A checkpoint holds what a simulation was told for the next frame.

use boucle_geometry::Vector;
use boucle_solver::{
    Certificate, Cloth, Field, FieldKind, Flow, IntegratorKind, Pressure, Region, Settings,
    Simulation, SpringMaterial, Wind, WindLaw,
};

use crate::contact_things::{ball, colliding, patch, placed};
use crate::determinism::velocity_bits;
use crate::sheets::run;

const SIDE: u32 = 8;
const COUNT: usize = (SIDE * SIDE) as usize;

/// A sheet above a ball in a breeze, held by four vertices and under pressure.
fn scene(integrator: IntegratorKind, threads: usize) -> Simulation {
    let sheet = patch([SIDE, SIDE], 0.6, SpringMaterial::default());
    let sheet = colliding(placed(sheet, |x| x + 0.2 * Vector::z()), 0.01, 0.3);
    let pressure = Some(Pressure { uniform: 1.0, ..Pressure::default() });
    let cloth = Cloth { pins: vec![0, 1, 2, SIDE - 1], pressure, ..sheet };
    let settings = Settings { integrator, threads, perturbation: 1e-6, ..Settings::default() };
    let velocity = Vector::new(0.0, 0.5, 0.0);
    let law = WindLaw::Face(Flow::new(1.2));
    let breeze = Wind { velocity, law, region: Region::Everywhere, ..Wind::default() };
    let ball = ball(Vector::zeros(), 0.18, 0.3);
    Simulation::with_colliders(vec![cloth], vec![ball], vec![breeze], settings)
        .expect("a simulation")
}

type Telling = (&'static str, fn(&mut Simulation));

/// Each way of telling a simulation something, by the name of its function.
const TELLINGS: [Telling; 15] = [
    ("nothing", |_| {}),
    ("set_pin_targets", |simulation| {
        let targets: Vec<_> =
            simulation.positions(0).iter().map(|x| x + Vector::x() / 30.0).collect();
        simulation.set_pin_targets(0, &targets);
    }),
    ("set_pin_weights", |simulation| {
        simulation.set_pin_weights(0, &[0.5; COUNT]).expect("weights");
    }),
    ("set_pin_stiffness", |simulation| {
        simulation.set_pin_weights(0, &[0.5; COUNT]).expect("weights");
        simulation.set_pin_stiffness(0, 50.0).expect("a stiffness");
    }),
    ("release_pins", |simulation| simulation.release_pins(0, &[0, 2])),
    ("grab", |simulation| {
        simulation.grab(0, &[30, 31], &[Vector::z(); 2], &[1.0, 0.5]).expect("a grab");
    }),
    ("set_positions", |simulation| {
        let places: Vec<_> =
            simulation.positions(0).iter().map(|x| x + Vector::z() / 9.0).collect();
        simulation.set_positions(0, &places);
    }),
    ("set_velocities", |simulation| simulation.set_velocities(0, &[Vector::y(); COUNT])),
    ("set_rest, shrink", |simulation| {
        simulation.set_rest(0, None, Some(&[0.2; COUNT])).expect("a shrink");
    }),
    ("set_rest, shape", |simulation| {
        let shape: Vec<_> = simulation.cloth(0).positions.iter().map(|x| 1.2 * x).collect();
        simulation.set_rest(0, Some(&shape), None).expect("a shape");
    }),
    ("set_pressure", |simulation| {
        simulation.set_pressure(0, -3.0, 0.0, None).expect("a pressure");
    }),
    ("set_fields", |simulation| {
        let field = Field { noise: 0.2, seed: 3, ..Field::new(FieldKind::Wind, 2.0) };
        simulation.set_fields(vec![field, Field::new(FieldKind::Drag, 1.0)]).expect("fields");
    }),
    ("set_wind_velocity", |simulation| {
        simulation.set_wind_velocity(0, Vector::new(1.0, 4.0, 0.0)).expect("a velocity");
    }),
    ("set_gravity", |simulation| {
        simulation.set_gravity(Vector::new(3.0, 0.0, -5.0)).expect("a gravity");
    }),
    ("set_collider_targets", |simulation| {
        simulation.set_collider_targets(0, &[Vector::new(0.02, 0.0, 0.05)]).expect("targets");
    }),
];

fn after(simulation: &mut Simulation) -> (Certificate, Vec<u64>) {
    run(simulation, 2);
    (simulation.certificate(), velocity_bits(simulation))
}

#[test]
fn what_was_told_before_a_checkpoint_is_known_to_what_goes_on_from_it() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::SymplecticEuler] {
        let mut plain = scene(integrator, 1);
        run(&mut plain, 2);
        let (start, unmoved) = (plain.checkpoint(), after(&mut plain));
        for (number, (what, tell)) in TELLINGS.into_iter().enumerate() {
            let mut whole = scene(integrator, 1);
            run(&mut whole, 2);
            tell(&mut whole);
            let checkpoint = whole.checkpoint();
            let mut resumed = scene(integrator, 2);
            resumed.restore(&checkpoint).expect("the same scene");
            assert!(resumed.checkpoint() == checkpoint, "{integrator:?}, {what}");
            let expected = after(&mut whole);
            assert!(after(&mut resumed) == expected, "{integrator:?}, {what}");
            assert_eq!(expected == unmoved, number == 0, "{integrator:?}, {what}: it does nothing");
            // What was told after a checkpoint is unknown to what goes back to it.
            tell(&mut whole);
            whole.restore(&start).expect("the same scene");
            assert!(after(&mut whole) == unmoved, "{integrator:?}, {what}: not forgotten");
        }
    }
}
