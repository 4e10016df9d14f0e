//! Distances, impacts and intersections of any points.

use arbitrary::Unstructured;
use boucle_geometry::{
    Vector, distance, edge_crosses_triangle, edge_edge_impact, edge_meets_triangle, is_inside,
    point_triangle_impact,
};

use crate::cloth::any;

/// Eight points, many of which coincide, lie in a line or in a plane.
pub(crate) fn random(bytes: &[u8]) {
    let mut source = Unstructured::new(bytes);
    let scale = [1.0, 1e-6, 1e-3, 1e4, 1e6][usize::from(any::<u8>(&mut source)) % 5];
    let origin = [0.0, 1.0, -1e5][usize::from(any::<u8>(&mut source)) % 3];
    let points: [Vector; 8] = std::array::from_fn(|_| {
        Vector::from_fn(|_, _| {
            let step = any::<i8>(&mut source);
            let off = if any::<u8>(&mut source) < 40 { any::<u16>(&mut source) } else { 0 };
            (origin + scale * (f64::from(step >> 4) + f64::from(off) * 1e-12)).clamp(-1e6, 1e6)
        })
    });
    let [a, b, c, d, e, f, g, h] = &points;
    let pairs = [distance::point_triangle(a, b, c, d), distance::edge_edge(a, b, c, d)];
    for (number, closest) in pairs.iter().enumerate() {
        let apart = closest.distance();
        assert!(apart.is_finite() && apart >= 0.0, "{number}: {apart} of {points:?}");
        let corners = [(a, b), (a, c), (a, d), (b, c), (b, d)].map(|(p, q)| (p - q).norm());
        let of_first = if number == 0 { &corners[..3] } else { &corners[1..] };
        let least = of_first.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(
            apart <= least * (1.0 + 1e-6) + 1e-9 * scale,
            "{number}: {apart} > {least}: {points:?}"
        );
    }
    for gap in [0.0, 1e-6 * scale, 0.5 * scale] {
        for impact in [
            point_triangle_impact([a, b, c, d], [e, f, g, h], gap),
            edge_edge_impact([a, b, c, d], [e, f, g, h], gap),
        ] {
            assert!(
                impact.is_none_or(|time| (0.0..=1.0).contains(&time)),
                "{impact:?}: {points:?}"
            );
        }
    }
    // Turning edge and triangle about does not change what is exact.
    let crosses = edge_crosses_triangle([a, b], [c, d, e]);
    assert_eq!(crosses, edge_crosses_triangle([b, a], [d, e, c]), "{points:?}");
    let _ = edge_meets_triangle([a, b], [c, d, e]);
    let _ = is_inside(a, [[*b, *c, *d], [*e, *f, *g]].into_iter());
}
