//! Springs that join particles at the same distance in memory.

use std::ops::Range;

use pulp::{Scalar, Simd};

use super::CHUNK;
use super::lanes::{Lanes, difference, vectors, vectors_mut};
use super::layout::Diagonal;
use super::window::Window;
use crate::law::spring::{Damping, Pull, Terms};
use crate::state::{Coordinates, State};

/// Fills a window with the forces of a diagonal's springs that end among a chunk's own particles.
#[inline(always)]
pub(super) fn fill_window<S: Simd, T: Terms>(
    simd: S,
    diagonal: &Diagonal,
    own: &Range<usize>,
    state: &State,
    window: &mut Window<'_>,
) {
    let offset = diagonal.offset;
    let reach = offset.min(CHUNK);
    let lead = Window::lead(offset);
    // Springs that arrive from particles before the chunk: spring i's force goes to the window's place i + shift.
    let place = lead - reach..lead - reach + offset.min(own.len());
    fill::<S, T>(simd, diagonal, state, window, place, own.start as isize - offset as isize);
    fill::<S, T>(simd, diagonal, state, window, lead..lead + own.len(), own.start as isize);
}

/// Fills places of a window with the forces of the springs from the `first` on, and with 0 where there are none.
#[inline(always)]
fn fill<S: Simd, T: Terms>(
    simd: S,
    diagonal: &Diagonal,
    state: &State,
    window: &mut Window<'_>,
    places: Range<usize>,
    first: isize,
) {
    let place_of = |spring: usize| {
        let place = places.start as isize + (spring as isize - first);
        (place.max(places.start as isize) as usize).min(places.end)
    };
    let from = place_of(diagonal.first);
    let to = place_of(diagonal.first + diagonal.rest_lengths.len()).max(from);
    let [x, y, z] = window.axes.each_mut().map(|axis| {
        axis[places.start..from].fill(0.0);
        axis[to..places.end].fill(0.0);
        &mut axis[from..to]
    });
    if from == to {
        return;
    }
    let start = (first + (from - places.start) as isize) as usize;
    let whole = (to - from) / S::F64_LANES * S::F64_LANES;
    let ([x, x_rest], [y, y_rest], [z, z_rest]) =
        (halves(x, whole), halves(y, whole), halves(z, whole));
    pull::<S, T>(simd, diagonal, start, state, [x, y, z]);
    pull::<Scalar, T>(Scalar::new(), diagonal, start + whole, state, [x_rest, y_rest, z_rest]);
}

#[inline(always)]
fn halves(slice: &mut [f64], middle: usize) -> [&mut [f64]; 2] {
    let (before, after) = slice.split_at_mut(middle);
    [before, after]
}

/// The forces on the second ends of the springs from particle `start` on, a whole number of vectors.
#[inline(always)]
fn pull<S: Simd, T: Terms>(
    simd: S,
    diagonal: &Diagonal,
    start: usize,
    state: &State,
    out: [&mut [f64]; 3],
) {
    let count = out[0].len();
    let pull = Pull {
        rest_length: Lanes::splat(simd, 0.0),
        stiffness: Lanes::splat(simd, diagonal.stiffness),
        damping: Lanes::splat(simd, diagonal.damping),
        stiffen_beyond: Lanes::splat(simd, diagonal.law.stiffen_beyond),
    };
    let first = start - diagonal.first;
    let rest_lengths = vectors::<S>(&diagonal.rest_lengths[first..first + count]);
    let [x, y, z] = cut::<S>(&state.position, start, count);
    let [ox, oy, oz] = cut::<S>(&state.position, start + diagonal.offset, count);
    let [u, v, w] = cut::<S>(&state.velocity, start, count);
    let [ou, ov, ow] = cut::<S>(&state.velocity, start + diagonal.offset, count);
    let [fx, fy, fz] = out.map(|axis| vectors_mut::<S>(&mut axis[..count]));
    for i in 0..fx.len() {
        let span = difference(simd, [x[i], y[i], z[i]], [ox[i], oy[i], oz[i]]);
        let velocity = if T::DAMPING == Damping::None {
            [pull.damping; 3]
        } else {
            difference(simd, [u[i], v[i], w[i]], [ou[i], ov[i], ow[i]])
        };
        let pull = Pull { rest_length: Lanes::of(simd, rest_lengths[i]), ..pull };
        [fx[i], fy[i], fz[i]] = pull.on_other::<T>(span, velocity).map(|force| force.values);
    }
}

#[inline(always)]
fn cut<S: Simd>(coordinates: &Coordinates, start: usize, count: usize) -> [&[S::f64s]; 3] {
    coordinates.0.each_ref().map(|axis| vectors::<S>(&axis[start..start + count]))
}
