//! Whether a point lies inside a closed body: its winding number.
//!
//! Seen from the point, every triangle covers a signed part of the sphere around it, its solid angle Ω. With a, b, c the
//! corners seen from the point,
//!
//! ```text
//! tan(Ω / 2) = a·(b × c) / (|a||b||c| + (a·b)|c| + (b·c)|a| + (c·a)|b|)
//! winding number = Σ Ω / 4π        1 inside, 0 outside
//! ```
//!
//! For a surface with holes the number is a fraction that still says how much of the point's sky is covered, so 0.5 parts
//! inside from outside where a ray would have to guess.
//!
//! Sources: van Oosterom & Strackee 1983 (solid angle); Jacobson, Kavan & Sorkine-Hornung 2013 (generalized winding number).

use std::f64::consts::PI;

use crate::Vector;

/// Whether a point lies inside a closed body, whose triangles run counterclockwise seen from outside.
///
/// On the surface itself the answer may be either.
#[must_use]
pub fn is_inside(point: &Vector, triangles: impl Iterator<Item = [Vector; 3]>) -> bool {
    // The halves of the angles add up to 2π inside; half of that parts inside from outside.
    triangles.map(|triangle| half_solid_angle(triangle.map(|corner| corner - point))).sum::<f64>()
        > PI
}

/// Half of the solid angle (sr) of a triangle seen from the origin, positive from behind.
fn half_solid_angle([a, b, c]: [Vector; 3]) -> f64 {
    let [p, q, r] = [a.norm(), b.norm(), c.norm()];
    let volume = a.dot(&b.cross(&c));
    volume.atan2(p * q * r + a.dot(&b) * r + b.dot(&c) * p + c.dot(&a) * q)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scatter::Scatter;

    /// The octahedron |x| + |y| + |z| <= 1, its triangles counterclockwise seen from outside.
    fn octahedron() -> Vec<[Vector; 3]> {
        let mut triangles = Vec::new();
        for corner in 0..8 {
            let sign = |axis: u32| if corner >> axis & 1 == 0 { 1.0 } else { -1.0 };
            let [a, b, c] = [Vector::x() * sign(0), Vector::y() * sign(1), Vector::z() * sign(2)];
            let is_outward = sign(0) * sign(1) * sign(2) > 0.0;
            triangles.push(if is_outward { [a, b, c] } else { [a, c, b] });
        }
        triangles
    }

    #[test]
    fn a_point_is_inside_an_octahedron_if_the_sum_of_its_coordinates_is_less_than_one() {
        let mut scatter = Scatter(5);
        for _ in 0..10_000 {
            let point = scatter.point();
            let expected = point.lp_norm(1) < 1.0;
            assert_eq!(is_inside(&point, octahedron().into_iter()), expected, "{point}");
        }
    }

    #[test]
    fn a_body_with_a_missing_triangle_still_has_an_inside() {
        for missing in 0..8 {
            let mut triangles = octahedron();
            triangles.remove(missing);
            assert!(is_inside(&Vector::zeros(), triangles.iter().copied()));
            assert!(!is_inside(&Vector::repeat(0.9), triangles.into_iter()));
        }
    }

    #[test]
    fn a_room_whose_walls_face_inward_has_no_inside() {
        let room = octahedron().into_iter().map(|[a, b, c]| [a, c, b]);
        assert!(!is_inside(&Vector::zeros(), room));
    }

    #[test]
    fn empty_surfaces_and_triangles_without_area_hold_nothing() {
        let flat = [[Vector::zeros(), Vector::x(), Vector::x()]; 3];
        assert!(!is_inside(&Vector::y(), flat.into_iter()));
        assert!(!is_inside(&Vector::zeros(), flat.into_iter()));
        assert!(!is_inside(&Vector::zeros(), std::iter::empty()));
    }
}
