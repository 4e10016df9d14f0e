//! Times of impact against the distance at many moments of the path, and against closed forms.

use super::{LEFT, edge_edge_impact, point_triangle_impact};
use crate::Vector;
use crate::distance::{edge_edge, point_triangle};
use crate::scatter::Scatter;

/// Moments of a path at which the distance is looked at.
const MOMENTS: u32 = 64;

/// A start and an end: of any kinds, or a motion in common with little of its own, or a passage through each other.
fn path(scatter: &mut Scatter, index: usize) -> ([Vector; 4], [Vector; 4], f64) {
    let (start, size) = scatter.four_points(index);
    let common = scatter.point() * size;
    let share = 10_f64.powi(-scatter.whole(0, 6)) * size;
    let end = match scatter.whole(0, 2) {
        0 => start.map(|point| point + common + scatter.point() * share),
        1 => start.map(|point| start[3] + (start[2] - point)),
        _ => [(); 4].map(|()| scatter.point() * size),
    };
    let largest = start.iter().chain(&end).fold(0.0, |size: f64, point| size.max(point.amax()));
    (start, end, largest)
}

/// Checks many paths of features whose distance is `measured`; gives how many had an impact and how many had none.
fn check_paths(
    seed: u64,
    impact: impl Fn([&Vector; 4], [&Vector; 4], f64) -> Option<f64>,
    measured: impl Fn(&[Vector; 4]) -> f64,
) -> [u32; 2] {
    let mut scatter = Scatter(seed);
    let mut counts = [0; 2];
    for index in 0..20_000 {
        let (start, end, size) = path(&mut scatter, index);
        let distance_at = |time: f64| {
            let now: [Vector; 4] = std::array::from_fn(|i| start[i] * (1.0 - time) + end[i] * time);
            measured(&now)
        };
        let first = distance_at(0.0);
        let gap = 0.1 * first * f64::from(scatter.whole(0, 4));
        let found = impact(start.each_ref(), end.each_ref(), gap);
        let rounding = 1e-13 * size;
        for moment in 0..=MOMENTS {
            let time = found.unwrap_or(1.0) * f64::from(moment) / f64::from(MOMENTS);
            let short = gap - distance_at(time);
            assert!(short <= rounding, "{index}: {short:e} less than {gap:e} at {time}");
        }
        // Nearer at the start, the steps may be used up.
        if let Some(time) = found.filter(|_| first > 1e-4 * size) {
            let late = distance_at(time) - gap - LEFT * (first - gap);
            assert!(late <= rounding, "{index}: {late:e} too early, at {time}");
        }
        counts[usize::from(found.is_some())] += 1;
    }
    counts
}

#[test]
fn a_point_and_a_triangle_keep_their_gap_until_impact_and_no_longer() {
    let counts =
        check_paths(6, point_triangle_impact, |[p, a, b, c]| point_triangle(p, a, b, c).distance());
    assert!(counts.iter().all(|&count| count > 5_000), "{counts:?}");
}

#[test]
fn two_edges_keep_their_gap_until_impact_and_no_longer() {
    let counts = check_paths(7, edge_edge_impact, |[a, b, c, d]| edge_edge(a, b, c, d).distance());
    assert!(counts.iter().all(|&count| count > 5_000), "{counts:?}");
}

#[test]
fn a_point_that_falls_on_a_triangle_stops_a_gap_above_it() {
    let [a, b, c] = [Vector::zeros(), Vector::x(), Vector::y()];
    let at = |z: f64| Vector::new(0.25, 0.25, z);
    let fall = |end: f64, gap: f64| {
        point_triangle_impact([&at(1.0), &a, &b, &c], [&at(end), &a, &b, &c], gap)
    };
    assert_eq!(fall(0.125, 0.0), None);
    assert_eq!(fall(0.125, 0.1), None);
    let time = fall(-1.0, 0.0).expect("it falls through");
    assert!((0.5 - 1e-9..=0.5).contains(&time), "{time}");
    let time = fall(-1.0, 0.5).expect("it falls through");
    assert!((0.25 - 1e-9..=0.25).contains(&time), "{time}");
    let time = fall(-1e9, 0.0).expect("a bullet falls through, too");
    assert!((0.999_9e-9..=1e-9).contains(&time), "{time}");
}

#[test]
fn edges_that_sweep_through_each_other_meet_halfway() {
    let [a, b] = [-Vector::x(), Vector::x()];
    let at = |z: f64| [Vector::new(0.3, -1.0, z), Vector::new(0.3, 1.0, z)];
    let ([c, d], [e, f]) = (at(1.0), at(-1.0));
    let time = edge_edge_impact([&a, &b, &c, &d], [&a, &b, &e, &f], 0.0).expect("they meet");
    assert!((0.5 - 1e-9..=0.5).contains(&time), "{time}");
    let rise = Vector::z() * 10.0;
    let [e, f] = [e + rise, f + rise];
    let (a_end, b_end) = (a + rise, b + rise);
    let carried = edge_edge_impact([&a, &b, &c, &d], [&a_end, &b_end, &e, &f], 0.0);
    assert_eq!(carried, Some(time), "the same path, carried along");
}

#[test]
fn what_slides_past_closely_has_no_impact() {
    let [a, b, c] = [Vector::zeros(), Vector::x(), Vector::y()];
    let at = |x: f64| Vector::new(x, 0.25, 1e-6);
    let found = point_triangle_impact([&at(-9.0), &a, &b, &c], [&at(9.0), &a, &b, &c], 0.0);
    assert_eq!(found, None);
    let found = point_triangle_impact([&at(0.1), &a, &b, &c], [&at(9.0), &a, &b, &c], 0.999e-6);
    assert_eq!(found, None);
}

#[test]
fn what_is_too_near_at_the_start_has_its_impact_there() {
    let [a, b, c] = [Vector::zeros(), Vector::x(), Vector::y()];
    let p = Vector::new(0.25, 0.25, 0.5);
    for gap in [0.5, 0.6] {
        let away = p + Vector::z();
        assert_eq!(point_triangle_impact([&p, &a, &b, &c], [&away, &a, &b, &c], gap), Some(0.0));
    }
    assert_eq!(edge_edge_impact([&a, &b, &a, &c], [&a, &b, &a, &c], 0.0), Some(0.0));
}
