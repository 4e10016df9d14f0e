//! The angle by which two triangles turn at their common edge.
//!
//! With the edge e from `x_0` to `x_1` and the wings `x_2`, to the left of it as seen from where both normals point, and `x_3`:
//!
//! ```text
//! n_2 = e x (x_2 - x_0)        n_3 = (x_3 - x_0) x e        tan(angle) = (n_2 x n_3)·e/|e| / (n_2·n_3)
//! ```
//!
//! Flat is 0; wings that rise make it negative. Its gradient is along the normals, and infinite only for triangles without
//! area.
//!
//! Source: Bridson, Marino & Fedkiw 2003; Grinspun et al. 2003.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use boucle_geometry::Vector;

use crate::law::number::Number;

/// Squared lengths of normals (m⁴) below which a triangle has no direction.
const FLATTEST: f64 = 1e-36;

/// A point, or a vector.
pub(super) type Point<N> = [N; 3];

/// The angle, and its gradient (1/m) at the four points; zeros where a triangle has no area.
#[inline(always)]
pub(super) fn angle_and_gradient<N: Number>(x: [Point<N>; 4]) -> (N, [Point<N>; 4]) {
    let e = minus(x[1], x[0]);
    let n2 = cross(e, minus(x[2], x[0]));
    let n3 = cross(minus(x[3], x[0]), e);
    let least = e[0].all(FLATTEST);
    let by_length = e[0].all(1.0) / dot(e, e).max(least).sqrt();
    let angle = angle_of(dot(cross(n2, n3), e) * by_length, dot(n2, n3));
    let has_area = |square: N| (square - least).min(square);
    let [s2, s3] = [dot(n2, n2), dot(n3, n3)];
    let both = has_area(s2).min(has_area(s3));
    let by_square = |square: N| (square.all(1.0) / square.max(least)).where_positive(both);
    let (n2, n3) = (scaled(by_square(s2), n2), scaled(by_square(s3), n3));
    let along = |from: Point<N>, to: Point<N>| dot(minus(to, from), e) * by_length;
    let sum = |a: N, b: N| plus(scaled(a, n2), scaled(b, n3));
    let length = dot(e, e) * by_length;
    let opposite = length.all(0.0) - length;
    let gradient = [
        sum(along(x[2], x[1]), along(x[3], x[1])),
        sum(along(x[0], x[2]), along(x[0], x[3])),
        scaled(opposite, n2),
        scaled(opposite, n3),
    ];
    (angle, gradient)
}

/// The angle alone.
pub(super) fn angle(x: [Vector; 4]) -> f64 {
    angle_and_gradient(x.map(Into::into)).0
}

/// What each point's height counts for in the angle (1/m), where both triangles are turned into one plane.
pub(super) fn weights(x: [Vector; 4]) -> [f64; 4] {
    let e = x[1] - x[0];
    let length = e.norm();
    let [left, right] = [x[2], x[3]].map(|wing| {
        let along = (wing - x[0]).dot(&e) / length;
        let height = e.cross(&(wing - x[0])).norm() / length;
        [(length - along) / height, along / height, -length / height].map(|part| part / length)
    });
    [left[0] + right[0], left[1] + right[1], left[2], right[2]]
}

/// An angle (rad) brought between -pi and pi by one turn.
#[inline(always)]
pub(super) fn the_shorter_way<N: Number>(angle: N) -> N {
    let (half, whole) = (angle.all(PI), angle.all(TAU));
    let angle = (angle - whole).where_positive_or(angle - half, angle);
    (angle + whole).where_positive_or(angle.all(-PI) - angle, angle)
}

/// The angle (rad) of the direction (x, y): `atan2`, of basic operations alone.
///
/// `tan(a/2) = t/(1 + sqrt(1 + t²))`, twice, leaves a series of ten terms within a few units in the last place.
#[inline(always)]
fn angle_of<N: Number>(y: N, x: N) -> N {
    let zero = x.all(0.0);
    let one = x.all(1.0);
    let size = |a: N| a.max(zero - a);
    let (height, width) = (size(y), size(x));
    let steep = height - width;
    let t = height.min(width) / height.max(width).max(x.all(f64::MIN_POSITIVE));
    let halved = |t: N| t / (one + (one + t * t).sqrt());
    let t = halved(halved(t));
    let square = t * t;
    let mut sum = x.all(-1.0 / 19.0);
    for odd in [17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0, 1.0] {
        // 1 - t²/3 + t⁴/5 - ...
        let sign = if (odd as i32 / 2) % 2 == 0 { 1.0 } else { -1.0 };
        sum = x.all(sign / odd) + square * sum;
    }
    let angle = x.all(4.0) * t * sum;
    let angle = (x.all(FRAC_PI_2) - angle).where_positive_or(steep, angle);
    let angle = (x.all(PI) - angle).where_positive_or(zero - x, angle);
    (zero - angle).where_positive_or(zero - y, angle)
}

#[inline(always)]
pub(super) fn minus<N: Number>(a: Point<N>, b: Point<N>) -> Point<N> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn plus<N: Number>(a: Point<N>, b: Point<N>) -> Point<N> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(super) fn scaled<N: Number>(factor: N, a: Point<N>) -> Point<N> {
    [factor * a[0], factor * a[1], factor * a[2]]
}

#[inline(always)]
pub(super) fn dot<N: Number>(a: Point<N>, b: Point<N>) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn cross<N: Number>(a: Point<N>, b: Point<N>) -> Point<N> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scatter::scattered;

    fn gradient(x: [Vector; 4]) -> [Vector; 4] {
        angle_and_gradient(x.map(Into::into)).1.map(Vector::from)
    }

    fn points(seed: u64) -> [Vector; 4] {
        let at =
            |i: u64| Vector::from_fn(|axis, _| 0.2 * scattered(16 * seed + 3 * i + axis as u64));
        let flat = [[0.0, 0.0], [1.0, 0.1], [0.4, 0.9], [0.5, -0.8]];
        std::array::from_fn(|i| Vector::new(flat[i][0], flat[i][1], 0.0) + at(i as u64))
    }

    #[test]
    fn the_gradient_is_the_slope_of_the_angle() {
        for seed in 0..50 {
            let x = points(seed);
            let gradient = gradient(x);
            for corner in 0..4 {
                for axis in 0..3 {
                    let at = |step: f64| {
                        let mut moved = x;
                        moved[corner][axis] += step;
                        angle(moved)
                    };
                    let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
                    let error = (gradient[corner][axis] - slope).abs();
                    assert!(error < 1e-7, "seed {seed}, point {corner}, axis {axis}: {error}");
                }
            }
        }
    }

    #[test]
    fn a_fold_has_the_angle_by_which_it_is_folded() {
        for degrees in [-170.0_f64, -90.0, -1.0, 0.0, 30.0, 150.0] {
            let (s, c) = degrees.to_radians().sin_cos();
            let x =
                [Vector::zeros(), Vector::x(), Vector::new(0.3, 1.0, 0.0), Vector::new(0.6, -c, s)];
            // The right wing turned up about the edge: the left normal turns onto the right one about -e.
            assert!((angle(x) + degrees.to_radians()).abs() < 1e-12, "{degrees}");
        }
    }

    #[test]
    fn turning_and_moving_the_whole_leaves_the_angle() {
        let x = points(7);
        let sum = gradient(x).iter().sum::<Vector>();
        assert!(sum.norm() < 1e-12, "{sum}");
        let torque: Vector = x.iter().zip(gradient(x)).map(|(x, g)| x.cross(&g)).sum();
        assert!(torque.norm() < 1e-12, "{torque}");
    }

    #[test]
    fn angles_of_directions_are_those_of_the_library() {
        for i in 0..10_000_i32 {
            let angle = f64::from(i - 5000) * 6.283e-4;
            for size in [1e-30, 1e-3, 1.0, 1e12] {
                let (y, x) = (size * angle.sin(), size * angle.cos());
                let error = (angle_of(y, x) - y.atan2(x)).abs();
                assert!(error < 1e-15 * 4.0, "{angle}: {error:e}");
            }
        }
        assert_eq!([angle_of(0.0, 0.0), angle_of(0.0, 2.0)].map(f64::to_bits), [0, 0]);
    }

    #[test]
    fn triangles_without_area_have_no_gradient() {
        let x = [Vector::zeros(), Vector::x(), 0.5 * Vector::x(), Vector::y()];
        assert!(gradient(x).iter().all(|g| g.norm() <= 0.0));
        assert!(gradient([Vector::zeros(); 4]).iter().all(|g| g.norm() <= 0.0));
    }
}
