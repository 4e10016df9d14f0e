//! How often things pass through each other, decided exactly.
//!
//! Edges of one body against triangles of another, or of the same, as far as they collide and share no vertex; a triangle
//! that comes nearer to a sphere or a capsule than its radius; a vertex behind a plane.

use boucle_geometry::{Vector, edge_crosses_triangle};

use super::Contacts;
use super::bodies::{Bodies, Patch};
use super::candidate::candidates_of;
use super::paths::Paths;
use crate::state::Coordinates;

impl Contacts {
    /// Counts the intersections of particles at these positions (m) with each other and with the colliders where they are.
    pub(crate) fn intersections(&mut self, positions: &Coordinates) -> u64 {
        self.find_intersections(positions).len() as u64
    }

    /// The points of each intersection: of the edge and the triangle, or of what comes too near. The last are repeated
    /// where there are fewer than five.
    fn find_intersections(&mut self, positions: &Coordinates) -> Vec<[u32; 5]> {
        self.paths.set_starts(positions);
        self.paths.step.fill(Vector::zeros());
        let first = self.bodies.particle_count;
        self.paths.start[first..].copy_from_slice(&self.frame[0]);
        self.fit(|body| body.radius);
        let Self { bodies, paths, .. } = &*self;
        let visit = |[a, b]: [&Patch; 2], found: &mut Vec<[u32; 5]>| {
            if bodies.may_touch(a.body, b.body) {
                crossings(bodies, paths, [a, b], found);
                crossings(bodies, paths, [b, a], found);
                too_near(bodies, paths, [a, b], found);
            }
        };
        let mut found = self.search(None, visit);
        self.each_plane(|particle, plane, normal| {
            let origin = paths.start[plane.points[0] as usize];
            if normal.dot(&(paths.start[particle as usize] - origin)) < 0.0 {
                let [first, second] = plane.points;
                found.push([particle, first, second, second, second]);
            }
        });
        found
    }
}

/// The edges that one patch owns through the triangle of another.
fn crossings(bodies: &Bodies, paths: &Paths, [a, b]: [&Patch; 2], found: &mut Vec<[u32; 5]>) {
    if b.size != 3 || a.size == 1 {
        return;
    }
    let place = |point: u32| &paths.start[point as usize];
    let is_included = |points: &[u32], other: u32| {
        points.iter().all(|&point| {
            !bodies.is_particle(point)
                || bodies.is_included(point, bodies.body_of[point as usize], other)
        })
    };
    if !is_included(&b.points, a.body) {
        return;
    }
    for i in (0..3).filter(|i| a.owned & (8 << i) != 0) {
        let edge = [a.points[i], a.points[(i + 1) % 3]];
        let is_apart = !b.points.contains(&edge[0]) && !b.points.contains(&edge[1]);
        if is_apart
            && is_included(&edge, b.body)
            && edge_crosses_triangle(edge.map(place), b.points.map(place))
        {
            let [p, q, r] = b.points;
            found.push([edge[0], edge[1], p, q, r]);
        }
    }
}

/// A triangle nearer to a ball or a capsule than its radius.
fn too_near(bodies: &Bodies, paths: &Paths, [a, b]: [&Patch; 2], found: &mut Vec<[u32; 5]>) {
    let radius = bodies.bodies[b.body as usize].radius;
    if radius == 0.0 {
        return;
    }
    let mut is_near = false;
    candidates_of(bodies, paths, [a, b], radius, |candidate| {
        let distance = candidate.closest(|point| paths.start[point as usize]).offset.norm();
        is_near = is_near || distance < radius;
    });
    if is_near {
        let [p, q, r] = a.points;
        found.push([p, q, r, b.points[0], b.points[1]]);
    }
}
