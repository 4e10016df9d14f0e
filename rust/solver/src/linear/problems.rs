//! Matrices that the tests of this module share.

use boucle_geometry::Vector;

use super::field::Field;
use super::laplacian::Laplacian;
use crate::scatter::scattered;

/// Columns times rows of particles, each joined to its eight neighbors.
pub(super) fn grid(columns: u32, rows: u32) -> (Vec<Vector>, Vec<[u32; 2]>) {
    let at = |c: u32, r: u32| r * columns + c;
    let mut pairs = Vec::new();
    for r in 0..rows {
        for c in 0..columns {
            for (dc, dr) in [(1, 0), (0, 1), (1, 1), (-1, 1)] {
                let (c2, r2) = (c as i32 + dc, r + dr);
                if (0..columns as i32).contains(&c2) && r2 < rows {
                    pairs.push([at(c, r), at(c2 as u32, r2)]);
                }
            }
        }
    }
    let positions = (0..columns * rows)
        .map(|i| Vector::new(f64::from(i % columns), 0.0, f64::from(i / columns)))
        .collect();
    (positions, pairs)
}

/// Uneven weights around 1 and a thousandth of inertia.
pub(super) fn matrix(pairs: &[[u32; 2]], count: usize, pins: &[usize]) -> Laplacian {
    let weights = (0..pairs.len() as u64).map(|i| 1.0 + 0.5 * scattered(i)).collect();
    Laplacian::new(pairs, weights, vec![1e-3; count], |particle| pins.contains(&particle))
}

/// Uneven vectors.
pub(super) fn noise(count: usize) -> Field {
    Field(std::array::from_fn(|axis| {
        (0..count as u64).map(|i| scattered(3 * i + axis as u64) as f32).collect()
    }))
}
