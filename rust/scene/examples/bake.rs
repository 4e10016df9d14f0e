//! Bakes a scene into a folder without Python: `cargo run -p boucle-scene --example bake -- SCENE.toml FOLDER`.

use std::ops::ControlFlow;
use std::process::ExitCode;

use boucle_scene::bake::{Request, bake};

fn main() -> ExitCode {
    let mut words = std::env::args_os().skip(1);
    let (Some(scene), Some(out), None) = (words.next(), words.next(), words.next()) else {
        eprintln!("bake: two words are accepted: SCENE.toml FOLDER");
        return ExitCode::from(2);
    };
    let request = Request { scene: scene.into(), out: out.into(), ..Request::default() };
    match bake(&request, &mut |_| ControlFlow::Continue(())) {
        Ok(_) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("bake: {error}");
            ExitCode::FAILURE
        }
    }
}
