//! How large a scene may be, and the checks of numbers against their ranges.
//!
//! Every size is checked before anything is allocated for it.

use std::ops::RangeInclusive;
use std::path::Path;

use crate::error::{Error, Result};

/// Vertices of all cloths of a scene together.
pub const MAX_VERTICES: usize = 4_000_000;
/// Memory (bytes) that a vertex of springs takes, and one of fabric: sheets of 250² that collide, by BDF2, were seen to take so much.
const VERTEX_BYTES: [u64; 2] = [3000, 12_000];
/// Bytes of a scene file (64 MiB).
pub const MAX_SCENE_BYTES: u64 = 64 << 20;
/// Largest coordinate and size (m); beyond it a float32 cache resolves less than 6 cm.
pub const MAX_LENGTH: f64 = 1e6;
/// Largest frame number, as in Blender.
pub const MAX_FRAME: i32 = 1_048_574;
/// Largest component of gravity (m/s²).
pub const MAX_GRAVITY: f64 = 1e6;
/// Worker threads.
pub const MAX_THREADS: usize = 1024;

/// Refuses a number outside a range; NaN is outside every range.
pub(crate) fn within(
    key: &str,
    value: f64,
    range: &RangeInclusive<f64>,
    accepted: &str,
) -> Result<()> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(Error::refuse(key, format!("{value:?}"), accepted))
}

/// Refuses a number that is not above zero and at most `max`.
pub(crate) fn above_zero(key: &str, value: f64, max: f64, unit: &str) -> Result<()> {
    if value > 0.0 && value <= max {
        return Ok(());
    }
    Err(Error::refuse(key, format!("{value:?}"), &format!("above 0 to {max:e}{unit}")))
}

/// Refuses a vector with a component beyond `max` in size.
pub(crate) fn vector(key: &str, value: &[f64], max: f64, unit: &str) -> Result<()> {
    let accepted = format!("-{max:e} to {max:e}{unit}");
    for (axis, &component) in value.iter().enumerate() {
        within(&format!("{key}.{axis}"), component, &(-max..=max), &accepted)?;
    }
    Ok(())
}

/// Refuses a frame number that Blender would not take.
pub(crate) fn frame(key: &str, value: i32) -> Result<()> {
    if (-MAX_FRAME..=MAX_FRAME).contains(&value) {
        return Ok(());
    }
    Err(Error::refuse(key, value, &format!("-{MAX_FRAME} to {MAX_FRAME}")))
}

/// Refuses more vertices than a scene may have.
pub(crate) fn vertices(key: &str, count: u64) -> Result<()> {
    if count <= MAX_VERTICES as u64 {
        return Ok(());
    }
    Err(Error::input(format!("{key}: {count} vertices; accepted: at most {MAX_VERTICES} a scene")))
}

/// Refuses cloths of so many vertices of springs, and of fabric, that the system has no memory for, before any of it is taken.
///
/// # Errors
/// [`Error::Input`] with the memory that they need.
pub(crate) fn memory(vertices: [u64; 2]) -> Result<()> {
    let bytes: u64 = vertices.iter().zip(VERTEX_BYTES).map(|(count, each)| count * each).sum();
    let is_allowed =
        most_of_container(Path::new("/sys/fs/cgroup")).is_none_or(|most| bytes <= most);
    let asked = usize::try_from(bytes).ok().map(|bytes| Vec::<u8>::new().try_reserve_exact(bytes));
    if is_allowed && asked.is_some_and(|asked| asked.is_ok()) {
        return Ok(());
    }
    let count: u64 = vertices.iter().sum();
    let gigabytes = bytes as f64 / 1e9;
    Err(Error::input(format!(
        "the cloths together: {count} vertices need about {gigabytes:.1} GB of memory, which the \
         system does not give; accepted: fewer vertices, or a machine with more memory"
    )))
}

/// Memory (bytes) that the container in which we run may take, where control groups limit it: the system promises more than
/// that, and ends whoever takes it.
fn most_of_container(groups: &Path) -> Option<u64> {
    let files = ["memory.max", "memory/memory.limit_in_bytes"];
    let read = |file| std::fs::read_to_string(groups.join(file)).ok();
    files.into_iter().find_map(read)?.trim().parse().ok()
}

/// Refuses more worker threads than make sense.
///
/// # Errors
/// [`Error::Input`] above [`MAX_THREADS`].
pub fn threads(count: usize) -> Result<()> {
    if count <= MAX_THREADS {
        return Ok(());
    }
    Err(Error::refuse("threads", count, "1 to 1024, or 0 for every core"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_and_infinity_are_outside_every_range() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(within("key", value, &(f64::MIN..=f64::MAX), "a number").is_err());
            assert!(above_zero("key", value, f64::MAX, "").is_err());
            assert!(vector("key", &[0.0, value], 1.0, "").is_err());
        }
    }

    #[test]
    fn more_memory_than_there_is_is_refused_before_it_is_taken() {
        assert_eq!(memory([4, 4]), Ok(()));
        let error = memory([0, 1 << 49]).expect_err("millions of gigabytes").to_string();
        assert!(error.contains("562949953421312 vertices need about 6755399441.1 GB"), "{error}");
    }

    #[test]
    fn a_container_tells_how_much_memory_it_may_take() {
        let folder = tempfile::tempdir().expect("a folder");
        assert_eq!(most_of_container(folder.path()), None);
        std::fs::create_dir(folder.path().join("memory")).expect("there is room");
        let old = folder.path().join("memory/memory.limit_in_bytes");
        std::fs::write(old, "9223372036854771712\n").expect("there is room");
        assert_eq!(most_of_container(folder.path()), Some(9_223_372_036_854_771_712));
        let new = folder.path().join("memory.max");
        std::fs::write(&new, "max\n").expect("there is room");
        assert_eq!(most_of_container(folder.path()), None);
        std::fs::write(new, "2147483648\n").expect("there is room");
        assert_eq!(most_of_container(folder.path()), Some(2 << 30));
    }

    #[test]
    fn a_refused_component_is_named_by_its_index() {
        let error =
            vector("scene.gravity", &[0.0, 2e9, 0.0], MAX_GRAVITY, " m/s²").expect_err("large");
        assert_eq!(error.to_string(), "scene.gravity.1 = 2000000000.0; accepted: -1e6 to 1e6 m/s²");
    }
}
