//! What a checkpoint is bound to.

use xxhash_rust::xxh3::Xxh3;

use crate::cloth::Cloth;
use crate::collider::Collider;
use crate::force::Wind;
use crate::settings::Settings;

/// A hash of everything that the motion depends on and that does not change.
pub(crate) fn digest(
    cloths: &[Cloth],
    colliders: &[Collider],
    winds: &[Wind],
    settings: &Settings,
) -> u64 {
    let mut hasher = Xxh3::new();
    let settings = Settings { threads: 0, ..settings.clone() };
    // Debug output of floats is exact: the shortest text that reads back as the same bits.
    hasher.update(format!("{settings:?} {winds:?} {colliders:?}").as_bytes());
    hasher.update(env!("CARGO_PKG_VERSION").as_bytes());
    for cloth in cloths {
        hasher.update(
            format!("{:?} {:?} {:?}", cloth.material, cloth.pins, cloth.collision).as_bytes(),
        );
        hasher.update(format!("{:?}", cloth.fabric).as_bytes());
        hasher.update(
            format!("{:?} {:?} {:?}", cloth.tailoring, cloth.pressure, cloth.bulk).as_bytes(),
        );
        hasher.update(format!("{:?} {:?}", cloth.pin_weights, cloth.pin_material).as_bytes());
        for spring in &cloth.springs {
            let [a, b] = spring.ends;
            for part in [a, b, spring.kind as u32] {
                hasher.update(&part.to_le_bytes());
            }
            for number in [spring.rest_length, spring.stiffness, spring.damping] {
                hasher.update(&number.to_le_bytes());
            }
        }
        for corner in cloth.mesh.faces().flatten() {
            hasher.update(&corner.to_le_bytes());
        }
        for number in cloth.masses.iter().chain(cloth.positions.iter().flatten()) {
            hasher.update(&number.to_le_bytes());
        }
    }
    hasher.digest()
}
