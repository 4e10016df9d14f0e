//! The sides of a tear, drawn apart by a hair.

use boucle_geometry::Vector;

use super::Simulation;
use crate::state::State;

/// By how far (m) both sides of a new tear are moved back from it, so that they are apart; and the most, as a part of the way to
/// the middle of their faces.
const APART: f64 = 5e-5;
const MOST_APART: f64 = 0.02;

/// How many other ways apart are tried where the first leads through something.
pub(super) const ATTEMPTS: usize = 5;

/// A piece of a vertex that has just parted.
pub(super) struct Parted {
    particle: usize,
    /// The particles of its faces.
    around: Vec<u32>,
    /// Back from the tear, and away from it to its side of the cloth (m).
    inward: Vector,
    across: Vector,
}

impl Parted {
    /// By how much (m) it moves in each attempt.
    fn way(&self, attempt: usize) -> Vector {
        match attempt {
            0 => self.inward,
            1 => 0.1 * self.inward,
            2 => 0.1 * self.inward + self.across,
            3 => 0.1 * self.inward - self.across,
            4 => 0.01 * self.across,
            _ => -0.01 * self.across,
        }
    }
}

impl Simulation {
    /// Draws sides apart, and counts intersections; then tries so many other ways where there are any. Says whether none are left.
    pub(super) fn draw_apart(&mut self, mut parted: Vec<Parted>, attempts: usize) -> bool {
        self.shift(&parted, |one| one.way(0));
        self.intersect();
        for attempt in 1..=attempts {
            if parted.is_empty() || self.intersections.is_none_or(|count| count == 0) {
                break;
            }
            let stuck: Vec<u32> =
                (0..self.cloths.len()).flat_map(|cloth| self.stuck(cloth)).collect();
            parted
                .retain(|one| one.around.iter().any(|vertex| stuck.binary_search(vertex).is_ok()));
            self.shift(&parted, |one| one.way(attempt) - one.way(attempt - 1));
            self.intersect();
        }
        self.intersections.is_none_or(|count| count == 0)
    }

    /// What has just parted: vertices beyond so many, and those that they were one with.
    pub(super) fn parted(&self, cloth: usize, before: usize) -> Vec<Parted> {
        let (own, base) = (&self.cloths[cloth], self.bases[cloth]);
        let count = own.positions.len();
        let Some(split) = self.splits[cloth].as_ref().filter(|_| count > before) else {
            return Vec::new();
        };
        let mut is_new = vec![false; split.origins().len()];
        split.origins()[before..].iter().for_each(|origin| is_new[*origin as usize] = true);
        let places = self.positions(cloth);
        let mut sums = vec![(Vector::zeros(), 0.0, Vec::new()); count];
        let mut normals = vec![Vector::zeros(); count];
        for (number, face) in own.mesh.faces().enumerate() {
            let middle: Vector = face.iter().map(|&vertex| places[vertex as usize]).sum();
            let normal = own.mesh.vector_area(number, &places);
            for &vertex in face {
                let (sum, number, around) = &mut sums[vertex as usize];
                *sum += middle / face.len() as f64;
                *number += 1.0;
                around.extend(face.iter().map(|&vertex| base + vertex));
                normals[split.origins()[vertex as usize] as usize] += normal;
            }
        }
        let moves = (0..count).filter(|&vertex| {
            let particle = base as usize + vertex;
            is_new[split.origins()[vertex] as usize] && !self.system.is_pinned(particle)
        });
        let parted = moves.map(|vertex| {
            let origin = split.origins()[vertex] as usize;
            let (sum, number, around) = &sums[vertex];
            let inward = sum / f64::max(*number, 1.0) - places[vertex];
            let size = APART.min(MOST_APART * inward.norm());
            let side = if vertex == origin { 1.0 } else { -1.0 };
            Parted {
                particle: base as usize + vertex,
                around: around.clone(),
                inward: size * inward.try_normalize(0.0).unwrap_or_else(Vector::zeros),
                across: side
                    * size
                    * normals[origin].try_normalize(0.0).unwrap_or_else(Vector::zeros),
            }
        });
        parted.collect()
    }

    /// The particles of a cloth at which things pass through each other, in order.
    pub(super) fn stuck(&self, cloth: usize) -> Vec<u32> {
        let counts = self.vertex_intersections(cloth);
        let stuck = (self.bases[cloth]..).zip(counts).filter(|(_, count)| *count > 0.0);
        stuck.map(|(particle, _)| particle).collect()
    }

    /// Moves what has parted (m), as if it had always been there.
    fn shift(&mut self, parted: &[Parted], way: impl Fn(&Parted) -> Vector) {
        let shift = |state: &mut State| {
            for one in parted {
                let moved = state.position.get(one.particle) + way(one);
                state.position.set(one.particle, &moved);
            }
        };
        shift(&mut self.state);
        if let Some(memory) = self.method.memory_mut() {
            shift(&mut memory.before);
        }
    }
}
