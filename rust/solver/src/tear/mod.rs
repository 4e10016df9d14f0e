//! Cloth that tears along its edges.
//!
//! An edge breaks that is pulled or strained beyond what it bears. What parts is the cloth across it: at one of its ends the
//! faces fall into two sides of the plane across the edge, and the edges between the sides are torn. A mesh whose edges are torn
//! is split wherever that parts the faces around a vertex: no face is lost, and only vertices are added.
//!
//! Source: the plane across the edge is that of Müller et al. 2007; masses, rest lengths and materials stay what they were.

mod carried;
mod fan;
mod pieces;
mod split;
#[cfg(test)]
mod tests;

pub(crate) use carried::Carried;
pub(crate) use fan::Fan;
pub(crate) use pieces::{pieces, spread};
pub(crate) use split::Split;

use crate::cloth::Cloth;
use crate::error::{Error, Result};
use crate::material::{at_least_zero, within_one};
use crate::scatter::scattered;

/// When a cloth tears.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tear {
    /// Tension (N) of an edge, its own spring's and its part of those beside it, beyond which it breaks; of fabric, the stress along it over a width as that of the triangle's
    /// sides. No tension breaks it if `None`.
    pub force: Option<f64>,
    /// Strain beyond which an edge breaks; none if `None`. If it is not below the deformation rate, the limiter does not act.
    pub strain: Option<f64>,
    /// Stress (N/m), tension over the width that an edge stands for, beyond which it breaks; none if `None`. Unlike a force it does
    /// not depend on how fine the mesh is, as long as the stress is smooth: at the end of a tear it is larger on finer meshes.
    pub stress: Option<f64>,
    /// By which part of them thresholds differ from edge to edge, up and down; 0 to 1.
    pub noise: f64,
    /// Chooses the random numbers.
    pub seed: u32,
    /// For each vertex, the part of the thresholds that holds there, 0 to 1; of an edge, the smaller of its ends' counts. All of
    /// it if empty.
    pub strength: Vec<f64>,
    /// Force (N) beyond which a seam comes undone; none if `None`.
    pub seam_force: Option<f64>,
    /// What opens by itself.
    pub openings: Vec<Opening>,
    /// The first frame at whose end anything tears; any if `None`.
    pub start: Option<i32>,
}

/// How an edge is loaded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Load {
    pub ends: [u32; 2],
    /// (N)
    pub tension: f64,
    pub strain: f64,
    /// (N/m)
    pub stress: f64,
}

/// Edges or seams that open at the end of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    /// The frame.
    pub frame: i32,
    /// Pairs of vertices: edges of faces, or seams.
    pub pairs: Vec<[u32; 2]>,
}

impl Tear {
    /// What an edge between vertices a and b of the mesh as given bears, as a part of the thresholds.
    pub(crate) fn bears(&self, edge: usize, [a, b]: [u32; 2]) -> f64 {
        let at = |vertex: u32| self.strength.get(vertex as usize).copied().unwrap_or(1.0);
        let random = scattered((u64::from(self.seed) << 32) ^ edge as u64);
        at(a).min(at(b)) * (1.0 + self.noise * random)
    }

    /// Whether pulled edges break at all.
    pub(crate) fn breaks_edges(&self) -> bool {
        self.force.or(self.strain).or(self.stress).is_some()
    }

    /// By which factor a load is beyond what breaks an edge that bears such a part of the thresholds.
    pub(crate) fn excess(&self, bears: f64, load: &Load) -> f64 {
        let of = |value: f64, threshold: Option<f64>| match threshold {
            Some(threshold) if value > 0.0 => value / (bears * threshold).max(f64::MIN_POSITIVE),
            _ => 0.0,
        };
        of(load.tension, self.force)
            .max(of(load.strain, self.strain))
            .max(of(load.stress, self.stress))
    }

    pub(crate) fn check(&self, cloth: &Cloth) -> Result<()> {
        let at = format!("cloth \"{}\": tear", cloth.name);
        for (what, value) in [
            ("force (N)", self.force),
            ("strain", self.strain),
            ("stress (N/m)", self.stress),
            ("seam_force (N)", self.seam_force),
        ] {
            at_least_zero(&format!("{at} {what}"), value.unwrap_or(0.0))?;
        }
        within_one(&format!("{at} noise"), self.noise)?;
        let refuse = |reason| Err(Error::BadCloth { cloth: cloth.name.clone(), reason });
        let (count, given) = (cloth.positions.len(), self.strength.len());
        if given != 0 && given != count {
            return refuse(format!("{given} strengths are given; accepted: {count}, one a vertex"));
        }
        self.strength.iter().try_for_each(|&of| within_one(&format!("{at} strength"), of))?;
        if cloth.mesh.vertex_count() != count || !cloth.mesh.loose_vertices().is_empty() {
            return refuse(
                "it is to tear, but has vertices without faces; accepted: meshes".to_owned(),
            );
        }
        let edges = cloth.mesh.edges();
        let seams = cloth.tailoring.sewing.iter().flat_map(|sewing| &sewing.seams);
        let mut seams: Vec<[u32; 2]> = seams.map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        seams.sort_unstable();
        for &[a, b] in self.openings.iter().flat_map(|opening| &opening.pairs) {
            let pair = [a.min(b), a.max(b)];
            if edges.binary_search(&pair).is_err() && seams.binary_search(&pair).is_err() {
                return refuse(format!(
                    "vertices {a} and {b} are to part, which no edge of a face and no seam joins; \
                     accepted: the ends of an edge or of a seam"
                ));
            }
        }
        Ok(())
    }
}
