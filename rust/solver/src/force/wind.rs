//! Wind: the air pushes along the cloth's normal.
//!
//! For wind velocity u (m/s), a particle's velocity v and its normal n, the mean of its faces' normals:
//!
//! ```text
//! F = kw ((u - v)·n) n                            (N)  on each particle: the classic law
//! F = 1/2 rho A |(u - v)·n| ((u - v)·n) n         (N)  on each face of area A, drag coefficient 1
//! ```
//!
//! The force of a face is shared equally by its corners. A region limits the wind to a box in space, where a
//! particle feels it while it is inside, or to some vertices.
//!
//! Source: Provot 1995 for the first law; the second is the pressure of a flow on a plate.

use boucle_geometry::{Aabb, Vector};
use rayon::prelude::*;

use super::{PressureScratch, Pressures};
use crate::cloth::Cloth;
use crate::error::{Error, Result};
use crate::kernel::{CHUNK, ChunkVectors};
use crate::material::at_least_zero;
use crate::state::State;

/// How wind becomes force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WindLaw {
    /// By particle, the classic law.
    Vertex {
        /// Force of a particle for each unit of wind speed (N·s/m).
        coefficient: f64,
    },
    /// By face: pressure of the flow.
    Face {
        /// Density of the air (kg/m³).
        air_density: f64,
    },
}

/// Where wind blows.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// Everywhere.
    Everywhere,
    /// Inside a box in space.
    Box(Aabb),
    /// On these vertices of every cloth.
    Vertices(Vec<u32>),
}

/// A steady wind.
#[derive(Clone, Debug, PartialEq)]
pub struct Wind {
    /// Velocity of the air (m/s).
    pub velocity: Vector,
    /// How it becomes force.
    pub law: WindLaw,
    /// Where it blows.
    pub region: Region,
}

impl Wind {
    /// Refuses values outside their domains.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] or [`Error::BadCloth`] for the first thing that is not accepted.
    pub fn check(&self, cloths: &[Cloth]) -> Result<()> {
        match self.law {
            WindLaw::Vertex { coefficient } => {
                at_least_zero("wind coefficient (N·s/m)", coefficient)?;
            }
            WindLaw::Face { air_density } => at_least_zero("air_density (kg/m³)", air_density)?,
        }
        if let Some(&speed) = self.velocity.iter().find(|speed| !(speed.abs() <= 1e4)) {
            return Err(Error::OutOfDomain {
                quantity: "wind velocity (m/s)".to_owned(),
                value: speed,
                domain: "-1e4 to 1e4",
            });
        }
        let Region::Vertices(vertices) = &self.region else { return Ok(()) };
        for cloth in cloths {
            let count = cloth.positions.len();
            if let Some(vertex) = vertices.iter().find(|&&vertex| vertex as usize >= count) {
                return Err(Error::BadCloth {
                    cloth: cloth.name.clone(),
                    reason: format!(
                        "the wind's region names vertex {vertex}; accepted: 0 to {}",
                        count - 1
                    ),
                });
            }
        }
        Ok(())
    }
}

/// All winds, and what they need to know of the meshes.
#[derive(Debug)]
pub(crate) struct Air {
    pub(crate) pressures: Pressures,
    winds: Vec<(Wind, Option<Vec<bool>>)>,
    /// Corners of all faces, in the simulation's numbering.
    face_starts: Vec<u32>,
    corners: Vec<u32>,
    /// For each particle, where its faces begin in `faces_of`, and the end of the last.
    particle_starts: Vec<u32>,
    faces_of: Vec<u32>,
}

/// What the air does to each face in the present state.
#[derive(Debug, Default)]
pub(crate) struct AirScratch {
    pub(crate) pressure: PressureScratch,
    faces: Vec<FaceAir>,
}

#[derive(Clone, Copy, Debug, Default)]
struct FaceAir {
    /// Unit normal, or zero for a face without area.
    normal: Vector,
    area: f64,
    velocity: Vector,
    corner_share: f64,
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
        let (winds, pressures) = (winds.collect(), Pressures::new(cloths));
        Self { pressures, winds, face_starts, corners, particle_starts, faces_of }
    }

    pub(crate) fn is_still(&self) -> bool {
        self.winds.is_empty() && self.pressures.is_empty()
    }

    /// Largest damping (N·s/m) that the classic law puts on a particle.
    pub(crate) fn damping(&self) -> f64 {
        let coefficients = self.winds.iter().map(|(wind, _)| match wind.law {
            WindLaw::Vertex { coefficient } => coefficient,
            WindLaw::Face { .. } => 0.0,
        });
        coefficients.sum()
    }

    /// Damping (N·s/m) that winds put on a particle, at most; faces as they were last observed.
    pub(crate) fn damping_of(&self, particle: usize, scratch: &AirScratch) -> f64 {
        let of_wind = |wind: &Wind| match wind.law {
            WindLaw::Vertex { coefficient } => coefficient,
            WindLaw::Face { air_density } => {
                let starts = self.particle_starts[particle] as usize
                    ..self.particle_starts[particle + 1] as usize;
                let faces = self.faces_of[starts].iter();
                let of_face = |&face: &u32| {
                    let face = &scratch.faces[face as usize];
                    let speed = (wind.velocity - face.velocity).dot(&face.normal);
                    face.corner_share * face.area * air_density * speed.abs()
                };
                faces.map(of_face).sum()
            }
        };
        self.winds.iter().map(|(wind, _)| of_wind(wind)).sum()
    }

    /// Largest damping (1/s) that pressure puts on a particle, with faces up to `gain` (m/s) faster than in `state`.
    ///
    /// The slope of `1/2 rho A s²` is `rho A s`. A step that is stable for it takes no more than the whole of s.
    pub(crate) fn pressure_damping(&self, state: &State, inverse_masses: &[f64], gain: f64) -> f64 {
        let pressing = self.winds.iter().filter_map(|(wind, _)| match wind.law {
            WindLaw::Face { air_density } => Some((air_density, wind.velocity)),
            WindLaw::Vertex { .. } => None,
        });
        let pressing: Vec<_> = pressing.collect();
        if pressing.is_empty() {
            return 0.0;
        }
        let mut scratch = AirScratch::default();
        self.observe_wind(state, &mut scratch);
        let share_of = |face: &FaceAir| {
            let slopes = pressing.iter().map(|&(air_density, velocity)| {
                air_density * ((velocity - face.velocity).norm() + gain)
            });
            slopes.sum::<f64>() * face.area * face.corner_share
        };
        let damping_of = |particle: usize| {
            let starts = self.particle_starts[particle] as usize
                ..self.particle_starts[particle + 1] as usize;
            let faces = self.faces_of[starts].iter().map(|&face| &scratch.faces[face as usize]);
            faces.map(share_of).sum::<f64>() * inverse_masses[particle]
        };
        (0..state.len()).map(damping_of).fold(0.0, f64::max)
    }

    /// Looks at every face in `state`.
    pub(crate) fn observe(&self, state: &State, scratch: &mut AirScratch) {
        if !self.winds.is_empty() {
            self.observe_wind(state, scratch);
        }
        if !self.pressures.is_empty() {
            self.pressures.observe(state, &mut scratch.pressure);
        }
    }

    fn observe_wind(&self, state: &State, scratch: &mut AirScratch) {
        scratch.faces.resize(self.face_starts.len() - 1, FaceAir::default());
        scratch.faces.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(|(face, air)| {
            *air = self.face_air(face, state);
        });
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

    /// Adds the forces (N) of wind and pressure on the particles of a chunk.
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
        let starts =
            self.particle_starts[particle] as usize..self.particle_starts[particle + 1] as usize;
        let faces = self.faces_of[starts].iter().map(|&face| &scratch.faces[face as usize]);
        let position = state.position.get(particle);
        let velocity = state.velocity.get(particle);
        let mut force = Vector::zeros();
        for (wind, mask) in &self.winds {
            let blows = match &wind.region {
                Region::Everywhere => true,
                Region::Box(region) => region.contains(&position),
                Region::Vertices(_) => mask.as_ref().is_some_and(|mask| mask[particle]),
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

/// Which particles a region of vertices holds.
fn vertex_mask(region: &Region, cloths: &[Cloth]) -> Option<Vec<bool>> {
    let Region::Vertices(vertices) = region else { return None };
    let mut mask = Vec::new();
    for cloth in cloths {
        let base = mask.len();
        mask.resize(base + cloth.positions.len(), false);
        for &vertex in vertices {
            mask[base + vertex as usize] = true;
        }
    }
    Some(mask)
}
