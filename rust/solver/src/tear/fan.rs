//! The faces around a vertex, one after the other, and where they part.

use boucle_geometry::Vector;

use super::Split;

/// Faces around a vertex.
#[derive(Debug)]
pub(crate) struct Fan {
    /// The edges from the vertex between one face and the next, with the vertices at their other ends. Those at both ends are
    /// borders, or torn; of a closed fan the first is also the last.
    spokes: Vec<(u32, u32)>,
    is_closed: bool,
}

impl Fan {
    /// Around the vertex of a corner, as far as edges hold.
    pub(crate) fn around(split: &Split, corner: u32) -> Self {
        let (mut at, mut exit) = (corner, split.edges_at(corner)[0]);
        let mut is_closed = false;
        while let Some(next) = across(split, at, exit) {
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
        while let Some(next) = across(split, at, entry) {
            if next == first {
                break;
            }
            entry = other(split, next, entry);
            at = next;
            spokes.push((entry, split.along(at, entry)));
        }
        Self { spokes, is_closed }
    }

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
    ) -> Option<Vec<(u32, u32)>> {
        let way = |vertex: u32| (place(vertex) - center).try_normalize(0.0);
        let pull = way(to)?;
        let slant = |vertex: u32| way(vertex).map_or(f64::INFINITY, |way| way.dot(&pull).abs());
        let best = |costs: &mut dyn Iterator<Item = (f64, Vec<(u32, u32)>)>| {
            costs.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|best| best.0.is_finite())
        };
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
            let mut costs = inner.map(|&spoke| (slant(spoke.1) + turn(spoke.1), vec![spoke]));
            return best(&mut costs).map(|best| best.1);
        }
        let count = self.spokes.len() - 1;
        let start = self.spokes[..count].iter().position(|(_, vertex)| *vertex == to)?;
        let others: Vec<(u32, u32)> =
            (1..count).map(|i| self.spokes[(start + i) % count]).collect();
        let pairs = others
            .iter()
            .enumerate()
            .flat_map(|(i, &one)| others[i + 1..].iter().map(move |&other| [one, other]));
        let mut costs = pairs.map(|[one, other]| {
            let bend = match (way(one.1), way(other.1)) {
                (Some(one), Some(other)) => 1.0 + one.dot(&other),
                _ => f64::INFINITY,
            };
            (slant(one.1) + slant(other.1) + bend, vec![one, other])
        });
        best(&mut costs).map(|best| best.1)
    }
}

/// The one other corner at the same vertex whose face has an edge that holds.
fn across(split: &Split, corner: u32, edge: u32) -> Option<u32> {
    if split.is_torn[edge as usize] {
        return None;
    }
    let vertex = split.vertex_of[corner as usize];
    let all = split.corners_of.of(split.origins[vertex as usize] as usize);
    let mut others = all.iter().copied().filter(|&other| {
        other != corner
            && split.vertex_of[other as usize] == vertex
            && split.edges_at(other).contains(&edge)
    });
    others.next().filter(|_| others.next().is_none())
}

/// The other edge of a corner.
fn other(split: &Split, corner: u32, edge: u32) -> u32 {
    let [out, into] = split.edges_at(corner);
    if out == edge { into } else { out }
}
