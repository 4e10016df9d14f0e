//! Pressure inside a cloth, along its faces' normals.
//!
//! ```text
//! p   = uniform + factor (V0/V - 1)                                   (N/m²)
//! V   = 1/3 sum_f (c_f - m)·S_f                                       (m³)
//! F_i = p w_i sum_f [ (a_i + a_(i-1))/3 + S_f/(3 n) ]                 (N)
//! ```
//!
//! for faces f of n corners, middle `c_f` and vector area `S_f`, cut into the triangles of their middle and a side, of vector
//! areas `a_i`: a triangle gives p S/3 to each of its corners. m is the middle of the cloth, so that the volume of an open
//! mesh does not depend on where it lies: its holes count as if they were closed by cones to m. V0 is the target volume, or
//! the volume of the rest shape; where it is 0 or less, the volume does not count, and a target of 0 says so. The factor is
//! the pressure of the air around a filling of fixed mass and temperature that is at rest at V0.
//!
//! On a closed mesh with equal weights w, `F = p dV/dx`, and all forces together are zero. Faces with a corner of weight 0 do
//! not count for the volume.
//!
//! In an implicit step p is taken at the present guess, and `-dp/dV F F^T/p²` is part of H: a volume resists as one. What
//! turning faces add is left out; it is small beside the tension that holds the pressure.
//!
//! Source: the law is that of Blender's cloth.

use boucle_geometry::Vector;
use rayon::prelude::*;

use super::filling::{Filling, LEAST_VOLUME, Level, share_out};
use crate::cloth::{Cloth, placed};
use crate::error::{Error, Result};
use crate::kernel::CHUNK;
use crate::state::State;

/// Largest pressure (N/m²) and volume (m³) that are taken.
const MOST: f64 = 1e12;

/// What inflates a cloth.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pressure {
    /// The part of the pressure that does not depend on the volume (N/m²); below 0 it sucks.
    pub uniform: f64,
    /// How much pressure (N/m²) twice the density of the filling adds.
    pub factor: f64,
    /// The volume (m³) at which the filling and the air around it balance; that of the rest shape if `None`, and 0 for a
    /// pressure that does not depend on the volume.
    pub target_volume: Option<f64>,
    /// For each vertex, which part of the pressure acts on it; all of it if empty.
    pub weights: Vec<f64>,
}

impl Pressure {
    /// Refuses values outside their domains, for a cloth of a name and so many vertices.
    pub(crate) fn check(&self, cloth: &str, vertices: usize) -> Result<()> {
        let Self { uniform, factor, target_volume, weights } = self;
        let refuse = |what: &str, value: f64, domain| {
            let quantity = format!("cloth \"{cloth}\": pressure {what}");
            Err(Error::OutOfDomain { quantity, value, domain })
        };
        if !(uniform.abs() <= MOST) {
            return refuse("uniform (N/m²)", *uniform, "-1e12 to 1e12");
        }
        if !(0.0..=MOST).contains(factor) {
            return refuse("factor (N/m²)", *factor, "0 to 1e12");
        }
        if let Some(volume) = target_volume.filter(|volume| !(0.0..=MOST).contains(volume)) {
            return refuse("target_volume (m³)", volume, "0 to 1e12");
        }
        if !weights.is_empty() && weights.len() != vertices {
            let given = weights.len();
            let reason =
                format!("{given} weights of pressure are given; accepted: {vertices} or none");
            return Err(Error::BadCloth { cloth: cloth.to_owned(), reason });
        }
        match weights.iter().find(|weight| !(0.0..=1.0).contains(*weight)) {
            Some(&weight) => refuse("weight", weight, "0 to 1"),
            None => Ok(()),
        }
    }
}

/// The pressures of all cloths.
#[derive(Debug, Default)]
pub(crate) struct Pressures {
    fillings: Vec<Filling>,
    face_starts: Vec<u32>,
    corners: Vec<u32>,
    /// For each particle, where its corners begin in `corners_of`, and the end of the last.
    particle_starts: Vec<u32>,
    corners_of: Vec<u32>,
}

/// What pressure does in one state.
#[derive(Debug, Default)]
pub(crate) struct PressureScratch {
    /// For each corner, its share (m²) of the vector area of its face.
    shares: Vec<Vector>,
    /// For each particle, the force (N).
    forces: Vec<Vector>,
    /// For each filling, p (N/m²) and -dp/dV (N/m⁵).
    levels: Vec<[f64; 2]>,
}

impl PressureScratch {
    /// The force (N) on a particle, as last observed.
    pub(crate) fn force(&self, particle: usize) -> Option<&Vector> {
        self.forces.get(particle)
    }
}

impl Pressures {
    pub(crate) fn new(cloths: &[Cloth]) -> Self {
        if cloths.iter().all(|cloth| cloth.pressure.is_none()) {
            return Self::default();
        }
        let particle_count: usize = cloths.iter().map(|cloth| cloth.positions.len()).sum();
        let (mut face_starts, mut corners, mut fillings) = (vec![0], Vec::new(), Vec::new());
        for (index, (cloth, base)) in placed(cloths).enumerate() {
            let Some(pressure) = &cloth.pressure else { continue };
            let first_face = face_starts.len() - 1;
            let weight = |vertex: u32| pressure.weights.get(vertex as usize).map_or(1.0, |w| *w);
            let mut counts = Vec::with_capacity(cloth.mesh.face_count());
            for face in cloth.mesh.faces() {
                corners.extend(face.iter().map(|vertex| vertex + base));
                face_starts.push(corners.len() as u32);
                counts.push(face.iter().all(|&vertex| weight(vertex) > 0.0));
            }
            let count = cloth.positions.len();
            let mut filling = Filling {
                cloth: index,
                first: base as usize,
                count,
                faces: first_face..face_starts.len() - 1,
                counts,
                weights: (0..count as u32).map(weight).collect(),
                rest_volume: 0.0,
                from: [0.0; 3],
                to: [0.0; 3],
                now: [0.0; 3],
            };
            let faces = |face: usize| cloth.mesh.face(face - first_face).iter().copied();
            let rest = cloth.rest();
            filling.rest_volume =
                filling.volume(faces, |vertex| rest[vertex as usize], rest.iter());
            filling.to = filling.level(pressure.uniform, pressure.factor, pressure.target_volume);
            (filling.from, filling.now) = (filling.to, filling.to);
            fillings.push(filling);
        }
        let mut of_particle = vec![Vec::new(); particle_count];
        for (number, &corner) in corners.iter().enumerate() {
            of_particle[corner as usize].push(number as u32);
        }
        let mut particle_starts = vec![0];
        particle_starts.extend(of_particle.iter().scan(0, |end, corners| {
            *end += corners.len() as u32;
            Some(*end)
        }));
        let corners_of = of_particle.concat();
        Self { fillings, face_starts, corners, particle_starts, corners_of }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.fillings.is_empty()
    }

    /// Sends the pressure of a cloth, if it has one, to other values by the end of the next frame.
    pub(crate) fn aim(&mut self, cloth: usize, uniform: f64, factor: f64, target: Option<f64>) {
        for filling in self.fillings.iter_mut().filter(|filling| filling.cloth == cloth) {
            filling.to = filling.level(uniform, factor, target);
        }
    }

    /// Takes the values after a part of the frame.
    pub(crate) fn put(&mut self, part: f64) {
        for Filling { from, to, now, .. } in &mut self.fillings {
            // What arrives is exactly there; between a volume that counts and none there is nothing.
            let jumps = (from[2] > 0.0) != (to[2] > 0.0);
            let is_there = part >= 1.0 || (jumps && part > 0.0);
            let mix = |i: usize| if is_there { to[i] } else { from[i] + part * (to[i] - from[i]) };
            *now = std::array::from_fn(mix);
        }
    }

    /// Ends the frame: what it led to is where the next begins.
    pub(crate) fn arrive(&mut self) {
        for filling in &mut self.fillings {
            (filling.from, filling.now) = (filling.to, filling.to);
        }
    }

    /// The values of each cloth that has any, as the frame begins and as it ends.
    pub(crate) fn levels(&self) -> impl Iterator<Item = [Level; 2]> {
        self.fillings.iter().map(|filling| [filling.from, filling.to])
    }

    /// Takes up such values.
    pub(crate) fn restore(&mut self, levels: &[[Level; 2]]) {
        for (filling, [from, to]) in self.fillings.iter_mut().zip(levels) {
            (filling.from, filling.to) = (*from, *to);
        }
        self.put(0.0);
    }

    fn corners_of_face(&self, face: usize) -> impl Iterator<Item = u32> + Clone {
        let corners = self.face_starts[face] as usize..self.face_starts[face + 1] as usize;
        self.corners[corners].iter().copied()
    }

    /// The present volume (m³) of a filling.
    fn volume_of(&self, filling: &Filling, state: &State) -> f64 {
        let at = |particle: usize| state.position.get(particle);
        let particles = filling.first..filling.first + filling.count;
        let all: Vec<Vector> = particles.map(at).collect();
        let faces = |face| self.corners_of_face(face);
        filling.volume(faces, |particle| at(particle as usize), all.iter())
    }

    /// Looks at every face in `state`, and finds all forces (N).
    pub(crate) fn observe(&self, state: &State, scratch: &mut PressureScratch) {
        self.observe_at(state, scratch, Filling::at);
    }

    /// The same with p (N/m²) and `-dp/dV` (N/m⁵) as told for a volume (m³).
    fn observe_at(
        &self,
        state: &State,
        scratch: &mut PressureScratch,
        at: impl Fn(&Filling, f64) -> [f64; 2],
    ) {
        let PressureScratch { shares, forces, levels } = scratch;
        shares.resize(self.corners.len(), Vector::zeros());
        forces.resize(state.len(), Vector::zeros());
        levels.clear();
        levels.extend(self.fillings.iter().map(|each| at(each, self.volume_of(each, state))));
        let mut tasks = Vec::new();
        let mut rest = &mut shares[..];
        let face_count = self.face_starts.len() - 1;
        for first in (0..face_count).step_by(CHUNK) {
            let end = (first + CHUNK).min(face_count);
            let count = (self.face_starts[end] - self.face_starts[first]) as usize;
            let (own, others) = rest.split_at_mut(count);
            rest = others;
            tasks.push((first..end, own));
        }
        tasks.into_par_iter().for_each(|(faces, mut shares)| {
            for face in faces {
                let corners: Vec<Vector> =
                    self.corners_of_face(face).map(|p| state.position.get(p as usize)).collect();
                let (own, others) = std::mem::take(&mut shares).split_at_mut(corners.len());
                share_out(&corners, own);
                shares = others;
            }
        });
        for (filling, [pressure, _]) in self.fillings.iter().zip(&*levels) {
            let particles = filling.first..filling.first + filling.count;
            let own = forces[particles].par_iter_mut().zip(&filling.weights);
            own.with_min_len(CHUNK).enumerate().for_each(|(vertex, (force, weight))| {
                let particle = filling.first + vertex;
                let corners = self.particle_starts[particle] as usize
                    ..self.particle_starts[particle + 1] as usize;
                let corners = self.corners_of[corners].iter();
                let area: Vector = corners.map(|&corner| shares[corner as usize]).sum();
                *force = *pressure * *weight * area;
            });
        }
    }

    /// For each filling: its particles, `-dp/dV` (N/m⁵), and at each particle the weighted area (m²) on which it presses, of
    /// those whose pressure changes with their volume; as last observed.
    pub(crate) fn stiff<'a>(
        &'a self,
        scratch: &'a PressureScratch,
    ) -> impl Iterator<Item = (std::ops::Range<usize>, f64, impl Fn(usize) -> Vector + 'a)> {
        let fillings = self.fillings.iter().zip(&scratch.levels);
        fillings.filter(|(_, level)| level[1] > 0.0).map(move |(filling, &[_, slope])| {
            let area = move |particle: usize| {
                let corners = self.particle_starts[particle] as usize
                    ..self.particle_starts[particle + 1] as usize;
                let corners = self.corners_of[corners].iter();
                let area: Vector = corners.map(|&corner| scratch.shares[corner as usize]).sum();
                filling.weights[particle - filling.first] * area
            };
            (filling.first..filling.first + filling.count, slope, area)
        })
    }

    /// The largest w² (1/s²) that pressures add to a state's oscillators at any time of the frame.
    pub(crate) fn stiffness(&self, state: &State, inverse_masses: &[f64]) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let mut scratch = PressureScratch::default();
        self.observe_at(state, &mut scratch, Filling::most_at);
        let as_one = self.stiff(&scratch).map(|(particles, slope, area)| {
            let each =
                particles.map(|particle| inverse_masses[particle] * area(particle).norm_squared());
            slope * each.sum::<f64>()
        });
        // Faces that turn: of a triangle, p/2 times its longest side between its corners.
        let turning = self.fillings.iter().zip(&scratch.levels).map(|(filling, [pressure, _])| {
            let particles = filling.first..filling.first + filling.count;
            let most = particles.map(|particle| {
                let corners = self.particle_starts[particle] as usize
                    ..self.particle_starts[particle + 1] as usize;
                let corners = self.corners_of[corners].iter();
                let sides: f64 = corners.map(|&c| scratch.shares[c as usize].norm().sqrt()).sum();
                inverse_masses[particle] * sides
            });
            2.0 * pressure.abs() * most.fold(0.0, f64::max)
        });
        as_one.fold(0.0, f64::max) + turning.fold(0.0, f64::max)
    }

    /// The energy (J) of the fillings of some cloths: what they have yet to give, less what they had at V0.
    pub(crate) fn energy(&self, cloths: std::ops::Range<usize>, state: &State) -> f64 {
        let own = self.fillings.iter().filter(|filling| cloths.contains(&filling.cloth));
        let each = own.map(|filling| {
            let [uniform, factor, balance] = filling.now;
            let volume = self.volume_of(filling, state);
            if balance <= 0.0 {
                return -uniform * volume;
            }
            let volume = volume.max(LEAST_VOLUME * balance);
            -uniform * (volume - balance)
                - factor * (balance * (volume / balance).ln() - (volume - balance))
        });
        each.sum()
    }

    /// The present volume (m³) of a cloth that has a pressure.
    pub(crate) fn volume(&self, cloth: usize, state: &State) -> Option<f64> {
        let filling = self.fillings.iter().find(|filling| filling.cloth == cloth)?;
        Some(self.volume_of(filling, state))
    }
}
