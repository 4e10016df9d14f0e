//! Triangles side by side: their forces, and the part of the tangent along each of their sides.

use pulp::Simd;

use super::hinge::{Point, cross, plus, scaled};
use super::membrane::{Frame, MembraneLaw, Triangle, flows, positive_part};
use super::packs::{LANES, Places};
use crate::kernel::{Lanes, vectors, vectors_mut};
use crate::law::number::Number;
use crate::state::{Coordinates, State};

/// Numbers of the part of a tangent that lies between two corners: xx, yx, yy, zx, zy, zz of the symmetric part, and the
/// vector of the other.
pub(super) const SIDE: usize = 9;

/// An array for each axis of a vector at each triangle.
type Vectors = [[f64; LANES]; 3];

/// Triangles of one law.
#[derive(Clone, Debug)]
pub(super) struct TrianglePack {
    /// The number of the first triangle.
    pub(super) first: usize,
    pub(super) count: usize,
    pub(super) law: u32,
    corners: [Places; 3],
    /// Gradients (1/m) of the second and third corner along the warp, then along the weft.
    gradients: [[f64; LANES]; 4],
    /// m², 0 of those that lack.
    area: [f64; LANES],
    /// For each side, -1 where it leads to a particle of a smaller number.
    directions: [[f64; LANES]; 3],
}

impl TrianglePack {
    /// Of triangles of one law, numbered from `first`.
    fn new(first: usize, triangles: &[Triangle]) -> Self {
        let count = triangles.len();
        let of = |lane: usize| &triangles[lane.min(count - 1)];
        let each = |number: fn(&Triangle) -> f64| std::array::from_fn(|lane| number(of(lane)));
        Self {
            first,
            count,
            law: triangles[0].law,
            corners: [0, 1, 2].map(|i| Places::new(count, |lane| of(lane).corners[i])),
            gradients: [
                each(|one| one.gradients[0][1]),
                each(|one| one.gradients[0][2]),
                each(|one| one.gradients[1][1]),
                each(|one| one.gradients[1][2]),
            ],
            area: std::array::from_fn(|lane| if lane < count { of(lane).area } else { 0.0 }),
            directions: [0, 1, 2].map(|side| {
                std::array::from_fn(|lane| {
                    let corners = of(lane).corners;
                    if corners[side] < corners[(side + 1) % 3] { 1.0 } else { -1.0 }
                })
            }),
        }
    }

    /// The triangles in packs.
    pub(super) fn all(triangles: &[Triangle]) -> Vec<Self> {
        let mut packs = Vec::with_capacity(triangles.len() / LANES + 1);
        let mut first = 0;
        for alike in triangles.chunk_by(|a, b| a.law == b.law) {
            for own in alike.chunks(LANES) {
                packs.push(Self::new(first, own));
                first += own.len();
            }
        }
        packs
    }

    /// The edges from the first corner to the second and third of a vector at each particle, in f64.
    #[inline(always)]
    fn spans(&self, of: &Coordinates) -> [Vectors; 2] {
        let [a, b, c] = self.corners.each_ref().map(
            #[inline(always)]
            |corner| {
                of.0.each_ref().map(
                    #[inline(always)]
                    |axis| corner.load(axis),
                )
            },
        );
        let mut spans = [b, c];
        for span in &mut spans {
            for axis in 0..3 {
                for lane in 0..LANES {
                    span[axis][lane] -= a[axis][lane];
                }
            }
        }
        spans
    }

    /// U and V of some lanes.
    #[inline(always)]
    fn frame<S: Simd>(&self, simd: S, [b, c]: &[Vectors; 2], i: usize) -> Frame<Lanes<S>> {
        let (b, c) = (vector(simd, b, i), vector(simd, c, i));
        let [bw, cw, bf, cf] = self.gradients.each_ref().map(
            #[inline(always)]
            |lanes| number(simd, lanes, i),
        );
        [plus(scaled(bw, b), scaled(cw, c)), plus(scaled(bf, b), scaled(cf, c))]
    }

    /// Adds the forces (N) of the triangles to those of the particles that are numbered from `first`.
    #[inline(always)]
    pub(super) fn add_forces<S: Simd>(
        &self,
        simd: S,
        law: &MembraneLaw,
        state: &State,
        first: usize,
        out: [&mut [f64]; 3],
    ) {
        let spans = self.spans(&state.position);
        let rates = law.is_damped().then(
            #[inline(always)]
            || self.spans(&state.velocity),
        );
        let mut forces = [[[0.0; LANES]; 3]; 3];
        for i in 0..LANES / S::F64_LANES {
            let strained = law.strained(self.frame(simd, &spans, i));
            let stress = match &rates {
                None => strained.stress,
                Some(rates) => law.damped(&strained, self.frame(simd, rates, i)),
            };
            let area = number(simd, &self.area, i);
            let stress = [area * stress[0], area * stress[1], area * stress[2]];
            let [along_warp, along_weft] = flows(stress, strained.frame);
            let [bw, cw, bf, cf] = self.gradients.each_ref().map(
                #[inline(always)]
                |lanes| number(simd, lanes, i),
            );
            let at_b = plus(scaled(bw, along_warp), scaled(bf, along_weft));
            let at_c = plus(scaled(cw, along_warp), scaled(cf, along_weft));
            let zero = area.all(0.0);
            for axis in 0..3 {
                let all = [at_b[axis] + at_c[axis], zero - at_b[axis], zero - at_c[axis]];
                for (corner, force) in forces.iter_mut().zip(all) {
                    vectors_mut::<S>(&mut corner[axis])[i] = force.values;
                }
            }
        }
        for (axis, out) in out.into_iter().enumerate() {
            for (corner, force) in self.corners.iter().zip(&forces) {
                corner.add(self.count, &force[axis], first, out);
            }
        }
    }

    /// The parts of the tangent along each triangle's three sides, for damping that multiplies stiffness of stretch and shear.
    #[inline(always)]
    pub(super) fn sides<S: Simd>(
        &self,
        simd: S,
        law: &MembraneLaw,
        positions: &Coordinates,
        [stretch, shear]: [f64; 2],
    ) -> [[[f64; LANES]; SIDE]; 3] {
        let spans = self.spans(positions);
        let mut sides = [[[0.0; LANES]; SIDE]; 3];
        for i in 0..LANES / S::F64_LANES {
            let strained = law.strained(self.frame(simd, &spans, i));
            let [u, v] = strained.frame;
            let area = number(simd, &self.area, i);
            let factor = area * area.all(stretch);
            let warp = factor * strained.stiffness[0];
            let weft = factor * strained.stiffness[1];
            let slide = area * area.all(shear * law.shear);
            let [ww, ff, wf] = positive_part(strained.stress);
            let pulls = [area * ww, area * ff, area * wf];
            let [bw, cw, bf, cf] = self.gradients.each_ref().map(
                #[inline(always)]
                |lanes| number(simd, lanes, i),
            );
            let zero = area.all(0.0);
            let corners = [[zero - (bw + cw), zero - (bf + cf)], [bw, bf], [cw, cf]];
            let normal = cross(u, v);
            for (side, out) in sides.iter_mut().enumerate() {
                let (from, to) = (corners[side], corners[(side + 1) % 3]);
                let direction = number(simd, &self.directions[side], i);
                let along = Along::new(from, to);
                let numbers = along.numbers([warp, weft, slide], pulls, [u, v]);
                let turn = direction * slide * along.turn;
                let turn = scaled(turn, normal);
                let all = [
                    numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5],
                    turn[0], turn[1], turn[2],
                ];
                for (out, value) in out.iter_mut().zip(all) {
                    vectors_mut::<S>(out)[i] = value.values;
                }
            }
        }
        sides
    }
}

/// What two corners' gradients make along the side between them, the sign such that what resists is positive.
struct Along<N> {
    ww: N,
    ff: N,
    /// Half the sum of both products.
    wf: N,
    /// Half their difference.
    turn: N,
}

impl<N: Number> Along<N> {
    #[inline(always)]
    fn new([iw, i_f]: [N; 2], [jw, jf]: [N; 2]) -> Self {
        let zero = iw.all(0.0);
        let half = iw.all(0.5);
        let (one, other) = (iw * jf, i_f * jw);
        Self {
            ww: zero - iw * jw,
            ff: zero - i_f * jf,
            wf: zero - half * (one + other),
            turn: half * (other - one),
        }
    }

    /// xx, yx, yy, zx, zy, zz.
    #[inline(always)]
    fn numbers(&self, [warp, weft, slide]: [N; 3], pulls: [N; 3], [u, v]: Frame<N>) -> [N; 6] {
        let of_u = warp * self.ww + slide * self.ff;
        let of_v = weft * self.ff + slide * self.ww;
        let of_both = slide * self.wf;
        let pull = pulls[0] * self.ww + pulls[1] * self.ff + pulls[2] * (self.wf + self.wf);
        // Rows of the block: of_u U Uᵀ + of_v V Vᵀ + of_both (U Vᵀ + V Uᵀ) + pull.
        let to_u = plus(scaled(of_u, u), scaled(of_both, v));
        let to_v = plus(scaled(of_v, v), scaled(of_both, u));
        let entry = |i: usize, j: usize| u[i] * to_u[j] + v[i] * to_v[j];
        [
            entry(0, 0) + pull,
            entry(1, 0),
            entry(1, 1) + pull,
            entry(2, 0),
            entry(2, 1),
            entry(2, 2) + pull,
        ]
    }
}

#[inline(always)]
fn number<S: Simd>(simd: S, lanes: &[f64; LANES], i: usize) -> Lanes<S> {
    Lanes::of(simd, vectors::<S>(lanes)[i])
}

#[inline(always)]
fn vector<S: Simd>(simd: S, lanes: &Vectors, i: usize) -> Point<Lanes<S>> {
    lanes.each_ref().map(
        #[inline(always)]
        |axis| number(simd, axis, i),
    )
}
