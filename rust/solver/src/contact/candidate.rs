//! Candidates: a point and a triangle, or two edges, that may meet on their way.

use boucle_geometry::Vector;
use boucle_geometry::distance::{Closest, edge_edge, point_triangle};

use super::bodies::{Bodies, Patch};
use super::paths::Paths;

/// Which features meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The first point and the triangle of the other three.
    PointTriangle,
    /// The edge of the first two points and that of the last two.
    EdgeEdge,
}

/// Two features.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) kind: Kind,
    pub(super) points: [u32; 4],
    /// Of a triangle: what it owns, as [`Patch::owned`]. Of two edges: the ends of the first that its patch owns, if the
    /// second is a lone edge.
    owned: u8,
    /// The first point is a lone one.
    is_lone: bool,
}

impl Candidate {
    /// How many points belong to the first feature.
    pub(super) fn split(&self) -> usize {
        match self.kind {
            Kind::PointTriangle => 1,
            Kind::EdgeEdge => 2,
        }
    }

    /// The closest points of both features where `place_of` puts their points.
    #[inline]
    pub(super) fn closest(&self, place_of: impl Fn(u32) -> Vector) -> Closest {
        let [a, b, c, d] = self.points.map(place_of);
        match self.kind {
            Kind::PointTriangle => point_triangle(&a, &b, &c, &d),
            Kind::EdgeEdge => edge_edge(&a, &b, &c, &d),
        }
    }

    /// Whether this is the candidate that speaks for the features that are closest: the same vertex or edge is closest in
    /// several triangles, and only the one that owns it counts.
    pub(super) fn speaks_for(&self, feature: u8) -> bool {
        if feature == 0b1111 {
            return true;
        }
        match self.kind {
            Kind::PointTriangle => {
                let corner = |i: usize| self.owned & (1 << i) != 0;
                let is_first = |i: usize| self.is_lone || self.points[0] < self.points[i + 1];
                match feature >> 1 {
                    0b001 => corner(0) && is_first(0),
                    0b010 => corner(1) && is_first(1),
                    0b100 => corner(2) && is_first(2),
                    0b011 => corner(3),
                    0b110 => corner(4),
                    _ => corner(5),
                }
            }
            Kind::EdgeEdge => match feature {
                0b1101 => self.owned & 1 != 0,
                0b1110 => self.owned & 2 != 0,
                _ => false,
            },
        }
    }
}

/// Calls `add` with the candidates of two patches whose features may come within `reach` (m) of each other.
#[inline]
pub(super) fn candidates_of(
    bodies: &Bodies,
    paths: &Paths,
    [a, b]: [&Patch; 2],
    reach: f64,
    mut add: impl FnMut(Candidate),
) {
    if !bodies.may_touch(a.body, b.body) {
        return;
    }
    let is_included = |point: u32, other: u32| {
        !bodies.is_particle(point)
            || bodies.is_included(point, bodies.body_of[point as usize], other)
    };
    let mut add = |candidate: Candidate| {
        let split = candidate.split();
        let (first, second) = candidate.points.split_at(split);
        let other = [bodies.body_of[second[0] as usize], bodies.body_of[first[0] as usize]];
        if first.iter().all(|&point| is_included(point, other[0]))
            && second.iter().all(|&point| is_included(point, other[1]))
            && paths.may_meet(first, second, reach)
        {
            add(candidate);
        }
    };
    for [one, other] in [[a, b], [b, a]] {
        if other.size == 3 {
            let [p, q, r] = other.points;
            for i in 0..3 {
                let point = one.points[i];
                if one.owned & (1 << i) != 0 && !other.points.contains(&point) {
                    let (kind, points) = (Kind::PointTriangle, [point, p, q, r]);
                    let (owned, is_lone) = (other.owned, one.size == 1);
                    add(Candidate { kind, points, owned, is_lone });
                }
            }
        }
    }
    for i in (0..3).filter(|i| a.owned & (8 << i) != 0) {
        let [p, q] = [a.points[i], a.points[(i + 1) % 3]];
        for j in (0..3).filter(|j| b.owned & (8 << j) != 0) {
            let [r, s] = [b.points[j], b.points[(j + 1) % 3]];
            if p != r && p != s && q != r && q != s {
                let ends = (a.owned >> i & 1) | (a.owned >> ((i + 1) % 3) & 1) << 1;
                let owned = if b.size == 2 { ends } else { 0 };
                let (kind, points) = (Kind::EdgeEdge, [p, q, r, s]);
                add(Candidate { kind, points, owned, is_lone: false });
            }
        }
    }
}
