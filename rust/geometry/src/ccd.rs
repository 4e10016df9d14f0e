//! Continuous collision: until when two features on straight paths surely keep a gap.
//!
//! The time is reached in steps, each of which is surely safe. At some time let d be the distance of the features A and B,
//! and n the direction from the closest point of B to that of A. With x the positions at that time, Δ the motions over the
//! whole path, and l the greatest length of a Δ of A less one of B:
//!
//! ```text
//! distance after τ  >=  d - l τ                                    no two points close in faster than l
//! distance after τ  >=  min over a, b of n·(x_a - x_b) + τ n·(Δ_a - Δ_b)    n keeps A and B apart
//! ```
//!
//! Both hold for all points of the features, which are means of their vertices, and the second for any direction n; the
//! normal of the triangle or of both edges is tried, too, for it is exact where d is so small that its direction is not.
//! The step ends where the best bound reaches the gap; when the distance itself has come close to the gap, the time is
//! found. The first bound alone is additive continuous collision detection, which takes hundreds of steps where things
//! slide past each other.
//!
//! All positions are taken relative to the first point, so common motion costs no accuracy, and what roundings may amount
//! to is added to the gap: where a collision may be, one is told.
//!
//! Sources: Mirtich 1996 (conservative advancement); Li, Kaufman & Jiang 2021, Codimensional incremental potential contact
//! (additive continuous collision detection).

use crate::Vector;
use crate::distance::{Closest, edge_edge, point_triangle};

/// The time is found when this share of the first distance beyond the gap is left.
const LEFT: f64 = 1e-9;

/// Steps after which the time reached so far is the answer. Half of the tests' paths take one or two, and one in a hundred
/// more than 32; those that use up all begin nearer than 1e-4 of their size, where directions drown in roundings.
const MOST_STEPS: usize = 1000;

/// How many roundings of the largest coordinate a distance may be wrong by.
const ROUNDINGS: f64 = 64.0;

/// The time in 0 to 1 up to which a point (first) and a triangle surely stay at least `gap` (m) apart; none if they do over
/// the whole path, 0 if they do not at its start.
#[must_use]
pub fn point_triangle_impact(start: [&Vector; 4], end: [&Vector; 4], gap: f64) -> Option<f64> {
    impact::<1>(start, end, gap, |[p, a, b, c]| point_triangle(p, a, b, c))
}

/// The time in 0 to 1 up to which two edges (two points each) surely stay at least `gap` (m) apart; none if they do over the
/// whole path, 0 if they do not at its start.
#[must_use]
pub fn edge_edge_impact(start: [&Vector; 4], end: [&Vector; 4], gap: f64) -> Option<f64> {
    impact::<2>(start, end, gap, |[a, b, c, d]| edge_edge(a, b, c, d))
}

/// The time of impact of the first `FIRST` of four points and the others.
fn impact<const FIRST: usize>(
    start: [&Vector; 4],
    end: [&Vector; 4],
    gap: f64,
    closest: impl Fn(&[Vector; 4]) -> Closest,
) -> Option<f64> {
    let [from, to] = [start, end].map(|points| points.map(|point| point - points[0]));
    let motion: [Vector; 4] = std::array::from_fn(|i| to[i] - from[i]);
    let size = from.iter().chain(&to).fold(0.0, |size: f64, point| size.max(point.amax()));
    let rounding = ROUNDINGS * f64::EPSILON * size;
    let keep = gap + rounding;
    let speed = pairs::<FIRST>().map(|(a, b)| (motion[a] - motion[b]).norm()).fold(0.0, f64::max);

    let (mut time, mut enough) = (0.0, 0.0);
    for step in 0..MOST_STEPS {
        let now: [Vector; 4] = std::array::from_fn(|i| from[i] + motion[i] * time);
        let nearest = closest(&now);
        let distance = nearest.distance();
        let beyond = distance - keep;
        if beyond <= enough {
            return Some(time);
        }
        if step == 0 {
            enough = rounding.max(LEFT * beyond);
        }
        let normal = normal_of::<FIRST>(&now);
        let parted = [nearest.offset / distance, normal, -normal]
            .map(|direction| time_apart::<FIRST>(&direction, &now, &motion, keep));
        // Features that do not move against each other make the first infinite.
        time += parted.into_iter().fold(beyond / speed, f64::max);
        if time >= 1.0 {
            return None;
        }
    }
    Some(time)
}

/// The direction across a triangle or two edges; not a number if they have none.
fn normal_of<const FIRST: usize>(x: &[Vector; 4]) -> Vector {
    let [u, v] = if FIRST == 1 { [x[2] - x[1], x[3] - x[1]] } else { [x[1] - x[0], x[3] - x[2]] };
    let normal = u.cross(&v);
    normal / normal.norm()
}

/// How long a direction keeps the features farther apart than `keep`; 0 if it does not do so now.
fn time_apart<const FIRST: usize>(
    direction: &Vector,
    now: &[Vector; 4],
    motion: &[Vector; 4],
    keep: f64,
) -> f64 {
    let times = pairs::<FIRST>().map(|(a, b)| {
        let beyond = direction.dot(&(now[a] - now[b])) - keep;
        let closing = direction.dot(&(motion[b] - motion[a]));
        match (beyond > 0.0, closing > 0.0) {
            (false, _) => 0.0,
            (true, false) => f64::INFINITY,
            (true, true) => beyond / closing,
        }
    });
    times.fold(f64::INFINITY, f64::min)
}

/// Each point of the first feature with each of the second.
fn pairs<const FIRST: usize>() -> impl Iterator<Item = (usize, usize)> {
    (0..FIRST).flat_map(|a| (FIRST..4).map(move |b| (a, b)))
}

#[cfg(test)]
mod tests;
