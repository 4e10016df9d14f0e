//! Candidates: a point and a triangle, or two edges, that may meet on their way.

use boucle_geometry::Vector;
use boucle_geometry::distance::{Closest, edge_edge, point_triangle};

use super::features::{Edge, NONE, Triangle};

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
    /// What the triangle, or the first edge if the second is a lone one, speaks for.
    owned: u8,
    /// The first point is a lone one.
    is_lone: bool,
}

impl Candidate {
    /// Of no points.
    pub(super) const NONE: Self =
        Self { kind: Kind::PointTriangle, points: [NONE; 4], owned: 0, is_lone: false };

    /// A point, lone or not, and a triangle.
    pub(super) fn point_triangle(point: u32, triangle: &Triangle, is_lone: bool) -> Option<Self> {
        let Triangle { points: [a, b, c], owned } = *triangle;
        let points = [point, a, b, c];
        (point != a && point != b && point != c).then_some(Self {
            kind: Kind::PointTriangle,
            points,
            owned,
            is_lone,
        })
    }

    /// Two edges, of which the second is a lone one or not.
    pub(super) fn edge_edge(first: &Edge, second: &Edge, is_lone: bool) -> Option<Self> {
        let ([a, b], [c, d]) = (first.points, second.points);
        let owned = if is_lone { first.owned } else { 0 };
        (a != c && a != d && b != c && b != d).then_some(Self {
            kind: Kind::EdgeEdge,
            points: [a, b, c, d],
            owned,
            is_lone: false,
        })
    }

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

    /// The same, where its triangle, or its first edge, speaks for something else.
    pub(super) fn speaking_for(self, owned: u8) -> Self {
        Self { owned, ..self }
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
