//! What is demanded of every result.

use std::fmt::{Debug, Display};

use boucle_scene::Assembly;
use boucle_solver::{Certificate, Simulation};

use crate::watch::watched;

/// Steps of a frame, times vertices, beyond which it is not run.
const MOST_WORK: usize = 40_000;
/// Longest refusal (bytes).
const LONGEST: usize = 2000;

/// A refusal is one line of words.
///
/// # Panics
/// When it is not.
pub(crate) fn refusal(error: &impl Display) {
    let text = error.to_string();
    assert!(text.len() > 10 && text.len() < LONGEST, "{} bytes: {text:?}", text.len());
    assert!(!text.contains(['\n', '\r']), "more than one line: {text:?}");
}

/// What was accepted, or nothing where it was refused in one line.
///
/// # Panics
/// When the refusal is more than a line, or none at all.
pub fn accepted<T, E: Display>(result: Result<T, E>) -> Option<T> {
    result.map_err(|error| refusal(&error)).ok()
}

/// Every number that a simulation tells is one.
///
/// # Panics
/// When it is not.
pub(crate) fn sound(simulation: &Simulation, certificate: &Certificate) {
    let c = certificate;
    finite("strain", &[c.max_strain, c.p99_strain, c.max_shear_strain]);
    finite("energy", &[c.kinetic_energy, c.potential_energy]);
    finite("safe step", &[simulation.safe_time_step()]);
    for cloth in 0..simulation.cloth_count() {
        let positions = simulation.positions(cloth);
        assert_eq!(positions.len(), simulation.cloth(cloth).positions.len());
        for position in &positions {
            finite("position", position.as_slice());
        }
        let velocities = simulation.velocities(cloth);
        for velocity in &velocities {
            finite("velocity", velocity.as_slice());
        }
        finite("strain of vertices", &simulation.vertex_strain(cloth));
        finite("tension of vertices", &simulation.vertex_tension(cloth));
        finite("contact of vertices", &simulation.vertex_contacts(cloth));
        finite("intersections of vertices", &simulation.vertex_intersections(cloth));
        finite("wetness", &simulation.wetness(cloth));
        finite("stiffness", &simulation.spring_stiffness(cloth));
        let tensions: Vec<f64> =
            simulation.edge_tension(cloth).iter().map(|(_, tension)| *tension).collect();
        finite("tension of edges", &tensions);
    }
}

/// Whether frames of a simulation are short enough to be run by the thousand.
pub(crate) fn is_light(simulation: &Simulation) -> bool {
    let vertices: usize =
        (0..simulation.cloth_count()).map(|cloth| simulation.cloth(cloth).positions.len()).sum();
    (simulation.substeps() as usize).saturating_mul(vertices) <= MOST_WORK
}

/// Moves a simulation on by a frame; nothing where that was refused in one line, or took too long and was interrupted.
///
/// # Panics
/// When the frame does not stop where it is told to, or leaves what is no number.
pub fn advance(simulation: &mut Simulation) -> Option<Certificate> {
    let outcome = accepted(watched(simulation.interrupter(), || simulation.advance()));
    // Where it was refused, the state is that of the last good frame.
    sound(simulation, &outcome.unwrap_or_else(|| simulation.certificate()));
    outcome
}

/// The same for the simulation of a scene.
pub(crate) fn advance_scene(scene: &mut Assembly) -> Option<Certificate> {
    let outcome = accepted(watched(scene.simulation.interrupter(), || scene.advance()));
    let simulation = &scene.simulation;
    sound(simulation, &outcome.unwrap_or_else(|| simulation.certificate()));
    outcome
}

pub(crate) fn finite<T: Copy + Into<f64> + Debug>(what: &str, numbers: &[T]) {
    let bad = numbers.iter().position(|&number| !number.into().is_finite());
    assert!(
        bad.is_none(),
        "{what} {bad:?} of {} is {:?}",
        numbers.len(),
        numbers[bad.unwrap_or(0)]
    );
}
