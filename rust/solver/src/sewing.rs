//! Seams as they are drawn together.
//!
//! A seam pulls its ends together with
//!
//! ```text
//! F = min(k d, F_max)          (N)          d = |x_i - x_j|
//! ```
//!
//! as a spring of no rest length whose stiffness over a step is `s k`, `s = min(1, F_max/(k d))`, d taken as the step begins.
//! Its damping is `sqrt(s)` times that of the closed seam: critical all the way, for the cloth that it draws. A seam that is
//! welded has no limit and is many times as stiff: its ends stay where no load of cloth parts them visibly.

use crate::cloth::{Cloth, placed};
use crate::kernel::Layout;
use crate::material::SpringKind;
use crate::state::Coordinates;

/// A welded seam is so many times as stiff.
const WELDED: f64 = 50.0;

#[derive(Clone, Copy, Debug)]
struct Seam {
    ends: [u32; 2],
    cloth: usize,
    /// Its spring in the cloth.
    spring: usize,
    /// (N/m) and (N·s/m)
    stiffness: f64,
    damping: f64,
    /// (N); 0 for none.
    force_max: f64,
    /// (m); 0 for never.
    weld_distance: f64,
    is_welded: bool,
}

/// The seams of all cloths, in the layout's order.
#[derive(Debug, Default)]
pub(crate) struct Seams {
    seams: Vec<Seam>,
    has_limits: bool,
}

impl Seams {
    pub(crate) fn new(cloths: &[Cloth]) -> Self {
        let mut seams = Vec::new();
        for (index, (cloth, base)) in placed(cloths).enumerate() {
            let Some(sewing) = &cloth.tailoring.sewing else { continue };
            let springs = cloth.springs.iter().enumerate();
            let sewn = springs.filter(|(_, spring)| spring.kind == SpringKind::Sewing);
            seams.extend(sewn.map(|(number, spring)| Seam {
                ends: spring.ends.map(|end| base + end),
                cloth: index,
                spring: number,
                stiffness: spring.stiffness,
                damping: spring.damping,
                force_max: sewing.force_max,
                weld_distance: sewing.weld_distance,
                is_welded: false,
            }));
        }
        let has_limits = seams.iter().any(|seam| seam.force_max > 0.0);
        Self { seams, has_limits }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.seams.is_empty()
    }

    /// The particles that each seam joins.
    pub(crate) fn ends(&self) -> impl Iterator<Item = [u32; 2]> {
        self.seams.iter().map(|seam| seam.ends)
    }

    /// The force (N) of the seam between two particles at these positions; 0 if there is none.
    pub(crate) fn pull(&self, ends: [u32; 2], positions: &Coordinates) -> f64 {
        let Ok(place) = self.seams.binary_search_by_key(&ends, |seam| seam.ends) else {
            return 0.0;
        };
        let seam = &self.seams[place];
        let pull = seam.stiffness * positions.distance_squared(ends[0], ends[1]).sqrt();
        match (seam.is_welded, seam.force_max > 0.0) {
            (true, _) => WELDED * pull,
            (false, true) => pull.min(seam.force_max),
            (false, false) => pull,
        }
    }

    /// Gives the seams of a cloth the stiffness with which it was given.
    pub(crate) fn put_given(&self, number: usize, cloth: &mut Cloth) {
        for seam in self.seams.iter().filter(|seam| seam.cloth == number) {
            cloth.springs[seam.spring].stiffness = seam.stiffness;
        }
    }

    /// Which seams are welded.
    pub(crate) fn welded(&self) -> impl Iterator<Item = bool> {
        self.seams.iter().map(|seam| seam.is_welded)
    }

    /// Welds the seams whose ends are near enough, and says whether there were any.
    pub(crate) fn weld(
        &mut self,
        positions: &Coordinates,
        cloths: &mut [Cloth],
        layout: &mut Layout,
    ) -> bool {
        let is_closed = |seam: &Seam| {
            let [a, b] = seam.ends;
            let distance = positions.distance_squared(a, b).sqrt();
            seam.is_welded || distance < seam.weld_distance
        };
        let closed: Vec<bool> = self.seams.iter().map(is_closed).collect();
        self.jump(closed.into_iter(), cloths, layout)
    }

    /// Takes over which seams are welded, and says whether that is new.
    pub(crate) fn jump(
        &mut self,
        welded: impl Iterator<Item = bool>,
        cloths: &mut [Cloth],
        layout: &mut Layout,
    ) -> bool {
        let mut is_new = false;
        for (number, (seam, is_welded)) in self.seams.iter_mut().zip(welded).enumerate() {
            if seam.is_welded == is_welded {
                continue;
            }
            (seam.is_welded, is_new) = (is_welded, true);
            let stiffness = if is_welded { WELDED * seam.stiffness } else { seam.stiffness };
            cloths[seam.cloth].springs[seam.spring].stiffness = stiffness;
            layout.set_seam(number, stiffness, seam.damping);
        }
        is_new
    }

    /// Limits the force of seams that are open as a step begins at these positions.
    pub(crate) fn limit(&self, positions: &Coordinates, layout: &mut Layout) {
        if !self.has_limits {
            return;
        }
        for (number, seam) in self.seams.iter().enumerate() {
            if seam.is_welded || seam.force_max == 0.0 {
                continue;
            }
            let [a, b] = seam.ends;
            let distance = positions.distance_squared(a, b).sqrt();
            let pull = seam.stiffness * distance;
            let part = if pull > seam.force_max { seam.force_max / pull } else { 1.0 };
            layout.set_seam(number, part * seam.stiffness, part.sqrt() * seam.damping);
        }
    }
}

/// Energy (J) of a seam of stiffness k (N/m) and largest force (N; 0 for none) whose ends are so far apart (m).
pub(crate) fn energy(stiffness: f64, force_max: f64, distance: f64) -> f64 {
    let limited = force_max / stiffness;
    if force_max > 0.0 && distance > limited {
        force_max * (distance - 0.5 * limited)
    } else {
        0.5 * stiffness * distance * distance
    }
}
