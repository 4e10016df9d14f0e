//! Soft pins are springs to their targets; weights change in time; a grab holds what was never pinned.

use std::f64::consts::PI;

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, IntegratorKind, Limiter, PinMaterial, Settings, Simulation, SpringMaterial, StepSize,
};

use crate::lying::{self, Hung, PROMISE, limited, lying_sheet};
use crate::sheets::{G, assert_close, classic, farthest, material, network, run, simulation};

/// A particle of some mass (kg) at the origin, alone, as a pin of a weight.
fn particle(mass: f64, weight: f64, pin_material: PinMaterial) -> Cloth {
    let free = material([0.0; 3]);
    let cloth = network(vec![Vector::zeros()], Vec::new(), vec![mass], &[0], free);
    Cloth { pin_weights: vec![weight], pin_material, ..cloth }
}

fn settings(integrator: IntegratorKind) -> Settings {
    Settings { integrator, threads: 1, ..classic() }
}

/// A hanging sheet of 2 m x 2 m and 0.8 kg, pinned with a weight along its upper edge, and deaf to all but gravity.
fn hung(side: u32, hung: Hung, weight: f64, stiffness: f64) -> Cloth {
    let material = SpringMaterial { damping: [0.05; 3], air_damping: 0.01, ..limited(0.05) };
    let cloth = lying_sheet(side, hung, material);
    let pin_material = PinMaterial { stiffness, damping_ratio: 2.0 };
    let upright = |x: &Vector| Vector::new(x.x, 0.0, x.y);
    Cloth {
        positions: cloth.positions.iter().map(upright).collect(),
        pin_weights: vec![weight; cloth.pins.len()],
        pin_material,
        ..cloth
    }
}

/// m g = k x, with every integrator.
#[test]
fn a_soft_pin_sags_by_its_weight_over_its_stiffness() {
    for integrator in IntegratorKind::ALL {
        let cloth = particle(0.02, 0.25, PinMaterial { stiffness: 40.0, damping_ratio: 1.0 });
        let mut simulation = simulation(cloth, settings(integrator));
        run(&mut simulation, 48);
        let expected = -0.02 * G / (0.25 * 40.0);
        assert_close(&format!("{integrator:?}"), simulation.positions(0)[0].z, expected, 1e-6);
    }
}

/// x = A cos(w t) for a whole and a half period: the fourth-order rule, and BDF2 whose period is long by (w h)²/6.
#[test]
fn a_goal_spring_without_damping_swings_with_the_period_of_its_stiffness() {
    for (integrator, substeps, error) in
        [(IntegratorKind::Rk4, 500, 1e-6), (IntegratorKind::Bdf2, 4000, 1e-2)]
    {
        let cloth = particle(0.5, 0.5, PinMaterial { stiffness: 4.0, damping_ratio: 0.0 });
        let period = 2.0 * PI * (0.5_f64 / (0.5 * 4.0)).sqrt();
        let settings = Settings {
            gravity: Vector::zeros(),
            fps: 2.0 / period,
            step_size: StepSize::Substeps(substeps),
            ..settings(integrator)
        };
        let mut simulation = simulation(cloth, settings);
        simulation.set_pin_targets(0, &[Vector::x() * 0.1]);
        simulation.set_pin_weights(0, &[0.0]).expect("a weight");
        run(&mut simulation, 1);
        simulation.set_pin_weights(0, &[0.5]).expect("a weight");
        for half in 1..=3 {
            run(&mut simulation, 1);
            let expected = if half % 2 == 1 { 0.2 } else { 0.0 };
            let off = (simulation.positions(0)[0].x - expected).abs();
            assert!(off < error * 0.1 * f64::from(half), "{integrator:?}, {half}: {off}");
        }
    }
}

/// The damping is of the velocity relative to the goal's: at constant speed nothing lags.
#[test]
fn a_soft_pin_follows_a_goal_of_constant_speed_without_lag() {
    for integrator in IntegratorKind::ALL {
        let cloth = particle(0.02, 0.5, PinMaterial { stiffness: 40.0, damping_ratio: 1.0 });
        let settings = Settings { gravity: Vector::zeros(), ..settings(integrator) };
        let mut simulation = simulation(cloth, settings);
        for frame in 1..=48 {
            simulation.set_pin_targets(0, &[Vector::y() * 0.01 * f64::from(frame)]);
            run(&mut simulation, 1);
        }
        let lag = (simulation.positions(0)[0].y - 0.48).abs();
        assert!(lag < 1e-5, "{integrator:?}: {lag} m");
    }
}

/// Weight over stiffness times weight is 8 mm: of the whole sheet on its patch, be that finer or coarser, row or corner.
#[test]
fn what_hangs_on_soft_pins_sags_alike_on_coarse_and_on_fine_meshes() {
    for patch in [Hung::Edge, Hung::Corner] {
        for side in [9, 17, 33] {
            let cloth = hung(side, patch, 0.5, 0.8 * G / 0.5 / 0.008);
            let (rest, pins, masses) =
                (cloth.positions.clone(), cloth.pins.clone(), cloth.masses.clone());
            let mut simulation = simulation(cloth, lying::settings(IntegratorKind::ImplicitEuler));
            let frames = if matches!(patch, Hung::Edge) { 48 } else { 240 };
            run(&mut simulation, frames);
            let now = simulation.positions(0);
            let mass: f64 = pins.iter().map(|&pin| masses[pin as usize]).sum();
            let sag: f64 = pins
                .iter()
                .map(|&pin| pin as usize)
                .map(|pin| masses[pin] / mass * (rest[pin].z - now[pin].z))
                .sum();
            // The limiter carries a part of the weight past the pins; a swing is not yet over.
            assert_close(&format!("{patch:?}, {side}"), sag, 0.008, 0.1);
        }
    }
}

#[test]
fn pins_of_weight_one_give_the_bits_of_hard_pins() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::SymplecticEuler] {
        let soft = hung(12, Hung::Corners, 1.0, 1e4);
        let hard = Cloth { pin_weights: Vec::new(), ..soft.clone() };
        let weights = vec![1.0; soft.positions.len()];
        let targets: Vec<_> = soft.positions.iter().map(|x| x + Vector::y() * 0.01).collect();
        let hashes = [soft, hard].map(|cloth| {
            let mut simulation = simulation(cloth, lying::settings(integrator));
            simulation.set_pin_targets(0, &targets);
            (0..6)
                .map(|_| {
                    simulation.set_pin_weights(0, &weights).expect("weights");
                    simulation.advance().expect("a frame").hash
                })
                .collect::<Vec<_>>()
        });
        assert_eq!(hashes[0], hashes[1], "{integrator:?}");
    }
}

/// Pins that move at (0.24, 0, -0.12) m/s become free: from then on they fall as a stone does.
#[test]
fn pins_whose_weight_goes_to_zero_fall_with_the_velocity_they_had() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::ImplicitEuler, IntegratorKind::Verlet]
    {
        let velocity = Vector::new(0.24, 0.0, -0.12);
        let mut simulation =
            simulation(particle(0.1, 1.0, PinMaterial::default()), settings(integrator));
        let frames_each = 1.0 / 24.0;
        for frame in 1..=3 {
            simulation.set_pin_targets(0, &[velocity * f64::from(frame) * frames_each]);
            run(&mut simulation, 1);
        }
        simulation.set_pin_weights(0, &[0.0]).expect("a weight");
        run(&mut simulation, 12);
        let t = 12.0 * frames_each;
        let expected = velocity * (3.0 * frames_each + t) - Vector::z() * 0.5 * G * t * t;
        let error = farthest(&simulation.positions(0), &[expected]);
        // Implicit Euler falls too far by g h t/2, with 2 steps a frame at the least.
        let allowed = if integrator == IntegratorKind::ImplicitEuler { 0.06 } else { 2e-3 };
        assert!(error < allowed, "{integrator:?}: {error} m");
    }
}

#[test]
fn what_was_free_becomes_a_hard_pin_within_a_frame_and_bursts_nothing() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::SymplecticEuler] {
        let cloth = hung(16, Hung::Corners, 1.0, 1000.0);
        let (rest, pins) = (cloth.positions.clone(), cloth.pins.clone());
        let mut simulation = simulation(cloth, lying::settings(integrator));
        simulation.set_pin_weights(0, &vec![0.0; rest.len()]).expect("weights");
        run(&mut simulation, 8);
        assert!(rest[0].z - simulation.positions(0)[0].z > 0.2, "it fell");
        simulation.set_pin_weights(0, &vec![1.0; rest.len()]).expect("weights");
        run(&mut simulation, 1);
        for &pin in &pins {
            assert_eq!(simulation.positions(0)[pin as usize], rest[pin as usize]);
        }
        let mut last = simulation.certificate();
        for _ in 0..24 {
            last = simulation.advance().expect("a frame");
        }
        assert!(last.max_strain < 0.05 + PROMISE, "{integrator:?}: {}", last.max_strain);
        assert!(last.kinetic_energy < 20.0, "{integrator:?}: {} J", last.kinetic_energy);
    }
}

/// However stiff: implicit steps do not depend on it, explicit ones become as short as it needs.
#[test]
fn goal_springs_are_stable_at_any_stiffness() {
    let cases = [
        (IntegratorKind::Bdf2, 1e9),
        (IntegratorKind::ImplicitEuler, 1e9),
        (IntegratorKind::SymplecticEuler, 1e5),
        (IntegratorKind::Verlet, 1e5),
    ];
    for (integrator, stiffness) in cases {
        let cloth = hung(9, Hung::Edge, 0.5, stiffness);
        let rest = cloth.positions.clone();
        let mut simulation = simulation(cloth, lying::settings(integrator));
        for frame in 0..12 {
            let way = Vector::y() * 0.05 * f64::from(frame);
            let targets: Vec<_> = rest.iter().map(|x| x + way).collect();
            simulation.set_pin_targets(0, &targets);
            let certificate = simulation.advance().expect("a frame");
            assert!(certificate.kinetic_energy < 50.0, "{integrator:?}, frame {frame}");
            let top = rest.len() - 1;
            let off = (simulation.positions(0)[top] - targets[top]).norm();
            assert!(off < 0.02, "{integrator:?}, frame {frame}: {off} m");
        }
    }
}

/// Soft pins that weaken, then a grab, with weights that change at every frame.
fn eventful(threads: usize) -> Simulation {
    let settings = Settings { threads, ..lying::settings(IntegratorKind::Bdf2) };
    simulation(hung(48, Hung::Corners, 0.9, 2000.0), settings)
}

fn live(simulation: &mut Simulation, frames: std::ops::Range<u32>) -> Vec<u64> {
    let count = simulation.positions(0).len();
    frames
        .map(|frame| {
            let weight = [0.9, 1.0, 1.0, 0.4, 0.1, 0.0, 0.7, 1.0][frame as usize % 8];
            simulation.set_pin_weights(0, &vec![weight; count]).expect("weights");
            if frame == 2 {
                let held = simulation.positions(0)[20];
                simulation.grab(0, &[20, 21], &[held, held], &[1.0, 0.5]).expect("a grip");
            }
            if frame == 7 {
                simulation.let_go();
            }
            simulation.advance().expect("a frame").hash
        })
        .collect()
}

#[test]
fn soft_pins_give_the_same_bits_with_any_number_of_threads_and_after_a_checkpoint() {
    let whole = live(&mut eventful(1), 0..9);
    assert_eq!(whole, live(&mut eventful(2), 0..9));
    for stop in [2, 4, 6] {
        let mut first = eventful(1);
        live(&mut first, 0..stop);
        let mut second = eventful(1);
        second.restore(&first.checkpoint()).expect("its own checkpoint");
        assert_eq!(
            second.certificate().potential_energy.to_bits(),
            first.certificate().potential_energy.to_bits()
        );
        assert_eq!(live(&mut second, stop..9), whole[stop as usize..], "from {stop}");
    }
}

/// k x²/2 is there, and nothing else is: without gravity a pin that swings keeps its energy.
#[test]
fn the_energy_of_goal_springs_is_counted() {
    let cloth = particle(0.5, 0.5, PinMaterial { stiffness: 4.0, damping_ratio: 0.0 });
    let step_size = StepSize::Substeps(200);
    let settings =
        Settings { gravity: Vector::zeros(), step_size, ..settings(IntegratorKind::Verlet) };
    let mut simulation = simulation(cloth, settings);
    simulation.set_pin_weights(0, &[0.0]).expect("a weight");
    simulation.set_pin_targets(0, &[Vector::x() * 0.1]);
    run(&mut simulation, 1);
    simulation.set_pin_weights(0, &[0.5]).expect("a weight");
    for frame in 0..24 {
        let certificate = simulation.advance().expect("a frame");
        let energy = certificate.kinetic_energy + certificate.potential_energy;
        assert_close(&format!("frame {frame}"), energy, 0.5 * 2.0 * 0.01, 1e-4);
    }
}

/// The middle of the lower edge is drawn aside and up, within reach of the corners, and let go.
#[test]
fn a_grab_takes_a_vertex_along_and_lets_it_swing_back() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::SymplecticEuler] {
        let material = SpringMaterial { limiter: Limiter::Project, ..limited(0.05) };
        let cloth =
            Cloth { material, pin_weights: Vec::new(), ..hung(17, Hung::Corners, 1.0, 1e3) };
        let mut simulation = simulation(cloth, lying::settings(integrator));
        run(&mut simulation, 12);
        let begin = simulation.positions(0)[8];
        let vertices = [7, 8, 9];
        let begins = vertices.map(|vertex: u32| simulation.positions(0)[vertex as usize]);
        for frame in 1..=24 {
            let way = Vector::new(0.0, 0.3, 0.0) * (f64::from(frame) / 12.0).min(1.0);
            let targets = begins.map(|x| x + way);
            simulation.grab(0, &vertices, &targets, &[0.5, 1.0, 0.5]).expect("a grip");
            let certificate = simulation.advance().expect("a frame");
            assert!(certificate.max_strain < 0.05 + PROMISE, "frame {frame}");
        }
        let off = (simulation.positions(0)[8] - begin - Vector::y() * 0.3).norm();
        assert!(off < 0.02, "{integrator:?}: {off} m from its goal");
        simulation.let_go();
        run(&mut simulation, 12);
        let back = simulation.positions(0)[8].y - begin.y;
        assert!(back < 0.15, "{integrator:?}: {back} m");
    }
}

#[test]
fn weights_and_grips_that_make_no_sense_are_refused() {
    let cloth = hung(5, Hung::Edge, 0.5, 1e3);
    let bad = Cloth { pin_weights: vec![0.5], ..cloth.clone() };
    let said = bad.check().expect_err("one weight for five pins").to_string();
    assert!(said.contains("1 weights of pins are given; accepted: 5"), "{said}");
    let mut simulation = simulation(cloth, lying::settings(IntegratorKind::Bdf2));
    let said = simulation.set_pin_weights(0, &[2.0; 25]).expect_err("a weight of 2").to_string();
    assert_eq!(said, "the weight of pin 20 is 2; accepted: 0 to 1");
    assert!(simulation.set_pin_stiffness(0, f64::NAN).is_err());
    let place = [Vector::zeros()];
    for (vertex, weight) in [(25, 1.0), (0, 0.0), (0, f64::NAN)] {
        assert!(simulation.grab(0, &[vertex], &place, &[weight]).is_err(), "{vertex}, {weight}");
    }
    assert!(simulation.grab(0, &[1], &[Vector::x() * f64::NAN], &[1.0]).is_err());
    assert!(simulation.grab(0, &[1, 2], &place, &[1.0]).is_err());
}

/// Where it hangs at rest it stays when it is put there: what draws its pins stays where it was.
#[test]
fn a_cloth_that_is_put_where_it_hangs_stays_there() {
    let cloth = particle(0.02, 0.25, PinMaterial { stiffness: 40.0, damping_ratio: 1.0 });
    let mut simulation = simulation(cloth, settings(IntegratorKind::Bdf2));
    run(&mut simulation, 48);
    let hanging = simulation.positions(0);
    simulation.set_positions(0, &hanging);
    run(&mut simulation, 1);
    assert_close("z", simulation.positions(0)[0].z, hanging[0].z, 1e-6);
}
