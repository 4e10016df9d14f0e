//! Numbers at the corners of faces, where each side of a tear has its own.

use boucle_solver::Simulation;

/// What is told.
pub(crate) const NAMES: [&str; 5] = ["strain", "tension", "contact", "intersection", "force"];

/// Gives a number for each corner of a cloth's faces.
pub(crate) type Reader = fn(&Simulation, usize) -> Vec<f32>;

/// What tells a quantity at the corners; none if there is no such quantity.
pub(crate) fn reader(quantity: &str) -> Option<Reader> {
    Some(match quantity {
        "strain" => |simulation, cloth| spread(simulation, cloth, Simulation::vertex_strain),
        "tension" => |simulation, cloth| spread(simulation, cloth, Simulation::vertex_tension),
        "contact" => |simulation, cloth| spread(simulation, cloth, Simulation::vertex_contacts),
        "intersection" => {
            |simulation, cloth| spread(simulation, cloth, Simulation::vertex_intersections)
        }
        "force" => Simulation::corner_tension,
        _ => return None,
    })
}

/// What the vertices have, at their corners.
fn spread(simulation: &Simulation, cloth: usize, of: Reader) -> Vec<f32> {
    let numbers = of(simulation, cloth);
    simulation.corners(cloth).into_iter().map(|vertex| numbers[vertex as usize]).collect()
}
