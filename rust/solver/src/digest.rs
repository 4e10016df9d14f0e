//! What a checkpoint is bound to.

use xxhash_rust::xxh3::Xxh3;

use crate::cloth::Cloth;
use crate::force::Wind;
use crate::settings::Settings;

/// A hash of everything that the motion depends on and that does not change.
pub(crate) fn digest(cloths: &[Cloth], winds: &[Wind], settings: &Settings) -> u64 {
    let mut hasher = Xxh3::new();
    let settings = Settings { threads: 0, ..settings.clone() };
    // Debug output of floats is exact: the shortest text that reads back as the same bits.
    hasher.update(format!("{settings:?} {winds:?}").as_bytes());
    for cloth in cloths {
        let Cloth { material, pins, springs, .. } = cloth;
        hasher.update(format!("{material:?} {pins:?} {springs:?}").as_bytes());
        for value in cloth.masses.iter().chain(cloth.positions.iter().flatten()) {
            hasher.update(&value.to_le_bytes());
        }
    }
    hasher.digest()
}
