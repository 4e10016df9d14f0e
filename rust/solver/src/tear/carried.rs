//! What an edge carries besides its own spring: of the springs beside it, the part that pulls along it.
//!
//! A cut across an edge of length l, over the width of cloth that the edge stands for, parts other springs too. By their virial, a
//! spring of length L and tension T at an angle θ with the edge adds, averaged over the places where a cut may cross the edge,
//!
//! ```text
//! T L cos²θ / l · share
//! ```
//!
//! to it. Of a bend spring, each of the two edges along it has half; of the shear spring across a side of two triangles, each of
//! them; of a diagonal, each of the sides of a quad that lie alike; of a triangle's other sides with what bends along them, each
//! triangle beside them. Summed over a row of cells that is the force of the row.

use boucle_geometry::{Mesh, Vector};

use crate::grouped::Grouped;
use crate::law::Spring;
use crate::material::SpringKind;

/// The springs of one cloth and their tensions.
pub(crate) struct Carried<'a> {
    mesh: &'a Mesh,
    /// At rest (m).
    rest: &'a [Vector],
    /// Now (m).
    positions: &'a [Vector],
    /// Of each kind that a mesh has: ends, sorted, with the tension (N).
    kinds: [Vec<([u32; 2], f64)>; 3],
}

impl<'a> Carried<'a> {
    /// Takes stretch, shear and bend springs with their tensions (N).
    pub(crate) fn new<'s>(
        mesh: &'a Mesh,
        rest: &'a [Vector],
        positions: &'a [Vector],
        springs: impl Iterator<Item = (&'s Spring, f64)>,
    ) -> Self {
        let mut kinds = [const { Vec::new() }; 3];
        for (spring, tension) in springs.filter(|(spring, _)| spring.kind != SpringKind::Sewing) {
            kinds[spring.kind as usize].push((spring.ends, tension));
        }
        for springs in &mut kinds {
            springs.sort_unstable_by_key(|(ends, _)| *ends);
        }
        Self { mesh, rest, positions, kinds }
    }

    /// The whole tension (N) of each stretch spring, sorted by its ends.
    pub(crate) fn tensions(&self) -> Vec<f64> {
        let mut tensions: Vec<f64> =
            self.of(SpringKind::Stretch).iter().map(|(_, tension)| *tension).collect();
        self.add_bends(&mut tensions);
        self.add_faces(&mut tensions);
        tensions
    }

    fn of(&self, kind: SpringKind) -> &[([u32; 2], f64)] {
        &self.kinds[kind as usize]
    }

    fn find(&self, kind: SpringKind, a: u32, b: u32) -> Option<usize> {
        self.of(kind).binary_search_by_key(&[a.min(b), a.max(b)], |(ends, _)| *ends).ok()
    }

    fn span(&self, [a, b]: [u32; 2]) -> Vector {
        self.positions[a as usize] - self.positions[b as usize]
    }

    /// What a spring adds to an edge, by its share.
    fn along(&self, edge: usize, ends: [u32; 2], tension: f64) -> f64 {
        let along = self.span(self.of(SpringKind::Stretch)[edge].0);
        let (length, span) = (along.norm(), self.span(ends));
        let cubed = length * length * length * span.norm();
        if cubed > 0.0 { tension * span.dot(&along).powi(2) / cubed } else { 0.0 }
    }

    /// Adds the springs of each face to its sides.
    fn add_faces(&self, tensions: &mut [f64]) {
        let opposite = self.opposite_corners();
        let sides = tensions.to_vec();
        let mut springs: Vec<([u32; 2], f64)> = Vec::new();
        for face in self.mesh.faces() {
            let n = face.len();
            let side = |i: usize| self.find(SpringKind::Stretch, face[i], face[(i + 1) % n]);
            springs.clear();
            if n == 3 {
                for i in 0..3 {
                    let Some(side) = side(i) else { continue };
                    let corners = opposite.of(side);
                    let ends = self.of(SpringKind::Stretch)[side].0;
                    springs.push((ends, sides[side] / corners.len() as f64));
                    if let [a, b] = *corners
                        && let Some(across) = self.find(SpringKind::Shear, a, b)
                    {
                        let (ends, tension) = self.of(SpringKind::Shear)[across];
                        springs.push((ends, 0.5 * tension));
                    }
                }
            } else {
                let share = 1.0 / (n as f64 - 2.0);
                // A quad has each of its diagonals twice so.
                let diagonals = if n == 4 { 2 } else { n };
                springs.extend((0..diagonals).filter_map(|i| {
                    let across = self.find(SpringKind::Shear, face[i], face[(i + 2) % n])?;
                    let (ends, tension) = self.of(SpringKind::Shear)[across];
                    Some((ends, share * tension))
                }));
            }
            for edge in (0..n).filter_map(side) {
                let own = self.of(SpringKind::Stretch)[edge].0;
                let others = springs.iter().filter(|(ends, _)| *ends != own);
                tensions[edge] +=
                    others.map(|&(ends, tension)| self.along(edge, ends, tension)).sum::<f64>();
            }
        }
    }

    /// Adds each bend spring to the two edges along it: of those ways, the one that was the straightest.
    fn add_bends(&self, tensions: &mut [f64]) {
        let edges = self.of(SpringKind::Stretch).iter().zip(0_u32..);
        let both_ways =
            edges.flat_map(|(&([a, b], _), number)| [(a, (b, number)), (b, (a, number))]);
        let neighbors = Grouped::new(self.mesh.vertex_count(), both_ways);
        for &(ends, tension) in self.of(SpringKind::Bend) {
            let [of_a, of_b] = ends.map(|end| neighbors.of(end as usize));
            let [a, b] = ends.map(|end| self.rest[end as usize]);
            // Neighbors are sorted, as edges are.
            let common = of_a.iter().filter_map(|&(middle, first)| {
                let place = of_b.binary_search_by_key(&middle, |(vertex, _)| *vertex).ok()?;
                let middle = self.rest[middle as usize];
                Some(((a - middle).norm() + (middle - b).norm(), [first, of_b[place].1]))
            });
            let Some((_, way)) = common.min_by(|one, other| one.0.total_cmp(&other.0)) else {
                continue;
            };
            for edge in way {
                tensions[edge as usize] += 0.5 * self.along(edge as usize, ends, tension);
            }
        }
    }

    /// For each edge, the third corners of the triangles beside it.
    fn opposite_corners(&self) -> Grouped<u32> {
        let triangles = self.mesh.faces().filter(|face| face.len() == 3);
        let sides = triangles.flat_map(|face| {
            (0..3).filter_map(|i| {
                let side = self.find(SpringKind::Stretch, face[i], face[(i + 1) % 3])?;
                Some((side as u32, face[(i + 2) % 3]))
            })
        });
        let sides: Vec<_> = sides.collect();
        Grouped::new(self.of(SpringKind::Stretch).len(), sides.into_iter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::springs_of_mesh;
    use crate::material::SpringMaterial;

    /// Cells on each side, enough that the middle does not see the border.
    const N: u32 = 12;

    /// Meshes of unit cells: quads, quads cut into triangles, and rows of equilateral triangles.
    fn meshes() -> [(Mesh, Vec<Vector>); 3] {
        let cells = (0..N * N).map(|i| (i / N) * (N + 1) + i % N);
        let quads: Vec<[u32; 4]> = cells.map(|a| [a, a + 1, a + N + 2, a + N + 1]).collect();
        let halves: Vec<[u32; 3]> =
            quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let count = ((N + 1) * (N + 1)) as usize;
        let place = |i: usize| {
            let i = i as u32;
            Vector::new(f64::from(i % (N + 1)), f64::from(i / (N + 1)), 0.0)
        };
        let square: Vec<Vector> = (0..count).map(place).collect();
        let lean = |x: &Vector| Vector::new(x.x - 0.5 * x.y, 0.75_f64.sqrt() * x.y, 0.0);
        let leaning = square.iter().map(lean).collect();
        let of = |faces: &[[u32; 3]]| Mesh::from_faces(count, faces).expect("triangles");
        [
            (Mesh::from_faces(count, &quads).expect("quads"), square.clone()),
            (of(&halves), square),
            (of(&halves), leaning),
        ]
    }

    /// The tension of a spring that gets longer as its place does.
    fn tension(spring: &Spring, now: &[Vector]) -> f64 {
        let [a, b] = spring.ends.map(|end| now[end as usize]);
        spring.stiffness * ((a - b).norm() - spring.rest_length)
    }

    /// Strained the same everywhere, an edge carries the stress along it over its width. The stress is that of all springs whose
    /// middle lies in a block of cells: their virial by its area.
    #[test]
    fn an_edge_carries_the_stress_along_it() {
        let material = SpringMaterial { stiffness: [500.0, 300.0, 200.0], ..Default::default() };
        for (mesh, rest) in meshes() {
            let springs = springs_of_mesh(&mesh, &rest, &material);
            for [xx, yy, xy] in
                [[0.0, 1e-4, 0.0], [1e-4, 0.0, 0.0], [5e-5, 5e-5, 5e-5], [2e-4, 1e-4, -7e-5]]
            {
                let strained =
                    |x: &Vector| x + Vector::new(xx * x.x + xy * x.y, xy * x.x + yy * x.y, 0.0);
                let now: Vec<Vector> = rest.iter().map(strained).collect();
                let corner = |column: u32, row: u32| now[(row * (N + 1) + column) as usize];
                let [right, up] = [corner(8, 4) - corner(4, 4), corner(4, 8) - corner(4, 4)];
                let area = right.cross(&up).norm();
                let is_inside = |x: Vector| {
                    let x = x - corner(4, 4) - 1e-3 * (right + up);
                    let parts = [x.cross(&up).norm(), right.cross(&x).norm()];
                    let signs = [x.cross(&up).z, right.cross(&x).z];
                    (0..2).all(|i| signs[i] >= 0.0 && parts[i] < area)
                };
                let mut stress = nalgebra::Matrix3::zeros();
                for spring in &springs {
                    let [a, b] = spring.ends.map(|end| now[end as usize]);
                    if is_inside(0.5 * (a + b)) {
                        let span = a - b;
                        let by = tension(spring, &now) / span.norm() / area;
                        stress += by * span * span.transpose();
                    }
                }
                let pulls = springs.iter().map(|spring| (spring, tension(spring, &now)));
                let carried = Carried::new(&mesh, &rest, &now, pulls);
                let from = 6 * (N + 1) + 6;
                for to in [from + 1, from + N + 1, from + N + 2] {
                    let Some(edge) = carried.find(SpringKind::Stretch, from, to) else { continue };
                    let along = now[to as usize] - now[from as usize];
                    let faces = mesh.faces().filter(|f| f.contains(&from) && f.contains(&to));
                    let shares = faces.map(|f| 1.0 / (f.len() as f64 - 2.0)).sum::<f64>();
                    let cell = area * f64::from(N * N) / 16.0 / mesh.face_count() as f64;
                    let width = cell * shares / along.norm();
                    let expected = along.dot(&(stress * along)) / along.norm_squared() * width;
                    let found = carried.tensions()[edge];
                    assert!((found - expected).abs() < 1e-3 * stress.norm(), "{found} {expected}");
                }
            }
        }
    }
}
