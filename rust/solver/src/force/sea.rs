//! Cloth in water: what carries it, what drags it, and how wet it is.
//!
//! Open cloth is wet on both sides and is carried by the weight of the water in whose place it is. A particle has the volume
//! `V = m/rho_b` of its dry mass and bulk density, and takes its place in the water evenly as it sinks through the height e:
//!
//! ```text
//! F = rho g V p          p = h/e + 1/2 within 0 to 1          (N)   h: its depth (m)
//! U = rho g V e p²/2 within the surface, rho g V h below      (J)
//! ```
//!
//! e is the thickness of the cloth, V over its area, but no less than 5 mm: twice the length over which water climbs up a wall. So a
//! mat floats as deep as its density says. Closed cloth keeps the water outside ([`super::hull`]).
//!
//! Faces feel the flow of the water as those in air do ([`super::flow`]), those of closed cloth on one side only, by the part of
//! their corners that is under water. The water that moves along with cloth has no mass here.
//!
//! Wet cloth is heavier, and its volume is the same: water is where air was. So cloth that takes up more than
//! `rho/rho_b - 1` of its mass sinks. Masses change between frames.

use std::ops::Range;

use boucle_geometry::Vector;
use rayon::prelude::*;

use super::faces::{FaceState, Faces};
use super::fields::Pushed;
use super::hull::{Hull, HullScratch};
use super::water::{Bulk, Water};
use crate::cloth::{Cloth, placed};
use crate::contact::facing;
use crate::kernel::CHUNK;
use crate::state::State;

/// Height (m) over which cloth takes its place in the water at the least.
const LEAST_HEIGHT: f64 = 0.005;

/// What a particle is to water.
#[derive(Clone, Copy, Debug)]
struct Float {
    /// m³; 0 where it is of a hull.
    volume: f64,
    /// m
    height: f64,
    /// Area (m²) at rest.
    area: f64,
    /// Which part of a face's flow acts: both sides or one.
    sides: f64,
}

impl Float {
    /// The part under water at a depth (m).
    fn part(&self, depth: f64) -> f64 {
        (depth / self.height + 0.5).clamp(0.0, 1.0)
    }
}

/// One cloth's particles and what they are made of.
#[derive(Debug)]
struct Soaking {
    particles: Range<usize>,
    bulk: Bulk,
}

/// The water, where it is, and the cloths in it.
#[derive(Debug)]
pub(crate) struct Sea {
    water: Water,
    /// When (s) the frame starts, and how far (s) into it the present step ends.
    time: [f64; 2],
    /// How far (m) the current has come by the start of the frame.
    drift: Vector,
    /// Gravity downwards (m/s²).
    pull: f64,
    floats: Vec<Float>,
    hulls: Vec<Hull>,
    soaking: Vec<Soaking>,
    /// Of each particle, 0 to 1; empty if no cloth takes up water.
    wetness: Vec<f64>,
}

/// What water does in one state.
#[derive(Debug, Default)]
pub(super) struct SeaScratch {
    depths: Vec<f64>,
    hulls: Vec<HullScratch>,
    pub(super) pushed: Vec<Pushed>,
}

/// Numbers of a checkpoint before those of wetness: level, current, drift.
pub(crate) const NUMBERS: usize = 7;

impl Sea {
    pub(super) fn new(water: Water, cloths: &[Cloth], gravity: &Vector) -> Self {
        let (mut floats, mut hulls, mut soaking) = (Vec::new(), Vec::new(), Vec::new());
        for (cloth, base) in placed(cloths) {
            let side = facing(&cloth.mesh, cloth.rest());
            let is_hull = side != 0.0 && cloth.bulk.is_hull != Some(false);
            let (first, count) = (base as usize, cloth.positions.len());
            if is_hull {
                hulls.push(Hull::new(first, count, cloth.mesh.triangles(), side));
            }
            let areas = cloth.vertex_areas();
            floats.extend(cloth.masses.iter().zip(areas).map(|(mass, area)| {
                let volume = mass / cloth.bulk.density;
                // Particles without faces are as thick as they are wide.
                let height = if area > 0.0 { volume / area } else { volume.cbrt() };
                let (volume, sides) = if is_hull { (0.0, 0.5) } else { (volume, 1.0) };
                Float { volume, height: height.max(LEAST_HEIGHT), area, sides }
            }));
            soaking.push(Soaking { particles: first..first + count, bulk: cloth.bulk.clone() });
        }
        let soaks = soaking.iter().any(|soaking| soaking.bulk.absorbency > 0.0);
        let wetness = vec![0.0; if soaks { floats.len() } else { 0 }];
        let (time, drift, pull) = ([0.0; 2], Vector::zeros(), (-gravity.z).max(0.0));
        Self { water, time, drift, pull, floats, hulls, soaking, wetness }
    }

    pub(super) fn set_gravity(&mut self, gravity: &Vector) {
        self.pull = (-gravity.z).max(0.0);
    }

    /// Puts the calm surface at a height (m) and lets the current flow so (m/s).
    pub(super) fn set(&mut self, level: f64, velocity: Vector) {
        (self.water.level, self.water.velocity) = (level, velocity);
    }

    pub(super) fn water(&self) -> &Water {
        &self.water
    }

    pub(super) fn start_frame(&mut self, time: f64) {
        self.time = [time, 0.0];
    }

    pub(super) fn start_step(&mut self, end: f64) {
        self.time[1] = end;
    }

    /// Ends a frame of a duration (s), in `state`: what is under water becomes wetter, all else drier. Says whether any has changed.
    pub(super) fn end_frame(&mut self, duration: f64, state: &State) -> bool {
        self.drift += duration * self.water.velocity;
        self.time = [self.time[0] + duration, 0.0];
        if self.wetness.is_empty() {
            return false;
        }
        let mut changes = false;
        for Soaking { particles, bulk } in &self.soaking {
            if bulk.absorbency <= 0.0 {
                continue;
            }
            for particle in particles.clone() {
                let depth = self.depth(&state.position.get(particle));
                let is_under = self.floats[particle].part(depth) > 0.0;
                let wetness = &mut self.wetness[particle];
                let now = bulk.soak(*wetness, duration, is_under);
                changes |= now.to_bits() != wetness.to_bits();
                *wetness = now;
            }
        }
        changes
    }

    /// What each particle weighs by what it weighs dry; nothing if none takes up water.
    pub(crate) fn heavier(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let absorbing = self.soaking.iter().filter(|soaking| soaking.bulk.absorbency > 0.0);
        absorbing.flat_map(|Soaking { particles, bulk }| {
            particles
                .clone()
                .map(|particle| (particle, 1.0 + bulk.absorbency * self.wetness[particle]))
        })
    }

    /// How wet each of some particles is: 0 dry to 1 full; nothing where no cloth takes up water.
    pub(crate) fn wetness(&self, particles: Range<usize>) -> &[f64] {
        self.wetness.get(particles).unwrap_or(&[])
    }

    /// All that changes, as numbers.
    pub(crate) fn to_numbers(&self) -> Vec<f64> {
        let Self { water, drift, wetness, .. } = self;
        let mut numbers = vec![water.level];
        numbers.extend(water.velocity.iter().chain(drift));
        numbers.extend(wetness);
        numbers
    }

    /// Whether such numbers are of this water.
    pub(crate) fn fits(&self, numbers: &[f64]) -> bool {
        let Some((head, wetness)) = numbers.split_first_chunk::<NUMBERS>() else { return false };
        wetness.len() == self.wetness.len()
            && head.iter().all(|number| number.is_finite())
            && wetness.iter().all(|wetness| (0.0..=1.0).contains(wetness))
    }

    /// Takes up such numbers, that fit.
    pub(crate) fn restore(&mut self, numbers: &[f64]) {
        let vector = |first: usize| Vector::from_column_slice(&numbers[first..first + 3]);
        self.set(numbers[0], vector(1));
        self.drift = vector(4);
        self.wetness.copy_from_slice(&numbers[NUMBERS..]);
    }

    fn depth(&self, place: &Vector) -> f64 {
        let [start, end] = self.time;
        self.water.depth(place, start + end, &(self.drift + end * self.water.velocity))
    }

    /// rho g (N/m³)
    fn weight(&self) -> f64 {
        self.water.flow.density * self.pull
    }

    /// Looks at every particle and face in `state`, and says of faces which part of them is immersed.
    pub(super) fn observe(
        &self,
        state: &State,
        faces: &Faces,
        each: &mut [FaceState],
        scratch: &mut SeaScratch,
    ) {
        let SeaScratch { depths, hulls, pushed } = scratch;
        depths.resize(state.len(), 0.0);
        depths.par_iter_mut().with_min_len(CHUNK / 4).enumerate().for_each(|(particle, depth)| {
            *depth = self.depth(&state.position.get(particle));
        });
        let depths = &*depths;
        each.par_iter_mut().with_min_len(CHUNK / 4).enumerate().for_each(|(number, face)| {
            let corners = faces.corners(number).iter().map(|&corner| corner as usize);
            let parts = corners.map(|corner| self.floats[corner].part(depths[corner]));
            face.immersed = parts.sum::<f64>() * face.corner_share;
        });
        hulls.resize_with(self.hulls.len(), HullScratch::default);
        for (hull, scratch) in self.hulls.iter().zip(&mut *hulls) {
            hull.observe(state, self.weight(), depths, scratch);
        }
        let (each, hulls) = (&*each, &*hulls);
        pushed.resize(state.len(), Pushed::default());
        pushed.par_iter_mut().with_min_len(CHUNK / 8).enumerate().for_each(|(particle, pushed)| {
            *pushed = self.push(particle, depths[particle], faces, each);
            let of = self.hulls.partition_point(|hull| hull.first <= particle);
            if self.floats[particle].sides < 1.0 {
                self.hulls[of - 1].push(particle, &hulls[of - 1], pushed);
            }
        });
    }

    /// What carries a particle at a depth (m), and what drags it by its faces.
    fn push(&self, particle: usize, depth: f64, faces: &Faces, each: &[FaceState]) -> Pushed {
        let float = &self.floats[particle];
        let part = float.part(depth);
        let carried = self.weight() * float.volume;
        let is_within = part > 0.0 && part < 1.0;
        let mut pushed = Pushed {
            force: carried * part * Vector::z(),
            damping: 0.0,
            stiffness: if is_within { carried / float.height } else { 0.0 },
        };
        let [start, end] = self.time;
        let carried = self.drift + end * self.water.velocity;
        for face in faces.around(particle).map(|face| &each[face]) {
            if face.immersed <= 0.0 {
                continue;
            }
            let stream = self.water.velocity_at(&face.middle, start + end, &carried);
            let w = stream - face.velocity;
            let area = float.sides * face.corner_share * face.area * face.immersed;
            pushed.force += self.water.flow.force(area, &w, &face.normal);
            pushed.damping += self.water.flow.slope(area, &w, &face.normal);
        }
        pushed
    }

    /// Largest damping (1/s) and square of a frequency (1/s²) that water puts on a particle that becomes faster by `gain` (m/s).
    pub(super) fn rates(&self, state: &State, inverse_masses: &[f64], gain: f64) -> [f64; 2] {
        let most = self.water.most_speed() + gain;
        let each =
            self.floats.iter().zip(inverse_masses).enumerate().map(|(particle, (float, w))| {
                let speed = most + state.velocity.get(particle).norm();
                let damping = float.area * self.water.flow.most_slope(speed);
                let of_faces = if float.volume > 0.0 { 0.0 } else { 2.0 * float.area };
                [damping * w, self.weight() * (float.volume / float.height + of_faces) * w]
            });
        each.fold([0.0; 2], |most, each| [most[0].max(each[0]), most[1].max(each[1])])
    }

    /// The work (J) to push aside the water in whose place some particles are.
    pub(crate) fn energy(&self, particles: Range<usize>, state: &State) -> f64 {
        let depths: Vec<f64> =
            (0..state.len()).map(|particle| self.depth(&state.position.get(particle))).collect();
        let open = particles.clone().map(|particle| {
            let Float { volume, height, .. } = self.floats[particle];
            let depth = depths[particle];
            let work = if depth > 0.5 * height {
                depth
            } else {
                0.5 * height * self.floats[particle].part(depth).powi(2)
            };
            volume * work
        });
        let closed = self.hulls.iter().filter(|hull| particles.contains(&hull.first));
        let of_hulls: f64 = closed.map(|hull| hull.energy(state, self.weight(), &depths)).sum();
        self.weight() * open.sum::<f64>() + of_hulls
    }
}
