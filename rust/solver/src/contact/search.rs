//! Which features may meet: points with triangles, edges with edges.

use boucle_geometry::{Bvh, Way};
use rayon::prelude::*;

use super::bodies::{Bodies, Body};
use super::candidate::Candidate;
use super::easing::Easing;
use super::features::{Edge, Features, Triangle};
use super::sieve::Sieve;
use super::{Contacts, Trees};
use crate::interrupter::Interrupter;

/// Points that one task fits, at the least.
const POINTS: usize = 1024;

impl Contacts {
    /// Fits all boxes to the present ways, with so much (m) around each feature of a body.
    pub(super) fn fit(&mut self, around: impl Fn(&Body) -> f64 + Sync) {
        let Self { bodies, cloths, colliders, paths, ways, .. } = self;
        let points = paths.start.par_iter().zip(&paths.step).zip(&bodies.body_of);
        let points = ways.par_iter_mut().zip(points).with_min_len(POINTS);
        points.for_each(|(way, ((start, step), body))| {
            *way = Way::new(start, step, around(&bodies.each[*body as usize]));
        });
        cloths.fit(&bodies.cloths, ways);
        colliders.fit(&bodies.colliders, ways);
    }

    /// Shows `visit` each candidate that may come as near on its way as boxes were fitted around both features, each once,
    /// with what its task has found so far; of pairs that lay nearer at rest, only those that may come nearer than they keep
    /// there or may stray. Returns the findings of all tasks in order.
    pub(super) fn search<T: Default + Send>(
        &self,
        visit: impl Fn(Candidate, &mut T) + Sync,
    ) -> Vec<T> {
        self.searching(None, self.bodies.easing.as_ref(), visit).everything()
    }

    /// The same for candidates with a changed point, wherever they lay at rest.
    pub(super) fn search_changed<T: Default + Send>(
        &self,
        is_changed: &[bool],
        visit: impl Fn(Candidate, &mut T) + Sync,
    ) -> Vec<T> {
        self.searching(Some(is_changed), None, visit).everything()
    }

    /// The same for candidates of a cloth and a collider. It is not stopped half way: what it finds is counted.
    pub(super) fn search_colliders<T: Default + Send>(
        &self,
        visit: impl Fn(Candidate, &mut T) + Sync,
    ) -> Vec<T> {
        let search = self.searching(None, None, visit);
        Search { interrupter: None, ..search }.cloths_and_colliders()
    }

    fn searching<'a, T>(
        &'a self,
        is_changed: Option<&'a [bool]>,
        easing: Option<&'a Easing>,
        visit: impl Fn(Candidate, &mut T) + Sync,
    ) -> Search<'a, impl Fn(Candidate, &mut T) + Sync> {
        let Self { bodies, cloths, colliders, ways, tangle, interrupter, .. } = self;
        let visit = move |candidate: Candidate, found: &mut T| {
            if bodies.candidate_may_touch(&candidate) && !tangle.lets_go(&candidate) {
                visit(candidate, found);
            }
        };
        Search {
            bodies,
            cloths,
            colliders,
            ways,
            is_changed,
            easing,
            interrupter: Some(interrupter),
            visit,
        }
    }
}

struct Search<'a, V> {
    bodies: &'a Bodies,
    cloths: &'a Trees,
    colliders: &'a Trees,
    ways: &'a [Way],
    is_changed: Option<&'a [bool]>,
    easing: Option<&'a Easing>,
    /// What stops it half way, if anything may.
    interrupter: Option<&'a Interrupter>,
    visit: V,
}

impl<V> Search<'_, V> {
    fn everything<T: Default + Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut T) + Sync,
    {
        let mut found = self.points_and_triangles_of_cloths();
        found.extend(self.edges_of_cloths());
        found.extend(self.cloths_and_colliders());
        found
    }

    fn sift<T>(&self, candidates: impl Iterator<Item = Candidate>, found: &mut T)
    where
        V: Fn(Candidate, &mut T),
    {
        let Self { bodies, ways, easing, .. } = *self;
        if self.interrupter.is_some_and(Interrupter::is_asked) {
            return;
        }
        Sieve { bodies, ways, easing }.sift(candidates, |each| (self.visit)(each, found));
    }

    /// Shows what the sieve leaves of pairs of a point and a triangle.
    fn points_and_triangles<'b, T>(
        &self,
        pairs: impl Iterator<Item = (u32, &'b Triangle)>,
        found: &mut T,
    ) where
        V: Fn(Candidate, &mut T),
    {
        let candidates = pairs.filter_map(|(point, triangle)| {
            let is_lone = !self.bodies.is_particle(point) && self.bodies.body(point).radius > 0.0;
            Candidate::point_triangle(point, triangle, is_lone)
        });
        self.sift(candidates, found);
    }

    /// Shows what the sieve leaves of pairs of edges.
    fn edges_and_edges<'b, T>(&self, pairs: impl Iterator<Item = [&'b Edge; 2]>, found: &mut T)
    where
        V: Fn(Candidate, &mut T),
    {
        let candidates = pairs.filter_map(|[first, second]| {
            let is_lone = self.bodies.body(second.points[0]).radius > 0.0;
            Candidate::edge_edge(first, second, is_lone)
        });
        self.sift(candidates, found);
    }

    /// The pairs of items of two hierarchies; of those of which the first is marked by what has changed, if it is said.
    fn between<T: Default + Send>(
        &self,
        [first, second]: [&Bvh; 2],
        is_marked: impl Fn(u32, &[bool]) -> bool + Sync,
        visit: impl Fn(&[[u32; 2]], &mut T) + Sync,
    ) -> Vec<T> {
        match self.is_changed {
            None => first.pairs_with(second, visit),
            Some(is_changed) => {
                first.pairs_of_marked_with(|item| is_marked(item, is_changed), second, visit)
            }
        }
    }

    fn points_and_triangles_of_cloths<T: Default + Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut T) + Sync,
    {
        let Features { points, triangles, .. } = &self.bodies.cloths;
        let [by_point, by_triangle] = [&self.cloths.points, &self.cloths.triangles];
        let pair =
            |point: u32, triangle: u32| (points[point as usize], &triangles[triangle as usize]);
        let is_point_marked =
            |item: u32, is_changed: &[bool]| is_changed[points[item as usize] as usize];
        let mut found = self.between([by_point, by_triangle], is_point_marked, |pairs, found| {
            self.points_and_triangles(
                pairs.iter().map(|&[point, triangle]| pair(point, triangle)),
                found,
            );
        });
        // Changed triangles meet points that have not changed, too.
        if let Some(is_changed) = self.is_changed {
            found.extend(by_triangle.pairs_of_marked_with(
                |item| is_marked(&triangles[item as usize].points, is_changed),
                by_point,
                |pairs, found| {
                    let pairs =
                        pairs.iter().filter(|&[_, point]| !is_point_marked(*point, is_changed));
                    let pairs = pairs.map(|&[triangle, point]| pair(point, triangle));
                    self.points_and_triangles(pairs, found);
                },
            ));
        }
        found
    }

    fn edges_of_cloths<T: Default + Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut T) + Sync,
    {
        let edges = &self.bodies.cloths.edges;
        let visit = |pairs: &[[u32; 2]], found: &mut T| {
            let pairs = pairs.iter().map(|pair| pair.map(|edge| &edges[edge as usize]));
            self.edges_and_edges(pairs, found);
        };
        match self.is_changed {
            None => self.cloths.edges.pairs(visit),
            Some(is_changed) => self
                .cloths
                .edges
                .pairs_of_marked(|item| is_marked(&edges[item as usize].points, is_changed), visit),
        }
    }

    fn cloths_and_colliders<T: Default + Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut T) + Sync,
    {
        let mut found = self.points_of_cloths_and_triangles_of_colliders();
        found.extend(self.triangles_of_cloths_and_points_of_colliders());
        found.extend(self.edges_of_cloths_and_colliders());
        found
    }

    fn points_of_cloths_and_triangles_of_colliders<T: Default + Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut T) + Sync,
    {
        let Bodies { cloths, colliders, .. } = self.bodies;
        self.between(
            [&self.cloths.points, &self.colliders.triangles],
            |item, is_changed| is_changed[cloths.points[item as usize] as usize],
            |pairs, found| {
                let pairs = pairs.iter().map(|&[point, triangle]| {
                    (cloths.points[point as usize], &colliders.triangles[triangle as usize])
                });
                self.points_and_triangles(pairs, found);
            },
        )
    }

    fn triangles_of_cloths_and_points_of_colliders<T: Default + Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut T) + Sync,
    {
        let Bodies { cloths, colliders, .. } = self.bodies;
        self.between(
            [&self.cloths.triangles, &self.colliders.points],
            |item, is_changed| is_marked(&cloths.triangles[item as usize].points, is_changed),
            |pairs, found| {
                let pairs = pairs.iter().map(|&[triangle, point]| {
                    (colliders.points[point as usize], &cloths.triangles[triangle as usize])
                });
                self.points_and_triangles(pairs, found);
            },
        )
    }

    fn edges_of_cloths_and_colliders<T: Default + Send>(&self) -> Vec<T>
    where
        V: Fn(Candidate, &mut T) + Sync,
    {
        let Bodies { cloths, colliders, .. } = self.bodies;
        self.between(
            [&self.cloths.edges, &self.colliders.edges],
            |item, is_changed| is_marked(&cloths.edges[item as usize].points, is_changed),
            |pairs, found| {
                let pairs = pairs.iter().map(|&[first, second]| {
                    [&cloths.edges[first as usize], &colliders.edges[second as usize]]
                });
                self.edges_and_edges(pairs, found);
            },
        )
    }
}

fn is_marked(points: &[u32], is_changed: &[bool]) -> bool {
    points.iter().any(|&point| is_changed[point as usize])
}
