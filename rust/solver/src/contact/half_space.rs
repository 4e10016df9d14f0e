//! Half-spaces that points must end in, and the nearest ends that do.

use boucle_geometry::Vector;

use crate::state::Coordinates;

/// A half-space `n·x >= offset` in which a point must end.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfSpace {
    pub(super) point: u32,
    pub(super) normal: Vector,
    /// m.
    pub(super) offset: f64,
}

/// Where particles may go that have been cut short: what else moves them keeps to it.
#[derive(Debug, Default)]
pub(crate) struct Walls {
    /// In the order of their points.
    half_spaces: Vec<HalfSpace>,
    /// Which particles have half-spaces, and which stay where they are; empty without walls.
    is_walled: Vec<bool>,
    is_stopped: Vec<bool>,
}

impl Walls {
    /// Adds half-spaces, and those of all particles that stay where they are.
    pub(super) fn add(&mut self, half_spaces: Vec<HalfSpace>, is_stopped: &[bool]) {
        self.is_walled.resize(is_stopped.len(), false);
        self.is_stopped.resize(is_stopped.len(), false);
        for (kept, is_stopped) in self.is_stopped.iter_mut().zip(is_stopped) {
            *kept |= is_stopped;
        }
        for half_space in &half_spaces {
            self.is_walled[half_space.point as usize] = true;
        }
        self.half_spaces.extend(half_spaces);
        self.half_spaces.sort_by_key(|half_space| half_space.point);
    }

    /// Whether a particle stays where it is.
    pub(crate) fn stop(&self, particle: usize) -> bool {
        self.is_stopped.get(particle) == Some(&true)
    }

    /// Puts a particle back into its half-spaces, one after the other.
    pub(crate) fn keep(&self, particle: usize, positions: &mut Coordinates) {
        if self.is_walled.get(particle) != Some(&true) {
            return;
        }
        let first = self.half_spaces.partition_point(|each| (each.point as usize) < particle);
        let own = self.half_spaces[first..].iter();
        let mut place = positions.get(particle);
        for HalfSpace { normal, offset, .. } in own.take_while(|own| own.point as usize == particle)
        {
            place += normal * (offset - normal.dot(&place)).max(0.0);
        }
        positions.set(particle, &place);
    }
}

/// Rounding (m) of a start that lies on the plane of its half-space.
const ROUNDING: f64 = 1e-12;

/// Sweeps over the half-spaces of a point: sliding along two of them takes a few.
const SWEEPS: usize = 8;

/// The end (m) of a point that starts in all its half-spaces, as near as a few projections get to where it wants to go.
///
/// What they leave outside a half-space is mended by going back towards the start; where a collider pushes, the start
/// itself is outside, and the half-space is left as it is.
pub(super) fn end_within(start: &Vector, wanted: Vector, half_spaces: &[HalfSpace]) -> Vector {
    let mut end = wanted;
    for _ in 0..SWEEPS {
        let mut is_inside = true;
        for HalfSpace { normal, offset, .. } in half_spaces {
            let missing = offset - normal.dot(&end);
            if missing > 0.0 {
                end += normal * missing;
                is_inside = false;
            }
        }
        if is_inside {
            return end;
        }
    }
    let part = half_spaces.iter().fold(1.0_f64, |part, HalfSpace { normal, offset, .. }| {
        let [from, to] = [start, &end].map(|place| normal.dot(place) - offset);
        let inside = from.max(0.0);
        if to < 0.0 && from >= -ROUNDING { part.min(inside / (inside - to)) } else { part }
    });
    start + (end - start) * if part < 1.0 { part * (1.0 - 1e-9) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half_space(normal: [f64; 3], offset: f64) -> HalfSpace {
        HalfSpace { point: 0, normal: Vector::from(normal).normalize(), offset }
    }

    #[test]
    fn a_point_slides_along_the_planes_that_stop_it() {
        let planes = [half_space([0.0, 0.0, 1.0], 0.0), half_space([1.0, 0.0, 0.0], -1.0)];
        let end = end_within(&Vector::new(0.0, 0.0, 1.0), Vector::new(-3.0, 2.0, -1.0), &planes);
        assert!((end - Vector::new(-1.0, 2.0, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn a_point_in_a_narrow_wedge_ends_inside_it() {
        let planes = [half_space([0.01, 0.0, 1.0], 0.0), half_space([0.01, 0.0, -1.0], 0.0)];
        let end = end_within(&Vector::new(1.0, 0.0, 0.0), Vector::new(-5.0, 0.0, 0.0), &planes);
        assert!(planes.iter().all(|plane| plane.normal.dot(&end) >= plane.offset));
        assert!(end.x < 0.5, "{end}");
    }

    #[test]
    fn a_point_that_starts_on_a_plane_but_for_rounding_stays_before_it() {
        let start = Vector::new(1.0, 0.0, -1e-17);
        let planes = [half_space([0.0, 0.0, 1.0], 0.0), half_space([0.01, 0.0, -1.0], 0.0)];
        let end = end_within(&start, Vector::new(-5.0, 0.0, 0.0), &planes);
        assert!(end.z > -1e-12, "{end}");
        assert!(planes[1].normal.dot(&end) >= -1e-12, "{end}");
    }
}
