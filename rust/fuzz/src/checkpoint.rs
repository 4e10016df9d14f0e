//! Checkpoints with some of their bytes changed, but whole by their checksum.

use std::cell::RefCell;
use std::fs;

use arbitrary::Unstructured;
use boucle_scene::checkpoint::Checkpoint;
use boucle_scene::{Assembly, Scene, source};
use xxhash_rust::xxh3::xxh3_64;

use crate::cloth::{any, one_of};
use crate::demands::{accepted, advance, is_light, sound};
use crate::files::Written;

/// Scenes whose checkpoints hold something of everything.
const SCENES: [&str; 4] = [
    include_str!("../scenes/hung.toml"),
    include_str!("../scenes/made_up.toml"),
    include_str!("../scenes/torn.toml"),
    include_str!("../scenes/weather.toml"),
];

thread_local! {
    /// Of each scene a simulation and its checkpoint after two frames.
    static KEPT: RefCell<Vec<(Assembly, Vec<u8>)>> = RefCell::new(SCENES.map(kept).into());
}

fn kept(text: &str) -> (Assembly, Vec<u8>) {
    let scene = Scene::from_toml(text, &[]).expect("a scene");
    let folder = std::path::Path::new(".");
    let meshes = source::rest_meshes(&scene, folder).expect("meshes");
    let colliders = source::rest_colliders(&scene, folder).expect("colliders");
    let mut assembly = Assembly::new(&scene, meshes, colliders, 1).expect("a simulation");
    for _ in 0..2 {
        assembly.advance().expect("a frame");
    }
    let bytes = assembly.simulation.checkpoint();
    (assembly, bytes)
}

/// What is restored can be told, saved and moved on; what is refused changes nothing.
pub(crate) fn simulation(bytes: &[u8]) {
    let mut source = Unstructured::new(bytes);
    KEPT.with_borrow_mut(|kept| {
        let number = usize::from(any::<u8>(&mut source)) % kept.len();
        let (assembly, good) = &mut kept[number];
        let simulation = &mut assembly.simulation;
        let bad = spoiled(&mut source, good);
        let is_taken = accepted(simulation.restore(&bad)).is_some();
        if is_taken {
            sound(simulation, &simulation.certificate());
            assert_eq!(simulation.checkpoint().len(), bad.len());
            if is_light(simulation) {
                let _ = advance(simulation);
            }
        } else {
            assert!(simulation.checkpoint() == *good, "a refused checkpoint changed something");
        }
        simulation.restore(good).expect("our own checkpoint");
        assert!(simulation.checkpoint() == *good, "what was restored before is still there");
    });
}

/// Numbers of 8 bytes that mean something somewhere.
const NUMBERS: [u64; 14] = [
    0,
    1,
    2,
    u64::MAX,
    i64::MAX as u64,
    1 << 32,
    1 << 61,
    f64::NAN.to_bits(),
    f64::INFINITY.to_bits(),
    f64::MAX.to_bits(),
    (-1.0_f64).to_bits(),
    1.0_f64.to_bits(),
    1e18_f64.to_bits(),
    0.1_f64.to_bits(),
];

/// Checkpoint bytes with some changes, and the checksum that they then have.
fn spoiled(source: &mut Unstructured<'_>, good: &[u8]) -> Vec<u8> {
    let mut bytes = good[..good.len() - 8].to_vec();
    for _ in 0..=any::<u8>(source) % 4 {
        if bytes.len() < 4 {
            break;
        }
        // Everything but the header stands at multiples of four bytes.
        let at = 4 * (usize::from(any::<u16>(source)) % (bytes.len() / 4));
        let number = one_of(source, &NUMBERS).to_le_bytes();
        let end = (at + 8).min(bytes.len());
        match any::<u8>(source) % 6 {
            0 => bytes[at] = any(source),
            1 => bytes.truncate(at.max(4)),
            2 => drop(bytes.splice(at..at, number)),
            3 => drop(bytes.drain(at..end)),
            4 => bytes[at..end].copy_from_slice(&any::<[u8; 8]>(source)[..end - at]),
            _ => bytes[at..end].copy_from_slice(&number[..end - at]),
        }
    }
    bytes.extend(xxh3_64(&bytes).to_le_bytes());
    bytes
}

/// The checkpoint of a bake, of bytes whose checksum is right or is not.
pub(crate) fn bake(bytes: &[u8]) {
    let mut content = b"BOUCLECP".to_vec();
    match bytes.split_first() {
        Some((0, raw)) => content = raw.to_vec(),
        Some((_, body)) => {
            content.extend(body);
            content.extend(xxh3_64(&content).to_le_bytes());
        }
        None => content.clear(),
    }
    let file = Written::new(boucle_scene::checkpoint::FILE_NAME, &content);
    let digest = content.get(12..28).and_then(|bytes| bytes.try_into().ok());
    let digest = digest.map_or(7, u128::from_le_bytes);
    let Some(Some(checkpoint)) = accepted(Checkpoint::read(&file.path, digest)) else { return };
    checkpoint.write(&file.path).expect("there is room");
    let again = Checkpoint::read(&file.path, digest).expect("our own file");
    assert_eq!(again.map(|again| again.simulation), Some(checkpoint.simulation));
    drop(fs::remove_file(&file.path));
}
