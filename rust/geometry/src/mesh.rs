//! A polygon mesh: which vertices each face joins, whatever their positions.

use std::collections::HashSet;
use std::fmt;

use crate::Vector;

/// Why a mesh is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshError {
    /// A face with fewer than three corners.
    FaceTooSmall {
        /// Face number, from 0.
        face: usize,
        /// How many corners it has.
        corner_count: usize,
    },
    /// A face names a vertex that is not there.
    VertexOutOfRange {
        /// Face number, from 0.
        face: usize,
        /// The vertex it names.
        vertex: i64,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// A face passes through the same vertex twice, as polygons with a hole cut in by a bridge do.
    RepeatedVertex {
        /// Face number, from 0.
        face: usize,
        /// The vertex, from 0.
        vertex: u32,
    },
    /// Face starts that do not cut the corners into faces.
    BrokenFaceStarts,
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FaceTooSmall { face, corner_count } => {
                write!(f, "face {face} has {corner_count} corners; accepted: 3 or more")
            }
            Self::VertexOutOfRange { face, vertex, vertex_count } => write!(
                f,
                "face {face} names vertex {vertex}; accepted: 0 to {}",
                vertex_count.saturating_sub(1)
            ),
            Self::RepeatedVertex { face, vertex } => write!(
                f,
                "face {face} passes through vertex {vertex} twice; accepted: faces without holes or \
                 repeated corners"
            ),
            Self::BrokenFaceStarts => {
                write!(f, "the face starts do not grow from 0 to the number of corners")
            }
        }
    }
}

impl std::error::Error for MeshError {}

/// Faces over numbered vertices: triangles, quads, n-gons, mixed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Mesh {
    vertex_count: usize,
    /// Where each face begins in `corners`, and the end of the last: `face_count + 1` numbers.
    face_starts: Vec<u32>,
    corners: Vec<u32>,
    /// Pairs of vertices that no face joins, smaller first, sorted.
    loose_edges: Vec<[u32; 2]>,
}

impl Mesh {
    /// A mesh from face starts (`face_count + 1` numbers, from 0 to the number of corners) and the vertex of each corner.
    ///
    /// # Errors
    /// When a face has fewer than three corners, repeats a vertex, or names one that is not there.
    pub fn new(
        vertex_count: usize,
        face_starts: Vec<u32>,
        corners: Vec<u32>,
    ) -> Result<Self, MeshError> {
        let ends_fit = face_starts.first() == Some(&0)
            && face_starts.last().map(|&end| end as usize) == Some(corners.len());
        if !ends_fit || face_starts.windows(2).any(|pair| pair[0] > pair[1]) {
            return Err(MeshError::BrokenFaceStarts);
        }
        let mesh = Self { vertex_count, face_starts, corners, loose_edges: Vec::new() };
        for (face, corners) in mesh.faces().enumerate() {
            check_face(face, corners, vertex_count)?;
        }
        Ok(mesh)
    }

    /// A mesh from lists of corners.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn from_faces<F: AsRef<[u32]>>(
        vertex_count: usize,
        faces: &[F],
    ) -> Result<Self, MeshError> {
        let mut face_starts = vec![0];
        let mut corners = Vec::new();
        for face in faces {
            corners.extend_from_slice(face.as_ref());
            face_starts.push(corners.len() as u32);
        }
        Self::new(vertex_count, face_starts, corners)
    }

    /// The same mesh with those of these pairs of vertices as loose edges that are no edges of its faces; each once.
    #[must_use]
    pub fn with_loose_edges(self, pairs: impl IntoIterator<Item = [u32; 2]>) -> Self {
        let pairs = pairs.into_iter().filter(|[a, b]| a != b);
        let mut loose_edges: Vec<[u32; 2]> = pairs.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        if !loose_edges.is_empty() {
            let edges = self.edges();
            loose_edges.sort_unstable();
            loose_edges.dedup();
            loose_edges.retain(|pair| edges.binary_search(pair).is_err());
        }
        Self { loose_edges, ..self }
    }

    /// The edges that no face has, smaller vertex first, sorted.
    #[must_use]
    pub fn loose_edges(&self) -> &[[u32; 2]] {
        &self.loose_edges
    }

    /// How many vertices there are, used or not.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// How many faces there are.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.face_starts.len().saturating_sub(1)
    }

    /// The triangles that the faces fall into: fans around their first corners.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + Clone {
        self.faces().flat_map(|corners| {
            let first = corners[0];
            corners[1..].windows(2).map(move |pair| [first, pair[0], pair[1]])
        })
    }

    /// How many triangles the faces fall into: corners less two, each.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.corners.len() - 2 * self.face_count()
    }

    /// The vertices of one face, in order around it.
    #[must_use]
    pub fn face(&self, face: usize) -> &[u32] {
        &self.corners[self.face_starts[face] as usize..self.face_starts[face + 1] as usize]
    }

    /// Every face's vertices.
    pub fn faces(&self) -> impl Iterator<Item = &[u32]> + Clone {
        self.face_starts.windows(2).map(|pair| &self.corners[pair[0] as usize..pair[1] as usize])
    }

    /// Every edge once, smaller vertex first, sorted.
    #[must_use]
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let mut edges: Vec<[u32; 2]> = self.faces().flat_map(face_edges).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// The vertices that no face uses, in order.
    #[must_use]
    pub fn loose_vertices(&self) -> Vec<u32> {
        let mut is_used = vec![false; self.vertex_count];
        for &vertex in &self.corners {
            is_used[vertex as usize] = true;
        }
        (0..self.vertex_count as u32).filter(|&vertex| !is_used[vertex as usize]).collect()
    }

    /// The vector area (m²) of one face: its normal, as long as its area (Newell 1972).
    ///
    /// # Panics
    /// When `positions` is shorter than the mesh's vertices.
    #[must_use]
    pub fn vector_area(&self, face: usize, positions: &[Vector]) -> Vector {
        let corners = self.face(face);
        let origin = positions[corners[0] as usize];
        corners[1..].windows(2).fold(Vector::zeros(), |area, pair| {
            let a = positions[pair[0] as usize] - origin;
            let b = positions[pair[1] as usize] - origin;
            area + 0.5 * a.cross(&b)
        })
    }
}

/// The edges around one face, smaller vertex first.
fn face_edges(corners: &[u32]) -> impl Iterator<Item = [u32; 2]> {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(&a, &b)| [a.min(b), a.max(b)])
}

fn check_face(face: usize, corners: &[u32], vertex_count: usize) -> Result<(), MeshError> {
    if corners.len() < 3 {
        return Err(MeshError::FaceTooSmall { face, corner_count: corners.len() });
    }
    if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= vertex_count) {
        let vertex = i64::from(vertex);
        return Err(MeshError::VertexOutOfRange { face, vertex, vertex_count });
    }
    let mut seen = HashSet::new();
    match corners.iter().find(|&&vertex| !seen.insert(vertex)) {
        Some(&vertex) => Err(MeshError::RepeatedVertex { face, vertex }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quad_and_triangle() -> Mesh {
        Mesh::from_faces(6, &[vec![0, 1, 2, 3], vec![1, 4, 2]]).expect("a good mesh")
    }

    #[test]
    fn edges_shared_by_two_faces_are_listed_once() {
        assert_eq!(quad_and_triangle().edges(), [[0, 1], [0, 3], [1, 2], [1, 4], [2, 3], [2, 4]]);
    }

    #[test]
    fn vertices_without_a_face_are_loose() {
        assert_eq!(quad_and_triangle().loose_vertices(), [5]);
        assert_eq!(quad_and_triangle().triangle_count(), 3);
    }

    #[test]
    fn an_edge_is_loose_that_no_face_has() {
        let mesh = quad_and_triangle().with_loose_edges([[3, 4], [2, 1], [4, 3], [5, 5], [0, 2]]);
        assert_eq!(mesh.loose_edges(), [[0, 2], [3, 4]]);
    }

    #[test]
    fn a_face_that_repeats_a_vertex_is_refused() {
        let error = Mesh::from_faces(4, &[[0, 1, 2, 1]]).expect_err("a hole's bridge");
        assert_eq!(error, MeshError::RepeatedVertex { face: 0, vertex: 1 });
    }

    #[test]
    fn a_face_beyond_the_vertices_is_refused() {
        let error = Mesh::from_faces(3, &[[0, 1, 3]]).expect_err("no vertex 3");
        assert_eq!(error, MeshError::VertexOutOfRange { face: 0, vertex: 3, vertex_count: 3 });
    }

    #[test]
    fn a_concave_polygon_has_its_true_area() {
        let positions = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]]
            .map(|[x, y]| Vector::new(x, y, 0.0));
        let mesh = Mesh::from_faces(5, &[[0, 1, 2, 3, 4]]).expect("an arrow");
        let area = mesh.vector_area(0, &positions);
        assert!((area - Vector::new(0.0, 0.0, 2.5)).norm() < 1e-15);
    }
}
