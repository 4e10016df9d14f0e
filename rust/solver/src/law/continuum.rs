//! Springs that together are as stiff as a membrane, whatever the mesh.
//!
//! The three numbers of a material are then those of the springs on a grid of squares, where a stiffness k (N/m) of
//! each kind is that of a membrane, at any resolution. Under a strain E a network stores, for each unit of area,
//!
//! ```text
//! 1/2 sum_e k_e L_e² (n·E n)² / A          whose C = sum_e k_e L_e² n n n n / A
//! ```
//!
//! and the invariant `C_iijj = sum k L²/A` of the grid of squares is 2, 4 and 8 times k for stretch, shear and bend
//! springs. On any mesh, a spring that stands for an area `A_e` gets
//!
//! ```text
//! k_e = 2 k A_e/L_e²      4 k A_e/L_e²      8 k A_e/L_e²
//! ```
//!
//! which keeps the invariant, so that the mean over all directions is right, and each direction where the mesh has
//! none of its own. The areas of one kind add up to that of the cloth: a face is shared evenly by its sides, by its
//! diagonals, or, for a triangle, by the springs across its sides; a vertex, by its bend springs.
//!
//! Source: Van Gelder 1998 for the areas; Lloyd, Székely & Harders 2007 for matching the tensor.

use std::collections::BTreeMap;

use boucle_geometry::{Mesh, Vector};

use super::Spring;
use crate::material::SpringKind;

/// `C_iijj` of a grid of squares for each unit of stiffness, by kind.
const INVARIANT: [f64; 3] = [2.0, 4.0, 8.0];

/// Replaces the membrane stiffness of springs by their own.
pub(super) fn from_membrane(mesh: &Mesh, positions: &[Vector], springs: &mut [Spring]) {
    let areas = areas(mesh, positions, springs);
    for (spring, area) in springs.iter_mut().zip(areas) {
        spring.stiffness *= INVARIANT[spring.kind as usize] * area / spring.rest_length.powi(2);
    }
}

/// The area (m²) that each spring stands for.
fn areas(mesh: &Mesh, positions: &[Vector], springs: &[Spring]) -> Vec<f64> {
    let number_of: BTreeMap<[u32; 2], usize> =
        springs.iter().enumerate().map(|(number, spring)| (spring.ends, number)).collect();
    let find = |a: u32, b: u32, kind: SpringKind| {
        let number = number_of.get(&[a.min(b), a.max(b)]).copied();
        number.filter(|&number| springs[number].kind == kind)
    };
    let mut areas = vec![0.0; springs.len()];
    let mut of_vertex = vec![0.0; mesh.vertex_count()];
    let opposite = opposite_corners(mesh);
    for (face, corners) in mesh.faces().enumerate() {
        let (n, area) = (corners.len(), mesh.vector_area(face, positions).norm());
        let corner = |i: usize| corners[i % n];
        let sides = (0..n).filter_map(|i| find(corner(i), corner(i + 1), SpringKind::Stretch));
        let across: Vec<usize> = if n == 3 {
            (0..3)
                .filter_map(|i| {
                    let other = opposite.get(&(corner(i + 1), corner(i)))?;
                    find(corner(i + 2), *other, SpringKind::Shear)
                })
                .collect()
        } else {
            let mut diagonals: Vec<usize> =
                (0..n).filter_map(|i| find(corner(i), corner(i + 2), SpringKind::Shear)).collect();
            diagonals.sort_unstable();
            diagonals.dedup();
            diagonals
        };
        for shared in [sides.collect(), across] {
            for &number in &shared {
                areas[number] += area / shared.len() as f64;
            }
        }
        for &corner in corners {
            of_vertex[corner as usize] += area / n as f64;
        }
    }
    let is_bend = |spring: &&Spring| spring.kind == SpringKind::Bend;
    let mut bends_of = vec![0.0; mesh.vertex_count()];
    for end in springs.iter().filter(is_bend).flat_map(|spring| spring.ends) {
        bends_of[end as usize] += 1.0;
    }
    for (spring, area) in springs.iter().zip(&mut areas).filter(|(spring, _)| is_bend(spring)) {
        let ends = spring.ends.map(|end| of_vertex[end as usize] / bends_of[end as usize]);
        *area = ends.iter().sum();
    }
    areas
}

/// The third corner of the triangle on each directed side.
fn opposite_corners(mesh: &Mesh) -> BTreeMap<(u32, u32), u32> {
    let triangles = mesh.faces().filter(|corners| corners.len() == 3);
    triangles
        .flat_map(|corners| {
            (0..3).map(|i| ((corners[i], corners[(i + 1) % 3]), corners[(i + 2) % 3]))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::springs_of_mesh;
    use super::*;
    use crate::material::{SpringMaterial, StiffnessFrom};
    use crate::scatter::scattered;

    const MEMBRANE: [f64; 3] = [200.0, 100.0, 3.0];

    fn springs(mesh: &Mesh, positions: &[Vector]) -> Vec<Spring> {
        let material = SpringMaterial {
            stiffness: MEMBRANE,
            stiffness_from: StiffnessFrom::Continuum,
            ..SpringMaterial::default()
        };
        springs_of_mesh(mesh, positions, &material)
    }

    /// Quads, or triangles of alternating diagonals, over `width` by `height` metres, inner vertices moved by `jitter`
    /// edges.
    fn sheet(cells: [u32; 2], size: [f64; 2], triangles: bool, jitter: f64) -> (Mesh, Vec<Vector>) {
        let [columns, rows] = cells.map(|count| count + 1);
        let at = |c: u32, r: u32| r * columns + c;
        let mut faces: Vec<Vec<u32>> = Vec::new();
        for (c, r) in (0..rows - 1).flat_map(|r| (0..columns - 1).map(move |c| (c, r))) {
            let [a, b, d, e] = [at(c, r), at(c + 1, r), at(c + 1, r + 1), at(c, r + 1)];
            match (triangles, (c + r) % 2) {
                (false, _) => faces.push(vec![a, b, d, e]),
                (true, 0) => faces.extend([vec![a, b, d], vec![a, d, e]]),
                (true, _) => faces.extend([vec![a, b, e], vec![b, d, e]]),
            }
        }
        let positions = (0..columns * rows).map(|i| {
            let (c, r) = (i % columns, i / columns);
            let is_inner = c > 0 && r > 0 && c + 1 < columns && r + 1 < rows;
            let shift =
                |k: u64| if is_inner { jitter * scattered(2 * u64::from(i) + k) } else { 0.0 };
            let x = (f64::from(c) + shift(0)) * size[0] / f64::from(cells[0]);
            let y = (f64::from(r) + shift(1)) * size[1] / f64::from(cells[1]);
            Vector::new(x, y, 0.0)
        });
        let positions = positions.collect();
        (Mesh::from_faces((columns * rows) as usize, &faces).expect("a sheet"), positions)
    }

    /// Twice the energy (N/m) of stretch and shear springs under a unit strain along a direction, for each unit of
    /// area.
    fn modulus(springs: &[Spring], positions: &[Vector], area: f64, angle: f64) -> f64 {
        let direction = Vector::new(angle.cos(), angle.sin(), 0.0);
        let energies = springs.iter().filter(|s| s.kind != SpringKind::Bend).map(|spring| {
            let [a, b] = spring.ends.map(|end| positions[end as usize]);
            let n = (a - b) / spring.rest_length;
            spring.stiffness * spring.rest_length.powi(2) * n.dot(&direction).powi(4)
        });
        energies.sum::<f64>() / area
    }

    #[test]
    fn a_grid_of_squares_keeps_its_stiffness_and_its_borders_half() {
        let (mesh, positions) = sheet([6, 5], [0.6, 0.5], false, 0.0);
        for spring in springs(&mesh, &positions) {
            let [a, b] = spring.ends.map(|end| positions[end as usize]);
            let is_border = [0, 1].into_iter().any(|axis| {
                let end = [0.6, 0.5][axis];
                (a[axis] - b[axis]).abs() < 1e-12
                    && (a[axis].abs() < 1e-12 || (a[axis] - end).abs() < 1e-12)
            });
            let factor = match spring.kind {
                SpringKind::Stretch if is_border => 0.5,
                SpringKind::Bend => continue,
                _ => 1.0,
            };
            let expected = factor * MEMBRANE[spring.kind as usize];
            assert!((spring.stiffness - expected).abs() < 1e-9, "{spring:?}: {expected}");
        }
    }

    /// Stretch twice as stiff as shear is isotropic: 1.5 times stretch along any direction.
    #[test]
    fn any_mesh_has_the_membranes_stiffness_in_every_direction() {
        let isotropic = 1.5 * MEMBRANE[0];
        for (cells, triangles, jitter, tolerance) in [
            ([40, 40], false, 0.0, 1e-9),
            ([80, 40], true, 0.0, 0.35),
            ([40, 40], false, 0.25, 0.03),
            ([40, 40], true, 0.25, 0.12),
            ([80, 80], true, 0.3, 0.12),
        ] {
            let size = [1.0, f64::from(cells[1]) / f64::from(cells[0])];
            let (mesh, positions) = sheet(cells, size, triangles, jitter);
            let springs = springs(&mesh, &positions);
            let area = size[0] * size[1];
            let moduli: Vec<f64> = (0..8)
                .map(|i| modulus(&springs, &positions, area, f64::from(i) * 0.4) / isotropic)
                .collect();
            let mean = moduli.iter().sum::<f64>() / 8.0;
            assert!((mean - 1.0).abs() < 0.03, "mean of {moduli:?}");
            assert!(moduli.iter().all(|m| (m - 1.0).abs() < tolerance), "{moduli:?}");
        }
    }
}
