//! Which features may meet: points with triangles, edges with edges.

use boucle_geometry::Bvh;

use super::bodies::{Bodies, Body};
use super::candidate::Candidate;
use super::features::{Edge, Features, Triangle};
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

    /// The pairs of items of two hierarchies; of those of which the first is marked by what has changed, if it is said.
    fn between<T: Send>(
        &self,
        [first, second]: [&Bvh; 2],
        is_marked: impl Fn(u32, &[bool]) -> bool + Sync,
        visit: impl Fn(u32, u32, &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        match self.is_changed {
            None => first.pairs_with(second, visit),
            Some(is_changed) => {
                first.pairs_of_marked_with(|item| is_marked(item, is_changed), second, visit)
            }
        }
    }

    fn points_and_triangles_of_cloths<T: Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut Vec<T>) + Sync,
    {
        let Features { points, triangles, .. } = &self.bodies.cloths;
        let [by_point, by_triangle] = [&self.cloths.points, &self.cloths.triangles];
        let point_of = |item: u32| points[item as usize];
        let visit = |point: u32, triangle: u32, found: &mut Vec<T>| {
            self.point_triangle(point_of(point), &triangles[triangle as usize], found);
        };
        let is_point_marked = |item: u32, is_changed: &[bool]| is_changed[point_of(item) as usize];
        let mut found = self.between([by_point, by_triangle], is_point_marked, visit);
        // Changed triangles meet points that have not changed, too.
        if let Some(is_changed) = self.is_changed {
            found.extend(by_triangle.pairs_of_marked_with(
                |item| is_marked(&triangles[item as usize].points, is_changed),
                by_point,
                |triangle, point, found| {
                    if !is_point_marked(point, is_changed) {
                        visit(point, triangle, found);
                    }
                },
            ));
        }
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
                .pairs_of_marked(|item| is_marked(&edges[item as usize].points, is_changed), visit),
        }
    }

    fn points_of_cloths_and_triangles_of_colliders<T: Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut Vec<T>) + Sync,
    {
        let Bodies { cloths, colliders, .. } = self.bodies;
        self.between(
            [&self.cloths.points, &self.colliders.triangles],
            |item, is_changed| is_changed[cloths.points[item as usize] as usize],
            |point, triangle, found| {
                let triangle = &colliders.triangles[triangle as usize];
                self.point_triangle(cloths.points[point as usize], triangle, found);
            },
        )
    }

    fn triangles_of_cloths_and_points_of_colliders<T: Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut Vec<T>) + Sync,
    {
        let Bodies { cloths, colliders, .. } = self.bodies;
        self.between(
            [&self.cloths.triangles, &self.colliders.points],
            |item, is_changed| is_marked(&cloths.triangles[item as usize].points, is_changed),
            |triangle, point, found| {
                let triangle = &cloths.triangles[triangle as usize];
                self.point_triangle(colliders.points[point as usize], triangle, found);
            },
        )
    }

    fn edges_of_cloths_and_colliders<T: Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut Vec<T>) + Sync,
    {
        let Bodies { cloths, colliders, .. } = self.bodies;
        self.between(
            [&self.cloths.edges, &self.colliders.edges],
            |item, is_changed| is_marked(&cloths.edges[item as usize].points, is_changed),
            |first, second, found| {
                let second = &colliders.edges[second as usize];
                self.edge_edge(&cloths.edges[first as usize], second, found);
            },
        )
    }
}

fn is_marked(points: &[u32], is_changed: &[bool]) -> bool {
    points.iter().any(|&point| is_changed[point as usize])
}
