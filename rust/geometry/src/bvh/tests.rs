//! Brute force is the oracle.

use super::{Bvh, Sweep, Way};
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
        Sweep::of([&Way::new(&self.middles[item], &self.moves[item], self.radius)])
    }

    fn bvh(&self) -> Bvh {
        let mut bvh = Bvh::new(&self.middles, &vec![0; self.middles.len()]);
        bvh.fit(|item| self.sweep(item));
        bvh
    }

    /// The test of the module's lecture, in f64.
    fn meets(&self, other: &Self, a: usize, b: usize) -> bool {
        self.nearly_meets(other, a, b, 0.0)
    }

    /// The same with so much (m) between them, as boxes in f32 are larger.
    fn nearly_meets(&self, other: &Self, a: usize, b: usize, gap: f64) -> bool {
        let reach = self.radius + other.radius + gap;
        (0..3).all(|axis| {
            let gap = other.middles[b][axis] - self.middles[a][axis];
            let nearing = other.moves[b][axis] - self.moves[a][axis];
            gap - reach + nearing.min(0.0) <= 0.0 && -gap - reach + (-nearing).min(0.0) <= 0.0
        })
    }
}

/// The pairs of all tasks, by smaller and larger item, in order.
fn sorted(found: &[Vec<[u32; 2]>]) -> Vec<[u32; 2]> {
    let mut found: Vec<[u32; 2]> = found.concat();
    for pair in &mut found {
        pair.sort_unstable();
    }
    found.sort_unstable();
    found
}

fn keep(pairs: &[[u32; 2]], found: &mut Vec<[u32; 2]>) {
    found.extend_from_slice(pairs);
}

#[test]
fn all_pairs_that_may_meet_are_found_once_and_only_they() {
    for count in [0, 1, 7, 8, 9, 65, 700] {
        let balls = Balls::new(count, 7, 0.2);
        let found = sorted(&balls.bvh().pairs(keep));
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
        let within = |gap: f64| -> Vec<[u32; 2]> {
            let near = pairs.clone().filter(|&[a, b]| balls.nearly_meets(&balls, a, b, gap));
            near.map(|pair| pair.map(|item| item as u32)).collect()
        };
        let is_found = |pair: &[u32; 2]| found.binary_search(pair).is_ok();
        assert!(within(0.0).iter().all(is_found), "{count} balls: {found:?}");
        let near = within(2e-5);
        assert!(found.iter().all(|pair| near.binary_search(pair).is_ok()), "{count}: {found:?}");
        assert!(found.windows(2).all(|pairs| pairs[0] != pairs[1]), "{count}: {found:?}");
        assert!(count < 700 || found.len() > 100);
    }
}

#[test]
fn pairs_with_a_marked_item_are_found_once() {
    let balls = Balls::new(1500, 3, 0.2);
    let bvh = balls.bvh();
    // Many, some in each group; few, with groups without any.
    for every in [37, 400] {
        let is_marked = |item: u32| item % every < 3;
        let found = sorted(&bvh.pairs_of_marked(is_marked, keep));
        let mut expected = sorted(&bvh.pairs(keep));
        expected.retain(|&[a, b]| is_marked(a) || is_marked(b));
        assert_eq!(found, expected);
        assert!(!found.is_empty());
    }
}

#[test]
fn two_hierarchies_find_their_pairs() {
    let (few, many) = (Balls::new(40, 1, 0.5), Balls::new(600, 2, 0.1));
    let mut found = many.bvh().pairs_with(&few.bvh(), keep).concat();
    found.sort_unstable();
    let expected: Vec<[u32; 2]> = (0..600)
        .flat_map(|a| (0..40).map(move |b| [a, b]))
        .filter(|&[a, b]| many.meets(&few, a, b))
        .map(|pair| pair.map(|item| item as u32))
        .collect();
    assert_eq!(found, expected);
    let none = Balls::new(0, 0, 0.0).bvh();
    assert!(none.pairs_with(&many.bvh(), keep).concat().is_empty());
    assert!(many.bvh().pairs_with(&none, keep).concat().is_empty());
    let marked = many.bvh().pairs_of_marked_with(|item| item < 300, &few.bvh(), keep).concat();
    assert_eq!(marked.len(), expected.iter().filter(|pair| pair[0] < 300).count());
}

#[test]
fn what_falls_together_does_not_meet() {
    let balls = Balls::new(300, 5, 0.0);
    let apart = balls.bvh().pairs(keep).concat().len();
    let still = Balls { moves: vec![Vector::zeros(); 300], ..balls };
    assert_eq!(apart, still.bvh().pairs(keep).concat().len());
}

#[test]
fn what_is_no_number_or_beyond_all_numbers_meets_nothing_that_is_not_there() {
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, -f64::MAX] {
        let mut balls = Balls::new(20, 9, 0.1);
        balls.middles[3] = Vector::repeat(odd);
        balls.moves[7] = Vector::repeat(odd);
        let found = balls.bvh().pairs(keep).concat();
        assert!(found.iter().flatten().all(|&item| item < 20), "{odd}: {found:?}");
    }
}

#[test]
fn found_pairs_come_in_the_same_order_on_any_number_of_threads() {
    let balls = Balls::new(3000, 11, 0.1);
    let bvh = balls.bvh();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| bvh.pairs(keep))
    };
    assert_eq!(on(1), on(3));
}
