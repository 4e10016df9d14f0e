//! Brute force is the oracle.

use super::{Bvh, Sweep};
use crate::Vector;
use crate::scatter::Scatter;

/// Balls that move.
struct Balls {
    middles: Vec<Vector>,
    moves: Vec<Vector>,
    radius: f64,
}

impl Balls {
    fn new(count: usize, seed: u64, speed: f64) -> Self {
        let mut scatter = Scatter(seed);
        let middles = (0..count).map(|_| 0.5 * scatter.point()).collect();
        let common = Vector::new(3.0, -2.0, 1.0);
        let moves = (0..count).map(|_| common + 0.5 * speed * scatter.point()).collect();
        Self { middles, moves, radius: 0.03 }
    }

    fn sweep(&self, item: u32) -> Sweep {
        let item = item as usize;
        Sweep::around([(&self.middles[item], &self.moves[item])], self.radius)
    }

    fn bvh(&self) -> Bvh {
        let mut bvh = Bvh::new(&self.middles, &vec![0; self.middles.len()]);
        bvh.fit(|item| self.sweep(item));
        bvh
    }

    /// The test of the module's lecture, in f64.
    fn meets(&self, other: &Self, a: usize, b: usize) -> bool {
        let reach = self.radius + other.radius;
        (0..3).all(|axis| {
            let gap = other.middles[b][axis] - self.middles[a][axis];
            let nearing = other.moves[b][axis] - self.moves[a][axis];
            gap - reach + nearing.min(0.0) <= 0.0 && -gap - reach + (-nearing).min(0.0) <= 0.0
        })
    }
}

#[test]
fn all_pairs_that_may_meet_are_found_once_and_only_they() {
    for count in [0, 1, 7, 8, 9, 65, 700] {
        let balls = Balls::new(count, 7, 0.2);
        let mut found = balls.bvh().pairs(|a, b, found| found.push([a.min(b), a.max(b)]));
        found.sort_unstable();
        let expected: Vec<[u32; 2]> = (0..count)
            .flat_map(|a| (a + 1..count).map(move |b| [a, b]))
            .filter(|&[a, b]| balls.meets(&balls, a, b))
            .map(|pair| pair.map(|item| item as u32))
            .collect();
        assert_eq!(found, expected, "{count} balls");
        assert!(count < 700 || found.len() > 100);
    }
}

#[test]
fn pairs_with_a_marked_item_are_found_once() {
    let balls = Balls::new(500, 3, 0.3);
    let is_marked = |item: u32| item % 37 < 3;
    let bvh = balls.bvh();
    let mut found = bvh.pairs_of_marked(is_marked, |a, b, found| found.push([a.min(b), a.max(b)]));
    found.sort_unstable();
    let mut expected = bvh.pairs(|a, b, found| {
        if is_marked(a) || is_marked(b) {
            found.push([a.min(b), a.max(b)]);
        }
    });
    expected.sort_unstable();
    assert_eq!(found, expected);
    assert!(!found.is_empty());
}

#[test]
fn two_hierarchies_find_their_pairs() {
    let (few, many) = (Balls::new(40, 1, 0.5), Balls::new(600, 2, 0.1));
    let mut found = many.bvh().pairs_with(&few.bvh(), |a, b, found| found.push([a, b]));
    found.sort_unstable();
    let expected: Vec<[u32; 2]> = (0..600)
        .flat_map(|a| (0..40).map(move |b| [a, b]))
        .filter(|&[a, b]| many.meets(&few, a, b))
        .map(|pair| pair.map(|item| item as u32))
        .collect();
    assert_eq!(found, expected);
    let none = Balls::new(0, 0, 0.0).bvh();
    assert!(none.pairs_with(&many.bvh(), |a, b, found| found.push([a, b])).is_empty());
    assert!(many.bvh().pairs_with(&none, |a, b, found| found.push([a, b])).is_empty());
    let marked = many.bvh().pairs_of_marked_with(
        |item| item < 300,
        &few.bvh(),
        |a, b, found: &mut Vec<_>| {
            found.push([a, b]);
        },
    );
    assert_eq!(marked.len(), expected.iter().filter(|pair| pair[0] < 300).count());
}

#[test]
fn what_falls_together_does_not_meet() {
    let balls = Balls::new(300, 5, 0.0);
    let apart = balls.bvh().pairs(|a, b, found| found.push([a, b])).len();
    let still = Balls { moves: vec![Vector::zeros(); 300], ..balls };
    assert_eq!(apart, still.bvh().pairs(|a, b, found| found.push([a, b])).len());
}

#[test]
fn found_pairs_come_in_the_same_order_on_any_number_of_threads() {
    let balls = Balls::new(3000, 11, 0.1);
    let bvh = balls.bvh();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| bvh.pairs(|a, b, found| found.push([a, b])))
    };
    assert_eq!(on(1), on(3));
}
