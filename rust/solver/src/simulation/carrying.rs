//! The state of a simulation taken over to the same cloths in more pieces.

use std::sync::Arc;

use super::Simulation;
use super::saved_shape::SavedShape;
use crate::checkpoint::Checkpoint;
use crate::cloth::Cloth;
use crate::fabric::Crease;
use crate::force::SEA_NUMBERS;
use crate::goals::Goal;
use crate::grab::Grab;
use crate::implicit::Memory;
use crate::state::{Coordinates, State};

/// Values by pairs of particles, to be found again.
struct ByPair<T>(Vec<([u32; 2], T)>);

impl<T: Copy> ByPair<T> {
    fn new(values: impl Iterator<Item = ([u32; 2], T)>) -> Self {
        let mut values: Vec<_> = values.map(|(pair, value)| (sorted(pair), value)).collect();
        values.sort_by_key(|(pair, _)| *pair);
        Self(values)
    }

    fn get(&self, pair: [u32; 2]) -> Option<T> {
        let place = self.0.binary_search_by_key(&sorted(pair), |(pair, _)| *pair);
        place.ok().map(|place| self.0[place].1)
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Simulation {
    /// Goes on with other cloths in the place of its own, given of each of their particles the one that it has been until now.
    /// Vertices keep their numbers; new ones come after them. Intersections are then to be counted. Returns what it was, but for
    /// where it is torn.
    pub(super) fn become_cloths(&mut self, cloths: Vec<Cloth>, from: &[u32]) -> Self {
        let saved = self.saved();
        let surroundings = (self.colliders.clone(), self.winds.clone());
        let pool = (Arc::clone(&self.threads), self.interrupter.clone());
        let mut next = Self::assemble(cloths, surroundings, self.settings.clone(), pool);
        next.digest = self.digest;
        next.splits = std::mem::take(&mut self.splits);
        let shape = self.shape_carried(&next, from);
        let carried = self.carried(saved, &next, from);
        next.take(carried, shape);
        (next.clipped, next.iterations_taken) = (self.clipped, self.iterations_taken);
        next.accuracy = self.accuracy;
        next.contacts.carry(self.forces_carried(&next, from));
        std::mem::replace(self, next)
    }

    /// The forces (N) with which contacts press the next particles: those of what they were, shared by mass.
    fn forces_carried(&self, next: &Self, from: &[u32]) -> Vec<(u32, f64)> {
        let mut forces = vec![0.0; self.state.len()];
        for (particle, force) in self.contacts.pressures() {
            forces[particle as usize] += force;
        }
        let parts =
            from.iter().zip(&next.system.masses).zip(0..).map(|((&old, mass), particle)| {
                (particle, forces[old as usize] * (mass / self.system.masses[old as usize]))
            });
        parts.filter(|(_, force)| *force > 0.0).collect()
    }

    /// A checkpoint of these cloths as one of the next.
    fn carried(&self, saved: Checkpoint, next: &Self, from: &[u32]) -> Checkpoint {
        let mut held = vec![None; self.state.len()];
        for (particle, own) in self.pins.all().zip(saved.pins) {
            held[particle as usize] = Some(own);
        }
        // All pieces of a pin are pins.
        let pins = next.pins.all().filter_map(|particle| held[from[particle as usize] as usize]);
        let goals = saved
            .grab
            .goals
            .into_iter()
            .map(|goal| Goal { particle: self.now(next, goal.particle), ..goal });
        // Of cloth that takes up no water there is no wetness.
        let water = match saved.water.split_at_checked(SEA_NUMBERS) {
            Some((head, wetness)) if !wetness.is_empty() => {
                let gathered = from.iter().map(|&old| wetness[old as usize]);
                head.iter().copied().chain(gathered).collect()
            }
            _ => saved.water,
        };
        Checkpoint {
            state: gathered(&saved.state, from),
            pins: pins.collect(),
            grab: Grab { goals: goals.collect() },
            water,
            memory: saved.memory.map(|memory| Memory {
                before: gathered(&memory.before, from),
                tensions: self.tensions_carried(next, from),
                ..memory
            }),
            ..saved
        }
    }

    /// The number that a particle has among the next cloths: that of the piece which keeps it.
    fn now(&self, next: &Self, particle: u32) -> u32 {
        let cloth = self.bases.partition_point(|&base| base <= particle) - 1;
        let vertex = particle - self.bases[cloth];
        let is_there = (vertex as usize) < next.cloths[cloth].positions.len();
        let given = if is_there { None } else { self.cloths[cloth].as_given(vertex) };
        next.bases[cloth] + given.unwrap_or(vertex)
    }

    fn tensions_carried(&self, next: &Self, from: &[u32]) -> Vec<f64> {
        let old = ByPair::new(self.method.held_edges());
        let edges = next.method.held_edges();
        edges.map(|(ends, _)| old.get(ends.map(|end| from[end as usize])).unwrap_or(0.0)).collect()
    }

    /// What changes the shape of these cloths, as that of the next.
    fn shape_carried(&self, next: &Self, from: &[u32]) -> SavedShape {
        let mut shape = self.saved_shape();
        for cloth in 0..self.cloths.len() {
            for lengths in &mut shape.lengths[cloth] {
                if !lengths.is_empty() {
                    *lengths = self.rest_carried(next, from, cloth, lengths);
                }
            }
        }
        let seams = self.seams.ends().zip(self.seams.welded());
        let welded = ByPair::new(seams);
        let before = |ends: [u32; 2]| ends.map(|end| from[end as usize]);
        shape.welded =
            next.seams.ends().map(|ends| welded.get(before(ends)).unwrap_or(false)).collect();
        let mut creases: Vec<_> =
            self.system.fabrics.creased_faces().zip(shape.creases.iter().copied()).collect();
        creases.sort_by_key(|(corners, _)| *corners);
        let find = |corners: [u32; 3]| {
            let corners = corners.map(|corner| from[corner as usize]);
            let place = creases.binary_search_by_key(&corners, |(own, _)| *own);
            place.map_or_else(|_| Crease::default(), |place| creases[place].1)
        };
        shape.creases = next.system.fabrics.creased_faces().map(find).collect();
        shape
    }

    /// Rest lengths (m) of a cloth's springs and then rest angles (rad) of its hinges, as those of the next cloth.
    fn rest_carried(&self, next: &Self, from: &[u32], cloth: usize, numbers: &[f64]) -> Vec<f64> {
        let (own, base) = (&self.cloths[cloth], self.bases[cloth]);
        let (lengths, angles) = numbers.split_at(own.springs.len());
        let ends = own.springs.iter().map(|spring| spring.ends.map(|end| base + end));
        let lengths = ByPair::new(ends.zip(lengths.iter().copied()));
        let hinges = self.system.fabrics.hinge_edges(cloth);
        let angles = ByPair::new(hinges.zip(angles.iter().copied()));
        let before = |ends: [u32; 2]| ends.map(|end| from[end as usize]);
        let base = next.bases[cloth];
        let springs = next.cloths[cloth].springs.iter();
        let carried = springs.map(|spring| {
            let old = lengths.get(before(spring.ends.map(|end| base + end)));
            old.unwrap_or(spring.rest_length)
        });
        let hinges = next.system.fabrics.hinge_edges(cloth);
        let hinges = hinges.zip(next.system.fabrics.rest_angles(cloth));
        carried.chain(hinges.map(|(ends, own)| angles.get(before(ends)).unwrap_or(own))).collect()
    }
}

/// A state whose particles are those of another with these numbers.
fn gathered(state: &State, from: &[u32]) -> State {
    let mut gathered = State::zeros(from.len());
    let gather = |to: &mut Coordinates, old: &Coordinates| {
        for (to, old) in to.0.iter_mut().zip(&old.0) {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = old[*from as usize]);
        }
    };
    gather(&mut gathered.position, &state.position);
    gather(&mut gathered.velocity, &state.velocity);
    gathered
}
