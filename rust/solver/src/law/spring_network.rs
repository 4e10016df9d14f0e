//! Which springs a mesh carries.
//!
//! ```text
//!   stretch   every edge
//!   shear     corner to next-but-one corner of every face with four or more corners (a quad's two
//!             diagonals), and the two corners opposite the edge that two triangles share
//!   bend      u to w where u-v and v-w are edges of no common face and w continues u-v the straightest:
//!             on a grid the neighbour after next along rows and columns
//! ```
//!
//! Two particles are joined once: a stretch spring comes before a shear spring, that before a bend spring.
//!
//! Source: Provot 1995 for grids; the rule for other meshes after Baraff & Witkin 1998's neighbourhoods.

use boucle_geometry::{Mesh, Vector};

use super::Spring;
use super::continuum::from_membrane;
use crate::grouped::Grouped;
use crate::material::{SpringKind, SpringMaterial, StiffnessFrom};

/// A continuation bends by less than 60°, or it is none.
const STRAIGHT_ENOUGH: f64 = -0.5;

/// The stretch, shear and bend springs of a mesh at rest, sorted by kind, then by ends.
///
/// # Panics
/// When `positions` (m) is shorter than the mesh's vertices.
#[must_use]
pub fn springs_of_mesh(
    mesh: &Mesh,
    positions: &[Vector],
    material: &SpringMaterial,
) -> Vec<Spring> {
    let edges = mesh.edges();
    let bends = bend_pairs(mesh, &edges, positions);
    let shears = without(shear_pairs(mesh), &edges);
    let bends = without(without(bends, &edges), &shears);
    let mut springs = Vec::with_capacity(edges.len() + shears.len() + bends.len());
    for (kind, pairs) in SpringKind::ALL.into_iter().zip([edges, shears, bends]) {
        for ends in pairs {
            let span = positions[ends[0] as usize] - positions[ends[1] as usize];
            springs.push(Spring {
                ends,
                kind,
                rest_length: span.norm(),
                stiffness: material.stiffness[kind as usize],
                damping: material.damping[kind as usize],
            });
        }
    }
    if material.stiffness_from == StiffnessFrom::Continuum {
        from_membrane(mesh, positions, &mut springs);
    }
    springs
}

fn ordered(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn sorted_once(mut pairs: Vec<[u32; 2]>) -> Vec<[u32; 2]> {
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Sorted pairs less other sorted ones.
fn without(mut pairs: Vec<[u32; 2]>, taken: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut taken = taken.iter().peekable();
    pairs.retain(|pair| {
        while taken.next_if(|&other| other < pair).is_some() {}
        taken.peek() != Some(&pair)
    });
    pairs
}

fn shear_pairs(mesh: &Mesh) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    let mut triangle_sides = Vec::new();
    for face in mesh.faces() {
        let n = face.len();
        if n == 3 {
            triangle_sides
                .extend((0..3).map(|i| (ordered(face[i], face[(i + 1) % 3]), face[(i + 2) % 3])));
        } else {
            pairs.extend((0..n).map(|i| ordered(face[i], face[(i + 2) % n])));
        }
    }
    triangle_sides.sort_unstable();
    for side in triangle_sides.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, a), (_, b)] = *side
            && a != b
        {
            pairs.push(ordered(a, b));
        }
    }
    sorted_once(pairs)
}

fn bend_pairs(mesh: &Mesh, edges: &[[u32; 2]], positions: &[Vector]) -> Vec<[u32; 2]> {
    let both_ways = edges.iter().flat_map(|&[a, b]| [(a, b), (b, a)]);
    let neighbors = Grouped::new(mesh.vertex_count(), both_ways);
    // For each corner, the two vertices beside it.
    let corners = mesh.faces().flat_map(|corners| {
        let n = corners.len();
        let around = move |i: usize| (corners[(i + n - 1) % n], corners[(i + 1) % n]);
        (0..n).map(move |i| (corners[i], around(i)))
    });
    let corners = Grouped::new(mesh.vertex_count(), corners);
    let mut pairs = Vec::new();
    let (mut spokes, mut beside) = (Vec::new(), Vec::new());
    for middle in 0..mesh.vertex_count() {
        // Vertices may have very many neighbors: what is the same for all pairs of them is found but once.
        spokes.clear();
        spokes.extend(neighbors.of(middle).iter().map(|&end| Spoke::new(positions, middle, end)));
        beside.clear();
        beside.extend(corners.of(middle).iter().flat_map(|&(a, b)| [(a, b), (b, a)]));
        beside.sort_unstable();
        for u in &spokes {
            let of_u = beside.partition_point(|&(a, _)| a < u.end);
            let of_u = &beside[of_u..beside.partition_point(|&(a, _)| a <= u.end)];
            let shares_face = |w: u32| of_u.binary_search(&(u.end, w)).is_ok();
            let others = spokes.iter().filter(|w| w.end != u.end);
            let candidates = others.map(|w| (u.cosine(w), w.end));
            let straightest =
                candidates.filter(|&(_, w)| !shares_face(w)).min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((cosine, w)) = straightest
                && cosine <= STRAIGHT_ENOUGH
            {
                pairs.push(ordered(u.end, w));
            }
        }
    }
    sorted_once(pairs)
}

/// The edge from a vertex to a neighbor.
struct Spoke {
    end: u32,
    /// (m)
    way: Vector,
    length: f64,
}

impl Spoke {
    fn new(positions: &[Vector], middle: usize, end: u32) -> Self {
        let way = positions[end as usize] - positions[middle];
        Self { end, way, length: way.norm() }
    }

    /// Cosine of the angle between two: -1 where one continues the other straight.
    fn cosine(&self, other: &Self) -> f64 {
        self.way.dot(&other.way) / (self.length * other.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disc of 4000 triangles around one vertex: with a walk over all faces for each two of its edges this took half a minute.
    #[test]
    fn a_vertex_with_thousands_of_neighbors_takes_no_longer_than_their_pairs() {
        let count = 4000_u32;
        let angle = |vertex: u32| std::f64::consts::TAU * f64::from(vertex) / f64::from(count);
        let rim =
            (0..count).map(|vertex| Vector::new(angle(vertex).cos(), angle(vertex).sin(), 0.0));
        let positions: Vec<Vector> = rim.chain([Vector::zeros()]).collect();
        let faces: Vec<[u32; 3]> = (0..count).map(|v| [v, (v + 1) % count, count]).collect();
        let mesh = Mesh::from_faces(positions.len(), &faces).expect("a disc");
        let started = std::time::Instant::now();
        let springs = springs_of_mesh(&mesh, &positions, &SpringMaterial::default());
        assert!(started.elapsed().as_secs() < 10, "{:?}", started.elapsed());
        let bends = springs.iter().filter(|spring| spring.kind == SpringKind::Bend);
        let across = |spring: &&Spring| spring.ends[1] - spring.ends[0] == count / 2;
        assert!(bends.filter(across).count() > 1900);
    }

    fn grid(columns: u32, rows: u32) -> (Mesh, Vec<Vector>) {
        let at = |c: u32, r: u32| r * columns + c;
        let faces: Vec<[u32; 4]> = (0..rows - 1)
            .flat_map(|r| (0..columns - 1).map(move |c| (c, r)))
            .map(|(c, r)| [at(c, r), at(c + 1, r), at(c + 1, r + 1), at(c, r + 1)])
            .collect();
        let positions = (0..rows * columns)
            .map(|i| Vector::new(f64::from(i % columns), f64::from(i / columns), 0.0))
            .collect();
        (Mesh::from_faces((rows * columns) as usize, &faces).expect("a grid"), positions)
    }

    fn counts(springs: &[Spring]) -> [usize; 3] {
        SpringKind::ALL.map(|kind| springs.iter().filter(|spring| spring.kind == kind).count())
    }

    #[test]
    fn a_grid_carries_the_papers_springs() {
        for (n, m) in [(3, 3), (5, 4), (16, 16)] {
            let (mesh, positions) = grid(n, m);
            let springs = springs_of_mesh(&mesh, &positions, &SpringMaterial::default());
            let (n, m) = (n as usize, m as usize);
            let expected =
                [(n - 1) * m + n * (m - 1), 2 * (n - 1) * (m - 1), (n - 2) * m + n * (m - 2)];
            assert_eq!(counts(&springs), expected);
            let has_two_steps = springs
                .iter()
                .filter(|spring| spring.kind == SpringKind::Bend)
                .all(|spring| (spring.rest_length - 2.0).abs() < 1e-12);
            assert!(has_two_steps, "bend springs join the neighbour after next");
        }
    }

    #[test]
    fn two_triangles_are_joined_across_their_common_edge() {
        let mesh = Mesh::from_faces(4, &[[0, 1, 2], [2, 1, 3]]).expect("two triangles");
        let positions =
            [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| Vector::new(x, y, 0.0));
        let springs = springs_of_mesh(&mesh, &positions, &SpringMaterial::default());
        let shear: Vec<_> = springs.iter().filter(|s| s.kind == SpringKind::Shear).collect();
        assert_eq!(counts(&springs), [5, 1, 0]);
        assert_eq!(shear[0].ends, [0, 3]);
    }

    #[test]
    fn a_triangle_lattice_bends_along_its_three_directions() {
        let n = 7_u32;
        let positions: Vec<Vector> = (0..n * n)
            .map(|i| {
                let (c, r) = (f64::from(i % n), f64::from(i / n));
                Vector::new(c + 0.5 * r, r * 0.75_f64.sqrt(), 0.0)
            })
            .collect();
        let faces: Vec<[u32; 3]> = (0..(n - 1) * (n - 1))
            .map(|i| i / (n - 1) * n + i % (n - 1))
            .flat_map(|i| [[i, i + 1, i + n], [i + 1, i + n + 1, i + n]])
            .collect();
        let mesh = Mesh::from_faces((n * n) as usize, &faces).expect("a lattice");
        let springs = springs_of_mesh(&mesh, &positions, &SpringMaterial::default());
        let middle = n / 2 * n + n / 2;
        let bends = springs
            .iter()
            .filter(|s| s.kind == SpringKind::Bend && s.ends.contains(&middle))
            .inspect(|s| assert!((s.rest_length - 2.0).abs() < 1e-12))
            .count();
        assert_eq!(bends, 6);
    }

    #[test]
    fn a_pentagon_has_all_its_diagonals() {
        let mesh = Mesh::from_faces(5, &[[0, 1, 2, 3, 4]]).expect("a pentagon");
        let positions: Vec<Vector> = (0..5)
            .map(|i| {
                let angle = f64::from(i) * std::f64::consts::TAU / 5.0;
                Vector::new(angle.cos(), angle.sin(), 0.0)
            })
            .collect();
        let springs = springs_of_mesh(&mesh, &positions, &SpringMaterial::default());
        assert_eq!(counts(&springs), [5, 5, 0]);
    }
}
