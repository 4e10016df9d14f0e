//! The faces of all cloths, as air and water meet them.

use boucle_geometry::Vector;
use rayon::prelude::*;

use crate::cloth::Cloth;
use crate::kernel::CHUNK;
use crate::state::State;

/// Which corners faces have, in the simulation's numbering, and which faces particles have.
#[derive(Debug)]
pub(super) struct Faces {
    starts: Vec<u32>,
    corners: Vec<u32>,
    /// For each particle, where its faces begin in `around`, and the end of the last.
    particle_starts: Vec<u32>,
    around: Vec<u32>,
}

/// A face in one state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FaceState {
    /// Unit normal, or zero for a face without area.
    pub(super) normal: Vector,
    /// m²
    pub(super) area: f64,
    /// Of its corners (m).
    pub(super) middle: Vector,
    /// Mean of its corners' (m/s).
    pub(super) velocity: Vector,
    /// What a corner takes of the whole.
    pub(super) corner_share: f64,
    /// The part of it that is under water.
    pub(super) immersed: f64,
}

impl Faces {
    pub(super) fn new(cloths: &[Cloth]) -> Self {
        let particle_count: usize = cloths.iter().map(|cloth| cloth.positions.len()).sum();
        let (mut starts, mut corners, mut base) = (vec![0], Vec::new(), 0);
        for cloth in cloths {
            for face in cloth.mesh.faces() {
                corners.extend(face.iter().map(|vertex| vertex + base));
                starts.push(corners.len() as u32);
            }
            base += cloth.positions.len() as u32;
        }
        let mut of_particle = vec![Vec::new(); particle_count];
        for face in 0..starts.len() - 1 {
            for &corner in &corners[starts[face] as usize..starts[face + 1] as usize] {
                of_particle[corner as usize].push(face as u32);
            }
        }
        let mut particle_starts = vec![0];
        particle_starts.extend(of_particle.iter().scan(0, |end, faces| {
            *end += faces.len() as u32;
            Some(*end)
        }));
        Self { starts, corners, particle_starts, around: of_particle.concat() }
    }

    pub(super) fn count(&self) -> usize {
        self.starts.len() - 1
    }

    pub(super) fn corners(&self, face: usize) -> &[u32] {
        &self.corners[self.starts[face] as usize..self.starts[face + 1] as usize]
    }

    /// The numbers of the faces around a particle.
    pub(super) fn around(&self, particle: usize) -> impl Iterator<Item = usize> + Clone + '_ {
        let starts =
            self.particle_starts[particle] as usize..self.particle_starts[particle + 1] as usize;
        self.around[starts].iter().map(|&face| face as usize)
    }

    /// Looks at every face in `state`.
    pub(super) fn observe(&self, state: &State, out: &mut Vec<FaceState>) {
        out.resize(self.count(), FaceState::default());
        out.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(|(face, out)| {
            *out = self.face(face, state);
        });
    }

    fn face(&self, face: usize, state: &State) -> FaceState {
        let corners = self.corners(face);
        let origin = state.position.get(corners[0] as usize);
        let spans = corners[1..].windows(2);
        let vector_area = spans.fold(Vector::zeros(), |sum, pair| {
            let a = state.position.get(pair[0] as usize) - origin;
            let b = state.position.get(pair[1] as usize) - origin;
            sum + 0.5 * a.cross(&b)
        });
        let area = vector_area.norm();
        let corner_share = 1.0 / corners.len() as f64;
        let mean = |of: &dyn Fn(usize) -> Vector| {
            corners.iter().map(|&corner| of(corner as usize)).sum::<Vector>() * corner_share
        };
        FaceState {
            normal: if area > 0.0 { vector_area / area } else { Vector::zeros() },
            area,
            middle: mean(&|corner| state.position.get(corner)),
            velocity: mean(&|corner| state.velocity.get(corner)),
            corner_share,
            immersed: 0.0,
        }
    }
}
