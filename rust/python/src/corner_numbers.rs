//! Numbers at the corners of faces, where each side of a tear has its own.

use boucle_solver::Simulation;
use pyo3::prelude::*;

use crate::boundary::refuse;

/// Gives a number for each corner of a cloth's faces.
pub(crate) type Reader = fn(&Simulation, usize) -> Vec<f32>;

/// What tells a quantity at the corners.
pub(crate) fn reader(py: Python<'_>, quantity: &str) -> PyResult<Reader> {
    Ok(match quantity {
        "strain" => |simulation, cloth| spread(simulation, cloth, Simulation::vertex_strain),
        "tension" => |simulation, cloth| spread(simulation, cloth, Simulation::vertex_tension),
        "contact" => |simulation, cloth| spread(simulation, cloth, Simulation::vertex_contacts),
        "intersection" => {
            |simulation, cloth| spread(simulation, cloth, Simulation::vertex_intersections)
        }
        "force" => Simulation::corner_tension,
        _ => {
            let accepted = "strain, tension, contact, intersection, force";
            return Err(refuse(py, format!("quantity = {quantity:?}; accepted: {accepted}")));
        }
    })
}

/// What the vertices have, at their corners.
fn spread(simulation: &Simulation, cloth: usize, of: Reader) -> Vec<f32> {
    let numbers = of(simulation, cloth);
    simulation.corners(cloth).into_iter().map(|vertex| numbers[vertex as usize]).collect()
}
