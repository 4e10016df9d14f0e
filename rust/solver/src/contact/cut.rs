//! What keeps two features from meeting: a plane between them.
//!
//! Features A and B, closest along n, are safe if
//!
//! ```text
//! min_A n·(x + step) - max_B n·(x + step) >= need        need = clamp(d/10, 0.5 µm, 20 µm)
//! ```
//!
//! for on straight ways the gap along n is concave in time, and not less than at the start or at the end. The direction at
//! the end and the one between both are tried too. What is not safe gets a plane across n: between the wanted ends, but
//! inside the gap of the start, so that both sides start on their side and can always stay there. Before a collider,
//! which goes its way whatever comes, the plane is where the collider ends.
//!
//! Source: Chen et al. 2023 (planar divide and truncate) for planes; the test is our own.

use boucle_geometry::Vector;

use super::bodies::Bodies;
use super::candidate::Candidate;
use super::half_space::HalfSpace;
use super::paths::Paths;

/// Gap (m) that must be left: more than positions lose when they are stored in single precision near the origin.
pub(super) const LEAST: f64 = 5e-7;
pub(super) const MOST: f64 = 2e-5;

/// Rounding (m) of gaps, far below those that must be left.
const ROUNDING: f64 = 1e-12;

/// Vectors (m) no longer than this have no direction.
const NO_DIRECTION: f64 = 1e-9;

/// A direction along which features are less than this part of their distance apart is ill-defined.
const CLEAR: f64 = 0.7;

/// What is to be done about two features.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cut {
    /// Keep the first feature beyond a plane, and the second feature before it.
    Plane { candidate: Candidate, normal: Vector, offsets: [f64; 2] },
    /// Keep all points where they are.
    Stop { candidate: Candidate },
}

impl Cut {
    pub(super) fn candidate(&self) -> &Candidate {
        let (Self::Plane { candidate, .. } | Self::Stop { candidate }) = self;
        candidate
    }

    /// Whether it is a plane before something that goes its way whatever comes.
    pub(super) fn is_before_collider(&self) -> bool {
        matches!(self, Self::Plane { offsets, .. } if offsets.iter().any(|offset| offset.is_infinite()))
    }
}

/// What must be done so that two features do not meet; nothing if they are safe.
pub(super) fn cut(candidate: &Candidate, bodies: &Bodies, paths: &Paths) -> Option<Cut> {
    let (first, second) = candidate.points.split_at(candidate.split());
    let radius = bodies.body(first[0]).radius + bodies.body(second[0]).radius;
    let gap = |normal: &Vector, place_of: &dyn Fn(u32) -> Vector| {
        let along = |point: &u32| normal.dot(&place_of(*point));
        let near = first.iter().map(along).fold(f64::INFINITY, f64::min);
        let far = second.iter().map(along).fold(f64::NEG_INFINITY, f64::max);
        [near, far + radius]
    };
    let start_of = |point: u32| paths.start[point as usize];
    let end_of = |point: u32| paths.end(point);
    let offset = candidate.closest(start_of).offset;
    let length = offset.norm();
    let distance = length - radius;
    // What is inside a sphere already has to come out.
    if distance <= 0.0 && radius > 0.0 {
        return None;
    }
    let normal = offset / length;
    let [near, far] = gap(&normal, &start_of);
    if !(near - far >= CLEAR * distance && near - far > 0.0) {
        return Some(Cut::Stop { candidate: *candidate });
    }
    let need = (0.1 * distance).clamp(LEAST, MOST).min(near - far);
    let [wanted_near, wanted_far] = gap(&normal, &end_of);
    if wanted_near - wanted_far >= need - ROUNDING {
        return None;
    }
    // Features that meet, or change sides, leave no direction.
    let direction = |sum: Vector| sum.try_normalize(NO_DIRECTION);
    let other = direction(candidate.closest(end_of).offset);
    let between = other.and_then(|other| direction(normal + other));
    let is_safe = |normal: Vector| {
        let [near, far] = gap(&normal, &start_of);
        let [wanted_near, wanted_far] = gap(&normal, &end_of);
        (near - far).min(wanted_near - wanted_far) >= need - ROUNDING
    };
    if other.is_some_and(is_safe) || between.is_some_and(is_safe) {
        return None;
    }
    let offsets = if second.iter().all(|&point| !paths.is_free(point)) {
        [wanted_far + need, f64::NEG_INFINITY]
    } else if first.iter().all(|&point| !paths.is_free(point)) {
        [f64::INFINITY, wanted_near - radius - need]
    } else {
        let half = 0.5 * need;
        let middle = 0.5 * (wanted_near + wanted_far);
        let middle = middle.max(far + half).min(near - half);
        [middle + half, middle - half]
    };
    Some(Cut::Plane { candidate: *candidate, normal, offsets })
}

/// The half-spaces of a cut.
pub(super) fn half_spaces(cut: &Cut, paths: &Paths, mut add: impl FnMut(HalfSpace)) {
    let Cut::Plane { candidate, normal, offsets: [near, far] } = cut else { return };
    let (first, second) = candidate.points.split_at(candidate.split());
    for &point in first.iter().filter(|&&point| paths.is_free(point)) {
        add(HalfSpace { point, normal: *normal, offset: *near });
    }
    for &point in second.iter().filter(|&&point| paths.is_free(point)) {
        add(HalfSpace { point, normal: -normal, offset: -far });
    }
}
