//! What tears at the end of a frame.

use boucle_geometry::Vector;

use super::Simulation;
use crate::cloth::{Cloth, placed};
use crate::error::Result;
use crate::material::SpringKind;
use crate::state::State;
use crate::tear::{Fan, Split, Tear};

/// By how far (m) both sides of a new tear are moved back from it, so that they are apart; and the most, as a part of the way to
/// the middle of their faces.
const APART: f64 = 5e-5;
const MOST_APART: f64 = 0.02;

/// An edge that is pulled beyond what it bears.
struct Break {
    /// How far beyond, as a factor.
    excess: f64,
    ends: [u32; 2],
}

impl Simulation {
    /// The vertex of each corner of a cloth's faces, in order. Where nothing is torn, as the mesh was given.
    #[must_use]
    pub fn corners(&self, cloth: usize) -> Vec<u32> {
        self.splits[cloth].as_ref().map_or_else(
            || self.cloths[cloth].mesh.faces().flatten().copied().collect(),
            |split| split.corners().to_vec(),
        )
    }

    /// Positions (m) of the corners of a cloth's faces, in order.
    #[must_use]
    pub fn corner_positions(&self, cloth: usize) -> Vec<Vector> {
        let base = self.bases[cloth];
        let corners = self.corners(cloth).into_iter();
        corners.map(|vertex| self.state.position.get((base + vertex) as usize)).collect()
    }

    /// Of each vertex of a cloth, the one that it was as the cloth was given. Those that tearing has added come after all others.
    #[must_use]
    pub fn origins(&self, cloth: usize) -> Vec<u32> {
        self.splits[cloth].as_ref().map_or_else(
            || (0..self.cloths[cloth].positions.len() as u32).collect(),
            |split| split.origins().to_vec(),
        )
    }

    /// The edges of a cloth that are torn, by their ends as given, in the order in which they tore.
    #[must_use]
    pub fn torn_edges(&self, cloth: usize) -> Vec<[u32; 2]> {
        self.splits[cloth].as_ref().map_or_else(Vec::new, |split| split.torn().collect())
    }

    /// The tension (N) of each edge of a cloth's faces, with its ends: of springs their pull, of fabric the stress along the edge
    /// over a width as that of the triangles beside it.
    #[must_use]
    pub fn edge_tension(&self, cloth: usize) -> Vec<([u32; 2], f64)> {
        self.edge_loads(cloth).into_iter().map(|(ends, pull, _)| (ends, pull)).collect()
    }

    /// A cloth as it was given, whole.
    #[must_use]
    pub fn given(&self, cloth: usize) -> &Cloth {
        self.splits[cloth].as_ref().map_or(&self.cloths[cloth], |split| split.given())
    }

    /// Tears what must tear at the end of a frame.
    pub(super) fn tear(&mut self) -> Result<()> {
        let mut has_torn = false;
        for cloth in 0..self.cloths.len() {
            if let Some(tear) = self.cloths[cloth].tear.clone() {
                let edges = self.broken_edges(cloth, &tear);
                let seams = self.broken_seams(cloth, &tear);
                let Some(split) = &mut self.splits[cloth] else { continue };
                for edge in edges {
                    has_torn |= split.tear(edge);
                }
                for seam in seams {
                    split.undo(seam);
                    has_torn = true;
                }
            }
        }
        if has_torn { self.follow_tears() } else { Ok(()) }
    }

    /// The edges to tear, by number as given: of those that are pulled too hard, the hardest pulled first, one in any
    /// neighborhood, as the others bear less once it has given way. And those whose time has come.
    fn broken_edges(&self, cloth: usize, tear: &Tear) -> Vec<u32> {
        let Some(split) = &self.splits[cloth] else { return Vec::new() };
        let opening = tear.openings.iter().filter(|opening| opening.frame == self.frame);
        let pairs = opening.flat_map(|opening| &opening.pairs);
        let mut edges: Vec<u32> = pairs.filter_map(|pair| split.edge_between(*pair)).collect();
        let mut broken = self.breaks(cloth, tear, split);
        broken.sort_by(|a, b| b.excess.total_cmp(&a.excess).then(a.ends.cmp(&b.ends)));
        let mut is_busy = vec![false; split.origins().len()];
        for Break { ends, .. } in broken {
            if ends.iter().any(|end| is_busy[*end as usize]) {
                continue;
            }
            let Some((spokes, center)) = self.way_across(cloth, split, ends) else { continue };
            is_busy[center as usize] = true;
            for (edge, end) in spokes {
                edges.push(edge);
                is_busy[end as usize] = true;
            }
            for end in ends {
                is_busy[end as usize] = true;
            }
        }
        edges
    }

    /// The edges that are loaded beyond what they bear.
    fn breaks(&self, cloth: usize, tear: &Tear, split: &Split) -> Vec<Break> {
        if tear.force.is_none() && tear.strain.is_none() {
            return Vec::new();
        }
        let loads = self.edge_loads(cloth).into_iter().filter_map(|(ends, tension, strain)| {
            let given = ends.map(|end| split.origins()[end as usize]);
            let edge = split.edge_between(given)?;
            let excess = tear.excess(tear.bears(edge as usize, given), tension, strain);
            (excess > 1.0).then_some(Break { excess, ends })
        });
        loads.collect()
    }

    /// Where the cloth parts across an edge: the edges that tear, with their far ends, and at which of its ends. Where a tear ends
    /// already, or the cloth, it parts more easily.
    fn way_across(
        &self,
        cloth: usize,
        split: &Split,
        ends: [u32; 2],
    ) -> Option<(Vec<(u32, u32)>, u32)> {
        let base = self.bases[cloth] as usize;
        let place = |vertex: u32| self.state.position.get(base + vertex as usize);
        let [a, b] = ends;
        let mut sides: Vec<(bool, u32, u32, Fan)> = [(a, b), (b, a)]
            .into_iter()
            .filter(|(center, _)| !self.system.is_pinned(base + *center as usize))
            .filter_map(|(center, to)| {
                let fan = Fan::around(split, split.corner_between(center, to)?);
                Some((fan.is_closed(), center, to, fan))
            })
            .collect();
        sides.sort_by_key(|(is_closed, center, ..)| (*is_closed, *center));
        sides.iter().find_map(|(_, center, to, fan)| {
            Some((fan.across(&place(*center), *to, place)?, *center))
        })
    }

    /// The seams that come undone, by number as given.
    fn broken_seams(&self, cloth: usize, tear: &Tear) -> Vec<u32> {
        let Some(split) = &self.splits[cloth] else { return Vec::new() };
        let seams = split.seams();
        let opening = tear.openings.iter().filter(|opening| opening.frame == self.frame);
        let opening: Vec<[u32; 2]> = opening
            .flat_map(|opening| &opening.pairs)
            .map(|&[a, b]| [a.min(b), a.max(b)])
            .collect();
        let base = self.bases[cloth];
        let own = self.cloths[cloth].springs.iter();
        let held = own.filter(|spring| spring.kind == SpringKind::Sewing);
        let broken = held.filter(|seam| {
            let [a, b] = seam.ends.map(|end| base + end);
            let pull = seam.stiffness * self.state.position.distance_squared(a, b).sqrt();
            opening.contains(&seam.ends) || tear.seam_force.is_some_and(|force| pull > force)
        });
        broken
            .filter_map(|seam| seams.iter().position(|ends| *ends == seam.ends))
            .map(|number| number as u32)
            .collect()
    }

    /// Goes on with the cloths as they are torn now.
    fn follow_tears(&mut self) -> Result<()> {
        let (cloths, from) = self.pieces();
        let before: Vec<usize> = self.cloths.iter().map(|cloth| cloth.positions.len()).collect();
        self.become_cloths(cloths, &from)?;
        for (cloth, before) in before.into_iter().enumerate() {
            self.draw_apart(cloth, before);
        }
        self.good.clone_from(&self.state);
        self.good_memory = self.method.memory().cloned();
        Ok(())
    }

    /// The cloths as they are torn, and of each of their particles the one that it has been until now.
    pub(super) fn pieces(&self) -> (Vec<Cloth>, Vec<u32>) {
        let mut from = Vec::new();
        let mut cloths = Vec::new();
        for ((cloth, base), split) in placed(&self.cloths).zip(&self.splits) {
            let Some(split) = split else {
                from.extend((0..cloth.positions.len() as u32).map(|vertex| base + vertex));
                cloths.push(cloth.clone());
                continue;
            };
            // A new vertex comes from where a corner of it was.
            let mut own: Vec<u32> = (0..split.origins().len() as u32).collect();
            let old = cloth.mesh.faces().flatten();
            for (&now, &old) in split.corners().iter().zip(old) {
                own[now as usize] = old;
            }
            from.extend(own.into_iter().map(|vertex| base + vertex));
            cloths.push(split.cloth());
        }
        (cloths, from)
    }

    /// Moves what has just parted a little back from the tear: vertices beyond so many, and those that they were one with.
    fn draw_apart(&mut self, cloth: usize, before: usize) {
        let (own, base) = (&self.cloths[cloth], self.bases[cloth] as usize);
        let count = own.positions.len();
        if count == before {
            return;
        }
        let Some(split) = &self.splits[cloth] else { return };
        let mut is_new = vec![false; split.origins().len()];
        split.origins()[before..].iter().for_each(|origin| is_new[*origin as usize] = true);
        let mut sums = vec![(Vector::zeros(), 0.0); count];
        let place = |vertex: u32| self.state.position.get(base + vertex as usize);
        for face in own.mesh.faces() {
            let middle: Vector = face.iter().map(|&vertex| place(vertex)).sum();
            for &vertex in face {
                let (sum, number) = &mut sums[vertex as usize];
                *sum += middle / face.len() as f64;
                *number += 1.0;
            }
        }
        let moves: Vec<(usize, Vector)> = (0..count)
            .filter(|&vertex| {
                is_new[split.origins()[vertex] as usize] && !self.system.is_pinned(base + vertex)
            })
            .map(|vertex| {
                let (sum, number) = sums[vertex];
                let way = sum / f64::max(number, 1.0) - place(vertex as u32);
                (base + vertex, way * (APART / way.norm().max(APART / MOST_APART)))
            })
            .collect();
        let shift = |state: &mut State| {
            for (particle, way) in &moves {
                let moved = state.position.get(*particle) + way;
                state.position.set(*particle, &moved);
            }
        };
        shift(&mut self.state);
        if let Some(memory) = self.method.memory_mut() {
            shift(&mut memory.before);
        }
    }
}
