//! The faces around a vertex, one after the other, and where they part.

use boucle_geometry::Vector;

use super::Split;

/// An edge from the vertex, with the vertex at its other end.
type Spoke = (u32, u32);

/// Faces around a vertex.
#[derive(Debug)]
pub(crate) struct Fan {
    /// The edges from the vertex between one face and the next. Those at both ends are borders, or torn; of a closed fan the first
    /// is also the last.
    spokes: Vec<Spoke>,
    is_closed: bool,
    /// Where more than two faces join in an edge that holds: both edges of every face at the vertex, and whether they hold.
    leaves: Vec<[(Spoke, bool); 2]>,
}

impl Fan {
    /// Around the vertex of a corner, as far as edges hold.
    pub(crate) fn around(split: &Split, corner: u32) -> Self {
        let corners = Corners::around(split, corner);
        let leaves = corners.leaves();
        let (mut at, mut exit) = (corner, split.edges_at(corner)[0]);
        let mut is_closed = !leaves.is_empty();
        while let Some(next) = corners.across(at, exit) {
            if next == corner {
                is_closed = true;
                break;
            }
            exit = other(split, next, exit);
            at = next;
        }
        let first = at;
        let mut spokes = vec![(exit, split.along(at, exit))];
        let mut entry = other(split, at, exit);
        spokes.push((entry, split.along(at, entry)));
        while let Some(next) = corners.across(at, entry) {
            if next == first {
                break;
            }
            entry = other(split, next, entry);
            at = next;
            spokes.push((entry, split.along(at, entry)));
        }
        Self { spokes, is_closed, leaves }
    }

    /// Whether the faces are all around the vertex, or more than two join in an edge: no tear and no border leads there.
    pub(crate) fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// The edges that part the faces most nearly across an edge to a vertex, given where vertices are (m): one of an open fan,
    /// two of a closed one, with the vertices at their other ends. None if no two sides would be left.
    pub(crate) fn across(
        &self,
        center: &Vector,
        to: u32,
        place: impl Fn(u32) -> Vector,
    ) -> Option<Vec<Spoke>> {
        let way = |vertex: u32| (place(vertex) - center).try_normalize(0.0);
        let pull = way(to)?;
        if !self.leaves.is_empty() {
            return self.between_sides(to, |vertex| way(vertex).map_or(0.0, |way| way.dot(&pull)));
        }
        let slant = |vertex: u32| way(vertex).map_or(f64::INFINITY, |way| way.dot(&pull).abs());
        if !self.is_closed {
            let [(first, end), .., (last, _)] = self.spokes[..] else { return None };
            // A tear that ends here goes straight on.
            let behind = if first == last { way(end) } else { None };
            let turn = |vertex: u32| match (behind, way(vertex)) {
                (Some(behind), Some(way)) => 0.5 * (1.0 + behind.dot(&way)),
                _ => 0.0,
            };
            let inner = &self.spokes[1..self.spokes.len() - 1];
            let inner = inner.iter().filter(|(_, vertex)| *vertex != to);
            return least(inner.map(|&spoke| (slant(spoke.1) + turn(spoke.1), vec![spoke])));
        }
        let count = self.spokes.len() - 1;
        let start = self.spokes[..count].iter().position(|(_, vertex)| *vertex == to)?;
        // Of each, its slant and its way; the one that is pulled has no part in it.
        let others = (1..count).map(|i| self.spokes[(start + i) % count]);
        let others: Vec<_> = others.map(|spoke| (spoke, slant(spoke.1), way(spoke.1))).collect();
        let pairs = others
            .iter()
            .enumerate()
            .flat_map(|(i, one)| others[i + 1..].iter().map(move |other| [one, other]));
        let costs = pairs.map(|[one, other]| {
            let bend = match (one.2, other.2) {
                (Some(one), Some(other)) => 1.0 + one.dot(&other),
                _ => f64::INFINITY,
            };
            (one.1 + other.1 + bend, [one.0, other.0])
        });
        least(costs).map(|spokes| spokes.to_vec())
    }

    /// The edges between the faces that are on the side of a vertex, of the plane across the way to it, and all others.
    fn between_sides(&self, to: u32, along: impl Fn(u32) -> f64) -> Option<Vec<Spoke>> {
        let mut sides: Vec<(Spoke, bool)> = Vec::new();
        for both in &self.leaves {
            let [a, b] = both.map(|((_, end), _)| end);
            let is_there = [a, b].contains(&to) || along(a) + along(b) > 0.0;
            let holding = both.iter().filter(|(_, holds)| *holds);
            sides.extend(holding.map(|(spoke, _)| (*spoke, is_there)));
        }
        sides.sort_unstable();
        let between = sides.chunk_by(|a, b| a.0 == b.0);
        let between = between.filter(|same| same[0].1 != same[same.len() - 1].1);
        let spokes: Vec<Spoke> = between.map(|same| same[0].0).collect();
        (!spokes.is_empty()).then_some(spokes)
    }
}

/// What costs least, if that is finite.
fn least<T>(costs: impl Iterator<Item = (f64, T)>) -> Option<T> {
    let least = costs.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|least| least.0.is_finite());
    least.map(|(_, what)| what)
}

/// The corners at a vertex, by the edges of their faces there that hold.
struct Corners<'a> {
    split: &'a Split,
    by_edge: Vec<(u32, u32)>,
}

impl<'a> Corners<'a> {
    /// At the vertex of one of them.
    fn around(split: &'a Split, corner: u32) -> Self {
        let vertex = split.vertex_of[corner as usize];
        let all = split.corners_of.of(split.origins[vertex as usize] as usize).iter();
        let own = all.filter(|&&other| split.vertex_of[other as usize] == vertex);
        let edges = own.flat_map(|&corner| split.edges_at(corner).map(|edge| (edge, corner)));
        let mut by_edge: Vec<(u32, u32)> = edges.filter(|(edge, _)| split.holds(*edge)).collect();
        by_edge.sort_unstable();
        Self { split, by_edge }
    }

    /// The one other corner whose face has an edge that holds.
    fn across(&self, corner: u32, edge: u32) -> Option<u32> {
        let start = self.by_edge.partition_point(|(other, _)| *other < edge);
        let beside = self.by_edge[start..].iter().take_while(|(other, _)| *other == edge);
        let mut others = beside.map(|(_, other)| *other).filter(|other| *other != corner);
        others.next().filter(|_| others.next().is_none())
    }

    /// Both edges of each face, and whether they hold, where more than two faces join in one; nothing where none do.
    fn leaves(&self) -> Vec<[(Spoke, bool); 2]> {
        let mut joints = self.by_edge.chunk_by(|a, b| a.0 == b.0);
        if joints.all(|same| same.len() < 3) {
            return Vec::new();
        }
        let mut corners: Vec<u32> = self.by_edge.iter().map(|(_, corner)| *corner).collect();
        corners.sort_unstable();
        corners.dedup();
        let Self { split, .. } = self;
        let spokes = |corner| {
            split
                .edges_at(corner)
                .map(|edge| ((edge, split.along(corner, edge)), split.holds(edge)))
        };
        corners.into_iter().map(spokes).collect()
    }
}

/// The other edge of a corner.
fn other(split: &Split, corner: u32, edge: u32) -> u32 {
    let [out, into] = split.edges_at(corner);
    if out == edge { into } else { out }
}
