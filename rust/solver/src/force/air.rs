//! Air and water around all cloths: winds, force fields, pressure and water on every particle.

use boucle_geometry::Vector;
use rayon::prelude::*;

use super::faces::{FaceState, Faces};
use super::field::Field;
use super::fields::{Fields, Pushed};
use super::sea::{Sea, SeaScratch};
use super::water::Water;
use super::wind::Wind;
use super::winds::{Streams, Winds};
use super::{PressureScratch, Pressures};
use crate::cloth::Cloth;
use crate::collider::Collider;
use crate::kernel::{CHUNK, ChunkVectors};
use crate::state::State;

/// All winds and fields and the water, and what they need to know of the meshes.
#[derive(Debug)]
pub(crate) struct Air {
    pub(crate) pressures: Pressures,
    pub(crate) sea: Option<Box<Sea>>,
    winds: Winds,
    fields: Fields,
    faces: Faces,
}

/// What air and water do in the present state.
#[derive(Debug, Default)]
pub(crate) struct AirScratch {
    pub(crate) pressure: PressureScratch,
    faces: Vec<FaceState>,
    streams: Streams,
    /// Empty where there are no fields.
    pushed: Vec<Pushed>,
    sea: SeaScratch,
}

impl AirScratch {
    /// Stiffness (N/m) with which fields and water hold a particle, at most; as it was last observed.
    pub(crate) fn stiffness_of(&self, particle: usize) -> f64 {
        self.pushes(particle).map(|pushed| pushed.stiffness).sum()
    }

    fn pushes(&self, particle: usize) -> impl Iterator<Item = &Pushed> {
        self.pushed.get(particle).into_iter().chain(self.sea.pushed.get(particle))
    }
}

impl Air {
    pub(crate) fn new(
        winds: Vec<Wind>,
        water: Option<Water>,
        cloths: &[Cloth],
        gravity: &Vector,
    ) -> Self {
        let masses = cloths.iter().flat_map(|cloth| cloth.masses.iter().copied());
        Self {
            pressures: Pressures::new(cloths),
            sea: water.map(|water| Box::new(Sea::new(water, cloths, gravity))),
            winds: Winds::new(winds, cloths),
            fields: Fields::new(masses.collect()),
            faces: Faces::new(cloths),
        }
    }

    pub(crate) fn is_still(&self) -> bool {
        self.has_no_flow() && self.pressures.is_empty()
    }

    fn has_no_flow(&self) -> bool {
        self.winds.is_empty() && self.fields.is_empty() && self.sea.is_none()
    }

    /// Takes these fields in the place of those before.
    pub(crate) fn set_fields(&mut self, fields: Vec<Field>) {
        self.fields.set(fields);
    }

    /// Lets a wind blow with this velocity (m/s) from now on.
    pub(crate) fn set_wind_velocity(&mut self, wind: usize, velocity: Vector) {
        self.winds.set_velocity(wind, velocity);
    }

    /// Puts the calm surface of the water at a height (m), and lets its current flow so (m/s), from now on.
    pub(crate) fn set_water(&mut self, level: f64, velocity: Vector) {
        if let Some(sea) = &mut self.sea {
            sea.set(level, velocity);
        }
    }

    /// The water, if there is any.
    pub(crate) fn water(&self) -> Option<&Water> {
        self.sea.as_ref().map(|sea| sea.water())
    }

    /// Lets things weigh by this gravity (m/s²) in water from now on.
    pub(crate) fn set_gravity(&mut self, gravity: &Vector) {
        if let Some(sea) = &mut self.sea {
            sea.set_gravity(gravity);
        }
    }

    /// The velocities (m/s) of the winds, and how far (m) they have come.
    pub(crate) fn wind_states(&self) -> impl ExactSizeIterator<Item = [Vector; 2]> {
        self.winds.states()
    }

    /// Takes up such states.
    pub(crate) fn restore_winds(&mut self, states: &[[Vector; 2]]) {
        self.winds.restore(states);
    }

    /// How many winds blow.
    pub(crate) fn wind_count(&self) -> usize {
        self.winds.count()
    }

    pub(crate) fn fields(&self) -> &[Field] {
        self.fields.each()
    }

    /// Whether colliders keep any wind off.
    pub(crate) fn is_sheltered(&self) -> bool {
        self.winds.are_sheltered()
    }

    /// Finds what feels winds in `state` among colliders whose points are there (m).
    pub(crate) fn shelter(&mut self, colliders: &[Collider], points: &[Vector], state: &State) {
        self.winds.shelter(colliders, points, &self.faces, state);
    }

    /// Begins the frame after this one, so many seconds after the first.
    pub(crate) fn start_frame(&mut self, frame: i32, time: f64) {
        self.fields.start_frame(frame);
        self.winds.start_frame(time);
        if let Some(sea) = &mut self.sea {
            sea.start_frame(time);
        }
    }

    /// Begins the steps of a frame, of h seconds each.
    pub(crate) fn start_steps(&mut self, h: f64, is_implicit: bool) {
        self.fields.start_steps(h, is_implicit);
    }

    /// Begins a step that ends so many seconds into the frame.
    pub(crate) fn start_step(&mut self, end: f64) {
        self.winds.start_step(end);
        if let Some(sea) = &mut self.sea {
            sea.start_step(end);
        }
    }

    /// Ends a frame of a duration (s) in `state`. Says whether any particle has become wetter or drier.
    pub(crate) fn end_frame(&mut self, duration: f64, state: &State) -> bool {
        self.winds.end_frame(duration);
        self.sea.as_mut().is_some_and(|sea| sea.end_frame(duration, state))
    }

    /// Largest damping (N·s/m) that the classic law puts on a particle.
    pub(crate) fn damping(&self) -> f64 {
        self.winds.damping()
    }

    /// Damping (N·s/m) that winds, fields and water put on a particle, at most; as they were last observed.
    pub(crate) fn damping_of(&self, particle: usize, scratch: &AirScratch) -> f64 {
        let pushes: f64 = scratch.pushes(particle).map(|pushed| pushed.damping).sum();
        let around = self.around(particle, scratch);
        pushes + self.winds.damping_of(particle, &around, &scratch.streams)
    }

    /// Largest damping (1/s) and square of a frequency (1/s²) that fields and water put on a particle within so many seconds, in
    /// which other forces make it up to `gain` (m/s) faster than in `state`, and fields by what they push it with now.
    pub(crate) fn push_rates(
        &self,
        state: &State,
        inverse_masses: &[f64],
        [gain, seconds]: [f64; 2],
    ) -> [f64; 2] {
        let [damping, stiffness] =
            self.sea.as_ref().map_or([0.0; 2], |sea| sea.rates(state, inverse_masses, gain));
        if self.fields.is_empty() {
            return [damping, stiffness];
        }
        let mut scratch = AirScratch::default();
        self.observe_flow(state, &mut scratch, gain);
        let pushes = scratch.pushed.iter().zip(inverse_masses);
        let pushes = pushes.map(|(pushed, w)| pushed.force.norm() * w);
        let gain = gain + seconds * pushes.fold(0.0, f64::max);
        self.observe_flow(state, &mut scratch, gain);
        let rates = scratch.pushed.iter().zip(inverse_masses);
        let of_fields = rates.fold([0.0; 2], |[damping, stiffness], (pushed, w)| {
            [f64::max(damping, pushed.damping * w), f64::max(stiffness, pushed.stiffness * w)]
        });
        [damping + of_fields[0], stiffness + of_fields[1]]
    }

    /// Largest damping (1/s) that winds put on a particle by its faces, with these up to `gain` (m/s) faster than in `state`.
    ///
    /// The slope of `1/2 rho A s²` is `rho A s`. A step that is stable for it takes no more than the whole of s.
    pub(crate) fn wind_damping(&self, state: &State, inverse_masses: &[f64], gain: f64) -> f64 {
        let slopes = self.winds.slopes();
        if slopes.is_empty() {
            return 0.0;
        }
        let mut scratch = AirScratch::default();
        self.faces.observe(state, &mut scratch.faces);
        let share_of = |particle: usize, face: &FaceState| {
            let own = face.velocity.norm() + gain;
            let blowing = slopes.iter().filter(|(_, reaches)| reaches(particle));
            let slope: f64 = blowing.map(|(slope, _)| slope(own)).sum();
            slope * face.area * face.corner_share
        };
        let damping_of = |particle: usize| {
            let faces = self.around(particle, &scratch);
            faces.map(|(_, face)| share_of(particle, face)).sum::<f64>() * inverse_masses[particle]
        };
        (0..state.len()).map(damping_of).fold(0.0, f64::max)
    }

    /// Looks at all that is in `state`.
    pub(crate) fn observe(&self, state: &State, scratch: &mut AirScratch) {
        if self.has_no_flow() {
            scratch.pushed.clear();
        } else {
            self.observe_flow(state, scratch, 0.0);
        }
        if !self.pressures.is_empty() {
            self.pressures.observe(state, &mut scratch.pressure);
        }
    }

    /// Looks at faces and particles that may become faster by `gain` (m/s).
    fn observe_flow(&self, state: &State, scratch: &mut AirScratch, gain: f64) {
        self.faces.observe(state, &mut scratch.faces);
        if let Some(sea) = &self.sea {
            sea.observe(state, &self.faces, &mut scratch.faces, &mut scratch.sea);
        }
        self.winds.observe(&scratch.faces, &mut scratch.streams);
        let count = if self.fields.is_empty() { 0 } else { state.len() };
        let mut pushed = std::mem::take(&mut scratch.pushed);
        pushed.resize(count, Pushed::default());
        pushed.par_iter_mut().with_min_len(CHUNK / 8).enumerate().for_each(|(particle, pushed)| {
            let motion = [state.position.get(particle), state.velocity.get(particle)];
            let faces = self.around(particle, scratch).map(|(_, face)| face);
            *pushed = self.fields.push(particle, motion, faces, gain);
        });
        scratch.pushed = pushed;
    }

    /// The faces around a particle by their numbers, as they were last observed.
    fn around<'a>(
        &'a self,
        particle: usize,
        scratch: &'a AirScratch,
    ) -> impl Iterator<Item = (usize, &'a FaceState)> + Clone {
        self.faces.around(particle).map(|face| (face, &scratch.faces[face]))
    }

    /// Adds the forces (N) of winds, fields, pressure and water on the particles of a chunk.
    pub(crate) fn add_forces(
        &self,
        chunk: usize,
        state: &State,
        scratch: &AirScratch,
        force: &mut ChunkVectors,
    ) {
        let first = chunk * CHUNK;
        for particle in first..(first + CHUNK).min(state.len()) {
            let mut push: Vector = scratch.pushes(particle).map(|pushed| pushed.force).sum();
            if !self.winds.is_empty() {
                let motion = [state.position.get(particle), state.velocity.get(particle)];
                let around = self.around(particle, scratch);
                self.winds.add_force(particle, motion, &around, &scratch.streams, &mut push);
            }
            if let Some(pressure) = scratch.pressure.force(particle) {
                push += pressure;
            }
            for axis in 0..3 {
                force[axis][particle - first] += push[axis];
            }
        }
    }
}
