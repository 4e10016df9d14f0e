//! The lee of colliders: what lies behind them in a wind.
//!
//! All rays against a wind are parallel, so colliders throw their shadows on one plane across it. A point is sheltered if it is in
//! the shadow of a triangle, a sphere or a capsule and farther along the wind than that. Triangles are sorted into the squares of a
//! grid on the plane. The lee has no end, and a plane throws none: wind that comes out of it or along it has no other side to
//! come from.
//!
//! Source: Wilson et al. 2014 shelter cloth and hair in the same way, by rays against the wind.

use boucle_geometry::Vector;
use boucle_geometry::distance::edge_edge;

use crate::collider::{Collider, Shape};
use crate::grouped::Grouped;

/// Squares of the grid at the most.
const MOST_SQUARES: f64 = 65_536.0;

/// A triangle on the plane: its corners there, and how far along the wind they are (m).
type Shadow = [Vector; 3];

/// What keeps the wind off.
#[derive(Debug)]
pub(super) struct Shelter {
    /// Two directions across the wind, and its own.
    axes: [Vector; 3],
    shadows: Vec<Shadow>,
    /// Ends (m) of what is round, and its radius (m).
    round: Vec<([Vector; 2], f64)>,
    grid: Grid,
    /// The smallest way (m) along the wind of all that is round.
    first: f64,
}

#[derive(Debug, Default)]
struct Grid {
    low: [f64; 2],
    /// Length (m) of a square's side.
    side: f64,
    counts: [usize; 2],
    shadows: Grouped<u32>,
}

impl Shelter {
    /// The lee of colliders whose points are there (m) in a wind (m/s); none without wind.
    pub(super) fn new(colliders: &[Collider], points: &[Vector], wind: &Vector) -> Option<Self> {
        let along = wind.try_normalize(1e-9)?;
        let least = along.iamin();
        let across = Vector::ith(least, 1.0).cross(&along).normalize();
        let axes = [across, along.cross(&across), along];
        let (mut shadows, mut round, mut base) = (Vec::new(), Vec::new(), 0);
        for collider in colliders {
            let own = &points[base..base + collider.positions.len()];
            base += own.len();
            match &collider.shape {
                Shape::Plane => {}
                Shape::Sphere { radius } => round.push(([own[0], own[0]], *radius)),
                Shape::Capsule { radius } => round.push(([own[0], own[1]], *radius)),
                Shape::Mesh(mesh) => shadows.extend(mesh.triangles().map(|corners| {
                    corners.map(|corner| {
                        Vector::from_fn(|axis, _| own[corner as usize].dot(&axes[axis]))
                    })
                })),
            }
        }
        let mut first = f64::INFINITY;
        for (ends, radius) in &round {
            first = ends.iter().map(|end| end.dot(&along) - radius).fold(first, f64::min);
        }
        let grid = Grid::new(&shadows);
        Some(Self { axes, shadows, round, grid, first })
    }

    /// Whether a point (m) lies behind something.
    pub(super) fn covers(&self, point: &Vector) -> bool {
        let place = Vector::from_fn(|axis, _| point.dot(&self.axes[axis]));
        let own = self.grid.square(&place).map_or(&[][..], |square| self.grid.shadows.of(square));
        if own.iter().any(|&shadow| is_behind(&place, &self.shadows[shadow as usize])) {
            return true;
        }
        let way = place.z - self.first;
        if way <= 0.0 {
            return false;
        }
        let far = point - way * self.axes[2];
        self.round.iter().any(|([a, b], radius)| edge_edge(point, &far, a, b).distance() < *radius)
    }
}

impl Grid {
    fn new(shadows: &[Shadow]) -> Self {
        if shadows.is_empty() {
            return Self::default();
        }
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in shadows.iter().flatten() {
            for axis in 0..2 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        let spans = [0, 1].map(|axis| (high[axis] - low[axis]).max(1e-9));
        let squares = (shadows.len() as f64).clamp(1.0, MOST_SQUARES);
        let side = (spans[0] * spans[1] / squares).sqrt().max(spans[0].max(spans[1]) / 1024.0);
        let counts = spans.map(|span| (span / side) as usize + 1);
        let mut grid = Self { low, side, counts, shadows: Grouped::default() };
        let mut pairs = Vec::new();
        for (number, shadow) in shadows.iter().enumerate() {
            let ends = |axis: usize| {
                let corners = shadow.iter().map(|corner| corner[axis]);
                let (least, most) = corners
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
                grid.row(axis, least)..=grid.row(axis, most)
            };
            for row in ends(1) {
                pairs.extend(
                    ends(0).map(|column| ((row * counts[0] + column) as u32, number as u32)),
                );
            }
        }
        grid.shadows = Grouped::new(counts[0] * counts[1], pairs.into_iter());
        grid
    }

    fn row(&self, axis: usize, x: f64) -> usize {
        (((x - self.low[axis]) / self.side).max(0.0) as usize).min(self.counts[axis] - 1)
    }

    /// The square that a place is in, if it is in any.
    fn square(&self, place: &Vector) -> Option<usize> {
        let rows = [0, 1].map(|axis| (place[axis] - self.low[axis]) / self.side);
        let is_inside = |axis: usize| rows[axis] >= 0.0 && rows[axis] <= self.counts[axis] as f64;
        if self.counts[0] == 0 || !is_inside(0) || !is_inside(1) {
            return None;
        }
        Some(self.row(1, place[1]) * self.counts[0] + self.row(0, place[0]))
    }
}

/// Whether a place is in a triangle's shadow and farther along the wind.
fn is_behind(place: &Vector, [a, b, c]: &Shadow) -> bool {
    let turn =
        |p: &Vector, q: &Vector| (q.x - p.x) * (place.y - p.y) - (q.y - p.y) * (place.x - p.x);
    let parts = [turn(b, c), turn(c, a), turn(a, b)];
    let whole: f64 = parts.iter().sum();
    if whole == 0.0 || parts.iter().any(|part| part * whole < 0.0) {
        return false;
    }
    (parts[0] * a.z + parts[1] * b.z + parts[2] * c.z) / whole < place.z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scatter::scattered;

    fn collider(shape: Shape, positions: Vec<Vector>) -> Collider {
        Collider { name: "c".to_owned(), shape, positions, thickness: 0.0, friction: 0.0 }
    }

    fn places() -> impl Iterator<Item = Vector> {
        (0..4000_u64).map(|i| Vector::from_fn(|axis, _| 3.0 * scattered(3 * i + axis as u64)))
    }

    /// A box turned against the wind, seen by stepping back against it in small steps.
    #[test]
    fn a_box_keeps_the_wind_off_what_lies_behind_it() {
        let corners = |i: u32| Vector::from_fn(|axis, _| f64::from(i >> axis & 1) - 0.5);
        let points: Vec<Vector> = (0..8).map(corners).collect();
        let crate_box = [collider(Shape::cuboid(), points.clone())];
        let wind = Vector::new(1.0, 2.0, -0.7);
        let shelter = Shelter::new(&crate_box, &points, &wind).expect("a wind");
        let step = 1e-3 * wind.normalize();
        let mut covered = 0;
        for place in places() {
            let near = |most: f64| (0..6000).any(|i| (place - f64::from(i) * step).amax() < most);
            let covers = shelter.covers(&place);
            assert!(covers || !near(0.499), "{place:?}");
            assert!(!covers || near(0.501), "{place:?}");
            covered += usize::from(covers);
        }
        assert!(covered > 100, "{covered}");
    }

    #[test]
    fn spheres_and_capsules_keep_the_wind_off_and_planes_do_not() {
        let ends = [Vector::new(0.0, 0.0, -1.0), Vector::new(0.0, 0.0, 1.0)];
        let things = [
            collider(Shape::Plane, ends.to_vec()),
            collider(Shape::Sphere { radius: 0.5 }, vec![Vector::x() * 2.0]),
            collider(Shape::Capsule { radius: 0.2 }, ends.to_vec()),
        ];
        let points: Vec<Vector> =
            things.iter().flat_map(|thing| thing.positions.iter().copied()).collect();
        let shelter = Shelter::new(&things, &points, &(Vector::y() * 3.0)).expect("a wind");
        for (place, is_covered) in [
            ([2.0, 1.0, 0.0], true),
            ([2.0, -1.0, 0.0], false),
            ([2.49, 50.0, 0.0], true),
            ([2.51, 50.0, 0.0], false),
            ([0.19, 2.0, 0.9], true),
            ([0.0, 2.0, 1.19], true),
            ([0.0, 2.0, 1.21], false),
            ([0.21, 2.0, 0.0], false),
            ([0.0, -2.0, 0.0], false),
            ([1.0, 5.0, -3.0], false),
        ] {
            assert_eq!(shelter.covers(&place.into()), is_covered, "{place:?}");
        }
        assert!(Shelter::new(&things, &points, &Vector::zeros()).is_none());
    }
}
