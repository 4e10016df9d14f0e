//! Edges longer than their deformation rate allows, by name.
//!
//! A limiter takes away what exceeds the rate, but where pins alone pull an edge further than that, nothing can. With
//! [`Limiter::None`] nothing is promised and no edge is named.

use crate::certificate::length;
use crate::cloth::Cloth;
use crate::limit::acting;
use crate::material::{Limiter, SpringKind};
use crate::state::State;

/// Strain beyond the rate that nobody sees and no report names.
pub(crate) const UNSEEN: f64 = 1e-3;

/// A mesh edge that is longer than its cloth allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverstretchedEdge {
    /// Its vertices.
    pub ends: [u32; 2],
    /// Its elongation `L/L0 - 1`.
    pub strain: f64,
}

/// The edges of a cloth whose strain exceeds the deformation rate by more than [`UNSEEN`], the worst first. `base` is
/// the number of its first particle.
pub(crate) fn overstretched(
    cloth: &Cloth,
    base: u32,
    state: &State,
    is_implicit: bool,
) -> Vec<OverstretchedEdge> {
    if acting(cloth, is_implicit) == Limiter::None {
        return Vec::new();
    }
    let most = cloth.material.deformation_rate + UNSEEN;
    let edges = cloth.springs.iter().filter(|spring| spring.kind == SpringKind::Stretch);
    let strained = edges.map(|edge| {
        let strain = length(state, edge.ends, base) / edge.rest_length - 1.0;
        OverstretchedEdge { ends: edge.ends, strain }
    });
    let mut found: Vec<_> = strained.filter(|edge| edge.strain > most).collect();
    found.sort_unstable_by(|one, other| {
        other.strain.total_cmp(&one.strain).then(one.ends.cmp(&other.ends))
    });
    found
}
