//! How many Chebyshev steps stand for the inverse of the compliances' sum.
//!
//! As many as its condition asks for, which grows with the square of how long faces are for their width: eight steps on squares cut
//! in two, 31 on triangles of 1:8, 61 of 1:16. One sliver among a hundred faces does not count: it is softer than it should be, and
//! the others cost what they did.

use nalgebra::Matrix3;

use crate::linear::chebyshev;

/// Error of the moments that is left, as a part of them.
pub(super) const LEFT: f64 = 0.01;

/// The most steps for the sake of a few faces, and the condition that they are then made for: slivers among others are
/// then softer than they should be.
const MOST_STEPS: usize = 24;
const MOST_CONDITION: f64 = 400.0;

/// The most if more than one face in so many asks for it.
const MANY: usize = 100;
const MOST_CONDITION_OF_MANY: f64 = 2000.0;

/// The least and the largest eigenvalue of the scaled compliance of one face: of the sum, they lie between those of its parts.
pub(super) fn eigenvalues(compliance: &Matrix3<f64>) -> Option<[f64; 2]> {
    let diagonal = compliance.diagonal();
    if !diagonal.iter().all(|&value| value > 0.0) {
        return None;
    }
    let scaled = Matrix3::from_fn(|i, j| compliance[(i, j)] / (diagonal[i] * diagonal[j]).sqrt());
    let eigenvalues = scaled.symmetric_eigenvalues();
    Some([eigenvalues.min(), eigenvalues.max()])
}

/// The least eigenvalue that only one face in so many is below.
pub(super) fn of_many(lows: &mut [f64]) -> f64 {
    if lows.is_empty() {
        return 1.0;
    }
    let rank = lows.len() / MANY;
    lows.select_nth_unstable_by(rank, f64::total_cmp).1.min(1.0)
}

/// As many Chebyshev steps as leave little of the error, given the least eigenvalue of all faces and that of all but a few.
pub(super) fn steps(low: f64, low_of_many: f64, high: f64) -> Vec<[f32; 2]> {
    // Of a matrix that is hardly regular, the steps leave the stiffest parts out.
    let few = low.max(high / MOST_CONDITION);
    let many = low_of_many.max(high / MOST_CONDITION_OF_MANY);
    let most = MOST_STEPS.max(count(many, high));
    let low = few.min(many).min(0.98 * high);
    chebyshev::steps(low as f32, high as f32).take(count(low, high).min(most)).collect()
}

/// How many steps leave little of the error.
fn count(low: f64, high: f64) -> usize {
    let root = (high / low.min(0.98 * high)).sqrt();
    let factor = (root - 1.0) / (root + 1.0);
    ((0.5 * LEFT).ln() / factor.ln()).ceil().max(1.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_slivers_cost_the_others_nothing() {
        let mut lows = vec![1.0 / 3.0; 1000];
        lows[..9].fill(1e-6);
        assert_eq!(steps(1e-6, of_many(&mut lows), 2.0).len(), MOST_STEPS);
        lows[..20].fill(1e-6);
        assert!(steps(1e-6, of_many(&mut lows), 2.0).len() > 4 * MOST_STEPS);
    }
}
