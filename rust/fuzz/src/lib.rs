//! What no input may do: panic, hang, bring forth what is no number, or be refused in more than one clear line.
//!
//! Each target turns bytes, whichever, into an input, does with it what a user would, and panics where it finds one of those.
//! `scripts/fuzz.py` searches for such bytes with libFuzzer; `tests/corpus.rs` replays those that were worth keeping, and random
//! changes of them, as part of the usual tests.

mod changes;
mod checkpoint;
mod cloth;
mod demands;
mod files;
mod geometry;
mod scene;
mod simulation;
mod watch;

pub use changes::changed;
pub use demands::{accepted, advance};

/// What takes any bytes.
pub type Target = fn(&[u8]);

/// Every target and its name, which is that of its folder in `corpus`.
pub const TARGETS: [(&str, Target); 8] = [
    ("scene", scene::text),
    ("values", scene::values),
    ("obj", files::obj),
    ("pc2", files::pc2),
    ("bake", checkpoint::bake),
    ("checkpoint", checkpoint::simulation),
    ("simulation", simulation::random),
    ("geometry", geometry::random),
];

/// Gives bytes to the target of a name.
///
/// # Panics
/// When there is no such target, or it finds what must not be.
pub fn run(name: &str, bytes: &[u8]) {
    let target = TARGETS.iter().find(|(known, _)| *known == name);
    target.unwrap_or_else(|| panic!("{name} is none of the targets")).1(bytes);
}
