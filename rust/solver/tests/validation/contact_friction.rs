//! Friction held to Coulomb's law: on an incline, and sliding to a stop.
//!
//! A slope is the floor under a tilted gravity, or a tilted plane under a level one. Every vertex touches from the first
//! frame on. The coefficient of a pair is the geometric mean of both sides.

use boucle_geometry::Vector;
use boucle_solver::{Collider, IntegratorKind, Settings, Simulation, SpringMaterial};

use crate::contact_things::{among, colliding, mean, patch, placed, plane};
use crate::sheets::{G, assert_close, run};

const IMPLICIT: [IntegratorKind; 2] = [IntegratorKind::Bdf2, IntegratorKind::ImplicitEuler];

const THICKNESS: f64 = 0.008;

/// A patch that lies on a plane with a normal, under a gravity (m/s²), with friction on both sides.
fn lying(
    normal: Vector,
    gravity: Vector,
    frictions: [f64; 2],
    integrator: IntegratorKind,
) -> Simulation {
    // Turned about y, from z to the normal.
    let along = Vector::new(normal.z, 0.0, -normal.x);
    let place = |x: &Vector| along * x.x + Vector::y() * x.y + normal * (x.z + THICKNESS);
    let cloth = placed(patch([8, 8], 0.25, SpringMaterial::default()), place);
    let cloth = colliding(cloth, THICKNESS, frictions[0]);
    let slope = Collider { friction: frictions[1], ..plane(normal, 0.0) };
    let settings = Settings { gravity, integrator, threads: 1, ..Settings::default() };
    among(vec![cloth], vec![slope], settings)
}

/// Down the x axis, at an angle (degrees).
fn on_a_slope(degrees: f64, frictions: [f64; 2], integrator: IntegratorKind) -> Simulation {
    let angle = degrees.to_radians();
    let gravity = G * Vector::new(angle.sin(), 0.0, -angle.cos());
    lying(Vector::z(), gravity, frictions, integrator)
}

/// How far (m) and how fast (m/s) a patch has gone along a direction after a second.
fn gone(mut simulation: Simulation, along: Vector) -> [f64; 2] {
    let start = mean(&simulation.positions(0));
    run(&mut simulation, 24);
    let way = mean(&simulation.positions(0)) - start;
    [way, mean(&simulation.velocities(0))].map(|vector| vector.dot(&along))
}

/// Implicit Euler goes `a t (t + h)/2`: up to 1/48 more than the half of `a t²` that BDF2 goes.
#[test]
fn a_patch_on_a_slope_of_35_degrees_slides_with_coulombs_acceleration() {
    for (integrator, late) in
        [(IntegratorKind::Bdf2, 0.0), (IntegratorKind::ImplicitEuler, 1.0 / 48.0)]
    {
        let simulation = on_a_slope(35.0, [0.5, 0.5], integrator);
        let [way, speed] = gone(simulation, Vector::x());
        assert_close(&format!("{integrator:?}: speed"), speed, 1.6088, 0.02);
        let twice = 2.0 * way / (1.0 + late);
        assert_close(&format!("{integrator:?}: twice the way"), twice, 1.6088, 0.02);
    }
}

/// The same slope made by the plane's normal: turning the scene turns the motion.
#[test]
fn a_tilted_plane_and_a_tilted_gravity_make_the_same_slope() {
    let angle = 35.0_f64.to_radians();
    let along = Vector::new(angle.cos(), 0.0, -angle.sin());
    let normal = Vector::new(angle.sin(), 0.0, angle.cos());
    for integrator in IMPLICIT {
        let gravity = G * -Vector::z();
        let [turned, _] = gone(lying(normal, gravity, [0.5, 0.5], integrator), along);
        let [level, _] = gone(on_a_slope(35.0, [0.5, 0.5], integrator), Vector::x());
        assert_close(&format!("{integrator:?}"), turned, level, 0.005);
    }
}

/// A degree below the angle of friction it stays, but for the creep of the smooth law (0.1 mm/s) and the first contact;
/// a degree above it slides, by half of what Coulomb's law says at least.
#[test]
fn a_patch_sticks_to_a_slope_if_its_tangent_is_below_the_friction_and_slides_above() {
    for integrator in IMPLICIT {
        for friction in [0.2_f64, 0.5, 1.0] {
            let critical = friction.atan().to_degrees();
            let what = format!("{integrator:?}, friction {friction}");
            let frictions = [friction, friction];
            let [way, speed] = gone(on_a_slope(critical - 1.0, frictions, integrator), Vector::x());
            assert!(way < 2e-3 && speed < 1e-3, "{what}: gone {way} m, at {speed} m/s");
            let steep = (critical + 1.0).to_radians();
            let expected = 0.5 * G * (steep.sin() - friction * steep.cos());
            let [way, _] = gone(on_a_slope(critical + 1.0, frictions, integrator), Vector::x());
            assert!(way > 0.5 * expected, "{what}: {way} m of {expected} m");
        }
    }
}

/// With 0.25 on one side and 1 on the other it is as with 0.5 on both; with nothing on one there is none.
#[test]
fn the_friction_of_a_pair_is_the_geometric_mean_of_both_sides() {
    let integrator = IntegratorKind::Bdf2;
    let way = |frictions| gone(on_a_slope(35.0, frictions, integrator), Vector::x())[0];
    assert_close("a quarter and one", way([0.25, 1.0]), way([0.5, 0.5]), 1e-9);
    let free = 0.5 * G * 35.0_f64.to_radians().sin();
    assert_close("ice", way([0.0, 1.0]), free, 1e-3);
}

#[test]
fn a_patch_of_2_m_per_s_slides_to_a_stop_where_friction_has_used_up_its_energy() {
    for integrator in IMPLICIT {
        for (friction, expected) in [(0.2, 1.0194), (0.4, 0.5097), (0.7, 0.2912)] {
            let mut simulation = on_a_slope(0.0, [friction, friction], integrator);
            let start = mean(&simulation.positions(0));
            // It settles for half a second, so that what it presses with is its weight.
            run(&mut simulation, 12);
            let settled = mean(&simulation.positions(0));
            assert!((settled - start).xy().norm() < 1e-6, "it drifts");
            simulation.set_velocities(0, &[2.0 * Vector::x(); 64]);
            run(&mut simulation, 48);
            let way = (mean(&simulation.positions(0)) - settled).x;
            let what = format!("{integrator:?}, friction {friction}");
            assert_close(&what, way, expected, 0.02);
            let speed = mean(&simulation.velocities(0)).norm();
            assert!(speed < 1e-3, "{what}: it still moves at {speed} m/s");
        }
    }
}
