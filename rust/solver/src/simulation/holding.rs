//! What holds the cloth: hard pins, and goal springs of soft pins and of a grab.

use boucle_geometry::Vector;

use super::Simulation;
use crate::error::{Error, Result};
use crate::goals::Goals;
use crate::grab::Grab;
use crate::material::{at_least_zero, within_one};
use crate::stability::Spectrum;
use crate::system::System;

impl Simulation {
    /// Where the pins of a cloth are to be at the end of the next frame (m): a position for each vertex, of which
    /// only the pinned are read. They move there in a straight line, or are drawn along one if they are soft.
    pub fn set_pin_targets(&mut self, cloth: usize, targets: &[Vector]) {
        let Self { pins, cloths, bases, .. } = self;
        pins.aim(|particle| {
            let vertex = cloths[cloth].as_given(particle.checked_sub(bases[cloth])?)?;
            targets.get(vertex as usize).copied()
        });
    }

    /// How firmly the pins of a cloth are held from now on: a weight (0 free, 1 hard) for each vertex, of which only
    /// pins are read.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] when one is not from 0 to 1.
    pub fn set_pin_weights(&mut self, cloth: usize, weights: &[f64]) -> Result<()> {
        for &pin in &self.given(cloth).pins {
            if let Some(&weight) = weights.get(pin as usize) {
                within_one(&format!("the weight of pin {pin}"), weight)?;
            }
        }
        let Self { pins, cloths, bases, .. } = self;
        pins.weigh(|particle| {
            let vertex = cloths[cloth].as_given(particle.checked_sub(bases[cloth])?)?;
            weights.get(vertex as usize).copied()
        });
        self.follow_holds();
        Ok(())
    }

    /// The stiffness (N/m) of a patch of a cloth's soft pins from now on, at weight 1.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] when it is negative or not finite.
    pub fn set_pin_stiffness(&mut self, cloth: usize, stiffness: f64) -> Result<()> {
        at_least_zero("pin_stiffness (N/m)", stiffness)?;
        self.pins.stiffen(cloth, stiffness);
        self.follow_holds();
        Ok(())
    }

    /// Lets pins go, with the velocity they have: their weight is 0 from now on.
    pub fn release_pins(&mut self, cloth: usize, vertices: &[u32]) {
        let Self { pins, cloths, bases, .. } = self;
        pins.weigh(|particle| {
            let vertex = cloths[cloth].as_given(particle.checked_sub(bases[cloth])?)?;
            vertices.contains(&vertex).then_some(0.0)
        });
        self.follow_holds();
    }

    /// Grabs vertices of a cloth as a hand would, in place of any that were grabbed before: goal springs draw them to
    /// targets (m), where their goals arrive at the end of the next frame. A weight above 0 for each says how the grip
    /// is shared. Vertices that are pinned stay so.
    ///
    /// # Errors
    /// [`Error::BadCloth`] when a vertex, a target or a weight is not accepted.
    pub fn grab(
        &mut self,
        cloth: usize,
        vertices: &[u32],
        targets: &[Vector],
        weights: &[f64],
    ) -> Result<()> {
        let (held, base) = (&self.cloths[cloth], self.bases[cloth]);
        let refuse = |reason| Err(Error::BadCloth { cloth: held.name.clone(), reason });
        let count = held.positions.len();
        if vertices.len() != targets.len() || vertices.len() != weights.len() {
            let (targets, weights, wanted) = (targets.len(), weights.len(), vertices.len());
            return refuse(format!(
                "{targets} targets and {weights} weights are given to grab; accepted: {wanted} of each"
            ));
        }
        if let Some(vertex) = vertices.iter().find(|&&vertex| vertex as usize >= count) {
            return refuse(format!("{vertex} is no vertex to grab; accepted: 0 to {}", count - 1));
        }
        if let Some(weight) = weights.iter().find(|&&weight| !(weight > 0.0 && weight <= 1.0)) {
            return refuse(format!(
                "the weight of a grab is {weight}; accepted: above 0, at most 1"
            ));
        }
        if targets.iter().flatten().any(|x| !(x.abs() <= crate::cloth::FARTHEST)) {
            return refuse("a target of a grab is no place; accepted: within 1e6 m".to_owned());
        }
        let grabbed = vertices.iter().zip(targets).zip(weights);
        let grabbed = grabbed.map(|((&vertex, &target), &weight)| (vertex, target, weight));
        self.grab = Grab::new(held, base, grabbed, &self.state, &self.grab);
        self.follow_holds();
        Ok(())
    }

    /// Lets go what was grabbed, with the velocity it has.
    pub fn let_go(&mut self) {
        self.grab = Grab::default();
        self.follow_holds();
    }

    /// Readies the goal springs for the next frame.
    pub(super) fn gather_goals(&mut self) {
        let goals = self.pins.goals().chain(self.grab.goals.iter().copied());
        self.system.goals = Goals::new(goals, self.frame_duration());
    }

    /// Ends a frame: goals rest where they are until they are aimed anew.
    pub(super) fn end_holds(&mut self) {
        self.pins.end_frame();
        self.grab.end_frame();
        self.system.goals.end_frame();
    }

    /// Holds what is held from the first.
    pub(super) fn start_holds(&mut self) {
        self.gather_goals();
        let Self { pins, system, .. } = self;
        pins.particles().for_each(|particle| system.set_pinned(particle as usize, true));
        self.follow_pins();
    }

    /// Rebuilds what depends on what is held and how firmly, as far as that has changed.
    pub(super) fn follow_holds(&mut self) {
        let before = std::mem::take(&mut self.system.goals);
        self.gather_goals();
        let mut is_pinned = vec![false; self.state.len()];
        self.pins.particles().for_each(|particle| is_pinned[particle as usize] = true);
        let pinned = is_pinned.iter().enumerate();
        let is_held_as_before = before.particles().eq(self.system.goals.particles())
            && pinned
                .clone()
                .all(|(particle, &is_pinned)| is_pinned == self.system.is_pinned(particle));
        if !is_held_as_before {
            pinned.for_each(|(particle, &is_pinned)| self.system.set_pinned(particle, is_pinned));
            self.follow_pins();
        } else if !self.system.goals.are_as_stiff_as(&before) {
            self.method.follow_pins(&self.system);
        }
    }

    /// Rebuilds what depends on which particles are held.
    pub(super) fn follow_pins(&mut self) {
        let System { fabrics, inverse_masses, .. } = &mut self.system;
        fabrics.follow_pins(|particle| inverse_masses[particle] == 0.0);
        self.method.follow_pins(&self.system);
        self.contacts.follow_pins(&self.system.inverse_masses);
        self.limits = (0..self.cloths.len()).filter_map(|cloth| self.limit_of(cloth)).collect();
        if !self.method.is_implicit() {
            self.spectrum = Spectrum::of(&self.cloths, &self.system);
        }
    }
}
