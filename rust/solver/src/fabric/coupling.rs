//! What pairs of a fabric's particles weigh in the constant matrix of an implicit step: one number, the same in all directions.
//!
//! A triangle's tangent is at most, with the stiffest of what acts along each yarn,
//!
//! ```text
//! A ((Y_warp + G) dw dwᵀ + (Y_weft + G) df dfᵀ)
//! ```
//!
//! whose entries off the diagonal are the opposite of the weights. Those of obtuse angles would be negative: they count as 0.

use super::membrane::{MembraneLaw, Triangle};

/// The weight (N/m) of each pair of particles, sorted by pair, and what of it damps (N·s/m).
pub(super) fn weights(triangles: &[Triangle], laws: &[MembraneLaw]) -> Vec<([u32; 2], [f64; 2])> {
    let mut all: Vec<([u32; 2], [f64; 2])> = Vec::with_capacity(3 * triangles.len());
    for triangle in triangles {
        let law = &laws[triangle.law as usize];
        let [stretch, shear] = law.times;
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let [a, b] = [triangle.corners[i], triangle.corners[j]];
            let products = triangle.gradients.map(|of| -triangle.area * of[i] * of[j]);
            let along = |stiffness: [f64; 2], shear: f64| {
                let sum: f64 = products.iter().zip(stiffness).map(|(p, of)| p * (of + shear)).sum();
                sum.max(0.0)
            };
            let stiffness = along(law.stretch, law.shear);
            let damping = along(law.stretch.map(|of| stretch * of), shear * law.shear);
            all.push(([a.min(b), a.max(b)], [stiffness, damping]));
        }
    }
    all.sort_by_key(|(pair, _)| *pair);
    all.chunk_by(|a, b| a.0 == b.0)
        .map(|same| {
            let sum =
                same.iter().fold([0.0; 2], |sum, (_, own)| [sum[0] + own[0], sum[1] + own[1]]);
            (same[0].0, sum)
        })
        .collect()
}
