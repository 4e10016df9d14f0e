//! How curvature varies from face to face.
//!
//! The compliance of a face has one curvature in all of it, though that of a hanging cloth grows from its rim to where it is
//! held: the sum over faces is then off by the square of what curvature grows by in a face, and a coarse cloth too soft. The
//! differences between faces side by side,
//!
//! ```text
//! mᵀ R m = sum over pairs of faces of A (K_a - K_b):D:(K_a - K_b)          (J)
//! ```
//!
//! tell that square: A the smaller area of the two, K the curvatures that moments m of hinges bend the faces to. `VARIED` of it
//! added to the energy leaves, of what a cantilever of ten cells bends too much, a tenth on grids and a fifth on meshes
//! without direction. A surface of one curvature knows nothing of it.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::compliance::{Face, components};

/// How much of R counts. With a third, cantilevers of five cells are right and finer ones too stiff.
const VARIED: f64 = 0.25;

/// The most entries in a row: the hinge, four of its faces, eight of their neighbors.
pub(super) const WIDTH: usize = 13;

/// A face that bends, as its neighbors see it.
#[derive(Clone, Copy, Debug)]
struct Bending {
    /// Its curvature for each moment at its edges (1/(N·m²)).
    curvatures: Matrix3<f64>,
    hinges: [Option<u32>; 3],
    stiffness: Vector3<f64>,
    area: f64,
}

/// The entries of `VARIED R` (rad/(N·m)) in the row of each hinge, given the compliance S of those faces that bend; and a number
/// that times `mᵀ S m` is at least `VARIED mᵀ R m`: a face has three neighbors, `(a - b)²` is at most `2 (a² + b²)`, and b counts
/// more where the yarns of a are stiffer along it.
pub(super) fn entries(
    hinge_count: usize,
    faces: &[Face],
    compliances: &[Option<Matrix3<f64>>],
) -> (Vec<Vec<(u32, f64)>>, f64) {
    let mut stiffest = 1.0_f64;
    let mut rows = vec![Vec::new(); hinge_count];
    let mut sides: Vec<Vec<(usize, usize)>> = vec![Vec::new(); hinge_count];
    for (number, face) in faces.iter().enumerate() {
        for (side, hinge) in face.hinges.iter().enumerate() {
            if let Some(hinge) = hinge {
                sides[*hinge as usize].push((number, side));
            }
        }
    }
    let bending = |(face, compliance): (&Face, &Option<Matrix3<f64>>)| {
        compliance.map(|compliance| Bending {
            curvatures: face.curvatures() * compliance,
            hinges: face.hinges,
            stiffness: components(face.bend),
            area: face.area(),
        })
    };
    let bending: Vec<Option<Bending>> = faces.iter().zip(compliances).map(bending).collect();
    for both in &sides {
        let [one, other] = both[..] else { continue };
        for (own, next) in [(one, other), (other, one)] {
            if let (Some(a), Some(b)) = (&bending[own.0], &bending[next.0]) {
                let turn = seen_from(own, next, faces);
                add(&mut rows, a, b, &turn);
                stiffest = stiffest.max(stiffer(a, b, &turn));
            }
        }
    }
    for row in &mut rows {
        merge(row);
    }
    (rows, 3.0 * VARIED * (1.0 + stiffest))
}

/// By how much the curvatures of a second face may count more with the yarns of the first than with its own.
fn stiffer(a: &Bending, b: &Bending, turn: &Matrix3<f64>) -> f64 {
    let own = Matrix3::from_diagonal(&b.stiffness.map(|of| 1.0 / of.sqrt()));
    let there = turn.transpose() * Matrix3::from_diagonal(&a.stiffness) * turn;
    (own * there * own).symmetric_eigenvalues().max()
}

/// Adds half of what a pair of faces counts for, as the first sees it, who turns the curvatures of the second to its own yarns.
fn add(rows: &mut [Vec<(u32, f64)>], a: &Bending, b: &Bending, turn: &Matrix3<f64>) {
    let mut apart = SMatrix::<f64, 3, 6>::zeros();
    apart.fixed_columns_mut::<3>(0).copy_from(&a.curvatures);
    apart.fixed_columns_mut::<3>(3).copy_from(&-(turn * b.curvatures));
    let weight = 0.5 * VARIED * a.area.min(b.area);
    let products = weight * apart.transpose() * Matrix3::from_diagonal(&a.stiffness) * apart;
    let hinges = [a.hinges, b.hinges];
    let hinges = hinges.as_flattened();
    for (i, row) in hinges.iter().enumerate() {
        for (j, column) in hinges.iter().enumerate() {
            if let (Some(row), Some(column)) = (row, column) {
                rows[*row as usize].push((*column, products[(i, j)]));
            }
        }
    }
}

/// One entry for each column, in order.
fn merge(row: &mut Vec<(u32, f64)>) {
    row.sort_by_key(|(column, _)| *column);
    row.dedup_by(|next, kept| {
        let is_same = next.0 == kept.0;
        if is_same {
            kept.1 += next.1;
        }
        is_same
    });
}

/// The way along a side of a face, in coordinates of its warp and weft, of length 1.
fn direction(face: &Face, side: usize) -> [f64; 2] {
    let [from, to] = [face.flat[side], face.flat[(side + 1) % 3]];
    let [w, f] = [to[0] - from[0], to[1] - from[1]];
    let length = w.hypot(f);
    [w / length, f / length]
}

/// What turns the curvatures of a face to the yarns and the side of another, given faces and their sides at the hinge between. A
/// face that is wound the other way is looked at from its back: its weft runs the other way, and what is up for it is down.
fn seen_from(own: (usize, usize), next: (usize, usize), faces: &[Face]) -> Matrix3<f64> {
    let [one, other] = [own, next].map(|(face, side)| direction(&faces[face], side));
    if faces[own.0].signs[own.1] * faces[next.0].signs[next.1] > 0.0 {
        return turned(one, other);
    }
    // From there both go the same way along their edge.
    turned(one, [-other[0], other[1]]) * Matrix3::from_diagonal(&Vector3::new(-1.0, -1.0, 1.0))
}

/// What turns the curvatures `(K_ww, K_ff, 2 K_wf)` of a face to the yarns of another, given the way along their common edge in
/// both, which each goes the other way.
fn turned(own: [f64; 2], next: [f64; 2]) -> Matrix3<f64> {
    let c = -(own[0] * next[0] + own[1] * next[1]);
    let s = -(next[0] * own[1] - next[1] * own[0]);
    #[rustfmt::skip]
    let turn = Matrix3::new(
        c * c, s * s, -c * s,
        s * s, c * c, c * s,
        2.0 * c * s, -2.0 * c * s, c * c - s * s,
    );
    turn
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::elements::Elements;
    use crate::fabric::tests::{cloth, sheet, uneven};
    use crate::fabric::{Fabric, Warp};
    use crate::scatter::scattered;
    use boucle_geometry::Vector;

    /// The triangles and hinges of a sheet whose yarns run another way in every face, and their compliance.
    fn elements(bend: [f64; 2]) -> (Elements, Vec<Vector>, Vec<Option<Matrix3<f64>>>) {
        let (faces, positions) = sheet([8; 2], [1.0; 2], 0.3);
        let map = (0..3 * faces.len() as u64).map(|i| [scattered(2 * i), scattered(2 * i + 1)]);
        let fabric = Fabric { warp: Warp::Mapped(map.collect()), bend, ..uneven() };
        let cloth = cloth(&faces, positions.clone(), 0.2, fabric.clone());
        let mut elements = Elements::default();
        elements.add(&cloth, &fabric, 0, 0);
        let compliances = elements.faces.iter().map(|face| Some(face.compliance())).collect();
        (elements, positions, compliances)
    }

    #[test]
    fn one_curvature_does_not_vary_whichever_way_yarns_run() {
        let (elements, positions, compliances) = elements([1e-3; 2]);
        let (entries, _) = entries(elements.hinges.len(), &elements.faces, &compliances);
        let [xx, yy, xy] = [0.3, -0.8, 0.5];
        // The moments of a sheet of that curvature: l M_nn, and D of a sheet alike in all directions is a number.
        let moments = elements.hinges.iter().map(|hinge| {
            let way = positions[hinge.corners[1] as usize] - positions[hinge.corners[0] as usize];
            (way.y * way.y * xx + way.x * way.x * yy - 2.0 * way.x * way.y * xy) / way.norm()
        });
        let moments: Vec<f64> = moments.collect();
        let is_inner = |hinge: usize| {
            let corners = elements.hinges[hinge].corners.map(|corner| positions[corner as usize]);
            corners.iter().all(|x| [x.x, x.y].iter().all(|&at| (0.24..0.76).contains(&at)))
        };
        let inner: Vec<usize> = (0..moments.len()).filter(|&hinge| is_inner(hinge)).collect();
        assert!(inner.len() > 20);
        for hinge in inner {
            let parts =
                entries[hinge].iter().map(|&(column, value)| value * moments[column as usize]);
            let (sum, size) =
                parts.fold((0.0, 0.0_f64), |(sum, size), p| (sum + p, size.max(p.abs())));
            assert!(sum.abs() < 1e-12 * size, "hinge {hinge}: {sum:e} beside {size:e}");
        }
    }

    /// What varies is a sum of squares, at most so many times what is stored, and acts both ways alike.
    #[test]
    fn what_varies_is_positive_and_bounded() {
        for bend in [[1e-3; 2], [3e-3, 1e-3], [1e-1, 1e-3]] {
            assert_bounded(bend);
        }
    }

    fn assert_bounded(bend: [f64; 2]) {
        let (elements, _, compliances) = elements(bend);
        let count = elements.hinges.len();
        let (entries, most) = entries(count, &elements.faces, &compliances);
        assert!(entries.iter().all(|row| row.len() <= WIDTH));
        let at = |row: usize, column: u32| {
            entries[row].iter().find(|entry| entry.0 == column).map(|entry| entry.1)
        };
        for (row, own) in entries.iter().enumerate() {
            for &(column, value) in own {
                let other = at(column as usize, row as u32).expect("the entry on the other side");
                assert!((value - other).abs() < 1e-9 * value.abs().max(1e-3), "{row}, {column}");
            }
        }
        for seed in 0..20_u64 {
            let mut moments: Vec<f64> =
                (0..count as u64).map(|i| scattered(seed * count as u64 + i)).collect();
            // Towards those that vary most.
            for _ in 0..30 {
                let product = |own: &Vec<(u32, f64)>| {
                    own.iter().map(|&(column, of)| of * moments[column as usize]).sum::<f64>()
                };
                let products: Vec<f64> = entries.iter().map(product).collect();
                let size = products.iter().map(|of| of * of).sum::<f64>().sqrt();
                moments = products.iter().map(|of| of / size).collect();
            }
            let varied: f64 = entries
                .iter()
                .zip(&moments)
                .map(|(own, moment)| {
                    moment
                        * own.iter().map(|&(column, of)| of * moments[column as usize]).sum::<f64>()
                })
                .sum();
            let stored: f64 = elements
                .faces
                .iter()
                .zip(&compliances)
                .map(|(face, compliance)| {
                    let at =
                        |hinge: Option<u32>| hinge.map_or(0.0, |hinge| moments[hinge as usize]);
                    let own = Vector3::from(face.hinges.map(at));
                    compliance.map_or(0.0, |compliance| own.dot(&(compliance * own)))
                })
                .sum();
            assert!(varied > 0.0 && varied < most * stored, "{varied} of {stored}");
        }
    }
}
