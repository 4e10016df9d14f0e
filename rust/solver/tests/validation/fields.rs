//! Force fields on cloth: their share of its area, and that they stay stable, deterministic and free where there are none.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, Field, FieldKind, FieldShape, IntegratorKind, Mass, Pressure, Settings, Simulation,
    StepSize,
};

use crate::sheets::{assert_close, classic, launched, material, run, sheet, simulation, steps_of};

/// A square of 0.5 m, of 0.2 kg/m², with soft springs.
fn square() -> Cloth {
    sheet([6, 6], 0.1, &Mass::Density(0.2), material([5.0, 1.0, 0.1]), &[])
}

fn implicit() -> Settings {
    let integrator = IntegratorKind::Bdf2;
    Settings { integrator, gravity: Vector::zeros(), threads: 1, ..classic() }
}

fn among(cloth: Cloth, fields: &[Field], settings: Settings) -> Simulation {
    let mut simulation = simulation(cloth, settings);
    simulation.set_fields(fields.to_vec()).expect("fields");
    simulation
}

/// In a wind that carries it, of 3 N/m², 0.2 kg/m² go 15 m/s²; with a wind factor of 1 only along the normal.
#[test]
fn a_field_pushes_each_vertex_by_its_share_of_the_area() {
    for (wind_factor, part) in [(0.0, 1.0), (1.0, 0.0), (0.5, 0.5)] {
        let axis = Vector::new(0.6, 0.0, 0.8);
        let field = Field { axis, wind_factor, ..Field::new(FieldKind::Wind, 3.0) };
        let settings = steps_of(1e-3, IntegratorKind::SymplecticEuler);
        let mut simulation = among(square(), &[field], settings);
        run(&mut simulation, 1);
        for v in simulation.velocities(0) {
            let expected = 1e-3 * 15.0 * Vector::new(part * 0.6, 0.0, 0.8);
            assert!((v - expected).norm() < 1e-12, "{v:?}");
        }
    }
}

/// A flow of f N·s/m³ brings cloth of density d to the wind's speed s/f by exp(-f t/d): 1 % is the error of the steps.
#[test]
fn a_flow_carries_cloth_to_its_own_speed() {
    let field = Field { flow: 2.0, ..Field::new(FieldKind::Wind, 3.0) };
    let mut simulation = among(square(), &[field], implicit());
    run(&mut simulation, 4);
    let expected = 1.5 * (1.0 - (-2.0 / 0.2 * 4.0 / 24.0_f64).exp());
    assert_close("speed", simulation.velocities(0)[7].z, expected, 0.01);
    run(&mut simulation, 24);
    assert_close("speed at last", simulation.velocities(0)[7].z, 1.5, 1e-5);
}

/// A turn of B/d = 2 rad/s changes directions, not speeds: 2 % is what the steps damp in half a turn.
#[test]
fn a_magnetic_field_turns_cloth_in_a_circle() {
    let field = Field { shape: FieldShape::Plane, ..Field::new(FieldKind::Magnetic, 0.4) };
    let velocities = [Vector::x(); 36];
    let mut simulation = launched(square(), Vec::new(), implicit(), &velocities);
    simulation.set_fields(vec![field]).expect("a field");
    run(&mut simulation, 36);
    let v = simulation.velocities(0)[7];
    assert_close("speed", v.norm(), 1.0, 0.02);
    let angle = f64::atan2(-v.y, v.x).rem_euclid(std::f64::consts::TAU);
    assert_close("angle", angle, 3.0, 0.02);
}

/// Fields a thousand times as strong as any that Blender's cloth bears. What damps or holds never makes fast: thrown
/// at 5 m/s, cloth is at most twice as fast afterwards.
#[test]
fn strong_drag_springs_and_flows_stay_stable() {
    let fields = [
        Field { damping: 1e3, ..Field::new(FieldKind::Drag, 1e4) },
        Field { damping: 1.0, ..Field::new(FieldKind::Harmonic { rest_length: 0.3 }, 1e3) },
        Field { flow: 1e4, ..Field::new(FieldKind::Wind, 1.0) },
    ];
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::ImplicitEuler] {
        for field in &fields {
            let settings = Settings { integrator, ..implicit() };
            let velocities = [Vector::new(5.0, 0.3, 0.4); 36];
            let mut simulation = launched(square(), Vec::new(), settings, &velocities);
            simulation.set_fields(vec![field.clone()]).expect("a field");
            let springs_give =
                if matches!(field.kind, FieldKind::Harmonic { .. }) { 40.0 } else { 10.0 };
            for frame in 0..48 {
                simulation.advance().expect("a frame");
                let speeds = simulation.velocities(0);
                let fastest = speeds.iter().map(Vector::norm).fold(0.0, f64::max);
                assert!(
                    fastest < springs_give,
                    "{integrator:?}, {field:?}, {frame}: {fastest} m/s"
                );
            }
        }
    }
}

fn hashes(threads: usize, frames: usize, fields: &[Field]) -> Vec<u64> {
    let cloth = sheet([70, 60], 0.02, &Mass::Density(0.2), material([5.0, 1.0, 0.1]), &[0]);
    let mut simulation = among(cloth, fields, Settings { threads, ..implicit() });
    (0..frames).map(|_| simulation.advance().expect("a frame").hash).collect()
}

#[test]
fn fields_give_the_same_bits_for_any_number_of_threads() {
    let turbulence = FieldKind::Turbulence { size: 0.3, is_global: false };
    let fields = [
        Field { noise: 1.0, wind_factor: 0.5, ..Field::new(turbulence, 3.0) },
        Field { shape: FieldShape::Plane, ..Field::new(FieldKind::Vortex, 1.0) },
    ];
    let one = hashes(1, 3, &fields);
    assert_eq!(hashes(3, 3, &fields), one);
    assert_ne!(hashes(1, 3, &fields[..1]), one);
}

/// Fields are told anew after a checkpoint, as pins are.
#[test]
fn a_run_taken_up_among_fields_goes_on_bit_for_bit() {
    let field = |frame: i32| Field {
        noise: 0.5,
        flow: 0.1,
        location: Vector::x() * (0.1 * f64::from(frame)),
        ..Field::new(FieldKind::Point { inverse_square: false }, 0.5)
    };
    let go = |simulation: &mut Simulation, frame: i32| {
        simulation.set_fields(vec![field(frame)]).expect("a field");
        simulation.set_gravity(Vector::z() * f64::from(frame)).expect("gravity");
        simulation.advance().expect("a frame").hash
    };
    let mut whole = simulation(square(), implicit());
    let hashes: Vec<u64> = (1..7).map(|frame| go(&mut whole, frame)).collect();
    let mut first = simulation(square(), implicit());
    for frame in 1..4 {
        go(&mut first, frame);
    }
    let mut second = simulation(square(), implicit());
    second.restore(&first.checkpoint()).expect("a checkpoint");
    let rest: Vec<u64> = (4..7).map(|frame| go(&mut second, frame)).collect();
    assert_eq!(rest, hashes[3..]);
}

#[test]
fn gravity_can_be_changed_from_frame_to_frame() {
    let mut simulation = simulation(square(), implicit());
    simulation.set_gravity(Vector::z() * -4.0).expect("gravity");
    run(&mut simulation, 1);
    assert_close("speed", simulation.velocities(0)[0].z, -4.0 / 24.0, 1e-9);
    assert!(simulation.set_gravity(Vector::z() * 1e7).is_err());
}

#[test]
fn a_field_that_is_taken_away_is_gone_also_where_pressure_stays() {
    let uniform = Pressure { uniform: 0.1, factor: 0.0, target_volume: None, weights: Vec::new() };
    for pressure in [None, Some(uniform)] {
        let make = || simulation(Cloth { pressure: pressure.clone(), ..square() }, implicit());
        let drag = Field { damping: 5.0, ..Field::new(FieldKind::Drag, 1.0) };
        let (mut whole, mut first) = (make(), make());
        for simulation in [&mut whole, &mut first] {
            simulation.set_fields(vec![drag.clone()]).expect("a field");
            run(simulation, 2);
            simulation.set_fields(Vec::new()).expect("none");
        }
        let mut second = make();
        second.restore(&first.checkpoint()).expect("a checkpoint");
        run(&mut whole, 3);
        run(&mut second, 3);
        assert_eq!(whole.certificate().hash, second.certificate().hash);
    }
}

/// The number of steps depends on nothing that a checkpoint leaves out.
#[test]
fn explicit_steps_among_fields_are_as_many_after_a_restart() {
    let integrator = IntegratorKind::Verlet;
    let settings = Settings { step_size: StepSize::Auto, ..Settings { integrator, ..implicit() } };
    let drag = Field { damping: 20.0, noise: 0.8, ..Field::new(FieldKind::Drag, 5.0) };
    let fields = [drag, Field::new(FieldKind::Magnetic, 8.0)];
    let mut whole = among(square(), &fields, settings.clone());
    let mut first = among(square(), &fields, settings.clone());
    run(&mut first, 3);
    let mut second = among(square(), &fields, settings);
    second.restore(&first.checkpoint()).expect("a checkpoint");
    run(&mut whole, 6);
    run(&mut second, 3);
    assert_eq!(whole.certificate(), second.certificate());
}
