//! Which springs lie on diagonals and which are gathered, found once and for all.

use std::collections::BTreeMap;
use std::ops::Range;

use super::CHUNK;
use crate::cloth::{Cloth, placed};
use crate::law::Spring;
use crate::law::spring::Law;
use crate::material::SpringKind;

/// A diagonal holds a spring for at least one in so many of a cloth's particles; fewer are gathered.
const SPARSEST: usize = 8;

/// Springs from particles in a row to those `offset` further on, of one stiffness and damping.
#[derive(Clone, Debug)]
pub(crate) struct Diagonal {
    /// The particle of the first rest length.
    pub(crate) first: usize,
    pub(crate) offset: usize,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    pub(crate) law: Law,
    pub(crate) is_bend: bool,
    /// For each particle in a row (m); 0 where it has no such spring.
    pub(crate) rest_lengths: Vec<f64>,
}

impl Diagonal {
    /// Those of these particles at which it may have a spring.
    #[inline(always)]
    pub(super) fn within(&self, particles: Range<usize>) -> Range<usize> {
        let start = particles.start.max(self.first);
        start..particles.end.min(self.first + self.rest_lengths.len()).max(start)
    }
}

/// Gathered particles that are computed side by side.
pub(crate) const GATHERED: usize = 8;

/// Up to `GATHERED` particles of one chunk; the last stands in for those that lack.
#[derive(Clone, Debug)]
pub(crate) struct Gather {
    pub(crate) particles: [u32; GATHERED],
    pub(crate) count: usize,
    pub(crate) slots: Range<usize>,
    pub(crate) law: Law,
}

/// One spring of each gathered particle; one that has no more is joined to itself by no spring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GatherSlot {
    /// The gather that it belongs to.
    pub(crate) gather: u32,
    /// Whether its springs resist bending: none stands beside one of another kind.
    pub(crate) is_bend: bool,
    pub(crate) neighbors: [u32; GATHERED],
    pub(crate) stiffness: [f64; GATHERED],
    pub(crate) damping: [f64; GATHERED],
    pub(crate) rest_lengths: [f64; GATHERED],
}

/// Where a layout has a spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// A diagonal, and the number of the spring on it.
    Diagonal(u32, u32),
    /// For each end, slot and lane.
    Gathered([(u32, u32); 2]),
}

/// All the springs of a simulation as the kernel reads them.
#[derive(Debug, Default)]
pub(crate) struct Layout {
    pub(crate) diagonals: Vec<Diagonal>,
    pub(crate) gathers: Vec<Gather>,
    pub(crate) gather_slots: Vec<GatherSlot>,
    pub(crate) gathers_of_chunk: Vec<Range<usize>>,
    /// Slot and lane of both ends of each seam.
    pub(crate) seams: Vec<[(u32, u32); 2]>,
}

/// A spring as one of its ends sees it.
#[derive(Clone, Copy, Debug)]
struct Half {
    neighbor: u32,
    spring: Spring,
}

impl Layout {
    pub(crate) fn new(cloths: &[Cloth]) -> Self {
        let mut layout = Self::default();
        let mut halves = Vec::new();
        let mut laws = Vec::new();
        for cloth in cloths {
            let law = Law::of(cloth);
            let base = laws.len();
            laws.resize(base + cloth.positions.len(), law);
            halves.resize(laws.len(), Vec::new());
            for springs in alike(cloth).into_values() {
                let may_be_diagonal = springs[0].kind != SpringKind::Sewing;
                if may_be_diagonal && springs.len() * SPARSEST >= cloth.positions.len() {
                    layout.diagonals.push(diagonal(&springs, base, law));
                } else {
                    scatter(&springs, base as u32, &mut halves);
                }
            }
        }
        for start in (0..laws.len()).step_by(CHUNK) {
            let end = (start + CHUNK).min(laws.len());
            layout.add_gathers(start..end, &halves, &laws);
        }
        layout.find_seams(cloths, laws.len());
        layout
    }

    /// Where springs between these pairs of particles are, bend springs or others; none for pairs that none joins.
    pub(crate) fn places(
        &self,
        pairs: impl IntoIterator<Item = [u32; 2]>,
        particle_count: usize,
        is_bend: bool,
    ) -> Vec<Option<Place>> {
        let mut gathered = vec![None; particle_count];
        for gather in &self.gathers {
            for (lane, &particle) in gather.particles[..gather.count].iter().enumerate() {
                gathered[particle as usize] = Some((gather, lane));
            }
        }
        let end = |own: u32, other: u32| {
            let (gather, lane) = gathered[own as usize]?;
            let slot = gather.slots.clone().find(|&slot| {
                let slot = &self.gather_slots[slot];
                slot.neighbors[lane] == other
                    && slot.rest_lengths[lane] > 0.0
                    && slot.is_bend == is_bend
            });
            Some((slot? as u32, lane as u32))
        };
        let place = |[a, b]: [u32; 2]| {
            let [first, offset] = [a.min(b), a.abs_diff(b)].map(|number| number as usize);
            let diagonal = self.diagonals.iter().position(|diagonal| {
                let springs = first.checked_sub(diagonal.first);
                let rest_length = springs.and_then(|spring| diagonal.rest_lengths.get(spring));
                let joins = rest_length.is_some_and(|length| *length > 0.0);
                joins && diagonal.offset == offset && diagonal.is_bend == is_bend
            });
            if let Some(diagonal) = diagonal {
                let spring = first - self.diagonals[diagonal].first;
                return Some(Place::Diagonal(diagonal as u32, spring as u32));
            }
            Some(Place::Gathered([end(a, b)?, end(b, a)?]))
        };
        pairs.into_iter().map(place).collect()
    }

    fn find_seams(&mut self, cloths: &[Cloth], particle_count: usize) {
        let seams: Vec<[u32; 2]> = placed(cloths)
            .flat_map(|(cloth, base)| {
                let seams = cloth.springs.iter().filter(|s| s.kind == SpringKind::Sewing);
                seams.map(move |seam| seam.ends.map(|end| base + end))
            })
            .collect();
        if seams.is_empty() {
            return;
        }
        let places = self.places(seams, particle_count, false).into_iter().flatten();
        self.seams = places
            .filter_map(|place| match place {
                Place::Gathered(ends) => Some(ends),
                Place::Diagonal(..) => None,
            })
            .collect();
    }

    /// Gives both ends of a seam, by its number among all, another stiffness (N/m) and damping (N·s/m).
    pub(crate) fn set_seam(&mut self, seam: usize, stiffness: f64, damping: f64) {
        for (slot, lane) in self.seams[seam] {
            let slot = &mut self.gather_slots[slot as usize];
            slot.stiffness[lane as usize] = stiffness;
            slot.damping[lane as usize] = damping;
        }
    }

    /// Gives the spring at a place another rest length (m).
    pub(crate) fn set_rest_length(&mut self, place: Place, rest_length: f64) {
        match place {
            Place::Diagonal(diagonal, spring) => {
                self.diagonals[diagonal as usize].rest_lengths[spring as usize] = rest_length;
            }
            Place::Gathered(ends) => {
                for (slot, lane) in ends {
                    self.gather_slots[slot as usize].rest_lengths[lane as usize] = rest_length;
                }
            }
        }
    }

    fn add_gathers(&mut self, chunk: Range<usize>, halves: &[Vec<Half>], laws: &[Law]) {
        let first = self.gathers.len();
        let mut particles: Vec<usize> = chunk.filter(|&i| !halves[i].is_empty()).collect();
        // Like numbers of springs fill a gather with the least waste; the order within a chunk is free.
        particles.sort_by_key(|&particle| halves[particle].len());
        for same_law in particles.chunk_by(|&a, &b| laws[a] == laws[b]) {
            for particles in same_law.chunks(GATHERED) {
                self.add_gather(particles, halves, laws[particles[0]]);
            }
        }
        self.gathers_of_chunk.push(first..self.gathers.len());
    }

    fn add_gather(&mut self, particles: &[usize], halves: &[Vec<Half>], law: Law) {
        let first_slot = self.gather_slots.len();
        let of_lane = |lane: usize| particles[lane.min(particles.len() - 1)];
        for is_bend in [false, true] {
            let of_kind = |particle: usize| {
                let springs = halves[particle].iter();
                springs.filter(move |half| (half.spring.kind == SpringKind::Bend) == is_bend)
            };
            let degree = particles.iter().map(|&particle| of_kind(particle).count()).max();
            for slot in 0..degree.unwrap_or(0) {
                let mut lanes = GatherSlot {
                    gather: self.gathers.len() as u32,
                    is_bend,
                    neighbors: std::array::from_fn(|lane| of_lane(lane) as u32),
                    stiffness: [0.0; GATHERED],
                    damping: [0.0; GATHERED],
                    rest_lengths: [0.0; GATHERED],
                };
                for lane in 0..GATHERED {
                    let Some(half) = of_kind(of_lane(lane)).nth(slot) else { continue };
                    lanes.neighbors[lane] = half.neighbor;
                    lanes.stiffness[lane] = half.spring.stiffness;
                    lanes.damping[lane] = half.spring.damping;
                    lanes.rest_lengths[lane] = half.spring.rest_length;
                }
                self.gather_slots.push(lanes);
            }
        }
        self.gathers.push(Gather {
            particles: std::array::from_fn(|lane| of_lane(lane) as u32),
            count: particles.len(),
            slots: first_slot..self.gather_slots.len(),
            law,
        });
    }
}

/// What the springs of one diagonal have in common: kind, offset, stiffness and damping (as bits).
type Likeness = (usize, u32, u64, u64);

/// A cloth's springs, smaller end first, by what they have in common.
fn alike(cloth: &Cloth) -> BTreeMap<Likeness, Vec<Spring>> {
    let mut groups = BTreeMap::new();
    for spring in cloth.springs.iter().filter(|s| s.stiffness > 0.0 || s.damping > 0.0) {
        let [a, b] = spring.ends;
        let likeness = (
            spring.kind as usize,
            a.abs_diff(b),
            spring.stiffness.to_bits(),
            spring.damping.to_bits(),
        );
        let group: &mut Vec<Spring> = groups.entry(likeness).or_default();
        group.push(Spring { ends: [a.min(b), a.max(b)], ..*spring });
    }
    groups
}

fn diagonal(springs: &[Spring], base: usize, law: Law) -> Diagonal {
    let starts = springs.iter().map(|spring| spring.ends[0] as usize);
    let first = starts.clone().min().unwrap_or(0);
    let last = starts.max().unwrap_or(0);
    let mut rest_lengths = vec![0.0; last - first + 1];
    for spring in springs {
        rest_lengths[spring.ends[0] as usize - first] = spring.rest_length;
    }
    let Spring { ends: [a, b], kind, stiffness, damping, .. } = springs[0];
    let offset = (b - a) as usize;
    let is_bend = kind == SpringKind::Bend;
    Diagonal { first: base + first, offset, stiffness, damping, law, is_bend, rest_lengths }
}

fn scatter(springs: &[Spring], base: u32, halves: &mut [Vec<Half>]) {
    for &spring in springs {
        let [a, b] = spring.ends.map(|end| base + end);
        halves[a as usize].push(Half { neighbor: b, spring });
        halves[b as usize].push(Half { neighbor: a, spring });
    }
}
