//! A simulation's state as bytes: versioned, checksummed, bound to what is simulated.
//!
//! ```text
//! "BOUCLECK" | version u32 | digest u64 | frame i32 | substeps u32 | particles u64
//! | positions and velocities, f64, axis by axis | pinned, a byte each | XXH3-64 of all before
//! ```
//!
//! All little-endian.

use xxhash_rust::xxh3::xxh3_64;

use crate::error::{Error, Result};
use crate::state::State;

const MAGIC: &[u8; 8] = b"BOUCLECK";
const VERSION: u32 = 1;
const HEADER: usize = 36;

/// What a checkpoint holds.
#[derive(Debug, PartialEq)]
pub(crate) struct Checkpoint {
    /// Hash of everything that does not change.
    pub(crate) digest: u64,
    pub(crate) frame: i32,
    pub(crate) substeps: u32,
    pub(crate) state: State,
    pub(crate) is_pinned: Vec<bool>,
}

impl Checkpoint {
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let count = self.state.len();
        let mut bytes = Vec::with_capacity(HEADER + 49 * count + 8);
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&self.digest.to_le_bytes());
        bytes.extend_from_slice(&self.frame.to_le_bytes());
        bytes.extend_from_slice(&self.substeps.to_le_bytes());
        bytes.extend_from_slice(&(count as u64).to_le_bytes());
        for axis in self.state.position.0.iter().chain(&self.state.velocity.0) {
            bytes.extend(axis.iter().flat_map(|value| value.to_le_bytes()));
        }
        bytes.extend(self.is_pinned.iter().map(|&is_pinned| u8::from(is_pinned)));
        let checksum = xxh3_64(&bytes);
        bytes.extend_from_slice(&checksum.to_le_bytes());
        bytes
    }

    pub(crate) fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let damaged = || Error::BadCheckpoint("is damaged; accepted: a whole one");
        let (body, checksum) = bytes.split_last_chunk::<8>().ok_or_else(damaged)?;
        if xxh3_64(body) != u64::from_le_bytes(*checksum) {
            return Err(damaged());
        }
        let mut reader = Reader(body);
        if reader.take::<8>() != Some(*MAGIC) {
            return Err(damaged());
        }
        if reader.take().map(u32::from_le_bytes) != Some(VERSION) {
            return Err(Error::BadCheckpoint("is of another version; accepted: version 1"));
        }
        Self::read_body(&mut reader).ok_or_else(damaged)
    }

    fn read_body(reader: &mut Reader<'_>) -> Option<Self> {
        let digest = u64::from_le_bytes(reader.take()?);
        let frame = i32::from_le_bytes(reader.take()?);
        let substeps = u32::from_le_bytes(reader.take()?);
        let count = usize::try_from(u64::from_le_bytes(reader.take()?)).ok()?;
        if reader.0.len() != count.checked_mul(49)? {
            return None;
        }
        let mut state = State::zeros(count);
        for axis in state.position.0.iter_mut().chain(&mut state.velocity.0) {
            for value in axis.iter_mut() {
                *value = f64::from_le_bytes(reader.take()?);
            }
        }
        let is_pinned = reader.0.iter().map(|&byte| byte != 0).collect();
        Some(Self { digest, frame, substeps, state, is_pinned })
    }
}

struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*taken)
    }
}

#[cfg(test)]
mod tests {
    use boucle_geometry::Vector;

    use super::*;

    fn checkpoint() -> Checkpoint {
        let state = State::at_rest(&[Vector::new(1.0, -0.0, 3.5), Vector::new(0.1, 1e-300, 7.0)]);
        Checkpoint { digest: 7, frame: -3, substeps: 9, state, is_pinned: vec![true, false] }
    }

    #[test]
    fn a_checkpoint_reads_back_as_it_was_written() {
        let bytes = checkpoint().to_bytes();
        assert_eq!(Checkpoint::from_bytes(&bytes), Ok(checkpoint()));
    }

    #[test]
    fn every_single_damaged_byte_is_noticed() {
        let good = checkpoint().to_bytes();
        for index in 0..good.len() {
            let mut bad = good.clone();
            bad[index] ^= 0x10;
            assert!(Checkpoint::from_bytes(&bad).is_err(), "byte {index}");
            assert!(Checkpoint::from_bytes(&good[..index]).is_err(), "cut at {index}");
        }
    }
}
