//! How often things pass through each other, decided exactly.
//!
//! Edges of one body against triangles of another, or of the same, as far as they collide and share no vertex; a feature
//! of a cloth that comes nearer to a sphere or a capsule than its radius; a vertex behind a plane.

use boucle_geometry::{Vector, edge_crosses_triangle};

use super::Contacts;
use super::features::{Edge, Triangle};
use super::recovery::Crossing;
use crate::state::Coordinates;

impl Contacts {
    /// Counts the intersections of particles at these positions (m) with each other and with the colliders where they are.
    pub(crate) fn intersections(&mut self, positions: &Coordinates) -> u64 {
        let first = self.bodies.particle_count;
        self.paths.start[first..].copy_from_slice(&self.frame[0]);
        self.stand_still(positions);
        self.tangle = self.find_tangle();
        (self.tangle.crossings.len() + self.too_near().len() + self.behind_planes().len()) as u64
    }

    /// Fits all boxes to particles at these positions (m) that do not move, nor do the colliders.
    pub(super) fn stand_still(&mut self, positions: &Coordinates) {
        self.paths.set_starts(positions);
        self.paths.step.fill(Vector::zeros());
        self.fit(|body| body.radius);
    }

    /// Each edge with a triangle that it passes through.
    pub(super) fn crossings(&self) -> Vec<Crossing> {
        let Self { bodies, cloths, colliders, .. } = self;
        let (own, others) = (&bodies.cloths, &bodies.colliders);
        let mut found = cloths.edges.pairs_with(&cloths.triangles, |pairs, found| {
            for &[edge, triangle] in pairs {
                self.cross(&own.edges[edge as usize], &own.triangles[triangle as usize], found);
            }
        });
        found.extend(cloths.edges.pairs_with(&colliders.triangles, |pairs, found| {
            for &[edge, triangle] in pairs {
                self.cross(&own.edges[edge as usize], &others.triangles[triangle as usize], found);
            }
        }));
        found.extend(cloths.triangles.pairs_with(&colliders.edges, |pairs, found| {
            for &[triangle, edge] in pairs {
                self.cross(&others.edges[edge as usize], &own.triangles[triangle as usize], found);
            }
        }));
        found.concat()
    }

    fn cross(&self, edge: &Edge, triangle: &Triangle, found: &mut Vec<Crossing>) {
        let ([p, q], [a, b, c]) = (edge.points, triangle.points);
        if [a, b, c].contains(&p) || [a, b, c].contains(&q) {
            return;
        }
        let place = |point: u32| &self.paths.start[point as usize];
        let may_touch = if self.bodies.is_particle(p) {
            self.bodies.may_touch(&edge.points, &triangle.points)
        } else {
            self.bodies.may_touch(&triangle.points, &edge.points)
        };
        if may_touch && edge_crosses_triangle(edge.points.map(place), triangle.points.map(place)) {
            found.push(Crossing { edge: *edge, triangle: *triangle });
        }
    }

    /// The points of each pair of a cloth's feature and a collider's that are nearer to each other than its radius.
    fn too_near(&self) -> Vec<[u32; 4]> {
        let Self { bodies, paths, .. } = self;
        let found = self.search_colliders(|candidate, found: &mut Vec<[u32; 4]>| {
            let radius =
                bodies.body(candidate.points[0]).radius + bodies.body(candidate.points[3]).radius;
            if radius > 0.0 {
                let closest = candidate.closest(|point| paths.start[point as usize]);
                if closest.offset.norm() < radius && bodies.speaks_for(&candidate, closest.feature)
                {
                    found.push(candidate.points);
                }
            }
        });
        found.concat()
    }

    /// Particles behind planes.
    fn behind_planes(&self) -> Vec<u32> {
        let mut found = Vec::new();
        self.each_plane(|particle, plane, normal| {
            let origin = self.paths.start[plane.points[0] as usize];
            if normal.dot(&(self.paths.start[particle as usize] - origin)) < 0.0 {
                found.push(particle);
            }
        });
        found
    }
}
