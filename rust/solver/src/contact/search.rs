//! Which features may meet: points with triangles, edges with edges.

use super::bodies::{Bodies, Body};
use super::candidate::Candidate;
use super::features::{Edge, Triangle};
use super::{Contacts, Trees};

impl Contacts {
    /// Fits all boxes to the present ways, with so much (m) around each feature of a body.
    pub(super) fn fit(&mut self, around: impl Fn(&Body) -> f64 + Sync) {
        let Self { bodies, cloths, colliders, paths, .. } = self;
        let around = |point: u32| around(bodies.body(point));
        cloths.fit(&bodies.cloths, paths, around);
        colliders.fit(&bodies.colliders, paths, around);
    }

    /// Calls `visit` for each candidate; for those with a changed point only, if it is said which are.
    pub(super) fn search<T: Send>(
        &self,
        is_changed: Option<&[bool]>,
        visit: impl Fn(Candidate, &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        let Self { bodies, cloths, colliders, tangle, .. } = self;
        let visit = |candidate: Candidate, found: &mut Vec<T>| {
            if !tangle.lets_go(&candidate) {
                visit(candidate, found);
            }
        };
        let search = Search { bodies, cloths, colliders, is_changed, visit };
        let mut found = search.points_and_triangles_of_cloths();
        found.extend(search.edges_of_cloths());
        found.extend(search.points_of_cloths_and_triangles_of_colliders());
        found.extend(search.triangles_of_cloths_and_points_of_colliders());
        found.extend(search.edges_of_cloths_and_colliders());
        found
    }
}

struct Search<'a, V> {
    bodies: &'a Bodies,
    cloths: &'a Trees,
    colliders: &'a Trees,
    is_changed: Option<&'a [bool]>,
    visit: V,
}

impl<V> Search<'_, V> {
    fn point_triangle<T>(&self, point: u32, triangle: &Triangle, found: &mut Vec<T>)
    where
        V: Fn(Candidate, &mut Vec<T>),
    {
        let is_particle = self.bodies.is_particle(point);
        let is_lone = !is_particle && self.bodies.body(point).radius > 0.0;
        let Some(candidate) = Candidate::point_triangle(point, triangle, is_lone) else { return };
        let may_touch = if is_particle {
            self.bodies.may_touch(&[point], &triangle.points)
        } else {
            self.bodies.may_touch(&triangle.points, &[point])
        };
        if may_touch {
            (self.visit)(candidate, found);
        }
    }

    fn edge_edge<T>(&self, first: &Edge, second: &Edge, found: &mut Vec<T>)
    where
        V: Fn(Candidate, &mut Vec<T>),
    {
        let is_lone = self.bodies.body(second.points[0]).radius > 0.0;
        let Some(candidate) = Candidate::edge_edge(first, second, is_lone) else { return };
        if self.bodies.may_touch(&first.points, &second.points) {
            (self.visit)(candidate, found);
        }
    }

    fn points_and_triangles_of_cloths<T: Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut Vec<T>) + Sync,
    {
        let features = &self.bodies.cloths;
        let (points, triangles) = (&self.cloths.points, &self.cloths.triangles);
        let Some(is_changed) = self.is_changed else {
            return points.pairs_with(triangles, |point, triangle, found| {
                let triangle = &features.triangles[triangle as usize];
                self.point_triangle(features.points[point as usize], triangle, found);
            });
        };
        let is_point_marked = |item: u32| is_changed[features.points[item as usize] as usize];
        let is_triangle_marked = |item: u32| {
            let points = features.triangles[item as usize].points;
            points.iter().any(|&point| is_changed[point as usize])
        };
        let mut found =
            points.pairs_of_marked_with(is_point_marked, triangles, |point, triangle, found| {
                let triangle = &features.triangles[triangle as usize];
                self.point_triangle(features.points[point as usize], triangle, found);
            });
        found.extend(triangles.pairs_of_marked_with(
            is_triangle_marked,
            points,
            |triangle, point, found| {
                if !is_point_marked(point) {
                    let triangle = &features.triangles[triangle as usize];
                    self.point_triangle(features.points[point as usize], triangle, found);
                }
            },
        ));
        found
    }

    fn edges_of_cloths<T: Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut Vec<T>) + Sync,
    {
        let edges = &self.bodies.cloths.edges;
        let visit = |first: u32, second: u32, found: &mut Vec<T>| {
            self.edge_edge(&edges[first as usize], &edges[second as usize], found);
        };
        match self.is_changed {
            None => self.cloths.edges.pairs(visit),
            Some(is_changed) => self
                .cloths
                .edges
                .pairs_of_marked(|item| is_marked(&edges[item as usize], is_changed), visit),
        }
    }

    fn points_of_cloths_and_triangles_of_colliders<T: Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut Vec<T>) + Sync,
    {
        let Bodies { cloths, colliders, .. } = self.bodies;
        let visit = |point: u32, triangle: u32, found: &mut Vec<T>| {
            let triangle = &colliders.triangles[triangle as usize];
            self.point_triangle(cloths.points[point as usize], triangle, found);
        };
        let (points, triangles) = (&self.cloths.points, &self.colliders.triangles);
        match self.is_changed {
            None => points.pairs_with(triangles, visit),
            Some(is_changed) => {
                let is_marked = |item: u32| is_changed[cloths.points[item as usize] as usize];
                points.pairs_of_marked_with(is_marked, triangles, visit)
            }
        }
    }

    fn triangles_of_cloths_and_points_of_colliders<T: Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut Vec<T>) + Sync,
    {
        let Bodies { cloths, colliders, .. } = self.bodies;
        let visit = |triangle: u32, point: u32, found: &mut Vec<T>| {
            let triangle = &cloths.triangles[triangle as usize];
            self.point_triangle(colliders.points[point as usize], triangle, found);
        };
        let (triangles, points) = (&self.cloths.triangles, &self.colliders.points);
        match self.is_changed {
            None => triangles.pairs_with(points, visit),
            Some(is_changed) => {
                let is_marked = |item: u32| {
                    let points = cloths.triangles[item as usize].points;
                    points.iter().any(|&point| is_changed[point as usize])
                };
                triangles.pairs_of_marked_with(is_marked, points, visit)
            }
        }
    }

    fn edges_of_cloths_and_colliders<T: Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut Vec<T>) + Sync,
    {
        let Bodies { cloths, colliders, .. } = self.bodies;
        let visit = |first: u32, second: u32, found: &mut Vec<T>| {
            let (first, second) =
                (&cloths.edges[first as usize], &colliders.edges[second as usize]);
            self.edge_edge(first, second, found);
        };
        let (edges, others) = (&self.cloths.edges, &self.colliders.edges);
        match self.is_changed {
            None => edges.pairs_with(others, visit),
            Some(is_changed) => edges.pairs_of_marked_with(
                |item| is_marked(&cloths.edges[item as usize], is_changed),
                others,
                visit,
            ),
        }
    }
}

fn is_marked(edge: &Edge, is_changed: &[bool]) -> bool {
    edge.points.iter().any(|&point| is_changed[point as usize])
}
