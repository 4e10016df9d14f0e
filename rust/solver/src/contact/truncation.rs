//! No way goes through anything: ways are cut short by planes between the features that would meet ([`super::cut`]).
//!
//! Points go as near to where they want as their planes let them ([`super::half_space`]), which may bring them near
//! others: those are looked for in rounds, until there are none. Planes stay; after some rounds, what still is not safe
//! stays where it started, and what meets that, until all is safe.
//!
//! Where the step was expected to lead is known from detection, and with it all candidates that may meet on ways that differ
//! from those by no more than the slack of the cloth. Only what strays farther is looked for again.

use boucle_geometry::Vector;
use rayon::prelude::*;

use super::Contacts;
use super::candidate::Candidate;
use super::cut::{Cut, LEAST, MOST, cut, half_spaces};
use super::half_space::{HalfSpace, end_within};
use crate::state::Coordinates;

/// Rounds of cutting: only what colliders push together takes as many.
const ROUNDS: usize = 500;

/// Rounds after which what is not safe no longer moves.
const SLIDING_ROUNDS: usize = 12;

/// Candidates that one task checks, at the least.
const CANDIDATES: usize = 256;

/// What has been cut so far.
struct Cutting {
    half_spaces: Vec<HalfSpace>,
    /// The ways (m) that were asked for.
    wanted: Vec<Vector>,
    is_stopped: Vec<bool>,
    /// Points whose ways are no longer those that were last checked.
    is_changed: Vec<bool>,
}

impl Contacts {
    /// Cuts the ways to these positions (m) short where they would lead through anything, and returns how many were.
    pub(crate) fn truncate(&mut self, ends: &mut Coordinates) -> u32 {
        let safe = self.paths.step.clone();
        self.paths.set_ends(ends);
        let count = self.bodies.particle_count;
        let changes = self.paths.step[..count].iter().zip(&safe);
        let mut cutting = Cutting {
            half_spaces: Vec::new(),
            wanted: self.paths.step.clone(),
            is_stopped: vec![false; count],
            is_changed: changes.map(|(step, safe)| !self.is_safe || step != safe).collect(),
        };
        if cutting.is_changed.contains(&true) {
            self.stay_before_planes(&mut cutting);
            for round in 0..ROUNDS {
                if self.interrupter.is_asked() {
                    break;
                }
                let cuts = self.cuts(&cutting.is_changed);
                self.take_up(&cuts, round < SLIDING_ROUNDS, &mut cutting);
                if !cutting.is_changed.contains(&true) {
                    break;
                }
            }
        }
        self.is_safe = true;
        self.walls.add(cutting.half_spaces, &cutting.is_stopped);
        self.write_ends(&cutting.wanted, ends)
    }

    /// Adds the half-spaces of planes that particles would end behind.
    fn stay_before_planes(&mut self, cutting: &mut Cutting) {
        let paths = &self.paths;
        self.each_plane(|particle, plane, normal| {
            let origin = paths.end(plane.points[0]);
            let gap = normal.dot(&(paths.end(particle) - origin));
            // What starts behind comes out by contact, and goes no deeper.
            let start = paths.start[particle as usize] - paths.start[plane.points[0] as usize];
            let least = LEAST.min(normal.dot(&start));
            if paths.is_free(particle) && gap < least {
                let offset = normal.dot(&origin) + least;
                cutting.half_spaces.push(HalfSpace { point: particle, normal, offset });
            }
        });
        self.shorten(cutting);
    }

    /// The cuts that ways need of which some have changed.
    fn cuts(&mut self, is_changed: &[bool]) -> Vec<Cut> {
        let is_concerned = |candidate: &Candidate| {
            candidate.points.iter().any(|&point| is_changed.get(point as usize) == Some(&true))
        };
        let Self { bodies, paths, watched, expected, .. } = &*self;
        let watched = watched.par_iter().with_min_len(CANDIDATES);
        let cuts = watched.filter(|candidate| is_concerned(candidate));
        let mut cuts: Vec<Cut> =
            cuts.filter_map(|candidate| cut(candidate, bodies, paths)).collect();
        // What is not watched keeps the slack of both along a direction: twice the gap that must be left is still there.
        let is_astray = |point: usize| {
            let slack = bodies.body(point as u32).slack - 2.0 * MOST;
            (paths.step[point] - expected[point]).norm_squared() > slack * slack
        };
        let is_astray: Vec<bool> = (0..is_changed.len()).map(is_astray).collect();
        if is_astray.contains(&true) {
            self.fit(|body| body.radius + MOST);
            let Self { bodies, paths, .. } = &*self;
            // Pairs with a point that has changed and one that is astray: all are found from the fewer of both.
            let count = |marks: &[bool]| marks.iter().filter(|is_marked| **is_marked).count();
            let marks = if count(&is_astray) < count(is_changed) { &is_astray } else { is_changed };
            let found = self.search_changed(marks, |candidate, found: &mut Vec<Cut>| {
                found.extend(cut(&candidate, bodies, paths));
            });
            cuts.extend(found.into_iter().flatten());
        }
        cuts
    }

    /// Takes cuts up: with their planes, if points may still slide along them. What that does not move, stops.
    fn take_up(&mut self, cuts: &[Cut], may_slide: bool, cutting: &mut Cutting) {
        cutting.is_changed.fill(false);
        for cut in cuts.iter().filter(|cut| may_slide || cut.is_before_collider()) {
            half_spaces(cut, &self.paths, |half_space| cutting.half_spaces.push(half_space));
        }
        self.shorten(cutting);
        let Cutting { is_stopped, is_changed, .. } = cutting;
        let is_moved = |point: &u32| is_changed.get(*point as usize) == Some(&true);
        let idle = cuts.iter().map(Cut::candidate).filter(|cut| !cut.points.iter().any(is_moved));
        let points = idle.flat_map(|cut| &cut.points).filter(|&&point| self.paths.is_free(point));
        let mut stops = false;
        for &point in points {
            is_stopped[point as usize] = true;
            stops = true;
        }
        if stops {
            self.shorten(cutting);
        }
    }

    /// Ends points where their half-spaces let them, and marks those that end elsewhere now.
    fn shorten(&mut self, cutting: &mut Cutting) {
        let Cutting { half_spaces, wanted, is_stopped, is_changed } = cutting;
        half_spaces.sort_by_key(|half_space| half_space.point);
        let mut own = &half_spaces[..];
        for (point, is_stopped) in is_stopped.iter().enumerate() {
            let count = own.partition_point(|half_space| half_space.point as usize == point);
            let (held_by, others) = own.split_at(count);
            own = others;
            if count == 0 && !is_stopped {
                continue;
            }
            // What stops is still pushed by colliders.
            let wanted = if *is_stopped { Vector::zeros() } else { wanted[point] };
            let start = self.paths.start[point];
            let step = end_within(&start, start + wanted, held_by) - start;
            is_changed[point] = is_changed[point] || step != self.paths.step[point];
            self.paths.step[point] = step;
        }
    }

    /// Writes the ends of ways that are not as they were wanted.
    fn write_ends(&mut self, wanted: &[Vector], ends: &mut Coordinates) -> u32 {
        let mut clipped = 0;
        for (point, wanted) in wanted[..self.bodies.particle_count].iter().enumerate() {
            if self.paths.step[point] != *wanted {
                ends.set(point, &self.paths.end(point as u32));
                clipped += 1;
            }
        }
        self.clipped += clipped;
        clipped
    }
}
