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

use boucle_geometry::Vector;

/// Squared lengths of normals (m⁴) below which a triangle has no direction.
const FLATTEST: f64 = 1e-36;

/// The angle.
pub(super) fn angle(x: [Vector; 4]) -> f64 {
    let [e, n2, n3] = frame(x);
    let length = e.norm();
    if length == 0.0 {
        return 0.0;
    }
    (n2.cross(&n3).dot(&e) / length).atan2(n2.dot(&n3))
}

/// The gradient of the angle (1/m) at the four points; zeros where a triangle has no area.
pub(super) fn gradient(x: [Vector; 4]) -> [Vector; 4] {
    let [e, n2, n3] = frame(x);
    let (length, squares) = (e.norm(), [n2.norm_squared(), n3.norm_squared()]);
    if length == 0.0 || squares.iter().any(|square| !(*square > FLATTEST)) {
        return [Vector::zeros(); 4];
    }
    let [n2, n3] = [n2 / squares[0], n3 / squares[1]];
    let along = |point: Vector| point.dot(&e) / length;
    let at_0 = along(x[1] - x[2]) * n2 + along(x[1] - x[3]) * n3;
    let at_1 = along(x[2] - x[0]) * n2 + along(x[3] - x[0]) * n3;
    [at_0, at_1, -length * n2, -length * n3]
}

fn frame([x0, x1, x2, x3]: [Vector; 4]) -> [Vector; 3] {
    let e = x1 - x0;
    [e, e.cross(&(x2 - x0)), (x3 - x0).cross(&e)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scatter::scattered;

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
}
