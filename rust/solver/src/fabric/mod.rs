//! Cloth as a continuum: triangles that resist strain (N/m), hinges between them that resist bending (N·m).
//!
//! Read [`membrane`] for the triangles, [`hinge`] for the angle of two of them, [`compliance`] for how faces share it, [`steps`]
//! and [`variation`] for what that leaves out, [`creases`] for bending that stays. [`elements`] are all of them from a mesh at rest;
//! [`observed`] and [`tangent`] are what they do in one state, to forces and to an implicit step.
//!
//! Damping is proportional to stiffness, by a time t for each kind: with z the damping ratio at a wave of 0.1 m and w its
//! frequency, from Y and G (N/m) and B (N·m) at the geometric mean of warp and weft, and the areal density rho (kg/m²),
//!
//! ```text
//! t = 2 z/w      w = q sqrt(Y/rho), q sqrt(G/rho), q² sqrt(B/rho)      q = 2 pi/0.1 m
//! ```
//!
//! Forces are evaluated in f64, eight triangles or hinges at a time, and each chunk of particles sums its own in a fixed
//! order; what reaches over the border of a chunk is computed on both sides.

mod compliance;
mod coupling;
#[cfg(test)]
mod crease_tests;
mod creases;
mod elements;
mod hinge;
mod hinges;
mod material;
mod membrane;
mod observed;
mod packs;
mod rows;
mod steps;
mod tangent;
#[cfg(test)]
mod tests;
mod triangles;
mod variation;

pub(crate) use creases::{CREASE, Crease};
pub(crate) use elements::edges;
pub use material::{Fabric, Warp};
pub(crate) use observed::FabricScratch;
pub(crate) use tangent::{FabricProduct, Moments, Tangent};

use std::f64::consts::TAU;
use std::ops::Range;

use boucle_geometry::Vector;
use pulp::Arch;

use crate::cloth::{Cloth, placed};
use crate::grouped::Grouped;
use crate::kernel::CHUNK;
use crate::law::Spring;
use crate::state::State;
use compliance::{Compliance, Face};
use coupling::Couplings;
use creases::Yielding;
use elements::{Elements, Hinge};
use hinges::HingePack;
use membrane::{MembraneLaw, Triangle};
use packs::LANES;
use triangles::TrianglePack;

/// The wavelength (m) at which damping ratios hold.
const DAMPED_WAVELENGTH: f64 = 0.1;

/// The least height of a triangle whose rest lengths are changed, as a part of a side.
const FLATTEST: f64 = 1e-3;

/// All fabrics among the cloths.
#[derive(Debug)]
pub(crate) struct Fabrics {
    laws: Vec<MembraneLaw>,
    /// For each law, the time (s) by which the bending stiffness is multiplied to damp.
    bend_times: Vec<f64>,
    triangles: Vec<Triangle>,
    /// In the order of the triangles.
    faces: Vec<Face>,
    /// Of each triangle, the springs of its cloth that are its sides.
    sides: Vec<[u32; 3]>,
    hinges: Vec<Hinge>,
    /// What belongs to each cloth.
    parts: Vec<Part>,
    /// Faces that do not bend, as all their corners are pinned.
    is_rigid: Vec<bool>,
    compliance: Compliance,
    couplings: Couplings,
    yielding: Yielding,
    /// Triangles and hinges as they are computed: side by side.
    triangle_packs: Vec<TrianglePack>,
    hinge_packs: Vec<HingePack>,
    /// For each chunk of particles, the packs that reach into it.
    triangle_packs_of: Grouped<u32>,
    hinge_packs_of: Grouped<u32>,
    arch: Arch,
}

/// The triangles and hinges of one cloth.
#[derive(Clone, Debug)]
struct Part {
    triangles: Range<usize>,
    hinges: Range<usize>,
}

impl Fabrics {
    pub(crate) fn new(cloths: &[Cloth]) -> Self {
        let (mut laws, mut bend_times, mut parts) = (Vec::new(), Vec::new(), Vec::new());
        let (mut elements, mut yielding) = (Elements::default(), Yielding::default());
        for (cloth, base) in placed(cloths) {
            let [first, first_hinge] = [elements.triangles.len(), elements.hinges.len()];
            if let Some(fabric) = &cloth.fabric {
                elements.add(cloth, fabric, base, laws.len() as u32);
                let area: f64 = elements.triangles[first..].iter().map(|one| one.area).sum();
                let density = cloth.masses.iter().sum::<f64>() / area;
                let [stretch, shear, bend] = damping_times(fabric, density);
                laws.push(MembraneLaw::new(fabric, [stretch, shear]));
                bend_times.push(bend);
                yielding.add(fabric, &elements.faces[first..], first);
            }
            let triangles = first..elements.triangles.len();
            parts.push(Part { triangles, hinges: first_hinge..elements.hinges.len() });
        }
        let count: usize = cloths.iter().map(|cloth| cloth.positions.len()).sum();
        let chunks = count.div_ceil(CHUNK);
        let Elements { triangles, faces, sides, hinges } = elements;
        yielding.link(hinges.len());
        let compliance = Compliance::new(hinges.len(), &faces, |_| false);
        let mut couplings = Couplings::new(&triangles, &hinges);
        couplings.follow(&hinges, &compliance, &bend_times);
        let triangle_packs = TrianglePack::all(&triangles);
        let hinge_packs = HingePack::all(&hinges, &bend_times);
        let in_triangle_packs = triangle_packs.iter().map(|pack| {
            let own = &triangles[pack.first..pack.first + pack.count];
            own.iter().flat_map(|one| one.corners).collect()
        });
        let in_hinge_packs =
            hinges.chunks(LANES).map(|own| own.iter().flat_map(|one| one.corners).collect());
        Self {
            triangle_packs_of: reaching(chunks, in_triangle_packs),
            hinge_packs_of: reaching(chunks, in_hinge_packs),
            laws,
            bend_times,
            is_rigid: vec![false; faces.len()],
            compliance,
            couplings,
            yielding,
            triangle_packs,
            hinge_packs,
            triangles,
            faces,
            sides,
            hinges,
            parts,
            arch: Arch::new(),
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Takes up which particles are pinned: a face between three of them does not bend.
    pub(crate) fn follow_pins(&mut self, is_pinned: impl Fn(usize) -> bool) {
        let is_rigid =
            |one: &Triangle| one.corners.iter().all(|&corner| is_pinned(corner as usize));
        let is_rigid: Vec<bool> = self.triangles.iter().map(is_rigid).collect();
        if is_rigid == self.is_rigid {
            return;
        }
        self.is_rigid = is_rigid;
        self.compliance =
            Compliance::new(self.hinges.len(), &self.faces, |face| self.is_rigid[face]);
        self.couplings.follow(&self.hinges, &self.compliance, &self.bend_times);
        self.yielding.follow_pins(|face| self.is_rigid[face]);
        self.lay_creases();
    }

    /// How many hinges a cloth has.
    pub(crate) fn hinge_count(&self, cloth: usize) -> usize {
        self.parts[cloth].hinges.len()
    }

    /// The angles (rad) that a cloth's hinges have in a shape (m) of its vertices, numbered from `base`.
    pub(crate) fn angles_in<'a>(
        &'a self,
        cloth: usize,
        base: u32,
        shape: &'a [Vector],
    ) -> impl Iterator<Item = f64> + 'a {
        let hinges = self.hinges[self.parts[cloth].hinges.clone()].iter();
        hinges
            .map(move |one| hinge::angle(one.corners.map(|corner| shape[(corner - base) as usize])))
    }

    /// The angles (rad) at which a cloth's hinges are at rest.
    pub(crate) fn rest_angles(&self, cloth: usize) -> impl Iterator<Item = f64> {
        self.hinges[self.parts[cloth].hinges.clone()].iter().map(|one| one.rest_angle)
    }

    /// Takes the rest lengths (m) of a cloth's springs, which were given others, and the rest angles (rad) of its hinges.
    /// Compliance stays that of the faces as they were given.
    pub(crate) fn put_rest(
        &mut self,
        cloth: usize,
        springs: &[Spring],
        given: &[f64],
        angles: &[f64],
    ) {
        let Part { triangles, hinges } = self.parts[cloth].clone();
        for number in triangles {
            let sides = self.sides[number].map(|side| side as usize);
            let lengths = sides.map(|side| springs[side].rest_length);
            let Triangle { corners, law, .. } = self.triangles[number];
            // To the bit what it was where nothing has changed.
            let is_given = sides
                .iter()
                .zip(lengths)
                .all(|(&side, length)| length.to_bits() == given[side].to_bits());
            let given = self.faces[number].flat;
            let flat = if is_given { given } else { resized(given, lengths) };
            self.triangles[number] = Triangle::new(corners, flat, law);
        }
        for (one, angle) in self.hinges[hinges].iter_mut().zip(angles) {
            one.rest_angle = *angle;
        }
        self.triangle_packs = TrianglePack::all(&self.triangles);
        self.hinge_packs = HingePack::all(&self.hinges, &self.bend_times);
        self.lay_creases();
    }

    /// Lets creases form and friction slip wherever the cloth is bent beyond what it bears in a state: see [`creases`].
    pub(crate) fn give_way(&mut self, state: &State) {
        if self.yielding.is_empty() {
            return;
        }
        let Self { yielding, compliance, hinges, hinge_packs, arch, .. } = self;
        yielding.give_way(state, compliance, hinge_packs, |hinge| hinges[hinge].rest_angle, *arch);
    }

    /// What bending has left in each face that may yield.
    pub(crate) fn creases(&self) -> &[Crease] {
        &self.yielding.creases
    }

    /// The corners of each face that may yield, in the order of its creases.
    pub(crate) fn creased_faces(&self) -> impl Iterator<Item = [u32; 3]> {
        self.yielding.numbers().map(|number| self.triangles[number].corners)
    }

    /// The edge of each hinge of a cloth.
    pub(crate) fn hinge_edges(&self, cloth: usize) -> impl Iterator<Item = [u32; 2]> {
        self.hinges[self.parts[cloth].hinges.clone()].iter().map(|one| {
            let [a, b, _, _] = one.corners;
            [a.min(b), a.max(b)]
        })
    }

    /// Takes up what [`Self::creases`] gave.
    pub(crate) fn put_creases(&mut self, creases: &[Crease]) {
        self.yielding.creases.copy_from_slice(creases);
        self.lay_creases();
    }

    fn lay_creases(&mut self) {
        let Self { yielding, hinges, hinge_packs, .. } = self;
        yielding.lay(hinge_packs, |hinge| hinges[hinge].rest_angle);
    }

    /// The corners of each triangle of a cloth, and its largest stress over a width as that of its sides (N).
    pub(crate) fn tensions<'a>(
        &'a self,
        cloth: usize,
        state: &'a State,
    ) -> impl Iterator<Item = ([u32; 3], f64)> + 'a {
        self.triangles[self.parts[cloth].triangles.clone()].iter().map(|one| {
            let frame = one.frame(|corner| state.position.get(corner as usize));
            let stress = self.laws[one.law as usize].strained(frame).stress;
            (one.corners, membrane::largest(stress) * (2.0 * one.area).sqrt())
        })
    }

    /// The sides of each triangle of a cloth, the smaller particle first, the pull along them (N/m) and a width as that of its
    /// sides (m).
    pub(crate) fn side_stresses<'a>(
        &'a self,
        cloth: usize,
        state: &'a State,
    ) -> impl Iterator<Item = ([u32; 2], f64, f64)> + 'a {
        self.parts[cloth].triangles.clone().flat_map(|number| {
            let one = &self.triangles[number];
            let frame = one.frame(|corner| state.position.get(corner as usize));
            let strained = self.laws[one.law as usize].strained(frame);
            let width = (2.0 * one.area).sqrt();
            let (flat, corners) = (self.faces[number].flat, one.corners);
            [(0, 1), (1, 2), (2, 0)].map(|(i, j)| {
                let side = [0, 1].map(|axis| flat[j][axis] - flat[i][axis]);
                let [a, b] = [corners[i], corners[j]];
                ([a.min(b), a.max(b)], strained.pull_along(side), width)
            })
        })
    }

    /// The energy (J) of some cloths.
    pub(crate) fn energy(&self, cloths: Range<usize>, state: &State) -> f64 {
        let parts = &self.parts[cloths];
        let triangles = parts.iter().flat_map(|part| &self.triangles[part.triangles.clone()]);
        let of_membrane: f64 = triangles
            .map(|one| {
                let frame = one.frame(|corner| state.position.get(corner as usize));
                one.area * self.laws[one.law as usize].strained(frame).energy()
            })
            .sum();
        let angles = self.hinges.iter().enumerate().map(|(number, one)| {
            let at = one.corners.map(|corner| state.position.get(corner as usize));
            let rest = self.hinge_packs[number / LANES].rest_angles[number % LANES];
            hinge::the_shorter_way(hinge::angle(at) - rest)
        });
        let mut angles: Vec<f64> = angles.collect();
        angles.resize(LANES * self.hinge_packs.len(), 0.0);
        let mut moments = Vec::new();
        self.compliance.moments(&angles, &mut moments, &mut compliance::Scratch::default());
        let own = parts.iter().flat_map(|part| part.hinges.clone());
        let inner = parts.iter().map(|part| self.yielding.inner_energy(&part.triangles));
        of_membrane
            + own.map(|number| 0.5 * angles[number] * moments[number]).sum::<f64>()
            + inner.sum::<f64>()
    }

    /// Bounds of the bending stiffness and damping of any motion by its mass (1/s², 1/s), near the shape at rest.
    pub(crate) fn bending_bounds(&self, inverse_masses: &[f64]) -> [f64; 2] {
        let mut rows = vec![[0.0_f64; 2]; inverse_masses.len()];
        for (number, one) in self.hinges.iter().enumerate() {
            let stiffness = self.compliance.stiffest(number);
            let damping = self.bend_times[one.law as usize] * stiffness;
            let sum: f64 = one.weights.iter().map(|weight| weight.abs()).sum();
            for (&corner, weight) in one.corners.iter().zip(&one.weights) {
                let part = weight.abs() * sum * inverse_masses[corner as usize];
                let row = &mut rows[corner as usize];
                *row = [row[0] + part * stiffness, row[1] + part * damping];
            }
        }
        rows.iter().fold([0.0; 2], |most, row| [most[0].max(row[0]), most[1].max(row[1])])
    }

    /// The number of the edge between two particles, the smaller first.
    pub(crate) fn edge_between(&self, ends: [u32; 2]) -> Option<u32> {
        self.couplings.edges.binary_search(&ends).ok().map(|edge| edge as u32)
    }

    /// What each pair of particles weighs in the constant matrix, sorted by pair: stiffness (N/m) and damping (N·s/m).
    pub(crate) fn weights(&self) -> Vec<([u32; 2], [f64; 2])> {
        self.couplings.weights(&self.triangles, &self.laws)
    }
}

/// A triangle in its plane with other lengths (m) of its sides, whose first side keeps its direction. Lengths that make no
/// triangle make one that is nearly flat.
fn resized(flat: [[f64; 2]; 3], [ab, bc, ca]: [f64; 3]) -> [[f64; 2]; 3] {
    let [a, b, _] = flat;
    let [x, y] = [b[0] - a[0], b[1] - a[1]];
    let length = x.hypot(y);
    let [x, y] = [x / length, y / length];
    let along = (ab * ab + ca * ca - bc * bc) / (2.0 * ab);
    let across = (ca * ca - along * along).max((FLATTEST * ca).powi(2)).sqrt();
    [[0.0; 2], [ab * x, ab * y], [along * x - across * y, along * y + across * x]]
}

/// For each chunk of particles, the packs that reach into it, given their corners.
fn reaching(chunks: usize, packs: impl Iterator<Item = Vec<u32>>) -> Grouped<u32> {
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    for (number, corners) in packs.enumerate() {
        let mut own: Vec<u32> = corners.iter().map(|corner| corner / CHUNK as u32).collect();
        own.sort_unstable();
        own.dedup();
        pairs.extend(own.into_iter().map(|chunk| (chunk, number as u32)));
    }
    Grouped::new(chunks, pairs.into_iter())
}

/// The times (s) by which damping of stretch, shear and bend is proportional to their stiffness. A wave of length L has
/// `w = k sqrt(Y/density)` in the plane and `w = k² sqrt(B/density)` out of it, with `k = 2 pi/L`; of it a time t damps the
/// part `t w/2`.
fn damping_times(fabric: &Fabric, density: f64) -> [f64; 3] {
    let k = TAU / DAMPED_WAVELENGTH;
    let mean = |both: [f64; 2]| (both[0] * both[1]).sqrt();
    let speeds = [
        k * (mean(fabric.stretch) / density).sqrt(),
        k * (fabric.shear / density).sqrt(),
        k * k * (mean(fabric.holding_bend()) / density).sqrt(),
    ];
    let of = |(ratio, w): (f64, f64)| if w > 0.0 { 2.0 * ratio / w } else { 0.0 };
    let [a, b, c] = fabric.damping_ratio;
    [(a, speeds[0]), (b, speeds[1]), (c, speeds[2])].map(of)
}
