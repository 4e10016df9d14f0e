//! Two edges.

use super::{Candidate, Closest, along, perpendicular};
use crate::Vector;

/// Closest points of the segments ab and cd: weights (1 - s, s, -(1 - t), -t) of a, b, c, d.
#[inline]
#[must_use]
pub fn edge_edge(a: &Vector, b: &Vector, c: &Vector, d: &Vector) -> Closest {
    let (ab, cd, ca) = (b - a, d - c, a - c);
    // The shortest of (a + s ab) - (c + t cd) = ca - t cd + s ab.
    if let Some((t, minus_s)) = perpendicular(&ca, &cd, &ab) {
        let s = -minus_s;
        if s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0 {
            return Closest::new([1.0 - s, s, t - 1.0, -t], ca + ab * s - cd * t);
        }
    }
    let (cb, da) = (b - c, a - d);
    let a_on_cd = along(&ca, &cd);
    let b_on_cd = along(&cb, &cd);
    let c_on_ab = along(&-ca, &ab);
    let d_on_ab = along(&-da, &ab);
    Candidate::new([1.0, 0.0, a_on_cd - 1.0, 0.0 - a_on_cd], ca - cd * a_on_cd)
        .or(Candidate::new([0.0, 1.0, b_on_cd - 1.0, 0.0 - b_on_cd], cb - cd * b_on_cd))
        .or(Candidate::new([1.0 - c_on_ab, c_on_ab, -1.0, 0.0], ca + ab * c_on_ab))
        .or(Candidate::new([1.0 - d_on_ab, d_on_ab, 0.0, -1.0], da + ab * d_on_ab))
        .closest()
}
