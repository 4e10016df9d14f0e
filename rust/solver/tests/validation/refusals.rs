//! What cannot be simulated is refused in a sentence, and a breakdown leaves the last good frame.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, Error, IntegratorKind, Limiter, Mass, Settings, Simulation, SpringMaterial, StepSize,
};

use crate::sheets::{classic, launched, material, run, shaken, sheet, simulation, steps_of};

/// A sheet whose springs allow steps of about 5 ms.
fn hung_sheet(material: SpringMaterial) -> Cloth {
    sheet([6, 6], 0.1, &Mass::PerVertex(0.01), material, &[0, 5])
}

fn springs() -> SpringMaterial {
    material([100.0, 50.0, 5.0])
}

fn substeps(count: u32, allow_unstable: bool) -> Settings {
    let step_size = StepSize::Substeps(count);
    Settings { step_size, allow_unstable, threads: 1, ..classic() }
}

fn refusal(cloth: Cloth, settings: Settings) -> Error {
    Simulation::new(vec![cloth], Vec::new(), settings).expect_err("a refusal")
}

#[test]
fn a_step_beyond_the_bound_is_refused_with_the_number_that_would_hold_it() {
    let error = refusal(hung_sheet(springs()), substeps(2, false));
    let Error::Unstable { step, bound, substeps: needed } = error else { panic!("{error:?}") };
    assert!((step - 1.0 / 48.0).abs() < 1e-12);
    assert!(bound > 0.0 && bound < step);
    assert!(
        Simulation::new(vec![hung_sheet(springs())], Vec::new(), substeps(needed as u32, false))
            .is_ok()
    );
    let one_less = refusal(hung_sheet(springs()), substeps(needed as u32 - 1, false));
    assert!(matches!(one_less, Error::Unstable { .. }), "{one_less:?}");
    let message = error.to_string();
    assert!(message.contains(&needed.to_string()) && message.contains("allow_unstable"));
    assert!(!message.contains('\n'), "{message}");
}

#[test]
fn a_time_step_in_seconds_is_refused_by_the_same_bound() {
    let in_seconds = |step| Settings { step_size: StepSize::Seconds(step), ..substeps(1, false) };
    let error = refusal(hung_sheet(springs()), in_seconds(0.02));
    let Error::Unstable { bound, .. } = error else { panic!("{error:?}") };
    assert!(refusal(hung_sheet(springs()), in_seconds(1.2 * bound)) != error);
    let mut accepted = simulation(hung_sheet(springs()), in_seconds(0.9 * bound));
    let taken = accepted.advance().expect("a frame").substeps;
    assert!(1.0 / 24.0 / f64::from(taken) <= 0.9 * bound * (1.0 + 1e-9));
}

#[test]
fn more_substeps_than_a_frame_may_take_are_refused_by_number() {
    let stiff = material([1e12, 0.0, 0.0]);
    let error = refusal(hung_sheet(stiff), classic());
    let Error::TooManySubsteps { substeps, limit, integrator } = error else { panic!("{error:?}") };
    assert!(substeps > f64::from(limit));
    assert_eq!(integrator, "symplectic_euler");
    let asked = refusal(hung_sheet(springs()), self::substeps(limit + 1, true));
    assert!(matches!(asked, Error::TooManySubsteps { .. }), "{asked:?}");
    let undamped = Settings { integrator: IntegratorKind::ForwardEuler, ..classic() };
    let error = refusal(hung_sheet(material([1e6, 0.0, 0.0])), undamped);
    assert!(error.to_string().contains("forward_euler"), "{error}");
}

/// A chain of frames up to the breakdown: the state that stays is the last good frame's, to the bit.
#[test]
fn a_breakdown_names_frame_and_vertex_and_keeps_the_last_good_frame() {
    for integrator in IntegratorKind::EXPLICIT {
        let settings = Settings { integrator, ..substeps(3, true) };
        let cloth = hung_sheet(springs());
        let start = shaken(&cloth.positions, 1e-3);
        let mut simulation = simulation(cloth, settings);
        simulation.set_positions(0, &start);
        let mut last = (simulation.certificate(), simulation.checkpoint());
        let error = loop {
            match simulation.advance() {
                Ok(certificate) => last = (certificate, simulation.checkpoint()),
                Err(error) => break error,
            }
            assert!(simulation.frame() < 2000, "{integrator:?} does not diverge");
        };
        let Error::Diverged { frame, vertex, ref cloth } = error else { panic!("{error:?}") };
        assert_eq!(frame, last.0.frame + 1);
        assert!(vertex < 36 && vertex != 0 && vertex != 5 && cloth == "sheet");
        assert_eq!(simulation.frame(), last.0.frame);
        assert_eq!(simulation.certificate(), last.0);
        assert!(simulation.checkpoint() == last.1, "{integrator:?}: the state has changed");
        let positions = simulation.positions(0);
        assert!(positions.iter().all(|x| x.iter().all(|value| value.is_finite())));
        let expected = format!("diverged at frame {frame}, vertex {vertex} of cloth \"sheet\"");
        assert_eq!(error.to_string(), expected);
        assert_eq!(simulation.advance(), Err(error));
    }
}

#[test]
fn a_breakdown_names_the_cloth_that_broke_down() {
    let named = |name: &str, material| Cloth { name: name.to_owned(), ..hung_sheet(material) };
    let cloths = vec![named("calm", material([0.1, 0.1, 0.0])), named("wild", springs())];
    let mut simulation =
        Simulation::new(cloths, Vec::new(), substeps(3, true)).expect("a simulation");
    let error = (0..2000).find_map(|_| simulation.advance().err()).expect("a breakdown");
    let Error::Diverged { vertex, cloth, .. } = error else { panic!("{error:?}") };
    assert!(cloth == "wild" && vertex < 36, "vertex {vertex} of {cloth}");
}

#[test]
fn a_pin_sent_to_no_place_is_a_breakdown_that_can_be_mended() {
    let mut simulation = simulation(hung_sheet(springs()), substeps(20, false));
    let good = simulation.positions(0);
    let mut lost = good.clone();
    lost[5].y = f64::NAN;
    simulation.set_pin_targets(0, &lost);
    let error = simulation.advance().expect_err("a pin at NaN");
    assert!(matches!(error, Error::Diverged { frame: 2, .. }), "{error:?}");
    assert_eq!(simulation.positions(0), good);
    simulation.set_pin_targets(0, &good);
    run(&mut simulation, 3);
    assert_eq!(simulation.positions(0)[5], good[5]);
}

/// Equation 6 stiffens springs as they are drawn out: the bound of the next frame follows.
#[test]
fn the_safe_step_shrinks_as_equation_six_stiffens_the_springs() {
    let stiffen = SpringMaterial { limiter: Limiter::Stiffen, ..springs() };
    let mut simulation = simulation(hung_sheet(stiffen), classic());
    let before = simulation.safe_time_step();
    let drawn: Vec<Vector> = simulation.positions(0).iter().map(|x| x * 3.0).collect();
    simulation.set_positions(0, &drawn);
    // Slope of k r (r - 1) at r = 3: five times the stiffness.
    assert!(simulation.safe_time_step() < before / 1.8);
}

#[test]
fn bad_settings_and_materials_are_refused_by_name() {
    let default = classic();
    let settings = [
        ("fps", Settings { fps: 0.0, ..default.clone() }),
        ("fps", Settings { fps: f64::NAN, ..default.clone() }),
        ("gravity", Settings { gravity: Vector::new(0.0, f64::INFINITY, 0.0), ..default.clone() }),
        ("substeps", Settings { step_size: StepSize::Substeps(0), ..default.clone() }),
        ("time_step", Settings { step_size: StepSize::Seconds(-1.0), ..default.clone() }),
        ("time_step", Settings { step_size: StepSize::Seconds(f64::NAN), ..default }),
    ];
    for (name, settings) in settings {
        let message = refusal(hung_sheet(springs()), settings).to_string();
        assert!(message.contains(name) && message.contains("accepted"), "{message}");
    }
    let materials = [
        ("stretch", SpringMaterial { stiffness: [-1.0, 0.0, 0.0], ..springs() }),
        ("damping_bend", SpringMaterial { damping: [0.0, 0.0, f64::NAN], ..springs() }),
        ("air_damping", SpringMaterial { air_damping: f64::INFINITY, ..springs() }),
        ("did you mean 0.10", SpringMaterial { deformation_rate: 10.0, ..springs() }),
    ];
    for (name, material) in materials {
        let cloth = Cloth { material, ..hung_sheet(springs()) };
        let message = refusal(cloth, classic()).to_string();
        assert!(message.contains(name), "{message}");
    }
}

/// Released into a state that has no room: an explicit step from 1e300 m/s overflows at once.
#[test]
fn a_velocity_beyond_all_numbers_is_a_breakdown() {
    let settings = steps_of(1e-3, IntegratorKind::SymplecticEuler);
    let cloth = hung_sheet(springs());
    let still = vec![Vector::zeros(); 36];
    let mut simulation = launched(cloth.clone(), Vec::new(), settings, &still);
    let far: Vec<Vector> = cloth.positions.iter().map(|x| x * 1e300).collect();
    simulation.set_positions(0, &far);
    assert!(matches!(simulation.advance(), Err(Error::Diverged { .. })));
}
