//! What pairs of particles at the same distance in memory make of a vector: both ends load side by side.

use std::ops::Range;

use pulp::{Scalar, Simd};

use super::Field;

/// What joins two particles, by N numbers a pair.
pub(crate) trait Link<const N: usize> {
    /// Of pairs side by side, for the difference d of their near ends less their far ends: what the near ends get, and what
    /// the far ends give.
    fn pull<S: Simd>(simd: S, numbers: [S::f32s; N], d: [S::f32s; 3]) -> [[S::f32s; 3]; 2];
}

/// Pairs of particles in a row with those `offset` further on, their numbers, and a vector for each particle.
#[derive(Clone, Copy)]
pub(crate) struct Row<'a, const N: usize> {
    /// The first near end.
    pub(crate) first: usize,
    pub(crate) offset: usize,
    pub(crate) numbers: [&'a [f32]; N],
    pub(crate) p: &'a Field,
}

/// Which of the ends.
const NEAR: usize = 0;
const FAR: usize = 1;

impl<const N: usize> Row<'_, N> {
    /// Adds what the pairs make of p to those of their ends that are in a range of particles; or subtracts it.
    #[inline(always)]
    pub(crate) fn add<S: Simd, L: Link<N>, const SUBTRACT: bool>(
        &self,
        simd: S,
        own: &Range<usize>,
        mut out: [&mut [f32]; 3],
    ) {
        let Self { first, offset, .. } = *self;
        let end = first + self.numbers[0].len();
        let begin_in = |from: usize, to: usize| first.max(from)..end.min(to);
        let last_inside = own.end.saturating_sub(offset);
        let entering = begin_in(own.start.saturating_sub(offset), own.start.min(last_inside));
        let (inside, leaving) = if offset < S::F32_LANES {
            (0..0, begin_in(own.start, own.end))
        } else {
            let middle = last_inside.max(own.start);
            (begin_in(own.start, middle), begin_in(middle, own.end))
        };
        // Vectors of both ends would overlap: each end of these pairs has its own turn.
        let near = if offset < S::F32_LANES { begin_in(own.start, last_inside) } else { 0..0 };
        self.add_one_end::<S, L, SUBTRACT, FAR>(simd, entering, own.start, &mut out);
        self.add_one_end::<S, L, SUBTRACT, FAR>(simd, near, own.start, &mut out);
        self.add_one_end::<S, L, SUBTRACT, NEAR>(simd, leaving, own.start, &mut out);
        self.add_both_ends::<S, L, SUBTRACT>(simd, inside, own.start, &mut out);
    }

    /// Of pairs by their near ends, one end.
    #[inline(always)]
    fn add_one_end<S: Simd, L: Link<N>, const SUBTRACT: bool, const END: usize>(
        &self,
        simd: S,
        pairs: Range<usize>,
        start: usize,
        [x, y, z]: &mut [&mut [f32]; 3],
    ) {
        if pairs.is_empty() {
            return;
        }
        let Self { first, offset, .. } = *self;
        let [to_own, to_other] = if END == FAR { [offset, 0] } else { [0, offset] };
        let place = pairs.start + to_own - start..pairs.end + to_own - start;
        add_to_one_end::<S, L, N, SUBTRACT, END>(
            simd,
            self.of(pairs.start - first..pairs.end - first),
            of(self.p, pairs.start + to_own..pairs.end + to_own),
            of(self.p, pairs.start + to_other..pairs.end + to_other),
            [&mut x[place.clone()], &mut y[place.clone()], &mut z[place]],
        );
    }

    /// Of pairs by their near ends, both ends, which must be at least the width of a vector apart.
    #[inline(always)]
    fn add_both_ends<S: Simd, L: Link<N>, const SUBTRACT: bool>(
        &self,
        simd: S,
        pairs: Range<usize>,
        start: usize,
        [x, y, z]: &mut [&mut [f32]; 3],
    ) {
        if pairs.is_empty() {
            return;
        }
        let Self { first, offset, .. } = *self;
        let places = pairs.start - start..pairs.end + offset - start;
        add_to_both_ends::<S, L, N, SUBTRACT>(
            simd,
            self.of(pairs.start - first..pairs.end - first),
            [of(self.p, pairs.clone()), of(self.p, pairs.start + offset..pairs.end + offset)],
            [&mut x[places.clone()], &mut y[places.clone()], &mut z[places]],
            offset,
        );
    }

    #[inline(always)]
    fn of(&self, pairs: Range<usize>) -> [&[f32]; N] {
        self.numbers.map(
            #[inline(always)]
            |numbers| &numbers[pairs.clone()],
        )
    }
}

#[inline(always)]
fn of(p: &Field, particles: Range<usize>) -> [&[f32]; 3] {
    p.0.each_ref().map(|axis| &axis[particles.clone()])
}

#[inline(always)]
pub(crate) fn difference<S: Simd>(simd: S, a: [S::f32s; 3], b: [S::f32s; 3]) -> [S::f32s; 3] {
    [0, 1, 2].map(
        #[inline(always)]
        |axis| simd.sub_f32s(a[axis], b[axis]),
    )
}

#[inline(always)]
fn add_or_subtract<S: Simd, const SUBTRACT: bool>(simd: S, to: &mut S::f32s, value: S::f32s) {
    *to = if SUBTRACT { simd.sub_f32s(*to, value) } else { simd.add_f32s(*to, value) };
}

/// What pairs side by side add to one of their ends.
#[inline(always)]
fn add_to_one_end<S: Simd, L: Link<N>, const N: usize, const SUBTRACT: bool, const END: usize>(
    simd: S,
    numbers: [&[f32]; N],
    own: [&[f32]; 3],
    other: [&[f32]; 3],
    out: [&mut [f32]; 3],
) {
    let whole = own[0].len() / S::F32_LANES * S::F32_LANES;
    let (numbers, numbers_rest) = split(numbers, whole);
    let (own, own_rest) = split(own, whole);
    let (other, other_rest) = split(other, whole);
    let (out, out_rest) = split_mut(out, whole);
    one_end_whole::<S, L, N, SUBTRACT, END>(simd, numbers, own, other, out);
    let scalar = Scalar::new();
    one_end_whole::<Scalar, L, N, SUBTRACT, END>(
        scalar,
        numbers_rest,
        own_rest,
        other_rest,
        out_rest,
    );
}

#[inline(always)]
fn one_end_whole<S: Simd, L: Link<N>, const N: usize, const SUBTRACT: bool, const END: usize>(
    simd: S,
    numbers: [&[f32]; N],
    own: [&[f32]; 3],
    other: [&[f32]; 3],
    out: [&mut [f32]; 3],
) {
    let numbers = Vectors::<S, N>::new(numbers);
    let [own, other] = [own, other].map(Vectors::<S, 3>::new);
    let [x, y, z] = out.map(|axis| S::as_mut_simd_f32s(axis).0);
    let count = x.len();
    let (y, z) = (&mut y[..count], &mut z[..count]);
    let (numbers, own, other) = (numbers.first(count), own.first(count), other.first(count));
    for i in 0..count {
        let d = difference(simd, own.at(i), other.at(i));
        let [fx, fy, fz] = L::pull(simd, numbers.at(i), d)[END];
        add_or_subtract::<S, SUBTRACT>(simd, &mut x[i], fx);
        add_or_subtract::<S, SUBTRACT>(simd, &mut y[i], fy);
        add_or_subtract::<S, SUBTRACT>(simd, &mut z[i], fz);
    }
}

/// What pairs side by side add to their near ends and take from their far ends, `offset` places further on.
#[inline(always)]
fn add_to_both_ends<S: Simd, L: Link<N>, const N: usize, const SUBTRACT: bool>(
    simd: S,
    numbers: [&[f32]; N],
    p: [[&[f32]; 3]; 2],
    [x, y, z]: [&mut [f32]; 3],
    offset: usize,
) {
    let out = [&mut *x, &mut *y, &mut *z];
    let whole = both_ends_whole::<S, L, N, SUBTRACT>(simd, numbers, p, out, offset);
    let numbers = numbers.map(
        #[inline(always)]
        |axis| &axis[whole..],
    );
    let [near, far] = p;
    let p = [split(near, whole).1, split(far, whole).1];
    let out = [&mut x[whole..], &mut y[whole..], &mut z[whole..]];
    both_ends_whole::<Scalar, L, N, SUBTRACT>(Scalar::new(), numbers, p, out, offset);
}

/// The same for those that fill vectors, and how many those are.
#[inline(always)]
fn both_ends_whole<S: Simd, L: Link<N>, const N: usize, const SUBTRACT: bool>(
    simd: S,
    numbers: [&[f32]; N],
    p: [[&[f32]; 3]; 2],
    [x, y, z]: [&mut [f32]; 3],
    offset: usize,
) -> usize {
    let count = numbers[0].len() / S::F32_LANES;
    let numbers = Vectors::<S, N>::new(numbers).first(count);
    let [near, far] = p.map(
        #[inline(always)]
        |axes| Vectors::<S, 3>::new(axes).first(count),
    );
    for i in 0..count {
        let d = difference(simd, near.at(i), far.at(i));
        let [gets, gives] = L::pull(simd, numbers.at(i), d);
        for (axis, (gets, gives)) in
            [&mut *x, &mut *y, &mut *z].into_iter().zip(gets.into_iter().zip(gives))
        {
            let own = vector_mut::<S>(axis, i * S::F32_LANES);
            *own = if SUBTRACT { simd.sub_f32s(*own, gets) } else { simd.add_f32s(*own, gets) };
            let other = vector_mut::<S>(axis, i * S::F32_LANES + offset);
            *other =
                if SUBTRACT { simd.add_f32s(*other, gives) } else { simd.sub_f32s(*other, gives) };
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
