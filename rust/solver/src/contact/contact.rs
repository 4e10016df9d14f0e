//! A contact: two features that are near each other, or will be, and the force between them.
//!
//! The gap is linear in the points, with the weights and the normal of the step's start:
//!
//! ```text
//! gap(x) = d + n·sum_i w_i (x_i - start_i)                                (m)
//! F(p)   = k p²/(2 s) for p < s,  k (p - s/2) beyond      p = reach - gap, s = reach/4   (N)
//! k      = 10 m/h² min(100, max(1, (reach/2d)²))                          (N/m)
//! f      = max(0, F(p) + c (F(p) - F(p0)))      c = 9                     (N)
//! ```
//!
//! with the mass m that the contact feels. Without the ramp over s a resting sheet trembles. The second part of f is a
//! dashpot beside the spring, from the depth p0 at the step's start: without it the lower contacts of a stack, which stop
//! what falls on them, throw it up again. It never pulls, and what starts behind has none: that comes out slowly anyway. The
//! potential of f is convex, and so is the step.
//!
//! Source: Li et al. 2020 for smooth contact in an implicit step, and for a dashpot in proportion to the spring's tangent;
//! the law is our own.

use boucle_geometry::Vector;
use boucle_geometry::distance::Closest;

use super::bodies::Bodies;
use super::candidate::Candidate;
use super::paths::Paths;

/// Stiffness of a contact, in units of m/h².
const STIFFNESS: f64 = 10.0;

/// Stiffness of the dashpot over a step, in units of the spring's: 50 layers that fall come to rest; with less, they bounce.
const DAMPING: f64 = 9.0;

/// The most by which closeness makes it stiffer. With the dashpot that is 1e4 m/h²: what single precision loses of the
/// inertia's part is below what conjugate gradients leave.
const STIFFEST: f64 = 100.0;

/// The part of the reach over which the force sets in.
const RAMP: f64 = 0.25;

/// A pair keeps no more between it than this part of its distance at rest.
pub(super) const OF_REST: f64 = 0.9;

/// What is inside a body comes out by this part of its depth a step, and by half a thickness at the least.
const OUT: f64 = 0.05;

/// What is inside or tangled comes out at most so fast (m/s), however short the steps are: it must not fly away.
const FASTEST: f64 = 1.0;

/// Distances (m) below this have no direction.
const NOWHERE: f64 = 1e-12;

/// A contact of up to four points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub(super) points: [u32; 4],
    /// Sum to zero; zero for points that take no part.
    pub(super) weights: [f64; 4],
    /// From the second feature to the first.
    pub(super) normal: Vector,
    /// Gap (m) at the start.
    distance: f64,
    /// Gap (m) below which the force sets in.
    reach: f64,
    /// Of spring and dashpot (N/m).
    stiffness: f64,
    /// What the dashpot takes from the force (N), for the depth at the start.
    relief: f64,
    /// Mass that it feels over h'² (N/m).
    pub(super) inertia: f64,
    pub(super) friction: f64,
}

/// Two features where they start, and how near they come on their way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    closest: Closest,
    normal: Vector,
    /// Gap (m) at the start.
    distance: f64,
    /// The least gap (m), at the start or at the end, between their closest points.
    nearest: f64,
    /// Gap (m) along the normal at the end, between any of their points.
    end: f64,
    /// What is kept free (m) around both.
    thickness: f64,
    /// How far (m) both may stray.
    slack: f64,
}

impl Near {
    #[inline]
    pub(super) fn new(candidate: &Candidate, bodies: &Bodies, paths: &Paths) -> Self {
        let points = candidate.points;
        let closest = candidate.closest(|point| paths.start[point as usize]);
        let length = closest.offset.norm();
        let sides = [points[0], points[3]].map(|point| bodies.body(point));
        let distance = length - sides[0].radius - sides[1].radius;
        let normal = closest.offset / length.max(NOWHERE);
        let steps = points.map(|point| normal.dot(&paths.step[point as usize]));
        let nearing: f64 = steps.iter().zip(&closest.weights).map(|(step, w)| step * w).sum();
        let (first, second) = steps.split_at(candidate.split());
        let least = first.iter().copied().fold(f64::INFINITY, f64::min);
        let most = second.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Self {
            closest,
            normal,
            distance,
            nearest: distance.min(distance + nearing),
            end: distance + least - most,
            thickness: sides[0].thickness + sides[1].thickness,
            slack: sides[0].slack + sides[1].slack,
        }
    }

    /// Whether ways that differ a little from these may lead through each other.
    pub(super) fn is_to_be_watched(&self) -> bool {
        !(self.end >= self.slack)
    }

    /// The contact of the features, if they come near enough.
    pub(super) fn contact(&self, candidate: &Candidate, bodies: &Bodies) -> Option<Contact> {
        let Self { closest, normal, distance, nearest, thickness, .. } = *self;
        if nearest >= thickness
            || closest.offset.norm() < NOWHERE
            || !bodies.speaks_for(candidate, closest.feature)
        {
            return None;
        }
        let points = candidate.points;
        let owners = [points[0], points[3]].map(|point| bodies.body_of[point as usize]);
        let reach = if owners[0] == owners[1] {
            thickness.min(OF_REST * bodies.rest_distance(candidate))
        } else {
            thickness.min(way_out(distance, thickness))
        };
        let [one, other] = owners.map(|body| bodies.each[body as usize].friction);
        (nearest < reach).then_some(Contact {
            points,
            weights: closest.weights,
            normal,
            distance,
            reach,
            stiffness: 0.0,
            relief: 0.0,
            inertia: 1.0,
            friction: (one * other).sqrt(),
        })
    }
}

/// The gap (m) that a step may end with at the most if it starts with this one.
fn way_out(distance: f64, thickness: f64) -> f64 {
    if distance < 0.0 { distance + (0.5 * thickness).max(-OUT * distance) } else { thickness }
}

impl Contact {
    /// What pushes tangled points apart along a direction, some way (m) a step.
    pub(super) fn parting(points: [u32; 4], weights: [f64; 4], normal: Vector, way: f64) -> Self {
        Self {
            points,
            weights,
            normal,
            distance: 0.0,
            reach: way,
            stiffness: 0.0,
            relief: 0.0,
            inertia: 1.0,
            friction: 0.0,
        }
    }

    /// The contact of a particle with a plane through a point with a normal, if it comes near enough.
    pub(super) fn with_plane(
        [particle, origin]: [u32; 2],
        normal: Vector,
        bodies: &Bodies,
        paths: &Paths,
    ) -> Option<Self> {
        let sides = [particle, origin].map(|point| bodies.body(point));
        let [start, step] = [&paths.start, &paths.step]
            .map(|of| normal.dot(&(of[particle as usize] - of[origin as usize])));
        let thickness = sides[0].thickness + sides[1].thickness;
        let reach = thickness.min(way_out(start, thickness));
        let friction = (sides[0].friction * sides[1].friction).sqrt();
        (start.min(start + step) < thickness).then_some(Self {
            points: [particle, origin, origin, origin],
            weights: [1.0, -1.0, 0.0, 0.0],
            normal,
            distance: start,
            reach,
            stiffness: 0.0,
            relief: 0.0,
            inertia: 1.0,
            friction,
        })
    }

    /// Takes its stiffness from the masses that it feels, for a step of h' seconds.
    pub(super) fn stiffen(&mut self, inverse_masses: &[f64], h: f64) {
        if self.distance <= 0.0 {
            self.reach = self.reach.min(self.distance + FASTEST * h);
        }
        let shares = self.points.iter().zip(&self.weights).map(|(&point, weight)| {
            inverse_masses.get(point as usize).map_or(0.0, |inverse| inverse * weight * weight)
        });
        let softness = shares.sum::<f64>() * h * h;
        if softness == 0.0 {
            (self.inertia, self.stiffness) = (1.0, 0.0);
            return;
        }
        // What is inside already comes out slowly.
        let near = if self.distance > 0.0 { 0.5 * self.reach / self.distance } else { 1.0 };
        let closeness = (near * near).clamp(1.0, STIFFEST);
        self.inertia = 1.0 / softness;
        self.stiffness = (1.0 + DAMPING) * STIFFNESS * closeness * self.inertia;
        if self.distance > 0.0 {
            let [force, _] = self.force(self.distance);
            self.relief = DAMPING / (1.0 + DAMPING) * force;
        }
    }

    /// Gap (m) where the points are `moved` (m) from their starts, summed by weights.
    #[inline]
    pub(super) fn gap(&self, moved: &Vector) -> f64 {
        self.distance + self.normal.dot(moved)
    }

    /// Force (N) and its slope (N/m) at a gap (m).
    #[inline]
    pub(super) fn force(&self, gap: f64) -> [f64; 2] {
        let depth = self.reach - gap;
        let ramp = RAMP * self.reach.abs();
        // Without a reach there is no ramp: min leaves out what is no number.
        let slope = self.stiffness * (depth / ramp).min(1.0);
        let force =
            if depth < ramp { 0.5 * slope * depth } else { self.stiffness * (depth - 0.5 * ramp) };
        if depth > 0.0 && force > self.relief { [force - self.relief, slope] } else { [0.0, 0.0] }
    }

    /// The depth (m) at which the contact would rest by itself, with the mass that it feels, if that went to a depth (m)
    /// without it, and without relief: of `a (free - p) = f(p)`.
    #[inline]
    fn rest(&self, free: f64) -> f64 {
        let Self { inertia, stiffness, reach, .. } = *self;
        let ramp = RAMP * reach.abs();
        let by_ramp = stiffness / (inertia * ramp);
        let depth = ((1.0 + 2.0 * by_ramp * free).sqrt() - 1.0) / by_ramp;
        if depth < ramp {
            depth
        } else {
            (inertia * free + 0.5 * stiffness * ramp) / (inertia + stiffness)
        }
    }

    /// Force (N) and slope (N/m) at a gap (m) for Newton's method, where the last iteration left a force (N): those of the
    /// tangent at the depth at which the contact would rest by itself. From the far side of the ramp Newton's own tangent
    /// leads there in halves only.
    #[inline]
    pub(super) fn tangent(&self, gap: f64, last: f64) -> [f64; 2] {
        let depth = self.reach - gap;
        let free = depth + (last + self.relief) / self.inertia;
        if free <= 0.0 || self.stiffness == 0.0 {
            return [0.0, 0.0];
        }
        let rest = self.rest(free);
        let [force, slope] = self.force(self.reach - rest);
        [(force + slope * (depth - rest)).max(0.0), slope]
    }

    /// Energy (J) at a gap (m).
    #[cfg(test)]
    pub(super) fn energy(&self, gap: f64) -> f64 {
        let ramp = RAMP * self.reach.abs();
        let relieved = |depth: f64| {
            let spring = if depth < ramp {
                self.stiffness * depth.powi(3) / (6.0 * ramp)
            } else {
                let beyond = depth - ramp;
                self.stiffness * (ramp * ramp / 6.0 + 0.5 * ramp * beyond + 0.5 * beyond * beyond)
            };
            spring - self.relief * depth
        };
        // Where the spring bears the relief.
        let by_ramp = (2.0 * self.relief * ramp / self.stiffness).sqrt();
        let least =
            if by_ramp < ramp { by_ramp } else { self.relief / self.stiffness + 0.5 * ramp };
        relieved((self.reach - gap).max(least)) - relieved(least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between two particles of 1 kg that start 1 mm apart, with a reach of 2 mm.
    fn pressed() -> Contact {
        let weights = [1.0, -1.0, 0.0, 0.0];
        let mut contact = Contact::parting([0, 1, 1, 1], weights, Vector::z(), 0.002);
        contact.distance = 0.001;
        contact.stiffen(&[1.0, 1.0], 0.01);
        contact
    }

    #[test]
    fn a_dashpot_does_not_change_the_force_of_what_stays_where_it_is() {
        let contact = pressed();
        let spring =
            Contact { stiffness: contact.stiffness / (1.0 + DAMPING), relief: 0.0, ..contact };
        let ([force, slope], [undamped, soft]) = (contact.force(0.001), spring.force(0.001));
        assert!((force - undamped).abs() < 1e-9 * undamped);
        assert!((slope - (1.0 + DAMPING) * soft).abs() < 1e-9 * slope);
    }

    #[test]
    fn a_dashpot_resists_what_comes_nearer_and_lets_go_of_what_opens_without_a_pull() {
        let contact = pressed();
        let [[nearer, _], [rest, _], [away, slope]] =
            [0.0009, 0.001, 0.0012].map(|gap| contact.force(gap));
        assert!(nearer > 1.5 * rest, "{nearer}, {rest}");
        assert!(away == 0.0 && slope == 0.0, "{away}, {slope}");
    }
}
