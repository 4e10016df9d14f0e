//! The file from which a stopped bake goes on.
//!
//! ```text
//! "BOUCLECP"  u32 version  u128 digest of the scene  i32 frame  f64 seconds so far
//! u64 length, report rows (JSON, one a line)  u64 length, the simulation's own checkpoint
//! u64 XXH3-64 of everything before
//! ```
//! Little-endian. It is replaced whole, and only after the caches and the report hold its frame: it is never ahead.

use std::fs;
use std::path::Path;

use xxhash_rust::xxh3::xxh3_64;

use crate::atomic::{self, Durability};
use crate::error::{Error, Result};

/// Its name in the bake's folder.
pub const FILE_NAME: &str = "boucle.checkpoint";

const MAGIC: &[u8; 8] = b"BOUCLECP";
const VERSION: u32 = 2;

/// A bake as it stood after a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// Of the scene, its meshes and the frames kept: another one is refused.
    pub digest: u128,
    /// The frame.
    pub frame: i32,
    /// Wall-clock time (s) so far.
    pub seconds: f64,
    /// The report's rows, JSON each.
    pub rows: Vec<String>,
    /// The simulation's own checkpoint.
    pub simulation: Vec<u8>,
}

impl Checkpoint {
    /// Replaces the checkpoint on disk.
    ///
    /// # Errors
    /// [`Error::Cache`] when it cannot be written; the old one is then still there.
    pub fn write(&self, path: &Path) -> Result<()> {
        atomic::replace(path, &self.bytes(), Durability::Power)
    }

    /// Reads the checkpoint of a scene; `None` if there is none.
    ///
    /// # Errors
    /// [`Error::Input`] when it is damaged or of another scene, [`Error::Cache`] when it cannot be read.
    pub fn read(path: &Path, digest: u128) -> Result<Option<Self>> {
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(Error::cache(path, "read", &error)),
        };
        let refuse = |reason: &str| {
            let accepted = "accepted: the checkpoint of this scene, or a bake without --resume";
            Error::input(format!("{}: the checkpoint {reason}; {accepted}", path.display()))
        };
        let checkpoint = Self::parse(&bytes).map_err(refuse)?;
        if checkpoint.digest != digest {
            return Err(refuse("is of another scene, other settings or another version"));
        }
        Ok(Some(checkpoint))
    }

    fn bytes(&self) -> Vec<u8> {
        let rows = self.rows.join("\n");
        let mut bytes = Vec::with_capacity(rows.len() + self.simulation.len() + 100);
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(self.digest.to_le_bytes());
        bytes.extend(self.frame.to_le_bytes());
        bytes.extend(self.seconds.to_le_bytes());
        for part in [rows.as_bytes(), &self.simulation] {
            bytes.extend((part.len() as u64).to_le_bytes());
            bytes.extend(part);
        }
        bytes.extend(xxh3_64(&bytes).to_le_bytes());
        bytes
    }

    fn parse(bytes: &[u8]) -> std::result::Result<Self, &'static str> {
        const DAMAGED: &str = "is damaged";
        // Whatever stands behind it is the other version's own.
        let mut rest = bytes.strip_prefix(MAGIC).ok_or(DAMAGED)?;
        if u32::from_le_bytes(take(&mut rest).ok_or(DAMAGED)?) != VERSION {
            return Err("is of another version");
        }
        let (body, sum) = rest.split_last_chunk::<8>().ok_or(DAMAGED)?;
        if xxh3_64(&bytes[..bytes.len() - sum.len()]) != u64::from_le_bytes(*sum) {
            return Err(DAMAGED);
        }
        let mut rest = body;
        let digest = u128::from_le_bytes(take(&mut rest).ok_or(DAMAGED)?);
        let frame = i32::from_le_bytes(take(&mut rest).ok_or(DAMAGED)?);
        let seconds = f64::from_le_bytes(take(&mut rest).ok_or(DAMAGED)?);
        let rows = std::str::from_utf8(part(&mut rest).ok_or(DAMAGED)?).map_err(|_| DAMAGED)?;
        let rows = rows.lines().map(str::to_owned).collect();
        let simulation = part(&mut rest).ok_or(DAMAGED)?.to_vec();
        Ok(Self { digest, frame, seconds, rows, simulation })
    }
}

/// The next bytes of a fixed size.
fn take<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
    let (head, tail) = rest.split_first_chunk::<N>()?;
    *rest = tail;
    Some(*head)
}

/// The next part: its length, then its bytes.
fn part<'a>(rest: &mut &'a [u8]) -> Option<&'a [u8]> {
    let length = usize::try_from(u64::from_le_bytes(take(rest)?)).ok()?;
    let (head, tail) = rest.split_at_checked(length)?;
    *rest = tail;
    Some(head)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checkpoint(rows: usize) -> Checkpoint {
        Checkpoint {
            digest: 7,
            frame: -2,
            seconds: 0.1,
            rows: vec!["{\"frame\":1}".to_owned(); rows],
            simulation: vec![1, 2, 3],
        }
    }

    #[test]
    fn a_checkpoint_reads_back_as_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(FILE_NAME);
        assert_eq!(Checkpoint::read(&path, 7), Ok(None));
        for rows in [0, 1, 3] {
            checkpoint(rows).write(&path).expect("there is room");
            assert_eq!(Checkpoint::read(&path, 7), Ok(Some(checkpoint(rows))));
        }
    }

    #[test]
    fn the_checkpoint_of_another_scene_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(FILE_NAME);
        checkpoint(1).write(&path).expect("there is room");
        let error = Checkpoint::read(&path, 8).expect_err("another digest");
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("another scene"), "{error}");
    }

    #[test]
    fn a_checkpoint_of_another_version_is_told_as_such() {
        for version in [0, VERSION - 1, VERSION + 1, u32::MAX] {
            let mut bytes = checkpoint(2).bytes();
            bytes[8..12].copy_from_slice(&version.to_le_bytes());
            bytes.truncate(60);
            assert_eq!(Checkpoint::parse(&bytes), Err("is of another version"));
        }
    }

    #[test]
    fn a_checkpoint_with_any_byte_changed_or_missing_is_refused() {
        let bytes = checkpoint(2).bytes();
        for index in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[index] ^= 0x10;
            assert!(Checkpoint::parse(&changed).is_err(), "byte {index} changed");
            assert!(Checkpoint::parse(&bytes[..index]).is_err(), "cut at {index}");
        }
    }
}
