//! Closest points against a search that knows nothing of features, and against closed forms.

use super::{Closest, edge_edge, point_triangle};
use crate::Vector;
use crate::scatter::Scatter;

/// Distance of a point and a segment.
fn to_segment(p: &Vector, a: &Vector, b: &Vector) -> f64 {
    let ab = b - a;
    let t = (p - a).dot(&ab) / ab.norm_squared();
    let t = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
    // The ends beside the foot, for segments so short that the foot is not to be trusted.
    [p - a - ab * t, p - a, p - b].map(|gap| gap.norm()).into_iter().fold(f64::INFINITY, f64::min)
}

/// The least value of a convex function on 0 to 1, by thirds.
fn least(f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..90 {
        let third = (high - low) / 3.0;
        if f(low + third) < f(high - third) { high -= third } else { low += third }
    }
    f(low).min(f(high)).min(f(0.0)).min(f(1.0))
}

/// The triangle as the segments parallel to ab: the distance to them is convex in how far off they are.
fn searched_point_triangle([p, a, b, c]: &[Vector; 4]) -> f64 {
    least(|w| {
        let toward = |corner: &Vector| corner + (c - corner) * w;
        to_segment(p, &toward(a), &toward(b))
    })
}

/// The distance of the points of ab to cd is convex along ab.
fn searched_edge_edge([a, b, c, d]: &[Vector; 4]) -> f64 {
    least(|s| to_segment(&(a + (b - a) * s), c, d))
}

/// The weights are those of two points of the features, and lead from one to the other.
fn check_weights(closest: &Closest, x: &[Vector; 4], size: f64, first: usize) {
    let w = closest.weights;
    assert!((w[..first].iter().sum::<f64>() - 1.0).abs() < 1e-15, "{closest:?}");
    assert!((w[first..].iter().sum::<f64>() + 1.0).abs() < 1e-15, "{closest:?}");
    assert!(w[..first].iter().all(|w| (0.0..=1.0).contains(w)), "{closest:?}");
    assert!(w[first..].iter().all(|w| (-1.0..=0.0).contains(w)), "{closest:?}");
    let led: Vector = x.iter().zip(w).map(|(point, w)| point * w).sum();
    assert!((led - closest.offset).amax() <= 1e-14 * size, "{closest:?} {x:?}");
    for (point, weight) in w.into_iter().enumerate() {
        assert_eq!(closest.feature >> point & 1 == 1, weight != 0.0);
    }
}

#[test]
fn no_point_of_a_triangle_is_nearer_than_the_closest() {
    let mut scatter = Scatter(1);
    for index in 0..100_000 {
        let (x, size) = scatter.four_points(index);
        let closest = point_triangle(&x[0], &x[1], &x[2], &x[3]);
        check_weights(&closest, &x, size, 1);
        let error = closest.distance() - searched_point_triangle(&x);
        assert!(error.abs() <= 1e-13 * size, "{index}: {error:e} of {size:e} for {x:?}");
    }
}

#[test]
fn no_points_of_two_edges_are_nearer_than_the_closest() {
    let mut scatter = Scatter(2);
    for index in 0..100_000 {
        let (x, size) = scatter.four_points(index);
        let closest = edge_edge(&x[0], &x[1], &x[2], &x[3]);
        check_weights(&closest, &x, size, 2);
        let error = closest.distance() - searched_edge_edge(&x);
        assert!(error.abs() <= 1e-13 * size, "{index}: {error:e} of {size:e} for {x:?}");
    }
}

#[test]
fn a_point_over_a_face_an_edge_and_a_corner_has_only_their_weights() {
    let [a, b, c] = [Vector::zeros(), Vector::x(), Vector::y()];
    let at = |x, y| point_triangle(&Vector::new(x, y, 2.0), &a, &b, &c);
    let over_face = at(0.25, 0.25);
    assert_eq!((over_face.weights, over_face.feature), ([1.0, -0.5, -0.25, -0.25], 0b1111));
    assert_eq!(over_face.offset, Vector::z() * 2.0);
    assert_eq!((at(0.5, -1.0).weights, at(0.5, -1.0).feature), ([1.0, -0.5, -0.5, 0.0], 0b0111));
    assert_eq!((at(1.0, 1.0).weights, at(1.0, 1.0).feature), ([1.0, 0.0, -0.5, -0.5], 0b1101));
    assert_eq!((at(-1.0, 0.5).weights, at(-1.0, 0.5).feature), ([1.0, -0.5, 0.0, -0.5], 0b1011));
    assert_eq!((at(-1.0, -1.0).weights, at(-1.0, -1.0).feature), ([1.0, -1.0, 0.0, 0.0], 0b0011));
    assert_eq!((at(9.0, -1.0).weights, at(9.0, -1.0).feature), ([1.0, 0.0, -1.0, 0.0], 0b0101));
    assert_eq!((at(0.0, 9.0).weights, at(0.0, 9.0).feature), ([1.0, 0.0, 0.0, -1.0], 0b1001));
}

#[test]
fn edges_that_face_each_other_or_only_an_end_have_only_their_weights() {
    let x = Vector::x();
    let across = |x, y, z| (Vector::new(x, y, z), Vector::new(x, y + 2.0, z));
    let at = |(c, d): (Vector, Vector)| edge_edge(&-x, &x, &c, &d);
    let crossing = at(across(0.5, -1.0, 3.0));
    assert_eq!((crossing.weights, crossing.feature), ([0.25, 0.75, -0.5, -0.5], 0b1111));
    assert_eq!(crossing.offset, Vector::z() * -3.0);
    let end_of_cd = at(across(0.5, 1.0, 3.0));
    assert_eq!((end_of_cd.weights, end_of_cd.feature), ([0.25, 0.75, -1.0, 0.0], 0b0111));
    let end_of_ab = at(across(5.0, -1.0, 3.0));
    assert_eq!((end_of_ab.weights, end_of_ab.feature), ([0.0, 1.0, -0.5, -0.5], 0b1110));
    let both_ends = at(across(-5.0, -9.0, 3.0));
    assert_eq!((both_ends.weights, both_ends.feature), ([1.0, 0.0, 0.0, -1.0], 0b1001));
}

#[test]
fn crossing_edges_and_points_on_a_triangle_have_no_distance() {
    let corners = [Vector::zeros(), Vector::x(), Vector::y()];
    let on = Vector::new(0.25, 0.25, 0.0);
    let touching = point_triangle(&on, &corners[0], &corners[1], &corners[2]);
    assert_eq!(touching.offset, Vector::zeros());
    let crossing = edge_edge(&corners[0], &(on * 2.0), &corners[1], &corners[2]);
    assert_eq!(crossing.offset, Vector::zeros());
}

#[test]
fn one_point_four_times_has_no_distance_from_itself() {
    for point in [Vector::zeros(), Vector::repeat(0.1), Vector::repeat(1e200)] {
        let closest = point_triangle(&point, &point, &point, &point);
        check_weights(&closest, &[point; 4], 1e200, 1);
        assert_eq!(closest.offset, Vector::zeros());
        let closest = edge_edge(&point, &point, &point, &point);
        check_weights(&closest, &[point; 4], 1e200, 2);
        assert_eq!(closest.offset, Vector::zeros());
    }
}
