//! The order of elimination: nested dissection by coordinates.
//!
//! A set of particles is cut across its longest extent at the median. The particles of one side that have neighbors on
//! the other are the separator: they are eliminated last, after both halves, which no longer touch. On a grid the
//! separator is one row or column. What is small enough is eliminated as one dense block.
//!
//! Source: George 1973; cuts by coordinates after Gilbert, Miller & Teng 1998.

use std::ops::Range;

use boucle_geometry::Vector;

use super::laplacian::Graph;

/// Particles that are eliminated as one block without being cut.
const LEAF: usize = 20;

/// A block of particles that are eliminated together: a separator, or a leaf.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Block {
    /// Its particles, by their places in the order.
    pub(crate) own: Range<u32>,
    /// The blocks of its two halves; both come before it, the second directly.
    pub(crate) children: Option<[u32; 2]>,
    /// The first block of its subtree, which ends with itself.
    pub(crate) first_block: u32,
    /// The first place of its subtree.
    pub(crate) first_place: u32,
}

/// Blocks in the order of their elimination, children before parents; the last is the root.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Dissection {
    pub(crate) blocks: Vec<Block>,
    /// The particle at each place.
    pub(crate) order: Vec<u32>,
    /// The place of each particle.
    pub(crate) places: Vec<u32>,
}

impl Dissection {
    pub(crate) fn new(graph: &Graph, positions: &[Vector]) -> Self {
        let count = graph.particle_count();
        let mut cutter = Cutter {
            graph,
            positions,
            set_of: vec![0; count],
            set_count: 0,
            dissection: Self { places: vec![0; count], ..Self::default() },
        };
        if count > 0 {
            cutter.dissect((0..count as u32).collect());
        }
        let mut dissection = cutter.dissection;
        for (place, &particle) in dissection.order.iter().enumerate() {
            dissection.places[particle as usize] = place as u32;
        }
        dissection
    }
}

struct Cutter<'a> {
    graph: &'a Graph,
    positions: &'a [Vector],
    /// The set that each particle was last put into.
    set_of: Vec<u32>,
    set_count: u32,
    dissection: Dissection,
}

impl Cutter<'_> {
    /// Orders a set and returns the number of its block.
    fn dissect(&mut self, particles: Vec<u32>) -> u32 {
        let first_block = self.dissection.blocks.len() as u32;
        let first_place = self.dissection.order.len() as u32;
        let (own, children) = match self.cut(&particles) {
            None => (particles, None),
            Some([lower, upper, separator]) => {
                drop(particles);
                let lower = self.dissect(lower);
                let upper = self.dissect(upper);
                (separator, Some([lower, upper]))
            }
        };
        let start = self.dissection.order.len() as u32;
        let sorted = self.along_longest_extent(own);
        self.dissection.order.extend(sorted);
        let own = start..self.dissection.order.len() as u32;
        self.dissection.blocks.push(Block { own, children, first_block, first_place });
        self.dissection.blocks.len() as u32 - 1
    }

    /// Cuts a set into a lower and an upper half and their separator; none if it stays whole.
    fn cut(&mut self, particles: &[u32]) -> Option<[Vec<u32>; 3]> {
        if particles.len() <= LEAF {
            return None;
        }
        let mut axes = [0, 1, 2];
        let extents = self.extents(particles);
        axes.sort_by(|&a, &b| extents[b].total_cmp(&extents[a]));
        let by_axis = axes.into_iter().find_map(|axis| {
            let coordinate = |particle: u32| self.positions[particle as usize][axis];
            let mut values: Vec<f64> = particles.iter().map(|&p| coordinate(p)).collect();
            let middle = values.len() / 2;
            let median = *values.select_nth_unstable_by(middle, f64::total_cmp).1;
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            // All that lie on the median go up; if that leaves nothing below, the lowest stay below.
            let split = if least < median {
                median
            } else {
                values.iter().copied().filter(|&value| value > least).fold(f64::INFINITY, f64::min)
            };
            let (lower, upper): (Vec<u32>, Vec<u32>) =
                particles.iter().partition(|&&particle| coordinate(particle) < split);
            (!lower.is_empty() && !upper.is_empty()).then_some((lower, upper))
        });
        // Particles that all lie in one point are cut by number.
        let (lower, upper) = by_axis.unwrap_or_else(|| {
            let (lower, upper) = particles.split_at(particles.len() / 2);
            (lower.to_vec(), upper.to_vec())
        });
        Some(self.separate(lower, upper))
    }

    /// Takes out of one of two sets what touches the other, whichever is the smaller part.
    fn separate(&mut self, lower: Vec<u32>, upper: Vec<u32>) -> [Vec<u32>; 3] {
        let [below, above] = [self.mark(&lower), self.mark(&upper)];
        let touches = |particle: u32, set: u32| {
            self.graph.neighbors(particle).iter().any(|&other| self.set_of[other as usize] == set)
        };
        let (low_edge, low_rest): (Vec<u32>, Vec<u32>) =
            lower.iter().partition(|&&particle| touches(particle, above));
        let (high_edge, high_rest): (Vec<u32>, Vec<u32>) =
            upper.iter().partition(|&&particle| touches(particle, below));
        if low_edge.len() < high_edge.len() {
            [low_rest, upper, low_edge]
        } else {
            [lower, high_rest, high_edge]
        }
    }

    fn mark(&mut self, particles: &[u32]) -> u32 {
        self.set_count += 1;
        for &particle in particles {
            self.set_of[particle as usize] = self.set_count;
        }
        self.set_count
    }

    fn extents(&self, particles: &[u32]) -> Vector {
        let mut low = Vector::repeat(f64::INFINITY);
        let mut high = Vector::repeat(f64::NEG_INFINITY);
        for &particle in particles {
            low = low.inf(&self.positions[particle as usize]);
            high = high.sup(&self.positions[particle as usize]);
        }
        high - low
    }

    /// Neighbors in a row next to each other, so that what is copied is copied in runs.
    fn along_longest_extent(&self, mut particles: Vec<u32>) -> Vec<u32> {
        let axis = self.extents(&particles).imax();
        let coordinate = |particle: u32| self.positions[particle as usize][axis];
        particles.sort_by(|&a, &b| coordinate(a).total_cmp(&coordinate(b)).then(a.cmp(&b)));
        particles
    }
}
