//! Scenes as text, and good scenes with some of their values replaced.

use std::path::{Component, Path};

use arbitrary::Unstructured;
use boucle_scene::{Assembly, Scene, source};
use toml::{Table, Value};

use crate::cloth::{any, one_of};
use crate::demands::{accepted, advance_scene, is_light, sound};

/// Vertices beyond which a scene is checked, but not run.
const MOST_VERTICES: u64 = 400;

/// Good scenes, in which every key of a scene file stands somewhere.
const SCENES: [&str; 5] = [
    include_str!("../scenes/hung.toml"),
    include_str!("../scenes/made_up.toml"),
    include_str!("../scenes/torn.toml"),
    include_str!("../scenes/weather.toml"),
    include_str!("../scenes/files.toml"),
];

/// Bytes as TOML and as JSON.
pub(crate) fn text(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    if let Some(scene) = accepted(Scene::from_toml(&text, &[])) {
        run(&scene);
    }
    if let Some(scene) = accepted(Scene::from_json(&text)) {
        run(&scene);
    }
    if let Some(first) = text.lines().next() {
        // The first line as an override.
        if let Some(scene) = accepted(Scene::from_toml(SCENES[0], &[first.to_owned()])) {
            run(&scene);
        }
    }
    let _ = accepted(boucle_scene::description::fields_from_json(&text));
}

/// One of the good scenes, some of whose values are replaced.
pub(crate) fn values(bytes: &[u8]) {
    let mut source = Unstructured::new(bytes);
    let text = one_of(&mut source, &SCENES);
    let mut tree = Value::Table(text.parse::<Table>().expect("a good scene"));
    for _ in 0..=any::<u8>(&mut source) % 4 {
        replace(&mut source, &mut tree);
    }
    let Value::Table(table) = tree else { return };
    if let Some(scene) = accepted(Scene::from_toml(&table.to_string(), &[])) {
        run(&scene);
    }
}

/// Goes down the tree by chance, and puts something else where it ends.
fn replace(source: &mut Unstructured<'_>, tree: &mut Value) {
    let mut place = tree;
    loop {
        let count = match &*place {
            Value::Table(table) => table.len(),
            Value::Array(list) => list.len(),
            _ => 0,
        };
        if count == 0 || any::<u8>(source) < 12 {
            break;
        }
        let next = usize::from(any::<u8>(source)) % count;
        place = match place {
            Value::Table(table) => table.iter_mut().nth(next).expect("so many are there").1,
            Value::Array(list) => &mut list[next],
            _ => return,
        };
    }
    *place = other(source, place);
}

/// Floats that mean something somewhere.
const FLOATS: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    1e-3,
    1e-9,
    1e-30,
    1e6,
    1e9,
    1e12,
    1e300,
    5e-324,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
];
/// Integers that mean something somewhere.
const INTEGERS: [i64; 13] = [
    0,
    1,
    2,
    3,
    -1,
    10,
    100,
    65536,
    2_147_483_647,
    -2_147_483_648,
    4_294_967_296,
    i64::MAX,
    i64::MIN,
];
/// Words that mean something somewhere, or nowhere.
const WORDS: [&str; 22] = [
    "",
    "x",
    "top",
    "left",
    "top_left",
    "rk4",
    "bdf2",
    "verlet",
    "leapfrog",
    "midpoint",
    "auto",
    "forward_euler",
    "fabric",
    "springs",
    "none",
    "stiffen",
    "provot",
    "continuum",
    "axial",
    "denim",
    "xy",
    "a\n\u{202e}b",
];

fn other(source: &mut Unstructured<'_>, value: &Value) -> Value {
    match (any::<u8>(source) % 12, value) {
        (0, _) => Value::Array(vec![value.clone(); usize::from(any::<u8>(source) % 5)]),
        (1, _) => Value::Boolean(any(source)),
        (2, _) => Value::Table(Table::new()),
        (3, _) => Value::String(one_of(source, &WORDS).to_owned()),
        (4, Value::Array(list)) => {
            let mut list = list.clone();
            list.truncate(usize::from(any::<u8>(source) % 4));
            Value::Array(list)
        }
        (4, Value::Table(table)) => {
            let gone = usize::from(any::<u8>(source)) % table.len().max(1);
            Value::Table(
                table
                    .iter()
                    .enumerate()
                    .filter(|(index, _)| *index != gone)
                    .map(|(_, (key, value))| (key.clone(), value.clone()))
                    .collect(),
            )
        }
        (5, _) => Value::Integer(one_of(source, &INTEGERS)),
        (6, _) => Value::Integer(i64::from(any::<i16>(source))),
        (7, Value::Float(number)) => Value::Float(number * one_of(source, &FLOATS)),
        (8 | 9, Value::Float(number)) => {
            Value::Float(number * 2_f64.powi(i32::from(any::<i8>(source)) / 8))
        }
        (8 | 9, Value::Integer(number)) => {
            Value::Integer(number.saturating_add(i64::from(any::<i8>(source))))
        }
        _ => Value::Float(one_of(source, &FLOATS)),
    }
}

/// Builds a scene and moves it on by two frames, if it is small.
fn run(scene: &Scene) {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes"));
    let cloths = scene.cloth.iter().flat_map(|cloth| [&cloth.mesh, &cloth.rest]);
    let colliders = scene.collider.iter().flat_map(|collider| [&collider.mesh, &collider.cache]);
    let is_ours = |name: &String| {
        let mut parts = Path::new(name).components();
        matches!((parts.next(), parts.next()), (Some(Component::Normal(_)), None))
    };
    if !cloths.chain(colliders).flatten().all(is_ours) {
        return;
    }
    let grids = scene.cloth.iter().filter_map(|cloth| cloth.grid.as_ref());
    let vertices: u64 =
        grids.map(|grid| grid.vertices.map(u64::from).iter().product::<u64>()).sum();
    if vertices > MOST_VERTICES || scene.cloth.len() + scene.collider.len() > 12 {
        return;
    }
    let Some(meshes) = accepted(source::rest_meshes(scene, folder)) else { return };
    let Some(colliders) = accepted(source::rest_colliders(scene, folder)) else { return };
    let Some(mut assembly) = accepted(Assembly::new(scene, meshes, colliders, 1)) else { return };
    sound(&assembly.simulation, &assembly.simulation.certificate());
    for _ in 0..2 {
        if !is_light(&assembly.simulation) {
            return;
        }
        if advance_scene(&mut assembly).is_none() {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_good_scenes_are_good() {
        for text in SCENES {
            let scene = Scene::from_toml(text, &[]).expect("a scene");
            let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes"));
            let meshes = source::rest_meshes(&scene, folder).expect("meshes");
            let colliders = source::rest_colliders(&scene, folder).expect("colliders");
            let mut assembly = Assembly::new(&scene, meshes, colliders, 1).expect("a simulation");
            assert!(is_light(&assembly.simulation));
            assembly.advance().expect("a frame");
            assembly.advance().expect("a frame");
        }
    }
}
