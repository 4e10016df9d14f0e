//! A point and a triangle.

use super::{Candidate, Closest, along, perpendicular};
use crate::Vector;

/// Closest points of a point and a triangle: weights (1, -u, -v, -w) of p, a, b, c.
#[inline]
#[must_use]
pub fn point_triangle(p: &Vector, a: &Vector, b: &Vector, c: &Vector) -> Closest {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    if let Some((v, w)) = perpendicular(&ap, &ab, &ac) {
        let u = 1.0 - v - w;
        if u > 0.0 && v > 0.0 && w > 0.0 {
            return Closest::new([1.0, -u, -v, -w], ap - ab * v - ac * w);
        }
    }
    let (bc, bp) = (c - b, p - b);
    let on_ab = along(&ap, &ab);
    let on_bc = along(&bp, &bc);
    let on_ac = along(&ap, &ac);
    Candidate::new([1.0, on_ab - 1.0, 0.0 - on_ab, 0.0], ap - ab * on_ab)
        .or(Candidate::new([1.0, 0.0, on_bc - 1.0, 0.0 - on_bc], bp - bc * on_bc))
        .or(Candidate::new([1.0, on_ac - 1.0, 0.0, 0.0 - on_ac], ap - ac * on_ac))
        .closest()
}
