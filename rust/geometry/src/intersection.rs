//! Whether an edge meets a triangle, decided exactly.
//!
//! Every question is the sign of a determinant, and Shewchuk's adaptive predicates give that sign without error (as long
//! as no product leaves the range of floating point numbers):
//!
//! ```text
//! orient3d(a, b, c, d)    on which side of the plane abc the point d lies, 0 in the plane
//! orient2d(a, b, c)       on which side of the line ab the point c lies, 0 on the line
//! ```
//!
//! An edge pq with one end on each side of the plane abc pierces it in one point, which lies in the triangle if the line
//! pq turns the same way around ab, bc and ca. In the plane itself the question is asked of a shadow on a coordinate plane
//! in which the triangle keeps an area: that projection is one to one. Triangles without area are the sum of their edges.
//!
//! A test with a tolerance would count thousands of crossings on flat sheets, whose edges all lie in the planes of their
//! neighbours.
//!
//! Source: Shewchuk 1997, Adaptive precision floating-point arithmetic and fast robust geometric predicates.

use std::cmp::Ordering;

use robust::{Coord, Coord3D};

use crate::Vector;

/// What an edge and a triangle have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meeting {
    /// No point.
    Apart,
    /// A point, but the smallest move may part them: an end of the edge lies in the plane of the triangle, or the edge
    /// passes through its border.
    Touching,
    /// The ends lie on either side, and the edge passes through the inside.
    Crossing,
}

/// Whether an edge and a triangle, both with their borders, have a point in common.
#[must_use]
pub fn edge_crosses_triangle(edge: [&Vector; 2], triangle: [&Vector; 3]) -> bool {
    edge_meets_triangle(edge, triangle) != Meeting::Apart
}

/// What an edge and a triangle, both with their borders, have in common.
#[must_use]
pub fn edge_meets_triangle(edge: [&Vector; 2], triangle: [&Vector; 3]) -> Meeting {
    use Ordering::Equal;
    if are_boxes_apart(&edge, &triangle) {
        return Meeting::Apart;
    }
    let ([p, q], [a, b, c]) = (edge, triangle);
    let sides = [side(a, b, c, p), side(a, b, c, q)];
    if sides == [Equal, Equal] {
        let is_met = plane_edge_meets_triangle(edge, triangle);
        return if is_met { Meeting::Touching } else { Meeting::Apart };
    }
    if sides[0] == sides[1] {
        return Meeting::Apart;
    }
    let turns = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    if turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater) {
        Meeting::Apart
    } else if sides.contains(&Equal) || turns.contains(&Equal) {
        Meeting::Touching
    } else {
        Meeting::Crossing
    }
}

/// Whether some axis tells two sets of points apart.
fn are_boxes_apart(these: &[&Vector], those: &[&Vector]) -> bool {
    (0..3).any(|axis| {
        let ends = |points: &[&Vector]| {
            points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), point| {
                (least.min(point[axis]), most.max(point[axis]))
            })
        };
        let (these, those) = (ends(these), ends(those));
        these.1 < those.0 || those.1 < these.0
    })
}

/// Whether an edge meets a triangle of its own plane, or one without area on its own line or plane.
fn plane_edge_meets_triangle(edge: [&Vector; 2], triangle: [&Vector; 3]) -> bool {
    let [a, b, c] = triangle;
    let is_inside = area_axis(&[triangle]).is_some_and(|axis| {
        let p = edge[0];
        let turns = [turn(a, b, p, axis), turn(b, c, p, axis), turn(c, a, p, axis)];
        !(turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater))
    });
    is_inside || [[a, b], [b, c], [c, a]].iter().any(|&border| do_edges_meet(edge, border))
}

/// Whether two edges, their ends included, have a point in common.
fn do_edges_meet([p, q]: [&Vector; 2], [a, b]: [&Vector; 2]) -> bool {
    if side(p, q, a, b) != Ordering::Equal {
        return false;
    }
    match area_axis(&[[p, q, a], [p, q, b], [a, b, p], [a, b, q]]) {
        // Four points of a plane, not of a line: each edge must have the other's ends on both sides of its line.
        Some(axis) => {
            let is_split = |ends: [Ordering; 2]| ends[0] != ends[1];
            is_split([turn(a, b, p, axis), turn(a, b, q, axis)])
                && is_split([turn(p, q, a, axis), turn(p, q, b, axis)])
        }
        // Four points of a line: they meet if no coordinate tells them apart.
        None => !are_boxes_apart(&[p, q], &[a, b]),
    }
}

/// The axis along which the shadow of one of these triangles has an area.
fn area_axis(triangles: &[[&Vector; 3]]) -> Option<usize> {
    let has_area =
        |axis: usize| triangles.iter().any(|&[a, b, c]| turn(a, b, c, axis) != Ordering::Equal);
    (0..3).find(|&axis| has_area(axis))
}

/// On which side of the plane abc the point d lies.
fn side(a: &Vector, b: &Vector, c: &Vector, d: &Vector) -> Ordering {
    let point = |v: &Vector| Coord3D { x: v.x, y: v.y, z: v.z };
    sign(robust::orient3d(point(a), point(b), point(c), point(d)))
}

/// On which side of the line ab the point c lies, seen along an axis.
fn turn(a: &Vector, b: &Vector, c: &Vector, axis: usize) -> Ordering {
    let shadow = |v: &Vector| Coord { x: v[(axis + 1) % 3], y: v[(axis + 2) % 3] };
    sign(robust::orient2d(shadow(a), shadow(b), shadow(c)))
}

fn sign(determinant: f64) -> Ordering {
    determinant.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

#[cfg(test)]
mod tests;
