//! Every target takes what was worth keeping, and random changes of it.

use std::fs;
use std::path::{Path, PathBuf};

use boucle_fuzz::{TARGETS, changed, run};

/// The files of a target, sorted by name.
fn kept(target: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target);
    let files = fs::read_dir(&folder).unwrap_or_else(|error| panic!("{target}: {error}"));
    let mut paths: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
    paths.sort();
    paths
}

/// Gives the files of a target to it, and so many changes of them.
fn replay(target: &str, changes: u64) {
    let files = kept(target);
    assert!(!files.is_empty(), "{target} has nothing to begin with");
    let contents: Vec<Vec<u8>> =
        files.iter().map(|path| fs::read(path).expect("it can be read")).collect();
    for (path, content) in files.iter().zip(&contents) {
        eprintln!("{}", path.display());
        run(target, content);
    }
    for seed in 0..changes {
        let bytes = changed(&contents[seed as usize % contents.len()], seed);
        eprintln!("{target}, change {seed}: {}", bytes.escape_ascii());
        run(target, &bytes);
    }
}

macro_rules! replayed {
    ($($sentence:ident: $target:literal, $changes:literal;)*) => {
        $(#[test]
        fn $sentence() {
            replay($target, $changes);
        })*

        #[test]
        fn every_target_is_replayed() {
            let names: Vec<&str> = TARGETS.iter().map(|(name, _)| *name).collect();
            assert_eq!(names, [$($target),*]);
        }
    };
}

replayed! {
    no_text_of_a_scene_is_more_than_refused: "scene", 600;
    no_value_of_a_scene_is_more_than_refused: "values", 300;
    no_mesh_file_is_more_than_refused: "obj", 4000;
    no_point_cache_is_more_than_refused: "pc2", 600;
    no_checkpoint_of_a_bake_is_more_than_refused: "bake", 400;
    no_checkpoint_of_a_simulation_is_more_than_refused: "checkpoint", 300;
    no_simulation_is_more_than_refused: "simulation", 300;
    no_points_are_more_than_far_apart: "geometry", 20000;
}

#[test]
fn the_corpus_is_small() {
    let sizes: Vec<u64> = TARGETS
        .iter()
        .flat_map(|(target, _)| kept(target))
        .map(|path| fs::metadata(path).expect("it is there").len())
        .collect();
    assert!(sizes.len() < 200, "{} files", sizes.len());
    assert!(sizes.iter().sum::<u64>() < 200_000, "{} bytes", sizes.iter().sum::<u64>());
}
