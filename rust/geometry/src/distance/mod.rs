//! Closest points of a point and a triangle, and of two segments: what contact is made of.
//!
//! Both are the same problem: the shortest vector r - s u - t v over a convex set of (s, t), a triangle or a square. The
//! minimum lies inside, where the vector is perpendicular to u and v, or on the border, where it is the shortest of the
//! distances of a point and a segment.
//!
//! **Inside**, the normal equations would square the ratio of the longest to the shortest side, and find nothing in a
//! sliver. Gram and Schmidt's way does not; on r, too, it is as accurate as Householder's reflections (Björck 1967):
//!
//! ```text
//! v' = v - (v·u / u·u) u        v across u
//! r' = r - (r·u / u·u) u
//! t  = r'·v' / v'·v'
//! s  = (r·u - t v·u) / u·u
//! ```
//!
//! This solves exactly a problem whose u, v and r differ by a few roundings from those given. So it may name the wrong
//! point of a sliver, but never one that is farther away by more than roundings; and where it names a point outside, the
//! border is no farther than the inside by more than that. Where v' is nothing but rounding, the inside is left out: all
//! that it could reach, the border reaches.
//!
//! **On the border** each parameter is clamped to 0 to 1. The weights of vertices that take no part are zero exactly.

mod edge_edge;
mod point_triangle;

#[cfg(test)]
mod tests;

pub use edge_edge::edge_edge;
pub use point_triangle::point_triangle;

use crate::Vector;

/// Square of the share of v across u below which they count as parallel: v' is then roundings alone.
const PARALLEL: f64 = 1e-30;

/// Closest points of two features: weights w sum to 0 over the four points in order; the vector from the second closest
/// point to the first is `sum_i w_i x_i`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Barycentric weights of the second feature's (or of each edge's) points, see the functions.
    pub weights: [f64; 4],
    /// From the closest point of the second feature to that of the first (m).
    pub offset: Vector,
    /// Which of the four points take part: bit i is set if the weight of point i is not zero.
    pub feature: u8,
}

impl Closest {
    #[inline]
    fn new(weights: [f64; 4], offset: Vector) -> Self {
        let bit = |point: usize| u8::from(weights[point] != 0.0) << point;
        Self { weights, offset, feature: bit(0) | bit(1) | bit(2) | bit(3) }
    }

    /// The distance of the two features (m).
    #[inline]
    #[must_use]
    pub fn distance(&self) -> f64 {
        self.offset.norm()
    }
}

/// Two closest points on the border: weights, offset, and its square.
#[derive(Clone, Copy)]
struct Candidate {
    weights: [f64; 4],
    offset: Vector,
    square: f64,
}

impl Candidate {
    #[inline]
    fn new(weights: [f64; 4], offset: Vector) -> Self {
        Self { weights, offset, square: offset.norm_squared() }
    }

    /// The nearer of two; the first if they are as near.
    #[inline]
    fn or(self, other: Self) -> Self {
        if other.square < self.square { other } else { self }
    }

    #[inline]
    fn closest(self) -> Closest {
        Closest::new(self.weights, self.offset)
    }
}

/// The parameters (s, t) of the shortest r - s u - t v, both unbounded; none if u and v are parallel or too short.
#[inline]
fn perpendicular(r: &Vector, u: &Vector, v: &Vector) -> Option<(f64, f64)> {
    let inverse = 1.0 / u.norm_squared();
    let (along, reach) = (v.dot(u), r.dot(u));
    let across = v - u * (along * inverse);
    let square = across.norm_squared();
    // Not "too small" but "not large enough": a u of length 0 makes NaN of all this.
    if !(square > PARALLEL * v.norm_squared()) {
        return None;
    }
    let t = (r - u * (reach * inverse)).dot(&across) / square;
    Some(((reach - t * along) * inverse, t))
}

/// Where in 0 to 1 the point `to` is closest to the segment from the origin along `edge`; 0 if the segment is a point.
#[inline]
#[expect(clippy::manual_clamp, reason = "the 0 / 0 of a segment without length becomes 0, not NaN")]
fn along(to: &Vector, edge: &Vector) -> f64 {
    (to.dot(edge) / edge.norm_squared()).max(0.0).min(1.0)
}
