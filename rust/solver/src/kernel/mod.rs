//! The spring kernel: the force on every particle, gathered from its neighbours.
//!
//! Every particle sums its own springs in a fixed order, so no two threads ever share a sum and the bits do not
//! depend on their number. Particles in a row whose springs lead to the same relative neighbours (the inside of a
//! grid) form a *run*: their neighbours lie side by side in memory too and load as vectors. The others are
//! *gathered* one index at a time.

mod evaluate;
mod layout;

pub(crate) use evaluate::{ChunkVectors, spring_forces};
pub(crate) use layout::Layout;

/// Particles that one task handles: small enough for its forces to stay in the nearest cache.
pub(crate) const CHUNK: usize = 256;

/// Particles computed side by side.
pub(crate) const WIDTH: usize = 4;
