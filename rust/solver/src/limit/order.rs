//! The order in which edges are limited: outward from the pins.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::grouped::Grouped;

/// An edge to be limited, its end nearer to the pins first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) near: u32,
    pub(super) far: u32,
    pub(super) rest_length: f64,
    /// How much the near end gives way where the far end gives way by 1: 0.1 if it is nearer to the pins by the
    /// whole edge, 1 if it is no nearer or nothing is pinned.
    pub(super) nearness: f64,
}

/// A distance (m) that sorts; distances are never NaN.
#[derive(Clone, Copy, PartialEq)]
struct Distance(f64);

impl Eq for Distance {}

impl PartialOrd for Distance {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Distance {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// By how much of a mean edge distances differ at least: closer ones are equal, so that rounding decides nothing.
const RESOLUTION: f64 = 1.0 / 64.0;

/// Edges sorted by the distance, along edges at rest, of their nearer end from the pins; what hangs on no pin comes
/// last, by number.
pub(super) fn outward(
    edges: &[([u32; 2], f64)],
    particle_count: usize,
    is_pinned: impl Fn(u32) -> bool,
) -> Vec<Edge> {
    let total: f64 = edges.iter().map(|(_, length)| length).sum();
    let grain = RESOLUTION * total / edges.len().max(1) as f64;
    let distances: Vec<f64> = distances(edges, particle_count, is_pinned)
        .into_iter()
        .map(|distance| (distance / grain).round() * grain)
        .collect();
    let mut sorted: Vec<(Distance, Distance, Edge)> = edges
        .iter()
        .map(|&([a, b], rest_length)| {
            let [da, db] = [a, b].map(|end| distances[end as usize]);
            let (near, far) = if db < da { (b, a) } else { (a, b) };
            let is_free = da.is_infinite();
            let nearness = if is_free { 1.0 } else { 0.1_f64.powf((da - db).abs() / rest_length) };
            let edge = Edge { near, far, rest_length, nearness };
            (Distance(da.min(db)), Distance(da.max(db)), edge)
        })
        .collect();
    sorted.sort_unstable_by_key(|&(near, far, edge)| (near, far, edge.near, edge.far));
    sorted.into_iter().map(|(_, _, edge)| edge).collect()
}

/// Dijkstra's distances from the pins (m).
fn distances(
    edges: &[([u32; 2], f64)],
    particle_count: usize,
    is_pinned: impl Fn(u32) -> bool,
) -> Vec<f64> {
    let both_ways = edges.iter().flat_map(|&([a, b], length)| [(a, (b, length)), (b, (a, length))]);
    let neighbors = Grouped::new(particle_count, both_ways);
    let mut distances = vec![f64::INFINITY; particle_count];
    let mut heap = BinaryHeap::new();
    for particle in (0..particle_count as u32).filter(|&particle| is_pinned(particle)) {
        distances[particle as usize] = 0.0;
        heap.push(Reverse((Distance(0.0), particle)));
    }
    while let Some(Reverse((Distance(distance), particle))) = heap.pop() {
        if distance > distances[particle as usize] {
            continue;
        }
        for &(neighbor, length) in neighbors.of(particle as usize) {
            let through = distance + length;
            if through < distances[neighbor as usize] {
                distances[neighbor as usize] = through;
                heap.push(Reverse((Distance(through), neighbor)));
            }
        }
    }
    distances
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_follow_each_other_outward_from_the_pin() {
        let chain = [([2, 3], 1.0), ([0, 1], 1.0), ([1, 2], 1.0)];
        let order = outward(&chain, 4, |particle| particle == 3);
        let ends: Vec<_> = order.iter().map(|edge| [edge.near, edge.far]).collect();
        assert_eq!(ends, [[3, 2], [2, 1], [1, 0]]);
        assert!(order.iter().all(|edge| (edge.nearness - 0.1).abs() < 1e-12));
    }

    #[test]
    fn a_free_piece_comes_last_and_gives_way_evenly() {
        let order = outward(&[([0, 1], 1.0), ([2, 3], 1.0)], 4, |particle| particle == 2);
        let nearness: Vec<_> = order.iter().map(|edge| edge.nearness).collect();
        assert!((nearness[0] - 0.1).abs() < 1e-12 && nearness[1].to_bits() == 1.0_f64.to_bits());
    }
}
