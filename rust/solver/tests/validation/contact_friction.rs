//! Friction held to Coulomb's law: on an incline, and sliding to a stop.
//!
//! A slope is the floor under a tilted gravity, or a tilted plane under a level one. Every vertex touches from the first
//! frame on. The coefficient of a pair is the geometric mean of both sides.

use boucle_geometry::Vector;
use boucle_solver::{Collider, IntegratorKind, Settings, Simulation, SpringMaterial};

use crate::contact_things::{among, colliding, floor, mean, patch, placed, plane};
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
    let place =
        |x: &Vector| along * x.x + Vector::y() * x.y + normal * (x.z + THICKNESS);
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

#[test]
fn a_patch_on_a_slope_of_35_degrees_slides_with_coulombs_acceleration() {
    for integrator in IMPLICIT {
        let simulation = on_a_slope(35.0, [0.5, 0.5], integrator);
        let [way, speed] = gone(simulation, Vector::x());
        assert_close(&format!("{integrator:?}: twice the way"), 2.0 * way, 1.6088, 0.02);
        assert_close(&format!("{integrator:?}: speed"), speed, 1.6088, 0.02);
    }
}
