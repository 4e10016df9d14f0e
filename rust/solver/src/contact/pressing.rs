//! What contacts press and rub at a guess of Newton's method.
//!
//! The force of a contact is far from linear over the way of a step: it sets in, and friction slides or sticks. So each
//! contact takes its tangent where it would come to rest by itself, with the mass m that it feels: it has a depth p and a
//! slip u (m), and its last force was f (N),
//!
//! ```text
//! a = m/h'²        free depth p + f/a        slip with friction |u| - mu f/a, after an iteration without
//! ```
//!
//! The first takes friction by what the same contact pressed with in the step before, within the frame; later ones take it
//! at the slip that they find. Where all have met, the tangent is that of the law.

use boucle_geometry::Vector;
use rayon::prelude::*;

use super::contact::Contact;
use super::{Contacts, friction};
use crate::linear::Field;
use crate::state::Coordinates;

/// What a contact does at a guess.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pressure {
    /// N, along its normal.
    pub(super) force: f64,
    /// N/m
    slope: f64,
    /// N/m, across its normal.
    resistance: f64,
    /// N, what friction goes by before a solution has found a force.
    expected: f64,
}

/// What contacts pressed with in the step before.
#[derive(Debug, Default)]
pub(super) struct Remembered {
    /// Contacts, sorted, and forces (N). Several pieces of what is tangled may be one to this.
    forces: Vec<(Name, f64)>,
}

/// What a contact is told by: its points, and which of them have a part in the first feature.
type Name = ([u32; 4], [bool; 4]);

fn name(contact: &Contact) -> Name {
    (contact.points, contact.weights.map(|weight| weight > 0.0))
}

impl Remembered {
    /// Remembers these contacts alone.
    pub(super) fn renew(&mut self, contacts: &[Contact], pressures: &[Pressure]) {
        self.forces.clear();
        let pressing = contacts.iter().zip(pressures).filter(|(_, pressure)| pressure.force > 0.0);
        self.forces.extend(pressing.map(|(contact, pressure)| (name(contact), pressure.force)));
        self.forces.sort_by_key(|(name, _)| *name);
        self.forces.dedup_by_key(|(name, _)| *name);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.forces.is_empty()
    }

    /// The force (N) of a contact; 0 if it did not press.
    pub(super) fn of(&self, contact: &Contact) -> f64 {
        let place = self.forces.binary_search_by_key(&name(contact), |(name, _)| *name);
        place.map_or(0.0, |place| self.forces[place].1)
    }
}

/// How a contact has moved.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// Gap (m).
    gap: f64,
    /// Across the normal (m), since the step began.
    slip: Vector,
}

impl Contacts {
    /// Adds the forces (N) of contacts at these positions (m) to those of everything else, and freezes their tangents, in a
    /// step of h seconds. Friction takes the pressure that the last solution found.
    pub(crate) fn push(&mut self, at: &Coordinates, residual: &mut Coordinates, h: f64) {
        let pressed = self.near.par_iter().zip(&self.pressures).map(|(contact, pressure)| {
            let way = self.way_of(contact, at);
            let pressure = pressure.renewed(contact, &way, h);
            (pressure, contact.normal * pressure.force - pressure.resistance * way.slip)
        });
        let (pressures, forces): (Vec<_>, Vec<_>) = pressed.unzip();
        self.pressures = pressures;
        self.matrix.set(self.pressures.iter().map(|own| [own.slope, own.resistance]));
        self.matrix.add_forces(&forces, residual);
    }

    fn way_of(&self, contact: &Contact, at: &Coordinates) -> Way {
        let (mut way, mut slip) = (Vector::zeros(), Vector::zeros());
        for (&point, &weight) in contact.points.iter().zip(&contact.weights) {
            if weight != 0.0 {
                let place = if self.bodies.is_particle(point) {
                    at.get(point as usize)
                } else {
                    self.paths.end(point)
                };
                way += weight * (place - self.paths.start[point as usize]);
                slip += weight * (place - self.origins[point as usize]);
            }
        }
        let normal = &contact.normal;
        Way { gap: contact.gap(&way), slip: slip - normal * normal.dot(&slip) }
    }

    /// Takes what contacts press (N) after the particles have moved (m), by the linear model.
    pub(crate) fn press(&mut self, moves: &Field) {
        let count = self.bodies.particle_count;
        let pairs = self.near.par_iter().zip(&mut self.pressures);
        pairs.for_each(|(contact, pressure)| {
            let ends = contact.points.iter().zip(&contact.weights);
            let along = ends.filter(|end| (*end.0 as usize) < count).map(|(&point, weight)| {
                let step = moves.0.each_ref().map(|axis| f64::from(axis[point as usize]));
                weight * contact.normal.dot(&Vector::from(step))
            });
            pressure.force = (pressure.force - pressure.slope * along.sum::<f64>()).max(0.0);
        });
    }
}

impl Pressure {
    /// Before the first guess, with a force (N) that is expected.
    pub(super) fn expected(force: f64) -> Self {
        Self { expected: force, ..Self::default() }
    }

    /// The same at a new guess.
    fn renewed(&self, contact: &Contact, way: &Way, h: f64) -> Self {
        let strength = contact.friction * (self.force + self.expected);
        let slip = way.slip.norm();
        let slipping = if self.resistance == 0.0 {
            (slip - strength / contact.inertia).max(0.0)
        } else {
            slip
        };
        let most = friction::FIRMEST * contact.inertia;
        let resistance = friction::resistance(strength, slipping, h).min(most);
        let [force, slope] = contact.tangent(way.gap, self.force);
        Self { force, slope, resistance, expected: 0.0 }
    }
}
