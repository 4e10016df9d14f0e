//! The state of a simulation as bytes, and back.

use super::Simulation;
use crate::checkpoint::Checkpoint;
use crate::error::{Error, Result};
use crate::goals::Goal;

impl Simulation {
    /// The whole state as bytes.
    #[must_use]
    pub fn checkpoint(&self) -> Vec<u8> {
        let (pins, pin_stiffness) = self.pins.held();
        let checkpoint = Checkpoint {
            digest: self.digest,
            frame: self.frame,
            substeps: self.substeps_taken,
            state: self.state.clone(),
            memory: self.method.memory().cloned(),
            colliders: self.contacts.collider_positions().to_vec(),
            shape: self.shape_numbers(),
            pins,
            pin_stiffness,
            grab: self.grab.clone(),
        };
        checkpoint.to_bytes()
    }

    /// Takes up the state of a checkpoint; what follows is bit-equal to never having stopped.
    ///
    /// # Errors
    /// [`Error::BadCheckpoint`] when it is damaged or of other cloths or settings.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        let checkpoint = Checkpoint::from_bytes(bytes)?;
        let is_grabbable = |goal: &Goal| (goal.particle as usize) < self.state.len();
        if checkpoint.digest != self.digest
            || checkpoint.state.len() != self.state.len()
            || checkpoint.colliders.len() != self.contacts.collider_positions().len()
            || !checkpoint.grab.goals.iter().all(is_grabbable)
            || !self.pins.restore(&checkpoint.pins, &checkpoint.pin_stiffness)
        {
            return Err(Error::BadCheckpoint(
                "is of another scene or other settings; accepted: the one that it was made from",
            ));
        }
        if let (Some(memory), Some(restored)) = (self.method.memory_mut(), checkpoint.memory) {
            *memory = restored;
        }
        self.contacts.place_colliders(&checkpoint.colliders);
        self.state = checkpoint.state;
        self.frame = checkpoint.frame;
        self.substeps_taken = checkpoint.substeps;
        self.iterations_taken = 0;
        self.grab = checkpoint.grab;
        self.follow_holds();
        if !self.take_shape_numbers(&checkpoint.shape) {
            return Err(Error::BadCheckpoint("is damaged; accepted: a whole one"));
        }
        self.method.follow_pins(&self.system);
        self.intersect();
        Ok(())
    }
}
