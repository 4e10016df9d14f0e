//! What of cloths is left out of contact with a kind of thing.
//!
//! As in Blender, a triangle is left out if all its corners are excluded. An edge or a vertex is left out with the last of its
//! triangles: one excluded vertex alone changes nothing.

use std::collections::{BTreeMap, BTreeSet};

use boucle_geometry::Mesh;

use super::features::Features;

/// Excluded vertices, and what collides among them all the same because a triangle that is not left out has it.
#[derive(Debug)]
pub(super) struct Exclusion {
    is_excluded: Vec<bool>,
    points: BTreeSet<u32>,
    /// With the points that they speak for where the others are left out.
    edges: BTreeMap<[u32; 2], u8>,
    /// With the corners and edges that they speak for then. Those with an excluded corner only.
    triangles: BTreeMap<[u32; 3], u8>,
}

impl Exclusion {
    /// Of nothing.
    pub(super) fn new(particle_count: usize) -> Self {
        Self {
            is_excluded: vec![false; particle_count],
            points: BTreeSet::new(),
            edges: BTreeMap::new(),
            triangles: BTreeMap::new(),
        }
    }

    /// Excludes vertices of a mesh, which are numbered from `base`.
    pub(super) fn add(&mut self, mesh: &Mesh, base: u32, vertices: &[u32]) {
        for vertex in vertices {
            self.is_excluded[(base + vertex) as usize] = true;
        }
        let collides = |corners: &[u32; 3]| corners.iter().any(|&c| !self.excludes(base + c));
        let colliding: Vec<[u32; 3]> = mesh.triangles().filter(collides).collect();
        let mut features = Features::default();
        features.add_triangles(&colliding, mesh.vertex_count(), base);
        let Self { is_excluded, points, edges, triangles } = self;
        let excludes = |point: &u32| is_excluded[*point as usize];
        points.extend(features.points.into_iter().filter(excludes));
        let sides = features.edges.iter().filter(|edge| edge.points.iter().any(excludes));
        edges.extend(sides.map(|edge| (edge.points, edge.owned)));
        let corners = features.triangles.iter().filter(|each| each.points.iter().any(excludes));
        triangles.extend(corners.map(|triangle| (triangle.points, triangle.owned)));
    }

    /// Whether a point is an excluded vertex; those of colliders are not.
    fn excludes(&self, point: u32) -> bool {
        self.is_excluded.get(point as usize).is_some_and(|&is_excluded| is_excluded)
    }

    /// Whether a point, an edge or a triangle collides.
    pub(super) fn keeps(&self, feature: &[u32]) -> bool {
        feature.iter().any(|&point| !self.excludes(point))
            || match *feature {
                [point] => self.points.contains(&point),
                [a, b] => self.edges.contains_key(&[a, b]),
                _ => false,
            }
    }

    /// What an edge or a triangle speaks for, if not for the same as without this exclusion.
    pub(super) fn owned(&self, feature: &[u32]) -> Option<u8> {
        match *feature {
            [a, b] => self.edges.get(&[a, b]).copied(),
            [a, b, c] => self.triangles.get(&[a, b, c]).copied(),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 4 x 4 vertices in quads; triangle 2 q of quad q is its lower right half.
    fn grid() -> Mesh {
        let quads: Vec<[u32; 4]> = (0..9)
            .map(|quad| quad / 3 * 4 + quad % 3)
            .map(|corner| [corner, corner + 1, corner + 5, corner + 4])
            .collect();
        Mesh::from_faces(16, &quads).expect("a grid")
    }

    fn excluding(vertices: &[u32]) -> Exclusion {
        let mut exclusion = Exclusion::new(20);
        exclusion.add(&grid(), 4, vertices);
        exclusion
    }

    #[test]
    fn a_triangle_with_a_corner_that_is_not_excluded_keeps_all_that_it_has() {
        let alone = excluding(&[5]);
        let mut features = Features::default();
        features.add_mesh(&grid(), 4);
        assert!(features.triangles.iter().all(|each| alone.keeps(&each.points)));
        assert!(features.edges.iter().all(|each| alone.keeps(&each.points)));
        assert!(features.points.iter().all(|&point| alone.keeps(&[point])));
        for triangle in &features.triangles {
            assert!([None, Some(triangle.owned)].contains(&alone.owned(&triangle.points)));
        }
    }

    #[test]
    fn of_two_excluded_rows_the_first_is_left_out() {
        let rows = excluding(&[0, 1, 2, 3, 4, 5, 6, 7]);
        for vertex in 0..16 {
            assert_eq!(rows.keeps(&[4 + vertex]), vertex >= 4, "{vertex}");
        }
        let mut features = Features::default();
        features.add_mesh(&grid(), 4);
        for edge in &features.edges {
            let is_above = edge.points.iter().all(|&point| point >= 8);
            assert_eq!(rows.keeps(&edge.points), is_above, "{:?}", edge.points);
        }
        let left: Vec<bool> =
            features.triangles.iter().map(|each| rows.keeps(&each.points)).collect();
        assert_eq!(left, [[false; 6].as_slice(), &[true; 12]].concat());
    }

    /// Whatever speaks for a feature collides, and there is exactly one.
    #[test]
    fn what_collides_has_one_triangle_that_speaks_for_it() {
        let exclusion = excluding(&[0, 1, 2, 4, 5, 6, 9, 15]);
        let mut features = Features::default();
        features.add_mesh(&grid(), 4);
        let (mut corners, mut sides) = (vec![0; 20], BTreeMap::new());
        for triangle in features.triangles.iter().filter(|each| exclusion.keeps(&each.points)) {
            let owned = exclusion.owned(&triangle.points).unwrap_or(triangle.owned);
            for i in 0..3 {
                let [a, b] = [triangle.points[i], triangle.points[(i + 1) % 3]];
                corners[a as usize] += owned >> i & 1;
                *sides.entry([a.min(b), a.max(b)]).or_insert(0) += owned >> (3 + i) & 1;
            }
        }
        for &point in &features.points {
            let speakers = corners[point as usize];
            assert_eq!(speakers, u8::from(exclusion.keeps(&[point])), "{point}");
        }
        for edge in &features.edges {
            let speakers = sides.get(&edge.points).copied().unwrap_or(0);
            assert_eq!(speakers, u8::from(exclusion.keeps(&edge.points)), "{:?}", edge.points);
        }
    }
}
