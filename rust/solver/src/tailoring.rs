//! How a cloth is made up: a rest shape other than the one it starts from, shrink, seams.

use std::collections::BTreeSet;

use boucle_geometry::Vector;

use crate::cloth::{Cloth, check_positions};
use crate::error::{Error, Result};
use crate::law::Spring;
use crate::material::{Limiter, SpringKind};

/// The least and the largest fraction by which rest lengths may shrink; below 0 they grow.
pub const SHRINK: [f64; 2] = [-10.0, 0.99];

/// Rest length (m) of a seam: as good as none, and the least that a spring may have.
pub(crate) const CLOSED: f64 = 1e-9;

/// Stiffness (N/m) of seams at the least, in cloth whose stretch springs are softer.
const LEAST_STIFFNESS: f64 = 1.0;

/// What a cloth is made up of besides its mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tailoring {
    /// Rest positions (m) where the cloth starts from others.
    pub rest_positions: Option<Vec<Vector>>,
    /// By which fraction rest lengths are less at each vertex; nowhere if empty.
    pub shrink: Vec<f64>,
    /// What draws the ends of loose edges together.
    pub sewing: Option<Sewing>,
}

/// Seams: pairs of vertices that are drawn together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sewing {
    /// The vertices of each.
    pub seams: Vec<[u32; 2]>,
    /// Largest force (N) of one seam; 0 for no limit.
    pub force_max: f64,
    /// Ends that are nearer than this (m) as a frame begins stay joined for good; 0 for never.
    pub weld_distance: f64,
}

impl Cloth {
    /// The same cloth, which starts from other positions (m): those that it was made with are its rest shape.
    ///
    /// # Errors
    /// [`Error::BadCloth`] when there are not as many, or one is no place in space.
    pub fn starting_at(self, positions: Vec<Vector>) -> Result<Self> {
        let (got, wanted) = (positions.len(), self.positions.len());
        if got != wanted {
            let reason =
                format!("it starts from {got} positions; accepted: {wanted}, one a vertex");
            return Err(Error::BadCloth { cloth: self.name, reason });
        }
        check_positions(&self.name, &positions)?;
        let rest_positions = Some(self.positions);
        let tailoring = Tailoring { rest_positions, ..self.tailoring };
        Ok(Self { positions, tailoring, ..self })
    }

    /// The same cloth with seams: springs of no rest length, as stiff as stretch springs, and damped so that
    /// the cloth that they draw together stops where they close. A seam takes the place of a shear or bend spring between its ends.
    ///
    /// # Errors
    /// [`Error::BadCloth`] when a seam does not join two vertices that no edge joins.
    pub fn sewn(mut self, sewing: Sewing) -> Result<Self> {
        let refuse = |reason| Err(Error::BadCloth { cloth: self.name.clone(), reason });
        let count = self.positions.len();
        let mut seams = BTreeSet::new();
        let Sewing { seams: pairs, force_max, weld_distance } = sewing;
        for [a, b] in pairs {
            if a == b || a.max(b) as usize >= count {
                return refuse(format!(
                    "a seam joins vertices {a} and {b}; accepted: two of the {count} vertices"
                ));
            }
            seams.insert([a.min(b), a.max(b)]);
        }
        let is_edge = |spring: &&Spring| {
            let is_side = self.fabric.is_some() && spring.kind == SpringKind::Shear;
            spring.kind == SpringKind::Stretch || is_side
        };
        if let Some(edge) = self.springs.iter().filter(is_edge).find(|s| seams.contains(&s.ends)) {
            let [a, b] = edge.ends;
            return refuse(format!(
                "a seam joins vertices {a} and {b}, which an edge of a face joins; accepted: vertices \
                 that no face joins"
            ));
        }
        self.springs.retain(|spring| !seams.contains(&spring.ends));
        let stretch = self.fabric.as_ref().map_or(self.material.stiffness[0], |fabric| {
            0.5 * (fabric.stretch[0] + fabric.stretch[1])
        });
        let stiffness = stretch.max(LEAST_STIFFNESS);
        // Half of the cloth on either side, shared out among the seams: the mass that one of them has to stop.
        let mass = 0.25 * self.masses.iter().sum::<f64>() / seams.len().max(1) as f64;
        let damping = 2.0 * (stiffness * mass).sqrt();
        let kind = SpringKind::Sewing;
        self.springs.extend(seams.iter().map(|&ends| Spring {
            ends,
            kind,
            rest_length: CLOSED,
            stiffness,
            damping,
        }));
        let seams = seams.into_iter().collect();
        self.tailoring.sewing = Some(Sewing { seams, force_max, weld_distance });
        self.check()?;
        Ok(self)
    }

    /// Its rest positions (m).
    #[must_use]
    pub fn rest(&self) -> &[Vector] {
        self.tailoring.rest_positions.as_ref().unwrap_or(&self.positions)
    }

    pub(crate) fn check_tailoring(&self) -> Result<()> {
        let refuse = |reason| Err(Error::BadCloth { cloth: self.name.clone(), reason });
        let (count, at) = (self.positions.len(), format!("cloth \"{}\"", self.name));
        if self.rest().len() != count {
            let given = self.rest().len();
            return refuse(format!("{given} rest positions are given; accepted: {count}"));
        }
        check_shrink(&self.name, &self.tailoring.shrink, count)?;
        let Some(sewing) = &self.tailoring.sewing else { return Ok(()) };
        for (what, value) in [
            ("sewing force_max (N)", sewing.force_max),
            ("sewing weld_distance (m)", sewing.weld_distance),
        ] {
            crate::material::at_least_zero(&format!("{at}: {what}"), value)?;
        }
        if self.material.limiter == Limiter::Stiffen && !sewing.seams.is_empty() {
            return refuse(
                "sewing and the limiter \"stiffen\", which would stiffen seams without end; \
                 accepted: another limiter"
                    .to_owned(),
            );
        }
        Ok(())
    }
}

/// Refuses shrink of a cloth that is not of so many vertices or out of its domain.
pub(crate) fn check_shrink(cloth: &str, shrink: &[f64], count: usize) -> Result<()> {
    let refuse = |reason| Err(Error::BadCloth { cloth: cloth.to_owned(), reason });
    if !shrink.is_empty() && shrink.len() != count {
        let given = shrink.len();
        return refuse(format!("{given} numbers of shrink are given; accepted: {count} or none"));
    }
    let [least, most] = SHRINK;
    match shrink.iter().position(|shrink| !(least..=most).contains(shrink)) {
        Some(vertex) => {
            let value = shrink[vertex];
            refuse(format!("vertex {vertex} shrinks by {value}; accepted: {least} to {most}"))
        }
        None => Ok(()),
    }
}
