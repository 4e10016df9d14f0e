//! The air around all cloths: winds, force fields and pressure on every particle.

use boucle_geometry::Vector;
use rayon::prelude::*;

use super::field::Field;
use super::fields::{Fields, Pushed};
use super::wind::{Region, Wind, WindLaw, vertex_mask};
use super::{PressureScratch, Pressures};
use crate::cloth::Cloth;
use crate::kernel::{CHUNK, ChunkVectors};
use crate::state::State;

/// A wind, and for regions of vertices whether it blows on each particle.
type Blowing = (Wind, Option<Vec<bool>>);

/// All winds and fields, and what they need to know of the meshes.
#[derive(Debug)]
pub(crate) struct Air {
    pub(crate) pressures: Pressures,
    winds: Vec<Blowing>,
    fields: Fields,
    /// Corners of all faces, in the simulation's numbering.
    face_starts: Vec<u32>,
    corners: Vec<u32>,
    /// For each particle, where its faces begin in `faces_of`, and the end of the last.
    particle_starts: Vec<u32>,
    faces_of: Vec<u32>,
}

/// What the air does to each face in the present state, and fields to each particle.
#[derive(Debug, Default)]
pub(crate) struct AirScratch {
    pub(crate) pressure: PressureScratch,
    faces: Vec<FaceAir>,
    /// Empty where there are no fields.
    pushed: Vec<Pushed>,
}

impl AirScratch {
    /// Stiffness (N/m) with which fields hold a particle, at most; as it was last observed.
    pub(crate) fn stiffness_of(&self, particle: usize) -> f64 {
        self.pushed.get(particle).map_or(0.0, |pushed| pushed.stiffness)
    }
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FaceAir {
    /// Unit normal, or zero for a face without area.
    pub(super) normal: Vector,
    pub(super) area: f64,
    velocity: Vector,
    pub(super) corner_share: f64,
}

impl Air {
    pub(crate) fn new(winds: Vec<Wind>, cloths: &[Cloth]) -> Self {
        let particle_count: usize = cloths.iter().map(|cloth| cloth.positions.len()).sum();
        let (mut face_starts, mut corners, mut base) = (vec![0], Vec::new(), 0);
        for cloth in cloths {
            for face in cloth.mesh.faces() {
                corners.extend(face.iter().map(|vertex| vertex + base));
                face_starts.push(corners.len() as u32);
            }
            base += cloth.positions.len() as u32;
        }
        let mut of_particle = vec![Vec::new(); particle_count];
        for face in 0..face_starts.len() - 1 {
            for &corner in &corners[face_starts[face] as usize..face_starts[face + 1] as usize] {
                of_particle[corner as usize].push(face as u32);
            }
        }
        let mut particle_starts = vec![0];
        particle_starts.extend(of_particle.iter().scan(0, |end, faces| {
            *end += faces.len() as u32;
            Some(*end)
        }));
        let faces_of = of_particle.concat();
        let winds = winds.into_iter().map(|wind| {
            let mask = vertex_mask(&wind.region, cloths);
            (wind, mask)
        });
        let masses = cloths.iter().flat_map(|cloth| cloth.masses.iter().copied());
        Self {
            pressures: Pressures::new(cloths),
            winds: winds.collect(),
            fields: Fields::new(masses.collect()),
            face_starts,
            corners,
            particle_starts,
            faces_of,
        }
    }

    pub(crate) fn is_still(&self) -> bool {
        self.winds.is_empty() && self.fields.is_empty() && self.pressures.is_empty()
    }

    /// Takes these fields in the place of those before.
    pub(crate) fn set_fields(&mut self, fields: Vec<Field>) {
        self.fields.set(fields);
    }

    /// Lets a wind blow with this velocity (m/s) from now on.
    pub(crate) fn set_wind_velocity(&mut self, wind: usize, velocity: Vector) {
        self.winds[wind].0.velocity = velocity;
    }

    /// The velocities (m/s) of the winds.
    pub(crate) fn wind_velocities(&self) -> impl ExactSizeIterator<Item = Vector> {
        self.winds.iter().map(|(wind, _)| wind.velocity)
    }

    /// How many winds blow.
    pub(crate) fn wind_count(&self) -> usize {
        self.winds.len()
    }

    pub(crate) fn fields(&self) -> &[Field] {
        self.fields.each()
    }

    /// Begins the frame after this one.
    pub(crate) fn start_frame(&mut self, frame: i32) {
        self.fields.start_frame(frame);
    }

    /// Begins the steps of a frame, of h seconds each.
    pub(crate) fn start_steps(&mut self, h: f64, is_implicit: bool) {
        self.fields.start_steps(h, is_implicit);
    }

    /// Largest damping (N·s/m) that the classic law puts on a particle.
    pub(crate) fn damping(&self) -> f64 {
        let coefficients = |of: Option<u32>| {
            let on_it = move |(wind, _): &&Blowing| match wind.region {
                Region::Cloth(cloth, _) => of == Some(cloth),
                _ => of.is_none(),
            };
            let each = self.winds.iter().filter(on_it).map(|(wind, _)| match wind.law {
                WindLaw::Vertex { coefficient } => coefficient,
                WindLaw::Face { .. } => 0.0,
            });
            each.sum::<f64>()
        };
        let own = self.winds.iter().filter_map(|(wind, _)| match wind.region {
            Region::Cloth(cloth, _) => Some(coefficients(Some(cloth))),
            _ => None,
        });
        coefficients(None) + own.fold(0.0, f64::max)
    }

    /// Damping (N·s/m) that winds and fields put on a particle, at most; as they were last observed.
    pub(crate) fn damping_of(&self, particle: usize, scratch: &AirScratch) -> f64 {
        let of_fields = scratch.pushed.get(particle).map_or(0.0, |pushed| pushed.damping);
        let of_wind = |wind: &Wind| match wind.law {
            WindLaw::Vertex { coefficient } => coefficient,
            WindLaw::Face { air_density } => {
                let of_face = |face: &FaceAir| {
                    let speed = (wind.velocity - face.velocity).dot(&face.normal);
                    face.corner_share * face.area * air_density * speed.abs()
                };
                self.faces_at(particle, scratch).map(of_face).sum()
            }
        };
        let blowing = self.winds.iter().filter(|(_, mask)| reaches(mask.as_ref(), particle));
        of_fields + blowing.map(|(wind, _)| of_wind(wind)).sum::<f64>()
    }

    /// Largest damping (1/s) and square of a frequency (1/s²) that fields put on a particle within so many seconds, in which
    /// other forces make it up to `gain` (m/s) faster than in `state`, and fields by what they push it with now.
    pub(crate) fn field_rates(
        &self,
        state: &State,
        inverse_masses: &[f64],
        [gain, seconds]: [f64; 2],
    ) -> [f64; 2] {
        if self.fields.is_empty() {
            return [0.0; 2];
        }
        let mut scratch = AirScratch::default();
        self.observe_flow(state, &mut scratch, gain);
        let pushes = scratch.pushed.iter().zip(inverse_masses);
        let pushes = pushes.map(|(pushed, w)| pushed.force.norm() * w);
        let gain = gain + seconds * pushes.fold(0.0, f64::max);
        self.observe_flow(state, &mut scratch, gain);
        let rates = scratch.pushed.iter().zip(inverse_masses);
        rates.fold([0.0; 2], |[damping, stiffness], (pushed, w)| {
            [f64::max(damping, pushed.damping * w), f64::max(stiffness, pushed.stiffness * w)]
        })
    }

    /// Largest damping (1/s) that pressure puts on a particle, with faces up to `gain` (m/s) faster than in `state`.
    ///
    /// The slope of `1/2 rho A s²` is `rho A s`. A step that is stable for it takes no more than the whole of s.
    pub(crate) fn pressure_damping(&self, state: &State, inverse_masses: &[f64], gain: f64) -> f64 {
        let pressing = self.winds.iter().filter_map(|(wind, mask)| match wind.law {
            WindLaw::Face { air_density } => Some((air_density, wind.velocity, mask.as_ref())),
            WindLaw::Vertex { .. } => None,
        });
        let pressing: Vec<_> = pressing.collect();
        if pressing.is_empty() {
            return 0.0;
        }
        let mut scratch = AirScratch::default();
        self.observe_flow(state, &mut scratch, 0.0);
        let share_of = |particle: usize, face: &FaceAir| {
            let blowing = pressing.iter().filter(|(.., mask)| reaches(*mask, particle));
            let slopes = blowing.map(|&(air_density, velocity, _)| {
                air_density * ((velocity - face.velocity).norm() + gain)
            });
            slopes.sum::<f64>() * face.area * face.corner_share
        };
        let damping_of = |particle: usize| {
            let faces = self.faces_at(particle, &scratch);
            faces.map(|face| share_of(particle, face)).sum::<f64>() * inverse_masses[particle]
        };
        (0..state.len()).map(damping_of).fold(0.0, f64::max)
    }

    /// Looks at every face in `state`, and where there are fields at every particle.
    pub(crate) fn observe(&self, state: &State, scratch: &mut AirScratch) {
        if self.winds.is_empty() && self.fields.is_empty() {
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
        scratch.faces.resize(self.face_starts.len() - 1, FaceAir::default());
        scratch.faces.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(|(face, air)| {
            *air = self.face_air(face, state);
        });
        let count = if self.fields.is_empty() { 0 } else { state.len() };
        let mut pushed = std::mem::take(&mut scratch.pushed);
        pushed.resize(count, Pushed::default());
        pushed.par_iter_mut().with_min_len(CHUNK / 8).enumerate().for_each(|(particle, pushed)| {
            let motion = [state.position.get(particle), state.velocity.get(particle)];
            *pushed = self.fields.push(particle, motion, self.faces_at(particle, scratch), gain);
        });
        scratch.pushed = pushed;
    }

    /// The faces around a particle, as they were last observed.
    fn faces_at<'a>(
        &'a self,
        particle: usize,
        scratch: &'a AirScratch,
    ) -> impl Iterator<Item = &'a FaceAir> + Clone {
        let starts =
            self.particle_starts[particle] as usize..self.particle_starts[particle + 1] as usize;
        self.faces_of[starts].iter().map(|&face| &scratch.faces[face as usize])
    }

    fn face_air(&self, face: usize, state: &State) -> FaceAir {
        let corners =
            &self.corners[self.face_starts[face] as usize..self.face_starts[face + 1] as usize];
        let origin = state.position.get(corners[0] as usize);
        let spans = corners[1..].windows(2);
        let vector_area = spans.fold(Vector::zeros(), |sum, pair| {
            let a = state.position.get(pair[0] as usize) - origin;
            let b = state.position.get(pair[1] as usize) - origin;
            sum + 0.5 * a.cross(&b)
        });
        let area = vector_area.norm();
        let corner_share = 1.0 / corners.len() as f64;
        let velocity = corners.iter().map(|&corner| state.velocity.get(corner as usize));
        FaceAir {
            normal: if area > 0.0 { vector_area / area } else { Vector::zeros() },
            area,
            velocity: velocity.sum::<Vector>() * corner_share,
            corner_share,
        }
    }

    /// Adds the forces (N) of winds, fields and pressure on the particles of a chunk.
    pub(crate) fn add_forces(
        &self,
        chunk: usize,
        state: &State,
        scratch: &AirScratch,
        force: &mut ChunkVectors,
    ) {
        let first = chunk * CHUNK;
        for particle in first..(first + CHUNK).min(state.len()) {
            let mut push = self.force_on(particle, state, scratch);
            if let Some(pressure) = scratch.pressure.force(particle) {
                push += pressure;
            }
            for axis in 0..3 {
                force[axis][particle - first] += push[axis];
            }
        }
    }

    fn force_on(&self, particle: usize, state: &State, scratch: &AirScratch) -> Vector {
        let faces = self.faces_at(particle, scratch);
        let position = state.position.get(particle);
        let velocity = state.velocity.get(particle);
        let mut force = scratch.pushed.get(particle).map_or(Vector::zeros(), |pushed| pushed.force);
        for (wind, mask) in &self.winds {
            let blows = match &wind.region {
                Region::Box(region) => region.contains(&position),
                _ => reaches(mask.as_ref(), particle),
            };
            if !blows {
                continue;
            }
            match wind.law {
                WindLaw::Vertex { coefficient } => {
                    let sum: Vector = faces.clone().map(|face| face.normal).sum();
                    let normal = sum.try_normalize(1e-12).unwrap_or_else(Vector::zeros);
                    force += coefficient * (wind.velocity - velocity).dot(&normal) * normal;
                }
                WindLaw::Face { air_density } => {
                    for face in faces.clone() {
                        let speed = (wind.velocity - face.velocity).dot(&face.normal);
                        let pressure = 0.5 * air_density * speed.abs() * speed;
                        force += face.corner_share * face.area * pressure * face.normal;
                    }
                }
            }
        }
        force
    }
}

/// Whether a wind with a mask blows on a particle; without one it may, wherever it is.
fn reaches(mask: Option<&Vec<bool>>, particle: usize) -> bool {
    mask.is_none_or(|mask| mask[particle])
}
