//! Edges and triangles on a lattice against rational arithmetic, and what roundings must not change.

use super::{Meeting, edge_crosses_triangle, edge_meets_triangle};
use crate::Vector;
use crate::scatter::Scatter;

type Whole = [i64; 3];

fn minus(a: Whole, b: Whole) -> Whole {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Whole, b: Whole) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Whole, b: Whole) -> Whole {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Whether a point with the homogeneous coordinates x / w, w > 0, lies in the triangle: on its plane, and on the inner side
/// of each border, or on one of the borders.
fn is_in_triangle(x: Whole, w: i64, triangle: [Whole; 3]) -> bool {
    let seen = triangle.map(|corner| minus(x, corner.map(|number| number * w)));
    let normal = cross(minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0]));
    let between =
        |i: usize, j: usize| cross(seen[i], seen[j]) == [0; 3] && dot(seen[i], seen[j]) <= 0;
    if between(0, 1) || between(1, 2) || between(2, 0) {
        return true;
    }
    let is_inner = |i: usize, j: usize| dot(cross(seen[i], seen[j]), normal) > 0;
    dot(seen[0], normal) == 0 && is_inner(0, 1) && is_inner(1, 2) && is_inner(2, 0)
}

/// Whether two edges meet: their ends on each other, or a crossing found by Cramer's rule.
fn do_edges_meet([p, q]: [Whole; 2], [a, b]: [Whole; 2]) -> bool {
    let (pq, ab, pa) = (minus(q, p), minus(b, a), minus(a, p));
    let normal = cross(pq, ab);
    let square = dot(normal, normal);
    if square == 0 {
        let on = |x: Whole, [a, b]: [Whole; 2]| {
            cross(minus(a, x), minus(b, x)) == [0; 3] && dot(minus(a, x), minus(b, x)) <= 0
        };
        return on(p, [a, b]) || on(q, [a, b]) || on(a, [p, q]) || on(b, [p, q]);
    }
    let (s, t) = (dot(cross(pa, ab), normal), dot(cross(pa, pq), normal));
    dot(pa, normal) == 0 && (0..=square).contains(&s) && (0..=square).contains(&t)
}

/// Whether an edge and a triangle meet: an end in the triangle, a border met, or the plane pierced in the triangle.
fn do_meet([p, q]: [Whole; 2], triangle: [Whole; 3]) -> bool {
    let [a, b, c] = triangle;
    if is_in_triangle(p, 1, triangle) || is_in_triangle(q, 1, triangle) {
        return true;
    }
    if [[a, b], [b, c], [c, a]].iter().any(|&border| do_edges_meet([p, q], border)) {
        return true;
    }
    let normal = cross(minus(b, a), minus(c, a));
    let (over, under) = (dot(minus(p, a), normal), dot(minus(q, a), normal));
    if over * under >= 0 {
        return false;
    }
    // p + (q - p) over / (over - under)
    let w = (over - under).abs();
    let t = over.abs();
    let x = [0, 1, 2].map(|axis| p[axis] * w + (q[axis] - p[axis]) * t);
    is_in_triangle(x, w, triangle)
}

fn meeting(x: &[Vector; 5]) -> Meeting {
    edge_meets_triangle([&x[0], &x[1]], [&x[2], &x[3], &x[4]])
}

#[test]
fn edges_meet_triangles_as_rational_arithmetic_says() {
    let mut scatter = Scatter(3);
    let mut counts = [0; 2];
    for index in 0..200_000 {
        let x = [(); 5].map(|()| scatter.lattice_point(1 + index % 4));
        let whole = x.map(|point| [point.x as i64, point.y as i64, point.z as i64]);
        let [p, q, a, b, c] = whole;
        let expected = do_meet([p, q], [a, b, c]);
        counts[usize::from(expected)] += 1;
        // Thirds of the lattice are rounded to other places: halves are not.
        let x = x.map(|point| point * 0.125 + Vector::repeat(1024.0));
        let met = edge_crosses_triangle([&x[0], &x[1]], [&x[2], &x[3], &x[4]]);
        assert_eq!(met, expected, "{whole:?}");
    }
    assert!(counts.iter().all(|&count| count > 30_000), "{counts:?}");
}

#[test]
fn the_answer_does_not_depend_on_the_order_of_vertices() {
    let mut scatter = Scatter(4);
    for index in 0..50_000 {
        let (four, _) = scatter.four_points(index);
        let fifth = four[index % 4] + (four[(index + 1) % 4] - four[index % 4]) * 0.3;
        let [p, q, a, b] = four;
        let expected = meeting(&[p, q, a, b, fifth]);
        for [a, b, c] in [[b, fifth, a], [fifth, a, b], [b, a, fifth], [a, fifth, b]] {
            assert_eq!(meeting(&[p, q, a, b, c]), expected);
            assert_eq!(meeting(&[q, p, a, b, c]), expected);
        }
    }
}

#[test]
fn an_edge_that_ends_a_rounding_before_a_triangle_does_not_meet_it() {
    let triangle = [[-0.3, -0.1, 0.7], [0.9, -0.2, 0.7], [0.1, 1.1, 0.7]].map(Vector::from);
    let at = |z: f64| {
        let ends = [Vector::new(0.1, 0.2, 3.0), Vector::new(0.1, 0.2, z)];
        edge_meets_triangle([&ends[0], &ends[1]], [&triangle[0], &triangle[1], &triangle[2]])
    };
    assert_eq!(at(0.7_f64.next_up()), Meeting::Apart);
    assert_eq!(at(0.7), Meeting::Touching);
    assert_eq!(at(0.7_f64.next_down()), Meeting::Crossing);
}

#[test]
fn a_passage_through_the_border_or_along_the_plane_is_a_touch() {
    let [a, b, c] = [Vector::zeros(), Vector::x(), Vector::y()];
    let through = |x, y| {
        let foot = Vector::new(x, y, 0.0);
        edge_meets_triangle([&(foot - Vector::z()), &(foot + Vector::z())], [&a, &b, &c])
    };
    assert_eq!(through(0.25, 0.25), Meeting::Crossing);
    assert_eq!(through(0.5, 0.5), Meeting::Touching);
    assert_eq!(through(0.0, 0.0), Meeting::Touching);
    assert_eq!(through(0.5, 0.5_f64.next_up()), Meeting::Apart);
    let within = [Vector::new(0.1, 0.1, 0.0), Vector::new(0.2, 0.3, 0.0)];
    assert_eq!(edge_meets_triangle([&within[0], &within[1]], [&a, &b, &c]), Meeting::Touching);
}

#[test]
fn neighbours_in_a_flat_sheet_meet_only_where_they_share_vertices() {
    let place = |x: i32, y: i32| {
        // A plane that no coordinate plane is parallel to, in numbers without roundings.
        let (x, y) = (f64::from(x) * 0.125, f64::from(y) * 0.125);
        Vector::new(x, y, x + 2.0 * y)
    };
    let triangle = [place(0, 0), place(1, 0), place(0, 1)];
    for x in -2..=2 {
        for y in -2..=2 {
            let edge = [place(x, y), place(x + 1, y)];
            let shares = y == 0 && (-1..=1).contains(&x) || y == 1 && (-1..=0).contains(&x);
            let met = edge_crosses_triangle(
                [&edge[0], &edge[1]],
                [&triangle[0], &triangle[1], &triangle[2]],
            );
            assert_eq!(met, shares, "{x} {y}");
        }
    }
}
