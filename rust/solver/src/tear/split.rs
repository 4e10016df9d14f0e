//! A cloth as it was given, and where it is torn.

use std::sync::Arc;

use boucle_geometry::Mesh;

use crate::cloth::Cloth;
use crate::grouped::Grouped;

/// Which vertices the corners of a cloth's faces are at, as edges tear one after the other.
///
/// A vertex keeps its number as long as there is a face at it: that with the first of its corners. The other sides of a tear
/// get the next numbers, in the order in which they part.
#[derive(Clone, Debug)]
pub(crate) struct Split {
    pub(super) given: Arc<Cloth>,
    /// Of the mesh as given, sorted.
    pub(super) edges: Vec<[u32; 2]>,
    /// Of each corner, the edge to the next corner of its face, and the corner before it.
    pub(super) sides: Vec<u32>,
    pub(super) before: Vec<u32>,
    /// Of each vertex as given, its corners.
    pub(super) corners_of: Grouped<u32>,
    /// Of each corner, the vertex that it is at now.
    pub(super) vertex_of: Vec<u32>,
    /// Of each vertex, the one that it was as given.
    pub(super) origins: Vec<u32>,
    pub(super) is_torn: Vec<bool>,
    /// Vertices that never part: hard pins.
    is_whole: Vec<bool>,
    /// Edges in the order in which they tore.
    torn: Vec<u32>,
    /// Seams that have come undone, by number as given.
    pub(super) undone: Vec<u32>,
}

impl Split {
    /// Of a cloth that is whole.
    pub(crate) fn new(given: Cloth) -> Self {
        let edges = given.mesh.edges();
        let (mut sides, mut before) = (Vec::new(), Vec::new());
        for face in given.mesh.faces() {
            let first = sides.len() as u32;
            let count = face.len() as u32;
            for i in 0..face.len() {
                let [a, b] = [face[i], face[(i + 1) % face.len()]];
                let place = edges.partition_point(|edge| *edge < [a.min(b), a.max(b)]);
                sides.push(place as u32);
                before.push(first + (i as u32 + count - 1) % count);
            }
        }
        let vertex_of: Vec<u32> = given.mesh.faces().flatten().copied().collect();
        let count = given.positions.len();
        let corners = (0..).zip(&vertex_of).map(|(corner, &vertex)| (vertex, corner));
        let mut is_whole = vec![false; count];
        for (i, &pin) in given.pins.iter().enumerate() {
            is_whole[pin as usize] = given.pin_weights.get(i).is_none_or(|weight| *weight >= 1.0);
        }
        Self {
            corners_of: Grouped::new(count, corners),
            is_torn: vec![false; edges.len()],
            origins: (0..count as u32).collect(),
            torn: Vec::new(),
            undone: Vec::new(),
            is_whole,
            vertex_of,
            edges,
            sides,
            before,
            given: Arc::new(given),
        }
    }

    /// The cloth as it was given.
    pub(crate) fn given(&self) -> &Cloth {
        &self.given
    }

    /// The vertex as given of each vertex.
    pub(crate) fn origins(&self) -> &[u32] {
        &self.origins
    }

    /// The vertex of each corner of each face, in order.
    pub(crate) fn corners(&self) -> &[u32] {
        &self.vertex_of
    }

    /// The edges that tore, in that order, by number in the sorted list of all as given; and the seams that came undone.
    pub(crate) fn history(&self) -> [&[u32]; 2] {
        [&self.torn, &self.undone]
    }

    /// The edges that tore, by their ends as given.
    pub(crate) fn torn(&self) -> impl Iterator<Item = [u32; 2]> {
        self.torn.iter().map(|&edge| self.edges[edge as usize])
    }

    /// The number of the edge between two vertices as given.
    pub(crate) fn edge_between(&self, [a, b]: [u32; 2]) -> Option<u32> {
        let place = self.edges.binary_search(&[a.min(b), a.max(b)]);
        place.ok().map(|place| place as u32)
    }

    /// The ends of an edge as given.
    pub(crate) fn ends(&self, edge: u32) -> [u32; 2] {
        self.edges[edge as usize]
    }

    /// Whether an edge is not torn.
    pub(crate) fn holds(&self, edge: u32) -> bool {
        !self.is_torn[edge as usize]
    }

    /// Whether a vertex never parts.
    pub(crate) fn is_whole(&self, vertex: u32) -> bool {
        self.is_whole[self.origins[vertex as usize] as usize]
    }

    /// The seams as given.
    pub(crate) fn seams(&self) -> &[[u32; 2]] {
        self.given.tailoring.sewing.as_ref().map_or(&[], |sewing| &sewing.seams)
    }

    /// A corner at a vertex whose face has the edge to another.
    pub(crate) fn corner_between(&self, center: u32, to: u32) -> Option<u32> {
        let corners = self.corners_of.of(self.origins[center as usize] as usize);
        corners.iter().copied().find(|&corner| {
            self.vertex_of[corner as usize] == center
                && self.edges_at(corner).iter().any(|&edge| self.along(corner, edge) == to)
        })
    }

    /// Whether edges and seams of these numbers are there.
    pub(crate) fn has(&self, [torn, undone]: [&[u32]; 2]) -> bool {
        let seams = self.seams().len();
        torn.iter().all(|&edge| (edge as usize) < self.edges.len())
            && undone.iter().all(|&seam| (seam as usize) < seams)
    }

    /// Undoes a seam, by number as given.
    pub(crate) fn undo(&mut self, seam: u32) {
        if let Err(place) = self.undone.binary_search(&seam) {
            self.undone.insert(place, seam);
        }
    }

    /// Tears an edge, by number; its ends part if that leaves two sides. Says whether it held before.
    pub(crate) fn tear(&mut self, edge: u32) -> bool {
        if std::mem::replace(&mut self.is_torn[edge as usize], true) {
            return false;
        }
        self.torn.push(edge);
        for vertex in self.edges[edge as usize] {
            self.part(vertex);
        }
        true
    }

    /// Gives the sides at a vertex as given, that no edge joins any more, vertices of their own.
    fn part(&mut self, vertex: u32) {
        if self.is_whole[vertex as usize] {
            return;
        }
        let corners = self.corners_of.of(vertex as usize);
        let mut corners: Vec<(u32, u32)> =
            corners.iter().map(|&corner| (self.vertex_of[corner as usize], corner)).collect();
        corners.sort_unstable();
        for here in corners.chunk_by(|a, b| a.0 == b.0) {
            let here: Vec<u32> = here.iter().map(|(_, corner)| *corner).collect();
            for (i, first) in self.sides_at(&here).into_iter().enumerate() {
                if first == 0 {
                    continue;
                }
                if first == i {
                    self.origins.push(vertex);
                }
                self.vertex_of[here[i] as usize] = if first == i {
                    self.origins.len() as u32 - 1
                } else {
                    self.vertex_of[here[first] as usize]
                };
            }
        }
    }

    /// For each of some corners at one vertex, the first that edges which are not torn join it to. Faces that meet at the vertex
    /// alone, from the first, count as joined.
    fn sides_at(&self, corners: &[u32]) -> Vec<usize> {
        let mut sides = self.joined(corners, |edge| !self.is_torn[edge as usize]);
        let whole = self.joined(corners, |_| true);
        for (i, &side) in whole.iter().enumerate() {
            if side == i && i > 0 {
                let (from, to) = (sides[i], sides[0]);
                sides.iter_mut().filter(|side| **side == from).for_each(|side| *side = to);
            }
        }
        sides
    }

    /// For each corner, the first that it is joined to by edges that hold.
    fn joined(&self, corners: &[u32], holds: impl Fn(u32) -> bool) -> Vec<usize> {
        let places = (0..).zip(corners);
        let mut edges: Vec<(u32, usize)> = places
            .flat_map(|(place, &corner)| self.edges_at(corner).map(|edge| (edge, place)))
            .filter(|(edge, _)| holds(*edge))
            .collect();
        edges.sort_unstable();
        let beside = |edge: u32| {
            let start = edges.partition_point(|(other, _)| *other < edge);
            edges[start..].iter().take_while(move |(other, _)| *other == edge)
        };
        let mut first = vec![usize::MAX; corners.len()];
        for start in 0..corners.len() {
            let mut open = vec![start];
            while let Some(place) = open.pop() {
                if first[place] == usize::MAX {
                    first[place] = start;
                    let own = self.edges_at(corners[place]);
                    open.extend(own.into_iter().flat_map(beside).map(|(_, place)| *place));
                }
            }
        }
        first
    }

    /// The two edges of a corner's face that meet in it.
    pub(super) fn edges_at(&self, corner: u32) -> [u32; 2] {
        [self.sides[corner as usize], self.sides[self.before[corner as usize] as usize]]
    }

    /// The vertex at the other end of an edge of a corner's face, from the corner.
    pub(super) fn along(&self, corner: u32, edge: u32) -> u32 {
        let before = self.before[corner as usize];
        if self.sides[before as usize] == edge {
            return self.vertex_of[before as usize];
        }
        // The next corner is the one whose own is before it.
        let (mut next, mut at) = (before, self.before[before as usize]);
        while at != corner {
            (next, at) = (at, self.before[at as usize]);
        }
        self.vertex_of[next as usize]
    }

    /// The mesh as it is torn.
    pub(super) fn mesh(&self) -> Mesh {
        let ends = self.given.mesh.faces().scan(0, |end, face| {
            *end += face.len() as u32;
            Some(*end)
        });
        let starts = std::iter::once(0).chain(ends).collect();
        let mesh = Mesh::new(self.origins.len(), starts, self.vertex_of.clone());
        // Corners of a face stay apart, as only their numbers change.
        let mesh = mesh.unwrap_or_else(|_| self.given.mesh.clone());
        mesh.with_loose_edges(self.given.mesh.loose_edges().iter().copied())
    }
}
