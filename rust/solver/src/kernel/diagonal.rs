//! Springs that join particles at the same distance in memory.

use std::ops::Range;

use pulp::{Scalar, Simd};

use super::BLOCK;
use super::lanes::{Lanes, difference, vectors, vectors_mut};
use super::layout::Diagonal;
use super::sums::{Axes, Sums};
use crate::law::spring::{Damping, Pull, Terms};
use crate::state::{Coordinates, State};

/// Adds the forces of a diagonal's springs that end in a chunk but begin before it.
#[inline(always)]
pub(super) fn add_from_before<S: Simd, T: Terms>(
    simd: S,
    diagonal: &Diagonal,
    chunk: &Range<usize>,
    state: &State,
    sums: &mut Sums,
) {
    let offset = diagonal.offset;
    let end = (chunk.end.max(offset) - offset).min(chunk.start);
    let springs = diagonal.within(chunk.start.max(offset) - offset..end);
    for start in springs.clone().step_by(BLOCK) {
        let springs = start..springs.end.min(start + BLOCK);
        let place = start + offset - chunk.start;
        let sums = sums.of_second_ends(place..place + springs.len());
        add::<S, T>(simd, diagonal, springs, state, sums);
    }
}

/// Adds the forces of a diagonal's springs that begin in a block of a chunk.
#[inline(always)]
pub(super) fn add_from_block<S: Simd, T: Terms>(
    simd: S,
    diagonal: &Diagonal,
    chunk: &Range<usize>,
    block: Range<usize>,
    state: &State,
    sums: &mut Sums,
) {
    let offset = diagonal.offset;
    let Range { start, end } = diagonal.within(block);
    let middle = (chunk.end.max(offset) - offset).clamp(start, end);
    let [from, through, to] = [start, middle, end].map(|first| first - chunk.start);
    if start < middle {
        let sums = sums.of(from..through, from + offset..through + offset);
        add::<S, T>(simd, diagonal, start..middle, state, sums);
    }
    if middle < end {
        add::<S, T>(simd, diagonal, middle..end, state, sums.of_first_ends(through..to));
    }
}

/// Adds the forces of the springs that begin at these particles: as many as fill vectors, then one by one.
#[inline(always)]
fn add<S: Simd, T: Terms>(
    simd: S,
    diagonal: &Diagonal,
    springs: Range<usize>,
    state: &State,
    sums: [Axes<'_>; 2],
) {
    let whole = springs.len() / S::F64_LANES * S::F64_LANES;
    let middle = springs.start + whole;
    let [[a, b, c], [d, e, f]] = sums;
    let ([a, a_rest], [b, b_rest], [c, c_rest]) =
        (halves(a, whole), halves(b, whole), halves(c, whole));
    let ([d, d_rest], [e, e_rest], [f, f_rest]) =
        (halves(d, whole), halves(e, whole), halves(f, whole));
    let rest = [[a_rest, b_rest, c_rest], [d_rest, e_rest, f_rest]];
    pull::<S, T>(simd, diagonal, springs.start..middle, state, [[a, b, c], [d, e, f]]);
    pull::<Scalar, T>(Scalar::new(), diagonal, middle..springs.end, state, rest);
}

#[inline(always)]
fn halves(slice: &mut [f64], middle: usize) -> [&mut [f64]; 2] {
    let (before, after) = slice.split_at_mut(middle);
    [before, after]
}

/// Adds the forces of a whole number of vectors of springs.
#[inline(always)]
fn pull<S: Simd, T: Terms>(
    simd: S,
    diagonal: &Diagonal,
    springs: Range<usize>,
    state: &State,
    sums: [Axes<'_>; 2],
) {
    let count = springs.len();
    let pull = Pull {
        rest_length: Lanes::splat(simd, 0.0),
        stiffness: Lanes::splat(simd, diagonal.stiffness),
        damping: Lanes::splat(simd, diagonal.damping),
        stiffen_beyond: Lanes::splat(simd, diagonal.law.stiffen_beyond),
    };
    let first = springs.start - diagonal.first;
    let rest_lengths = vectors::<S>(&diagonal.rest_lengths[first..first + count]);
    let [x, y, z] = cut::<S>(&state.position, springs.start, count);
    let [ox, oy, oz] = cut::<S>(&state.position, springs.start + diagonal.offset, count);
    let [u, v, w] = cut::<S>(&state.velocity, springs.start, count);
    let [ou, ov, ow] = cut::<S>(&state.velocity, springs.start + diagonal.offset, count);
    let [[lx, ly, lz], [ax, ay, az]] = sums;
    // All of one length, and the compiler knows it: no place is checked within the loop.
    let n = rest_lengths.len();
    let ([x, y, z], [ox, oy, oz]) = ([&x[..n], &y[..n], &z[..n]], [&ox[..n], &oy[..n], &oz[..n]]);
    let ([u, v, w], [ou, ov, ow]) = ([&u[..n], &v[..n], &w[..n]], [&ou[..n], &ov[..n], &ow[..n]]);
    let [lx, ly, lz] = [whole::<S>(lx, n), whole::<S>(ly, n), whole::<S>(lz, n)];
    let [ax, ay, az] = [whole::<S>(ax, n), whole::<S>(ay, n), whole::<S>(az, n)];
    for i in 0..n {
        let span = difference(simd, [x[i], y[i], z[i]], [ox[i], oy[i], oz[i]]);
        let velocity = if T::DAMPING == Damping::None {
            [pull.damping; 3]
        } else {
            difference(simd, [u[i], v[i], w[i]], [ou[i], ov[i], ow[i]])
        };
        let pull = Pull { rest_length: Lanes::of(simd, rest_lengths[i]), ..pull };
        let [fx, fy, fz] = pull.on_other::<T>(span, velocity);
        lx[i] = (Lanes::of(simd, lx[i]) + fx).values;
        ly[i] = (Lanes::of(simd, ly[i]) + fy).values;
        lz[i] = (Lanes::of(simd, lz[i]) + fz).values;
        ax[i] = (Lanes::of(simd, ax[i]) + fx).values;
        ay[i] = (Lanes::of(simd, ay[i]) + fy).values;
        az[i] = (Lanes::of(simd, az[i]) + fz).values;
    }
}

#[inline(always)]
fn cut<S: Simd>(coordinates: &Coordinates, start: usize, count: usize) -> [&[S::f64s]; 3] {
    let [x, y, z] = &coordinates.0;
    let part = start..start + count;
    [vectors::<S>(&x[part.clone()]), vectors::<S>(&y[part.clone()]), vectors::<S>(&z[part])]
}

#[inline(always)]
fn whole<S: Simd>(axis: &mut [f64], count: usize) -> &mut [S::f64s] {
    &mut vectors_mut::<S>(axis)[..count]
}
