//! A sieve for candidates: most pairs of features whose boxes meet stay apart, and a rough look shows it.
//!
//! Along any direction o, features A and B are apart by
//!
//! ```text
//! gap = (min_A o·x - max_B o·x) / |o|                                  (m)
//! ```
//!
//! at the least. Along no direction does that change by more than the largest difference M of the steps of their points. A
//! pair with a gap of M more than what is around both comes no nearer than that. Any direction proves it; the one between
//! the closest points proves most. It is computed in f32, many pairs at a time: what is around points makes up for
//! rounding.
//!
//! Source: the directions are those of Ericson 2005, section 5.1.

use boucle_geometry::Way;
use pulp::{Arch, Simd, WithSimd};

use super::candidate::Candidate;

/// Pairs that are looked at together.
const COUNT: usize = 32;

/// The same number of all pairs.
type Row = [f32; COUNT];

/// A vector, or a point (m).
type Three = [f32; 3];

/// Pairs side by side.
struct Pairs {
    places: [[Row; 3]; 4],
    steps: [[Row; 3]; 4],
    /// What is around both features (m).
    around: Row,
}

impl Pairs {
    #[inline(always)]
    fn set(&mut self, lane: usize, ways: [&Way; 4]) {
        for (point, way) in ways.into_iter().enumerate() {
            for axis in 0..3 {
                self.places[point][axis][lane] = way.start[axis];
                self.steps[point][axis][lane] = way.end[axis] - way.start[axis];
            }
        }
        self.around[lane] = ways[0].around + ways[3].around;
    }

    /// By how much (m) each pair stays apart along its direction at the least, beyond what is around both.
    #[inline(always)]
    fn slack(&self, split: usize, direction: impl Fn([Three; 4]) -> Three) -> Row {
        let mut slack = [0.0; COUNT];
        for (lane, slack) in slack.iter_mut().enumerate() {
            let pick = |rows: &[[Row; 3]; 4], point: usize| -> Three {
                [rows[point][0][lane], rows[point][1][lane], rows[point][2][lane]]
            };
            let places = [0, 1, 2, 3].map(|point| pick(&self.places, point));
            let along = direction(places);
            let (mut near, mut far) = (f32::INFINITY, f32::NEG_INFINITY);
            let mut change = 0.0;
            for first in 0..split {
                near = least(near, dot(along, minus(places[first], places[0])));
                let step = pick(&self.steps, first);
                for second in split..4 {
                    let apart = minus(step, pick(&self.steps, second));
                    change = most(change, dot(apart, apart));
                }
            }
            for place in &places[split..] {
                far = most(far, dot(along, minus(*place, places[0])));
            }
            let needed = self.around[lane] + change.sqrt();
            *slack = near - far - needed * dot(along, along).sqrt();
        }
        slack
    }
}

/// What sifts.
pub(super) struct Sieve<'a, C, D, V> {
    ways: &'a [Way],
    candidates: C,
    direction: D,
    visit: V,
}

impl<C, D, V> Sieve<'_, C, D, V>
where
    C: Iterator<Item = Candidate>,
    D: Fn([Three; 4]) -> Three,
    V: FnMut(Candidate),
{
    /// Shows the candidates that may come as near on their ways as what is around both, by a direction for each.
    pub(super) fn sift(ways: &[Way], candidates: C, direction: D, visit: V) {
        Arch::new().dispatch(Sieve { ways, candidates, direction, visit });
    }
}

impl<C, D, V> WithSimd for Sieve<'_, C, D, V>
where
    C: Iterator<Item = Candidate>,
    D: Fn([Three; 4]) -> Three,
    V: FnMut(Candidate),
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        let zero = [[[0.0; COUNT]; 3]; 4];
        let mut pairs = Pairs { places: zero, steps: zero, around: [0.0; COUNT] };
        let mut shown = [Candidate::NONE; COUNT];
        loop {
            let mut count = 0;
            for candidate in self.candidates.by_ref().take(COUNT) {
                pairs.set(count, candidate.points.map(|point| &self.ways[point as usize]));
                shown[count] = candidate;
                count += 1;
            }
            if count == 0 {
                break;
            }
            let slack = pairs.slack(shown[0].split(), &self.direction);
            for (candidate, slack) in shown[..count].iter().zip(slack) {
                // What is no number does not prove anything.
                if !(slack > 0.0) {
                    (self.visit)(*candidate);
                }
            }
        }
    }
}

/// From the closest point of a triangle to a point, nearly.
#[inline(always)]
pub(super) fn point_triangle([p, a, b, c]: [Three; 4]) -> Three {
    let (ab, ac, bc) = (minus(b, a), minus(c, a), minus(c, b));
    let (ap, bp) = (minus(p, a), minus(p, b));
    let (ab_ab, ab_ac, ac_ac) = (dot(ab, ab), dot(ab, ac), dot(ac, ac));
    let (ap_ab, ap_ac) = (dot(ap, ab), dot(ap, ac));
    let inverse = 1.0 / (ab_ab * ac_ac - ab_ac * ab_ac);
    let v = (ac_ac * ap_ab - ab_ac * ap_ac) * inverse;
    let w = (ab_ab * ap_ac - ab_ac * ap_ab) * inverse;
    let mut nearest = ahead(ap, -part(ap_ab / ab_ab), ab);
    let mut square = dot(nearest, nearest);
    for border in
        [ahead(ap, -part(ap_ac / ac_ac), ac), ahead(bp, -part(dot(bp, bc) / dot(bc, bc)), bc)]
    {
        let border_square = dot(border, border);
        nearest = choose(border_square < square, border, nearest);
        square = least(border_square, square);
    }
    let within = ahead(ahead(ap, -v, ab), -w, ac);
    choose((v >= 0.0) & (w >= 0.0) & (v + w <= 1.0), within, nearest)
}

/// From the closest point of one edge to that of another, nearly.
#[inline(always)]
pub(super) fn edge_edge([a, b, c, d]: [Three; 4]) -> Three {
    let (ab, cd, ca) = (minus(b, a), minus(d, c), minus(a, c));
    let (ab_ab, ab_cd, cd_cd) = (dot(ab, ab), dot(ab, cd), dot(cd, cd));
    let (ca_ab, ca_cd) = (dot(ca, ab), dot(ca, cd));
    let s = part((ab_cd * ca_cd - ca_ab * cd_cd) / (ab_ab * cd_cd - ab_cd * ab_cd));
    let t = part((ab_cd * s + ca_cd) / cd_cd);
    let s = part((ab_cd * t - ca_ab) / ab_ab);
    ahead(ahead(ca, s, ab), -t, cd)
}

#[inline(always)]
fn minus(a: Three, b: Three) -> Three {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot(a: Three, b: Three) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `from + way along`.
#[inline(always)]
fn ahead(from: Three, way: f32, along: Three) -> Three {
    [from[0] + way * along[0], from[1] + way * along[1], from[2] + way * along[2]]
}

#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// A number between 0 and 1; 0 for what is no number.
#[inline(always)]
fn part(x: f32) -> f32 {
    least(most(x, 0.0), 1.0)
}

#[inline(always)]
fn choose(is_first: bool, first: Three, second: Three) -> Three {
    let pick = |axis: usize| if is_first { first[axis] } else { second[axis] };
    [pick(0), pick(1), pick(2)]
}
