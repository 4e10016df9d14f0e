//! Runs and gathers, block by block.

use super::layout::{Gather, Layout, Run};
use super::{CHUNK, WIDTH};
use crate::law::spring::{
    AxiallyDamped, AxiallyDampedStiffening, Block, Damping, Lanes, RelativelyDamped,
    RelativelyDampedStiffening, Terms, Undamped, UndampedStiffening, Vectors,
};
use crate::state::{Coordinates, State};

/// The forces (N) on the particles of one chunk, an array an axis.
pub(crate) type ChunkVectors = [[f64; CHUNK]; 3];

/// Calls a function with the terms of a law as its type parameter.
macro_rules! with_terms {
    ($law:expr, $function:ident($($argument:expr),*)) => {
        match ($law.damping, $law.stiffen_beyond.is_finite()) {
            (Damping::None, false) => $function::<Undamped>($($argument),*),
            (Damping::Relative, false) => $function::<RelativelyDamped>($($argument),*),
            (Damping::Axial, false) => $function::<AxiallyDamped>($($argument),*),
            (Damping::None, true) => $function::<UndampedStiffening>($($argument),*),
            (Damping::Relative, true) => $function::<RelativelyDampedStiffening>($($argument),*),
            (Damping::Axial, true) => $function::<AxiallyDampedStiffening>($($argument),*),
        }
    };
}

/// Fills `force` with the spring forces on the particles of a chunk.
///
/// Inlined into its caller, to be compiled for the instruction set that the caller found.
#[inline(always)]
pub(crate) fn spring_forces(
    layout: &Layout,
    chunk: usize,
    state: &State,
    force: &mut ChunkVectors,
) {
    let (runs, gathers) = layout.chunks[chunk].clone();
    for run in &layout.runs[runs] {
        with_terms!(run.law, add_run(layout, run, chunk * CHUNK, state, force));
    }
    for gather in &layout.gathers[gathers] {
        with_terms!(gather.law, add_gather(layout, gather, chunk * CHUNK, state, force));
    }
}

#[inline(always)]
fn add_run<T: Terms>(
    layout: &Layout,
    run: &Run,
    first: usize,
    state: &State,
    force: &mut ChunkVectors,
) {
    let last_block = run.particles.end - WIDTH;
    let mut start = run.particles.start;
    loop {
        // The last block overlaps the one before it: it computes the same bits again.
        let particle = start.min(last_block);
        let total = run_block::<T>(layout, run, particle, state);
        for axis in 0..3 {
            force[axis][particle - first..particle - first + WIDTH].copy_from_slice(&total[axis].0);
        }
        start += WIDTH;
        if start >= run.particles.end {
            break;
        }
    }
}

#[inline(always)]
fn run_block<T: Terms>(
    layout: &Layout,
    run: &Run,
    particle: usize,
    state: &State,
) -> Vectors<WIDTH> {
    let mut total = [Lanes::ZERO; 3];
    let position = load(&state.position, particle);
    let velocity = load_velocity::<T>(state, particle);
    for slot in &layout.run_slots[run.slots.clone()] {
        let neighbor = (particle as isize + slot.offset) as usize;
        let rest = slot.rest_lengths + (particle - run.particles.start);
        Block {
            span: difference(&position, &load(&state.position, neighbor)),
            relative_velocity: difference(&velocity, &load_velocity::<T>(state, neighbor)),
            rest_length: lanes_at(&layout.rest_lengths, rest),
            stiffness: Lanes::splat(slot.stiffness),
            damping: Lanes::splat(slot.damping),
            stiffen_beyond: run.law.stiffen_beyond,
        }
        .add_force::<T>(&mut total);
    }
    total
}

#[inline(always)]
fn add_gather<T: Terms>(
    layout: &Layout,
    gather: &Gather,
    first: usize,
    state: &State,
    force: &mut ChunkVectors,
) {
    let mut total = [Lanes::ZERO; 3];
    let position = collect(&state.position, &gather.particles);
    let velocity = collect_velocity::<T>(state, &gather.particles);
    for slot in &layout.gather_slots[gather.slots.clone()] {
        Block {
            span: difference(&position, &collect(&state.position, &slot.neighbors)),
            relative_velocity: difference(
                &velocity,
                &collect_velocity::<T>(state, &slot.neighbors),
            ),
            rest_length: Lanes(slot.rest_lengths),
            stiffness: Lanes(slot.stiffness),
            damping: Lanes(slot.damping),
            stiffen_beyond: gather.law.stiffen_beyond,
        }
        .add_force::<T>(&mut total);
    }
    for axis in 0..3 {
        for lane in 0..WIDTH {
            force[axis][gather.particles[lane] as usize - first] = total[axis].0[lane];
        }
    }
}

#[inline(always)]
fn lanes_at(values: &[f64], start: usize) -> Lanes<WIDTH> {
    let values = &values[start..start + WIDTH];
    Lanes(std::array::from_fn(|lane| values[lane]))
}

#[inline(always)]
fn load(coordinates: &Coordinates, particle: usize) -> Vectors<WIDTH> {
    std::array::from_fn(|axis| lanes_at(&coordinates.0[axis], particle))
}

#[inline(always)]
fn load_velocity<T: Terms>(state: &State, particle: usize) -> Vectors<WIDTH> {
    if T::DAMPING == Damping::None {
        return [Lanes::ZERO; 3];
    }
    load(&state.velocity, particle)
}

#[inline(always)]
fn collect(coordinates: &Coordinates, particles: &[u32; WIDTH]) -> Vectors<WIDTH> {
    std::array::from_fn(|axis| Lanes(particles.map(|particle| coordinates.0[axis][particle as usize])))
}

#[inline(always)]
fn collect_velocity<T: Terms>(state: &State, particles: &[u32; WIDTH]) -> Vectors<WIDTH> {
    if T::DAMPING == Damping::None {
        return [Lanes::ZERO; 3];
    }
    collect(&state.velocity, particles)
}

#[inline(always)]
fn difference(a: &Vectors<WIDTH>, b: &Vectors<WIDTH>) -> Vectors<WIDTH> {
    std::array::from_fn(|axis| a[axis] - b[axis])
}
