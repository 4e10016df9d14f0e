//! The state of a simulation as bytes, and back.

use super::Simulation;
use super::saved_shape::SavedShape;
use crate::checkpoint::Checkpoint;
use crate::error::{Error, Result};
use crate::goals::Goal;

impl Simulation {
    /// The whole state as bytes, with all that it was told for the next frame.
    #[must_use]
    pub fn checkpoint(&self) -> Vec<u8> {
        self.saved().to_bytes()
    }

    /// The same before it is bytes.
    pub(super) fn saved(&self) -> Checkpoint {
        let (pins, pin_stiffness) = self.pins.held();
        Checkpoint {
            digest: self.digest,
            frame: self.frame,
            substeps: self.substeps_taken,
            state: self.state.clone(),
            memory: self.method.memory().cloned(),
            gravity: self.settings.gravity,
            winds: self.system.air.wind_states().collect(),
            fields: self.system.air.fields().to_vec(),
            water: self.system.air.sea.as_ref().map_or_else(Vec::new, |sea| sea.to_numbers()),
            colliders: self.contacts.collider_positions().clone(),
            shape: self.shape_numbers(),
            pins,
            pin_stiffness,
            grab: self.grab.clone(),
            tears: self.tears(),
        }
    }

    /// Takes up the state of a checkpoint; what follows is bit-equal to never having stopped.
    ///
    /// # Errors
    /// [`Error::BadCheckpoint`] when it is damaged or of other cloths or settings; nothing is then changed.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        let checkpoint = Checkpoint::from_bytes(bytes)?;
        if checkpoint.digest != self.digest {
            return Err(Error::BadCheckpoint(
                "is of another scene or other settings; accepted: the one that it was made from",
            ));
        }
        let (tears, undo) = (self.tears(), self.saved());
        if self.tear_alike(&checkpoint.tears).is_some() && self.take_if_whole(checkpoint) {
            if self.has_energies() {
                return Ok(());
            }
        } else if tears == self.tears() {
            return Err(damaged());
        }
        // What was is whole.
        let _ = self.tear_alike(&tears);
        self.take_if_whole(undo);
        Err(damaged())
    }

    fn take_if_whole(&mut self, checkpoint: Checkpoint) -> bool {
        let Some(shape) = self.read_shape(&checkpoint.shape) else { return false };
        let fits = self.fits(&checkpoint);
        if fits {
            self.take(checkpoint, shape);
            self.intersect();
        }
        fits
    }

    /// Whether the energies of the present state are numbers: those of finite positions and velocities may be too large for one.
    fn has_energies(&self) -> bool {
        let certificate = self.certificate();
        certificate.kinetic_energy.is_finite() && certificate.potential_energy.is_finite()
    }

    /// Takes up a checkpoint that fits; intersections are then to be counted.
    pub(super) fn take(&mut self, checkpoint: Checkpoint, shape: SavedShape) {
        self.pins.restore(&checkpoint.pins, &checkpoint.pin_stiffness);
        if let (Some(memory), Some(restored)) = (self.method.memory_mut(), checkpoint.memory) {
            *memory = restored;
        }
        self.contacts.place_colliders(checkpoint.colliders);
        self.state = checkpoint.state;
        self.frame = checkpoint.frame;
        self.substeps_taken = checkpoint.substeps;
        self.iterations_taken = 0;
        self.clipped = 0;
        self.grab = checkpoint.grab;
        self.settings.gravity = checkpoint.gravity;
        self.system.set_gravity(checkpoint.gravity);
        self.system.air.restore_winds(&checkpoint.winds);
        if let Some(sea) = &mut self.system.air.sea {
            sea.restore(&checkpoint.water);
        }
        self.start_flows();
        self.weigh();
        self.system.air.set_fields(checkpoint.fields);
        self.follow_holds();
        self.take_shape(shape);
        self.method.follow_pins(&self.system);
    }

    /// Whether a checkpoint holds as much of everything as there is here; its shape is looked at when it is read.
    fn fits(&self, checkpoint: &Checkpoint) -> bool {
        let is_grabbable = |goal: &Goal| (goal.particle as usize) < self.state.len();
        let remembers_alike = match (self.method.memory(), &checkpoint.memory) {
            (Some(own), Some(restored)) => own.tensions.len() == restored.tensions.len(),
            (own, restored) => own.is_none() && restored.is_none(),
        };
        let own = &self.contacts.collider_positions()[0];
        let sea = self.system.air.sea.as_ref();
        checkpoint.state.len() == self.state.len()
            && sea.map_or(checkpoint.water.is_empty(), |sea| sea.fits(&checkpoint.water))
            && checkpoint.winds.len() == self.system.air.wind_count()
            && checkpoint.colliders.iter().all(|points| points.len() == own.len())
            && checkpoint.grab.goals.iter().all(is_grabbable)
            && self.pins.fit(&checkpoint.pins, &checkpoint.pin_stiffness)
            && remembers_alike
    }
}

fn damaged() -> Error {
    Error::BadCheckpoint("is damaged; accepted: a whole one")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::{Cloth, Mass};
    use crate::fabric::Fabric;
    use crate::force::Pressure;
    use crate::implicit::Memory;
    use crate::material::SpringMaterial;
    use crate::settings::{IntegratorKind, Settings};
    use crate::tear::{Opening, Tear};
    use boucle_geometry::{Mesh, Vector};

    fn of(change: impl Fn(Cloth) -> Cloth) -> Simulation {
        let mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]]).expect("a mesh");
        let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let positions = positions.map(|[x, y]| Vector::new(x, y, 0.0)).to_vec();
        let (mass, material) = (Mass::Density(0.2), SpringMaterial::default());
        let cloth = Cloth::from_mesh("c", mesh, positions, &mass, material, vec![0]);
        let settings = Settings { threads: 1, ..Settings::default() };
        let cloths = vec![change(cloth.expect("a cloth"))];
        Simulation::new(cloths, Vec::new(), settings).expect("a simulation")
    }

    fn inflated() -> Simulation {
        let pressure = Some(Pressure { uniform: 1.0, ..Pressure::default() });
        of(|cloth| Cloth { pressure: pressure.clone(), ..cloth })
    }

    /// What is told of a rest shape as it is, or of one that comes to be again what it was, changes nothing but by roundings;
    /// those must not differ between cloth that goes on and cloth that was restored.
    #[test]
    fn fabric_that_is_told_its_own_rest_shape_goes_on_by_the_same_bits_after_a_restore() {
        let unchanged = of(|cloth| cloth.of_fabric(Fabric::default()).expect("a fabric"));
        let shape = unchanged.cloth(0).positions.clone();
        for integrator in [IntegratorKind::Verlet, IntegratorKind::Bdf2] {
            let settings = Settings { threads: 1, integrator, ..Settings::default() };
            let cloth = unchanged.cloth(0).clone();
            let mut simulation =
                Simulation::new(vec![cloth], Vec::new(), settings).expect("a simulation");
            simulation.advance().expect("a frame");
            let told_nothing = simulation.checkpoint();
            let hash = simulation.advance().expect("a frame").hash;
            simulation.restore(&told_nothing).expect("a whole one");
            simulation.set_rest(0, Some(&shape), None).expect("accepted");
            assert_eq!(simulation.advance().expect("a frame").hash, hash, "{integrator:?}");
            let told = simulation.checkpoint();
            let hash = simulation.advance().expect("a frame").hash;
            simulation.restore(&told).expect("a whole one");
            assert_eq!(simulation.advance().expect("a frame").hash, hash, "{integrator:?}");
        }
    }

    /// Of each of the two faces, six numbers.
    #[test]
    fn creases_that_do_not_fit_are_refused() {
        let fabric = Fabric { bend_hysteresis: 1e-3, ..Fabric::default() };
        let mut simulation = of(|cloth| cloth.of_fabric(fabric.clone()).expect("a fabric"));
        let before = simulation.checkpoint();
        let spoils: [fn(&mut Vec<f64>); 3] = [
            |shape| shape.truncate(8),
            |shape| shape.push(0.0),
            |shape| shape.last_mut().into_iter().for_each(|number| *number = f64::INFINITY),
        ];
        for spoil in spoils {
            let mut bad = Checkpoint::from_bytes(&before).expect("a whole one");
            assert_eq!(bad.shape.len(), 2 + 2 * 6);
            spoil(&mut bad.shape);
            let refused = simulation.restore(&bad.to_bytes());
            assert!(matches!(refused, Err(Error::BadCheckpoint(_))), "{refused:?}");
        }
        assert!(simulation.checkpoint() == before);
    }

    /// Each is whole by its checksum, and of the same scene by its digest.
    #[test]
    fn a_checkpoint_that_does_not_fit_is_refused_before_anything_changes() {
        let mut told = inflated();
        told.set_rest(0, None, Some(&[0.1; 4])).expect("accepted");
        told.advance().expect("a frame");
        let mut simulation = inflated();
        let before = simulation.checkpoint();
        let spoils: [fn(&mut Checkpoint); 10] = [
            |bad| bad.shape.truncate(3),
            |bad| bad.shape.push(0.0),
            |bad| bad.shape[0] += 1.0,
            |bad| bad.shape[1] = 0.0,
            |bad| bad.shape.last_mut().into_iter().for_each(|number| *number = f64::NAN),
            |bad| bad.memory = None,
            |bad| bad.memory = Some(Memory::new(&bad.state, 1)),
            |bad| bad.pin_stiffness.clear(),
            |bad| bad.pins.clear(),
            |bad| bad.colliders = [(); 2].map(|()| vec![Vector::zeros()]),
        ];
        for (number, spoil) in spoils.iter().enumerate() {
            let mut bad = Checkpoint::from_bytes(&told.checkpoint()).expect("a whole one");
            spoil(&mut bad);
            let refused = simulation.restore(&bad.to_bytes());
            let expected = Error::BadCheckpoint("is damaged; accepted: a whole one");
            assert_eq!(refused, Err(expected), "{number}");
            assert!(simulation.checkpoint() == before, "{number}");
        }
        simulation.restore(&told.checkpoint()).expect("a whole one");
        assert!(simulation.checkpoint() == told.checkpoint());
    }

    /// Each number is finite, what comes of them is not.
    #[test]
    fn a_checkpoint_whose_energies_are_no_numbers_is_refused_and_undone() {
        let spoils: [fn(&mut Checkpoint); 3] = [
            |bad| bad.state.position.0[2][1] = 1e200,
            |bad| bad.state.velocity.0[0][2] = -1e160,
            |bad| bad.gravity.z = f64::MAX,
        ];
        for integrator in [IntegratorKind::Verlet, IntegratorKind::Bdf2] {
            let settings = Settings { threads: 1, integrator, ..Settings::default() };
            let cloth = of(|cloth| cloth).cloth(0).clone();
            let make = || Simulation::new(vec![cloth.clone()], Vec::new(), settings.clone());
            let [mut simulation, mut other] = [(); 2].map(|()| make().expect("a simulation"));
            simulation.advance().expect("a frame");
            other.advance().expect("a frame");
            let before = simulation.checkpoint();
            for (number, spoil) in spoils.iter().enumerate() {
                let mut bad = Checkpoint::from_bytes(&before).expect("a whole one");
                spoil(&mut bad);
                let refused = simulation.restore(&bad.to_bytes());
                assert_eq!(refused, Err(damaged()), "{number}");
                assert!(simulation.checkpoint() == before, "{number}");
            }
            let [one, two] = [&mut simulation, &mut other].map(|s| s.advance().expect("a frame"));
            assert_eq!(one.hash, two.hash, "{integrator:?}");
        }
    }

    /// The two triangles part at the corner that is not pinned.
    #[test]
    fn a_refused_checkpoint_of_whole_cloth_leaves_torn_cloth_as_it_is() {
        let opening = Opening { frame: 2, pairs: vec![[0, 2]] };
        let tear = Tear { openings: vec![opening], ..Tear::default() };
        let first = Settings::default().first_frame;
        let mut simulation = of(|cloth| Cloth { tear: Some(tear.clone()), ..cloth });
        let whole = simulation.checkpoint();
        while simulation.frame() < 2.max(first + 1) {
            simulation.advance().expect("a frame");
        }
        simulation.advance().expect("a frame");
        assert_eq!(simulation.positions(0).len(), 5);
        let before = simulation.checkpoint();
        let spoils: [fn(&mut Checkpoint); 4] = [
            |bad| bad.shape.push(0.0),
            |bad| bad.tears = vec![1.0, 99.0, 0.0],
            |bad| bad.tears.push(0.0),
            |bad| bad.pins.clear(),
        ];
        for (number, spoil) in spoils.iter().enumerate() {
            let mut bad = Checkpoint::from_bytes(&whole).expect("a whole one");
            spoil(&mut bad);
            let refused = simulation.restore(&bad.to_bytes());
            assert!(matches!(refused, Err(Error::BadCheckpoint(_))), "{number}: {refused:?}");
            assert!(simulation.checkpoint() == before, "{number}");
        }
        simulation.restore(&whole).expect("a whole one");
        assert_eq!(simulation.positions(0).len(), 4);
        simulation.restore(&before).expect("a whole one");
        assert!(simulation.checkpoint() == before);
    }
}
