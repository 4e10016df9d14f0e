//! What springs on one diagonal make of a vector at each particle.

use std::ops::Range;

use pulp::{Scalar, Simd};

use super::Tangents;
use crate::kernel::Diagonal;
use crate::linear::Field;

/// A diagonal, its tangents, and a vector for each particle.
pub(super) struct Springs<'a> {
    pub(super) diagonal: &'a Diagonal,
    pub(super) tangents: &'a Tangents,
    pub(super) p: &'a Field,
}

impl Springs<'_> {
    /// Adds what the springs make of p to those of their ends that are in a range of particles; or subtracts it.
    #[inline(always)]
    pub(super) fn add<S: Simd, const SUBTRACT: bool>(
        &self,
        simd: S,
        own: &Range<usize>,
        mut out: [&mut [f32]; 3],
    ) {
        let Diagonal { first, offset, .. } = *self.diagonal;
        let end = first + self.diagonal.rest_lengths.len();
        let begin_in = |from: usize, to: usize| first.max(from)..end.min(to);
        let last_inside = own.end.saturating_sub(offset);
        let entering = begin_in(own.start.saturating_sub(offset), own.start.min(last_inside));
        let (inside, leaving) = if offset < S::F32_LANES {
            (0..0, begin_in(own.start, own.end))
        } else {
            let middle = last_inside.max(own.start);
            (begin_in(own.start, middle), begin_in(middle, own.end))
        };
        // Vectors of both ends would overlap: each end of these springs has its own turn.
        let near = if offset < S::F32_LANES { begin_in(own.start, last_inside) } else { 0..0 };
        self.add_one_end::<S, SUBTRACT>(simd, entering, [offset, 0], own.start, &mut out);
        self.add_one_end::<S, SUBTRACT>(simd, near, [offset, 0], own.start, &mut out);
        self.add_one_end::<S, SUBTRACT>(simd, leaving, [0, offset], own.start, &mut out);
        self.add_both_ends::<S, SUBTRACT>(simd, inside, own.start, &mut out);
    }

    /// Of springs by the particles that they begin at, one end, that many particles further on than the beginning.
    #[inline(always)]
    fn add_one_end<S: Simd, const SUBTRACT: bool>(
        &self,
        simd: S,
        springs: Range<usize>,
        [to_own, to_other]: [usize; 2],
        start: usize,
        [x, y, z]: &mut [&mut [f32]; 3],
    ) {
        if springs.is_empty() {
            return;
        }
        let Diagonal { first, .. } = *self.diagonal;
        let place = springs.start + to_own - start..springs.end + to_own - start;
        add_to_one_end::<S, SUBTRACT>(
            simd,
            self.tangents.of(springs.start - first..springs.end - first),
            of(self.p, springs.start + to_own..springs.end + to_own),
            of(self.p, springs.start + to_other..springs.end + to_other),
            [&mut x[place.clone()], &mut y[place.clone()], &mut z[place]],
        );
    }

    /// Of springs by the particles that they begin at, both ends, which must be at least the width of a vector apart.
    #[inline(always)]
    fn add_both_ends<S: Simd, const SUBTRACT: bool>(
        &self,
        simd: S,
        springs: Range<usize>,
        start: usize,
        [x, y, z]: &mut [&mut [f32]; 3],
    ) {
        if springs.is_empty() {
            return;
        }
        let Diagonal { first, offset, .. } = *self.diagonal;
        let places = springs.start - start..springs.end + offset - start;
        add_to_both_ends::<S, SUBTRACT>(
            simd,
            self.tangents.of(springs.start - first..springs.end - first),
            [of(self.p, springs.clone()), of(self.p, springs.start + offset..springs.end + offset)],
            [&mut x[places.clone()], &mut y[places.clone()], &mut z[places]],
            offset,
        );
    }
}

#[inline(always)]
fn of(p: &Field, particles: Range<usize>) -> [&[f32]; 3] {
    p.0.each_ref().map(|axis| &axis[particles.clone()])
}

/// `alpha n (n·d) + beta d` of springs side by side, `d = own - other`.
#[inline(always)]
fn pull<S: Simd>(
    simd: S,
    [nx, ny, nz, beta]: [S::f32s; 4],
    own: [S::f32s; 3],
    other: [S::f32s; 3],
) -> [S::f32s; 3] {
    let [dx, dy, dz] = [0, 1, 2].map(
        #[inline(always)]
        |axis| simd.sub_f32s(own[axis], other[axis]),
    );
    let along = simd.add_f32s(
        simd.add_f32s(simd.mul_f32s(nx, dx), simd.mul_f32s(ny, dy)),
        simd.mul_f32s(nz, dz),
    );
    [(nx, dx), (ny, dy), (nz, dz)].map(
        #[inline(always)]
        |(n, d)| simd.add_f32s(simd.mul_f32s(along, n), simd.mul_f32s(beta, d)),
    )
}

#[inline(always)]
fn add_or_subtract<S: Simd, const SUBTRACT: bool>(simd: S, to: &mut S::f32s, value: S::f32s) {
    *to = if SUBTRACT { simd.sub_f32s(*to, value) } else { simd.add_f32s(*to, value) };
}

/// What springs side by side add to one of their ends.
#[inline(always)]
fn add_to_one_end<S: Simd, const SUBTRACT: bool>(
    simd: S,
    tangents: [&[f32]; 4],
    own: [&[f32]; 3],
    other: [&[f32]; 3],
    out: [&mut [f32]; 3],
) {
    let whole = own[0].len() / S::F32_LANES * S::F32_LANES;
    let (tangents, tangents_rest) = split(tangents, whole);
    let (own, own_rest) = split(own, whole);
    let (other, other_rest) = split(other, whole);
    let (out, out_rest) = split_mut(out, whole);
    one_end_whole::<S, SUBTRACT>(simd, tangents, own, other, out);
    let scalar = Scalar::new();
    one_end_whole::<Scalar, SUBTRACT>(scalar, tangents_rest, own_rest, other_rest, out_rest);
}

#[inline(always)]
fn one_end_whole<S: Simd, const SUBTRACT: bool>(
    simd: S,
    tangents: [&[f32]; 4],
    own: [&[f32]; 3],
    other: [&[f32]; 3],
    out: [&mut [f32]; 3],
) {
    let tangents = Vectors::<S, 4>::new(tangents);
    let [own, other] = [own, other].map(Vectors::<S, 3>::new);
    let [x, y, z] = out.map(|axis| S::as_mut_simd_f32s(axis).0);
    let count = x.len();
    let (y, z) = (&mut y[..count], &mut z[..count]);
    let (tangents, own, other) = (tangents.first(count), own.first(count), other.first(count));
    for i in 0..count {
        let [fx, fy, fz] = pull(simd, tangents.at(i), own.at(i), other.at(i));
        add_or_subtract::<S, SUBTRACT>(simd, &mut x[i], fx);
        add_or_subtract::<S, SUBTRACT>(simd, &mut y[i], fy);
        add_or_subtract::<S, SUBTRACT>(simd, &mut z[i], fz);
    }
}

/// What springs side by side add to their near ends and take from their far ends, `offset` places further on.
#[inline(always)]
fn add_to_both_ends<S: Simd, const SUBTRACT: bool>(
    simd: S,
    tangents: [&[f32]; 4],
    p: [[&[f32]; 3]; 2],
    [x, y, z]: [&mut [f32]; 3],
    offset: usize,
) {
    let whole =
        both_ends_whole::<S, SUBTRACT>(simd, tangents, p, [&mut *x, &mut *y, &mut *z], offset);
    let tangents = tangents.map(
        #[inline(always)]
        |axis| &axis[whole..],
    );
    let [near, far] = p;
    let [near, far] = [split(near, whole).1, split(far, whole).1];
    let out = [&mut x[whole..], &mut y[whole..], &mut z[whole..]];
    both_ends_whole::<Scalar, SUBTRACT>(Scalar::new(), tangents, [near, far], out, offset);
}

/// The same for those that fill vectors, and how many those are.
#[inline(always)]
fn both_ends_whole<S: Simd, const SUBTRACT: bool>(
    simd: S,
    tangents: [&[f32]; 4],
    p: [[&[f32]; 3]; 2],
    [x, y, z]: [&mut [f32]; 3],
    offset: usize,
) -> usize {
    let count = tangents[0].len() / S::F32_LANES;
    let tangents = Vectors::<S, 4>::new(tangents).first(count);
    let [near, far] = p.map(
        #[inline(always)]
        |axes| Vectors::<S, 3>::new(axes).first(count),
    );
    for i in 0..count {
        let [fx, fy, fz] = pull(simd, tangents.at(i), near.at(i), far.at(i));
        for (axis, force) in [(&mut *x, fx), (&mut *y, fy), (&mut *z, fz)] {
            let own = vector_mut::<S>(axis, i * S::F32_LANES);
            *own = if SUBTRACT { simd.sub_f32s(*own, force) } else { simd.add_f32s(*own, force) };
            let other = vector_mut::<S>(axis, i * S::F32_LANES + offset);
            *other =
                if SUBTRACT { simd.add_f32s(*other, force) } else { simd.sub_f32s(*other, force) };
        }
    }
    count * S::F32_LANES
}

#[inline(always)]
fn vector_mut<S: Simd>(axis: &mut [f32], place: usize) -> &mut S::f32s {
    &mut S::as_mut_simd_f32s(&mut axis[place..place + S::F32_LANES]).0[0]
}

/// Arrays as vectors of one width.
#[derive(Clone, Copy)]
struct Vectors<'a, S: Simd, const N: usize>([&'a [S::f32s]; N]);

impl<'a, S: Simd, const N: usize> Vectors<'a, S, N> {
    #[inline(always)]
    fn new(arrays: [&'a [f32]; N]) -> Self {
        Self(arrays.map(
            #[inline(always)]
            |array| S::as_simd_f32s(array).0,
        ))
    }

    #[inline(always)]
    fn first(self, count: usize) -> Self {
        Self(self.0.map(
            #[inline(always)]
            |array| &array[..count],
        ))
    }

    #[inline(always)]
    fn at(&self, i: usize) -> [S::f32s; N] {
        self.0.map(
            #[inline(always)]
            |array| array[i],
        )
    }
}

#[inline(always)]
fn split<const N: usize>(slices: [&[f32]; N], at: usize) -> ([&[f32]; N], [&[f32]; N]) {
    (slices.map(|slice| &slice[..at]), slices.map(|slice| &slice[at..]))
}

#[inline(always)]
fn split_mut(slices: [&mut [f32]; 3], at: usize) -> ([&mut [f32]; 3], [&mut [f32]; 3]) {
    let [x, y, z] = slices;
    let ((x, x_rest), (y, y_rest), (z, z_rest)) =
        (x.split_at_mut(at), y.split_at_mut(at), z.split_at_mut(at));
    ([x, y, z], [x_rest, y_rest, z_rest])
}
