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

use std::ops::{Add, Div, Mul, Sub};

use boucle_geometry::Way;
use pulp::{Arch, Simd, WithSimd};

use super::bodies::Bodies;
use super::candidate::{Candidate, Kind};
use super::easing::{Easing, OF_REST_AT_MOST};
use crate::kernel::lane_operators;

/// Pairs that are looked at together: whole vectors of every instruction set.
const COUNT: usize = 32;

/// The same number of all pairs.
type Row = [f32; COUNT];

/// Pairs side by side: where their points start, how far they go, and what is around both features (m).
struct Pairs {
    places: [[Row; 3]; 4],
    steps: [[Row; 3]; 4],
    around: Row,
    /// Where they are at rest, and what is around them at the least, if they lay near each other there.
    rests: [[Row; 3]; 4],
    least: Row,
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
        self.least[lane] = self.around[lane];
    }

    #[inline(always)]
    fn ease(&mut self, lane: usize, (places, by): ([&[f32; 3]; 4], f32)) {
        for (point, place) in places.into_iter().enumerate() {
            for (rests, place) in self.rests[point].iter_mut().zip(place) {
                rests[lane] = *place;
            }
        }
        self.least[lane] -= by;
    }

    /// What is around both features of some of the pairs, or less if they lay near each other at rest.
    #[inline(always)]
    fn needed<S: Simd>(&self, simd: S, kind: Kind, is_eased: bool, vector: usize) -> Lanes<S> {
        let around = lanes(simd, &self.around, vector);
        if !is_eased {
            return around;
        }
        let [a, b, c, d] = rows(simd, &self.rests, vector);
        let square = match kind {
            Kind::PointTriangle => (a - b).square().min((a - c).square()).min((a - d).square()),
            Kind::EdgeEdge => {
                let of_a = (a - c).square().min((a - d).square());
                of_a.min((b - c).square()).min((b - d).square())
            }
        };
        let eased = square.sqrt() * Lanes::all(simd, OF_REST_AT_MOST);
        around.min(eased).max(lanes(simd, &self.least, vector))
    }

    /// By how much (m) some of the pairs stay apart along their directions at the least, beyond what is around both.
    #[inline(always)]
    fn spare<S: Simd>(&self, simd: S, kind: Kind, is_eased: bool, vector: usize) -> Lanes<S> {
        let x = rows(simd, &self.places, vector);
        let steps = rows(simd, &self.steps, vector);
        let direction = match kind {
            Kind::PointTriangle => point_triangle(simd, x),
            Kind::EdgeEdge => edge_edge(x),
        };
        // Places are taken from the first point, which loses least.
        let [b, c, d] = [x[1] - x[0], x[2] - x[0], x[3] - x[0]];
        let zero = Lanes::all(simd, 0.0);
        let [b, c, d] = [direction.dot(b), direction.dot(c), direction.dot(d)];
        let change = most_change(steps[0], [steps[2], steps[3]]);
        let (gap, change) = match kind {
            Kind::PointTriangle => {
                (zero - b.max(c).max(d), change.max((steps[0] - steps[1]).square()))
            }
            Kind::EdgeEdge => {
                (zero.min(b) - c.max(d), change.max(most_change(steps[1], [steps[2], steps[3]])))
            }
        };
        let needed = self.needed(simd, kind, is_eased, vector) + change.sqrt();
        gap - needed * direction.square().sqrt()
    }
}

/// The largest square by which a step differs from others.
#[inline(always)]
fn most_change<S: Simd>(step: Three<S>, [one, other]: [Three<S>; 2]) -> Lanes<S> {
    (step - one).square().max((step - other).square())
}

#[inline(always)]
fn lanes<S: Simd>(simd: S, row: &Row, vector: usize) -> Lanes<S> {
    Lanes { simd, values: S::as_simd_f32s(row).0[vector] }
}

#[inline(always)]
fn rows<S: Simd>(simd: S, [a, b, c, d]: &[[Row; 3]; 4], vector: usize) -> [Three<S>; 4] {
    [three(simd, a, vector), three(simd, b, vector), three(simd, c, vector), three(simd, d, vector)]
}

#[inline(always)]
fn three<S: Simd>(simd: S, [x, y, z]: &[Row; 3], vector: usize) -> Three<S> {
    Three([lanes(simd, x, vector), lanes(simd, y, vector), lanes(simd, z, vector)])
}

/// What sifts.
#[derive(Clone, Copy)]
pub(super) struct Sieve<'a> {
    pub(super) bodies: &'a Bodies,
    pub(super) ways: &'a [Way],
    /// Whether, and how much, less is enough for pairs that lay near each other at rest.
    pub(super) easing: Option<&'a Easing>,
}

impl Sieve<'_> {
    /// Shows the candidates, of one kind, that may come as near on their ways as what is around both features.
    pub(super) fn sift(
        self,
        candidates: impl Iterator<Item = Candidate>,
        visit: impl FnMut(Candidate),
    ) {
        Arch::new().dispatch(Sifting { sieve: self, candidates, visit });
    }
}

struct Sifting<'a, C, V> {
    sieve: Sieve<'a>,
    candidates: C,
    visit: V,
}

impl<C: Iterator<Item = Candidate>, V: FnMut(Candidate)> WithSimd for Sifting<'_, C, V> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let Sieve { bodies, ways, easing } = self.sieve;
        let zero = [[[0.0; COUNT]; 3]; 4];
        let none = [0.0; COUNT];
        let mut pairs = Pairs { places: zero, steps: zero, around: none, rests: zero, least: none };
        let mut shown = [Candidate::NONE; COUNT];
        let mut spare = [0.0; COUNT];
        loop {
            let mut count = 0;
            while count < COUNT
                && let Some(candidate) = self.candidates.next()
            {
                let [a, b, c, d] = candidate.points;
                let way = |point: u32| &ways[point as usize];
                pairs.set(count, [way(a), way(b), way(c), way(d)]);
                if let Some(eased) =
                    easing.and_then(|easing| easing.between(bodies, candidate.points))
                {
                    pairs.ease(count, eased);
                }
                shown[count] = candidate;
                count += 1;
            }
            let kind = shown[0].kind;
            for vector in 0..count.div_ceil(S::F32_LANES) {
                let spare = &mut S::as_mut_simd_f32s(&mut spare).0[vector];
                *spare = pairs.spare(simd, kind, easing.is_some(), vector).values;
            }
            for (candidate, spare) in shown[..count].iter().zip(spare) {
                // What is no number does not prove anything.
                if !(spare > 0.0) {
                    (self.visit)(*candidate);
                }
            }
            if count < COUNT {
                break;
            }
        }
    }
}

/// From the closest point of a triangle to a point, nearly.
#[inline(always)]
fn point_triangle<S: Simd>(simd: S, [p, a, b, c]: [Three<S>; 4]) -> Three<S> {
    let (ab, ac, bc, ap, bp) = (b - a, c - a, c - b, p - a, p - b);
    let (ab_ab, ab_ac, ac_ac) = (ab.square(), ab.dot(ac), ac.square());
    let (ap_ab, ap_ac) = (ap.dot(ab), ap.dot(ac));
    let on_ab = ap - ab * (ap_ab / ab_ab).part();
    let on_ac = ap - ac * (ap_ac / ac_ac).part();
    let on_bc = bp - bc * (bp.dot(bc) / bc.square()).part();
    let nearest = on_ac.where_positive(on_ab.square() - on_ac.square(), on_ab);
    let nearest = on_bc.where_positive(nearest.square() - on_bc.square(), nearest);
    let whole = ab_ab * ac_ac - ab_ac * ab_ac;
    let v = ac_ac * ap_ab - ab_ac * ap_ac;
    let w = ab_ab * ap_ac - ab_ac * ap_ab;
    let least = v.min(w).min(whole - v - w);
    let one = Lanes::all(simd, 1.0);
    let within = ap - ab * (v * (one / whole)) - ac * (w * (one / whole));
    within.where_positive(least, nearest)
}

/// From the closest point of one edge to that of another, nearly.
#[inline(always)]
fn edge_edge<S: Simd>([a, b, c, d]: [Three<S>; 4]) -> Three<S> {
    let (ab, cd, ca) = (b - a, d - c, a - c);
    let (ab_ab, ab_cd, cd_cd) = (ab.square(), ab.dot(cd), cd.square());
    let (ca_ab, ca_cd) = (ca.dot(ab), ca.dot(cd));
    let s = ((ab_cd * ca_cd - ca_ab * cd_cd) / (ab_ab * cd_cd - ab_cd * ab_cd)).part();
    let t = ((ab_cd * s + ca_cd) / cd_cd).part();
    let s = ((ab_cd * t - ca_ab) / ab_ab).part();
    ca + ab * s - cd * t
}

/// Numbers of as many pairs as a processor computes at a time.
#[derive(Clone, Copy)]
struct Lanes<S: Simd> {
    simd: S,
    values: S::f32s,
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    fn all(simd: S, value: f32) -> Self {
        Self { simd, values: simd.splat_f32s(value) }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self { values: self.simd.min_f32s(self.values, other.values), ..self }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self { values: self.simd.max_f32s(self.values, other.values), ..self }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self { values: self.simd.sqrt_f32s(self.values), ..self }
    }

    /// Not below 0, nor above 1.
    #[inline(always)]
    fn part(self) -> Self {
        self.max(Self::all(self.simd, 0.0)).min(Self::all(self.simd, 1.0))
    }
}

/// Vectors of as many pairs.
#[derive(Clone, Copy)]
struct Three<S: Simd>([Lanes<S>; 3]);

impl<S: Simd> Three<S> {
    #[inline(always)]
    fn dot(self, other: Self) -> Lanes<S> {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        x * a + y * b + z * c
    }

    #[inline(always)]
    fn square(self) -> Lanes<S> {
        self.dot(self)
    }

    /// This where a sign is positive, the other elsewhere.
    #[inline(always)]
    fn where_positive(self, sign: Lanes<S>, other: Self) -> Self {
        let simd = sign.simd;
        let is_positive = simd.less_than_f32s(simd.splat_f32s(0.0), sign.values);
        let mut chosen = other;
        for (chosen, own) in chosen.0.iter_mut().zip(self.0) {
            chosen.values = simd.select_f32s(is_positive, own.values, chosen.values);
        }
        chosen
    }
}

lane_operators! {
    Add: add, add_f32s;
    Sub: sub, sub_f32s;
    Mul: mul, mul_f32s;
    Div: div, div_f32s;
}

impl<S: Simd> Add for Three<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        Self([x + a, y + b, z + c])
    }
}

impl<S: Simd> Sub for Three<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        Self([x - a, y - b, z - c])
    }
}

impl<S: Simd> Mul<Lanes<S>> for Three<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, number: Lanes<S>) -> Self {
        let [x, y, z] = self.0;
        Self([x * number, y * number, z * number])
    }
}
