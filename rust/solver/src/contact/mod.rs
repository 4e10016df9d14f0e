//! Contact: cloth with itself, with other cloth, and with colliders.
//!
//! **Positions at the end of every step are free of intersections if they were at its start**, and if the colliders leave
//! room. A step
//!
//! 1. detects: which features come near each other on the way that the cloth would take ([`candidate`]),
//! 2. takes those as contacts with a force and friction into its linear system ([`contact`], [`friction`], [`matrix`]),
//! 3. truncates: cuts the solved way short where features would meet all the same ([`truncation`]).
//!
//! Lists are made by tasks that do not depend on threads and joined in their order; sums are gathered point by point.

mod bodies;
mod candidate;
#[expect(clippy::module_inception, reason = "the module of contact holds the type of one contact")]
mod contact;
mod cut;
mod detection;
mod easing;
mod enclosure;
mod exclusion;
mod features;
mod friction;
mod half_space;
mod intersections;
mod matrix;
mod paths;
mod pressing;
mod recovery;
mod response;
mod search;
mod settling;
mod sewn;
mod sieve;
#[cfg(test)]
mod tests;
mod truncation;

use boucle_geometry::{Vector, Way};

use crate::cloth::Cloth;
use crate::collider::Collider;
use crate::interrupter::Interrupter;
use crate::state::Coordinates;
use bodies::Bodies;
use candidate::Candidate;
use contact::Contact;
pub use detection::Detection;
pub(crate) use enclosure::facing;
use features::Trees;
pub(crate) use half_space::Walls;
pub(crate) use matrix::ContactMatrix;
use paths::Paths;
use pressing::{Pressure, Remembered};
use recovery::Tangle;
pub(crate) use response::Response;

/// The longest way (m) that colliders and cloth may go towards each other before they meet contacts again.
pub(crate) const LONGEST_WAY: f64 = 0.15;

/// Everything that touches, and how.
#[derive(Debug)]
pub(crate) struct Contacts {
    bodies: Bodies,
    cloths: Trees,
    colliders: Trees,
    paths: Paths,
    /// The same ways in f32, as boxes were last fitted to them.
    ways: Vec<Way>,
    /// Where all points were (m) when the step began: what slips has slipped from there.
    origins: Vec<Vector>,
    /// Where the colliders' points are (m) at the start and at the end of the frame.
    frame: [Vec<Vector>; 2],
    near: Vec<Contact>,
    /// What has passed through.
    tangle: Tangle,
    /// Candidates that may meet on ways near those that were expected, and those ways (m).
    watched: Vec<Candidate>,
    expected: Vec<Vector>,
    /// Whether the present ways are free of intersections.
    is_safe: bool,
    /// What ways were cut short by.
    walls: Walls,
    pub(crate) matrix: ContactMatrix,
    /// What each contact does at the present guess.
    pressures: Vec<Pressure>,
    /// The force (N) on particles before the cloths were torn, until the next step.
    carried: Vec<(u32, f64)>,
    remembered: Remembered,
    /// Vertices that were cut short since they were last counted.
    clipped: u32,
    interrupter: Interrupter,
}

impl Contacts {
    pub(crate) fn new(cloths: &[Cloth], colliders: &[Collider], interrupter: &Interrupter) -> Self {
        let bodies = Bodies::new(cloths, colliders);
        let of_colliders = &bodies.rest[bodies.particle_count..];
        Self {
            cloths: Trees::new(&bodies.cloths, &bodies.rest, &bodies.body_of),
            colliders: Trees::new(&bodies.colliders, &bodies.rest, &bodies.body_of),
            paths: Paths::at_rest(&bodies.rest),
            ways: vec![Way::default(); bodies.rest.len()],
            origins: bodies.rest.clone(),
            frame: [of_colliders.to_vec(), of_colliders.to_vec()],
            near: Vec::new(),
            tangle: Tangle::default(),
            watched: Vec::new(),
            expected: vec![Vector::zeros(); bodies.rest.len()],
            is_safe: false,
            walls: Walls::default(),
            matrix: ContactMatrix::default(),
            pressures: Vec::new(),
            carried: Vec::new(),
            remembered: Remembered::default(),
            clipped: 0,
            interrupter: interrupter.clone(),
            bodies,
        }
    }

    /// Takes over which particles are pinned.
    pub(crate) fn follow_pins(&mut self, inverse_masses: &[f64]) {
        self.paths.follow_pins(inverse_masses);
    }

    /// Takes over how far the edges at each vertex of a cloth have shrunk, whose first particle is `base`: what lies near each
    /// other at rest may then lie nearer.
    pub(crate) fn scale_rest(&mut self, base: u32, scales: &[f64]) {
        let Bodies { scales: all, rest, .. } = &mut self.bodies;
        all.resize(rest.len(), 1.0);
        all[base as usize..base as usize + scales.len()].copy_from_slice(scales);
    }

    /// Whether nothing can touch anything.
    pub(crate) fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// How many contacts the last step had.
    pub(crate) fn count(&self) -> u32 {
        self.near.len() as u32
    }

    /// Whether anything pressed in the step before.
    pub(crate) fn remembers(&self) -> bool {
        !self.remembered.is_empty()
    }

    /// Vertices whose way was cut short, once for each cut, since this was last asked.
    pub(crate) fn take_clipped(&mut self) -> u32 {
        std::mem::take(&mut self.clipped)
    }

    /// The same, without forgetting them.
    pub(crate) fn clipped(&self) -> u32 {
        self.clipped
    }

    /// What ways have been cut short by since it was forgotten.
    pub(crate) fn walls(&self) -> &Walls {
        &self.walls
    }

    pub(crate) fn forget_walls(&mut self) {
        self.walls = Walls::default();
    }

    /// The force (N) that each contact presses each of its particles with.
    pub(crate) fn pressures(&self) -> impl Iterator<Item = (u32, f64)> {
        let points = self.near.iter().zip(&self.pressures).flat_map(|(contact, pressure)| {
            let shares = contact.weights.map(|weight| weight.abs() * pressure.force);
            contact.points.into_iter().zip(shares)
        });
        let points = points.filter(|&(point, _)| self.bodies.is_particle(point));
        points.chain(self.carried.iter().copied())
    }

    /// Takes over the forces (N) of particles that now are others, to tell them until the next step.
    pub(crate) fn carry(&mut self, forces: Vec<(u32, f64)>) {
        self.carried = forces;
    }

    /// The particles of each edge and triangle that pass through each other.
    pub(crate) fn tangled(&self) -> impl Iterator<Item = u32> {
        let crossings = self.tangle.crossings.iter();
        let points = crossings
            .flat_map(|crossing| crossing.edge.points.into_iter().chain(crossing.triangle.points));
        points.filter(|&point| self.bodies.is_particle(point))
    }

    /// Where the points of all colliders are (m), and where they are to be at the end of the next frame.
    pub(crate) fn collider_positions(&self) -> &[Vec<Vector>; 2] {
        &self.frame
    }

    /// Puts the points of all colliders there (m).
    pub(crate) fn place_colliders(&mut self, positions: [Vec<Vector>; 2]) {
        self.frame = positions;
    }

    /// Sends points of colliders, from one of them on, to targets (m) that they reach at the end of the next frame.
    pub(crate) fn aim(&mut self, first: usize, targets: &[Vector]) {
        self.frame[1][first..first + targets.len()].copy_from_slice(targets);
    }

    /// The longest way (m) that a collider and a particle with one of these velocities (m/s), or a pin that is told to go so far
    /// (m), go towards each other over the next frame of a duration (s); 0 without colliders.
    pub(crate) fn longest_way(&self, velocities: &Coordinates, pin_way: f64, duration: f64) -> f64 {
        let ways = self.frame[0].iter().zip(&self.frame[1]).map(|(from, to)| (to - from).norm());
        if self.is_empty() || self.frame[0].is_empty() {
            return 0.0;
        }
        let speeds =
            (0..self.bodies.particle_count).map(|particle| velocities.get(particle).norm_squared());
        let of_particles = duration * speeds.fold(0.0, f64::max).sqrt();
        ways.fold(0.0, f64::max) + of_particles.max(pin_way)
    }

    /// Ends a frame: its end is the start of the next.
    pub(crate) fn end_frame(&mut self) {
        let [from, to] = &mut self.frame;
        from.copy_from_slice(to);
    }

    /// Starts a step over a part of a frame, from and to, of so many parts, with particles at these positions (m).
    pub(crate) fn start_step(&mut self, part: [u32; 2], count: u32, positions: &Coordinates) {
        let at = |part: u32, from: &Vector, to: &Vector| {
            // What arrives is exactly there.
            if part == count {
                *to
            } else {
                from + f64::from(part) / f64::from(count) * (to - from)
            }
        };
        let first = self.bodies.particle_count;
        let [from, to] = &self.frame;
        for ((start, from), to) in self.paths.start[first..].iter_mut().zip(from).zip(to) {
            *start = at(part[0], from, to);
        }
        self.paths.set_starts(positions);
        self.follow_tangle(positions);
        let [from, to] = &self.frame;
        let Paths { start, step, .. } = &mut self.paths;
        let ways = start[first..].iter().zip(&mut step[first..]);
        for ((start, step), (from, to)) in ways.zip(from.iter().zip(to)) {
            *step = at(part[1], from, to) - start;
        }
        self.origins.copy_from_slice(&self.paths.start);
        if part[0] == 0 {
            // A frame depends on nothing but the state at its start.
            self.near.clear();
            self.pressures.clear();
            self.carried.clear();
        }
    }

    /// Starts the rest of a step from where its first part has ended (m): the colliders have already gone their way.
    pub(crate) fn start_again(&mut self, positions: &Coordinates) {
        self.paths.set_starts(positions);
        let count = self.bodies.particle_count;
        let colliders = self.paths.start[count..].iter_mut().zip(&mut self.paths.step[count..]);
        for (start, step) in colliders {
            *start += std::mem::take(step);
        }
    }

    /// Calls `visit` with each particle and each plane that it may touch, and the plane's normal at the end of the step.
    fn each_plane(&self, mut visit: impl FnMut(u32, &bodies::Plane, Vector)) {
        let Self { bodies, paths, .. } = self;
        for plane in &bodies.planes {
            let [origin, ahead] = plane.points.map(|point| paths.end(point));
            let normal = (ahead - origin).normalize();
            for particle in 0..bodies.particle_count as u32 {
                if bodies.may_touch(&[particle], &plane.points[..1]) {
                    visit(particle, plane, normal);
                }
            }
        }
    }
}
