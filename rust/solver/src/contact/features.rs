//! The points, edges and triangles of cloths or of colliders, and hierarchies of boxes over them.

use boucle_geometry::{Bvh, Mesh, Sweep, Vector, Way};

/// Three points, and which of its corners and edges it speaks for: bit i for corner i, bit 3 + i for the edge from corner i
/// to the next. Every corner and edge of a mesh has one triangle that does.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub(super) points: [u32; 3],
    pub(super) owned: u8,
}

/// Two points, and which of them it speaks for: bit i for end i.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) points: [u32; 2],
    pub(super) owned: u8,
    /// The third points of its first two triangles, or [`NONE`].
    pub(super) apexes: [u32; 2],
}

/// In the place of a point that is not there.
pub(super) const NONE: u32 = u32::MAX;

/// All features of one side.
#[derive(Clone, Debug, Default)]
pub(super) struct Features {
    pub(super) points: Vec<u32>,
    pub(super) edges: Vec<Edge>,
    pub(super) triangles: Vec<Triangle>,
}

impl Features {
    /// Adds those of a mesh whose vertices are numbered from `base`. Vertices without a face are left out.
    pub(super) fn add_mesh(&mut self, mesh: &Mesh, base: u32) {
        let all: Vec<[u32; 3]> = mesh.triangles().collect();
        self.add_triangles(&all, mesh.vertex_count(), base);
    }

    /// Adds triangles and what they have, of so many vertices that are numbered from `base`.
    pub(super) fn add_triangles(&mut self, all: &[[u32; 3]], vertex_count: usize, base: u32) {
        let first = self.triangles.len();
        let mut is_owned = vec![false; vertex_count];
        let mut sides = Vec::with_capacity(3 * all.len());
        for (place, corners) in all.iter().enumerate() {
            let mut owned = 0;
            for i in 0..3 {
                let [a, b] = [corners[i], corners[(i + 1) % 3]];
                sides.push(([a.min(b), a.max(b)], first + place, i));
                let is_owned = &mut is_owned[a as usize];
                owned |= u8::from(!*is_owned) << i;
                *is_owned = true;
            }
            let points = corners.map(|corner| base + corner);
            self.triangles.push(Triangle { points, owned });
        }
        sides.sort_unstable();
        let (edges, points) = (&mut self.edges, &mut self.points);
        for same in sides.chunk_by(|(one, ..), (other, ..)| one == other) {
            let (ends, place, i) = same[0];
            self.triangles[place].owned |= 8 << i;
            let mut apexes = [NONE; 2];
            for (apex, &(_, place, i)) in apexes.iter_mut().zip(same) {
                *apex = self.triangles[place].points[(i + 2) % 3];
            }
            let mut owned = 0;
            for (i, end) in ends.into_iter().enumerate() {
                // The triangles' marks are used up: an end that is still marked has no edge yet.
                owned |= u8::from(std::mem::take(&mut is_owned[end as usize])) << i;
            }
            edges.push(Edge { points: ends.map(|end| base + end), owned, apexes });
        }
        let mut used: Vec<u32> = all.iter().flatten().map(|vertex| base + vertex).collect();
        used.sort_unstable();
        used.dedup();
        points.extend(used);
    }

    pub(super) fn add_point(&mut self, point: u32) {
        self.points.push(point);
    }

    pub(super) fn add_edge(&mut self, points: [u32; 2]) {
        self.points.extend(points);
        self.edges.push(Edge { points, owned: 0b11, apexes: [NONE; 2] });
    }
}

/// A hierarchy of boxes over each kind of feature.
#[derive(Clone, Debug)]
pub(super) struct Trees {
    pub(super) points: Bvh,
    pub(super) edges: Bvh,
    pub(super) triangles: Bvh,
}

impl Trees {
    /// Hierarchies over features where their points lie (m); those of a body stay together.
    pub(super) fn new(features: &Features, places: &[Vector], body_of: &[u32]) -> Self {
        fn tree<'a>(
            features: impl Iterator<Item = &'a [u32]> + Clone,
            places: &[Vector],
            body_of: &[u32],
        ) -> Bvh {
            let middles: Vec<Vector> = features
                .clone()
                .map(|points| {
                    let sum: Vector = points.iter().map(|&point| places[point as usize]).sum();
                    sum / points.len() as f64
                })
                .collect();
            let groups: Vec<u32> = features.map(|points| body_of[points[0] as usize]).collect();
            Bvh::new(&middles, &groups)
        }
        let Features { points, edges, triangles } = features;
        Self {
            points: tree(points.chunks(1), places, body_of),
            edges: tree(edges.iter().map(|edge| &edge.points[..]), places, body_of),
            triangles: tree(triangles.iter().map(|each| &each.points[..]), places, body_of),
        }
    }

    /// Fits all boxes to the ways of all points.
    pub(super) fn fit(&mut self, features: &Features, ways: &[Way]) {
        let way = |point: u32| &ways[point as usize];
        let Features { points, edges, triangles } = features;
        self.points.fit(|item| Sweep::of([way(points[item as usize])]));
        self.edges.fit(|item| Sweep::of(edges[item as usize].points.map(way)));
        self.triangles.fit(|item| Sweep::of(triangles[item as usize].points.map(way)));
    }
}
