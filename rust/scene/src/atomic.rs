//! Files that are either the old ones or the new ones, whole, whatever happens in between.

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

use crate::error::{Error, Result};

/// Whether a file must outlive a power cut, or only the end of the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Durability {
    /// Outlives the process.
    Process,
    /// Outlives the machine's power; costs some milliseconds.
    Power,
}

/// Replaces a file by writing a temporary one beside it and renaming that.
///
/// # Errors
/// [`Error::Cache`]; the old file is then still there, and the temporary one is not.
pub(crate) fn replace(path: &Path, bytes: &[u8], durability: Durability) -> Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    let part = path.with_file_name(name);
    write_through(&part, path, bytes, durability).map_err(|error| {
        // The refusal below matters more than a temporary file that cannot be removed either.
        drop(fs::remove_file(&part));
        Error::cache(path, "written", &error)
    })
}

fn write_through(
    part: &Path,
    path: &Path,
    bytes: &[u8],
    durability: Durability,
) -> std::io::Result<()> {
    let mut file = File::create(part)?;
    file.write_all(bytes)?;
    if durability == Durability::Power {
        file.sync_all()?;
    }
    drop(file);
    fs::rename(part, path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_cannot_be_replaced_stays_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("report.json");
        replace(&path, b"old", Durability::Power).expect("there is room");
        replace(&path, b"new", Durability::Process).expect("there is room");
        assert_eq!(fs::read(&path).expect("it is there"), b"new");
        let blocked = folder.path().join("blocked");
        fs::create_dir_all(blocked.join("full")).expect("a folder in the way");
        let error = replace(&blocked, b"new", Durability::Process).expect_err("a folder");
        assert_eq!(error.exit_code(), 4);
        assert!(error.to_string().contains("blocked"), "{error}");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 2);
    }
}
