use super::Ending::{Diverged, Done, Refused, Stopped};
use super::*;

/// A hung sheet of so many vertices a side, with other keys of `[solver]`.
fn sheet(side: usize, frames: i32, solver: &str) -> String {
    format!(
        r#"{{"scene": {{"frames": [1, {frames}]}}, "collision": {{"enabled": false}}, "solver": {{{solver}}}, "cloth": [{{
        "name": "sheet", "grid": {{"size": [1, 1], "vertices": [{side}, {side}], "plane": "xz"}}, "pins": ["top"]}}]}}"#
    )
}

fn rows(scenes: Vec<String>, threads: usize) -> Vec<Row> {
    let request = Request { scenes, threads, ..Request::default() };
    run(&request, &mut |_| ControlFlow::Continue(())).expect("threads are there")
}

/// What of a row does not depend on the clock.
fn bits(row: &Row) -> String {
    to_json(&[Row { seconds: 0.0, ..row.clone() }])
}

/// The certificate of the last frame of a scene run alone.
fn alone(text: &str) -> FrameRow {
    let scene = Scene::from_json(text).expect("a good scene");
    let meshes = source::rest_meshes(&scene, Path::new("")).expect("grids");
    let mut assembly = Assembly::new(&scene, meshes, Vec::new(), 1).expect("a good scene");
    let certificates = (1..scene.scene.frames[1]).map(|_| assembly.advance().expect("stable"));
    FrameRow::new(&certificates.last().expect("a frame"), None)
}

#[test]
fn every_row_is_that_of_its_scene_alone_whatever_the_threads() {
    let explicit = r#""integrator": "verlet""#;
    let scenes: Vec<String> =
        (2..12).map(|side| sheet(side, 4, if side % 2 == 0 { explicit } else { "" })).collect();
    for threads in [1, 2, 3, 8] {
        let rows = rows(scenes.clone(), threads);
        assert_eq!(rows.len(), scenes.len());
        for (row, scene) in rows.iter().zip(&scenes) {
            let (last, alone) = (row.last.as_ref().expect("it ran"), alone(scene));
            assert_eq!((row.ending, &row.error), (Done, &None));
            assert_eq!((&last.hash, last.frame), (&alone.hash, 4));
            assert_eq!(last.kinetic_energy.to_bits(), alone.kinetic_energy.to_bits());
            assert!(row.largest_strain.expect("it ran") >= last.max_strain);
        }
    }
}

#[test]
fn a_large_scene_runs_after_the_small_ones_and_keeps_its_place() {
    let solver = r#""substeps": 1"#;
    let scenes = vec![sheet(5, 2, solver), sheet(182, 2, solver), sheet(6, 2, solver)];
    const { assert!(182 * 182 >= LARGE) };
    let mut counts = Vec::new();
    let request = Request { scenes: scenes.clone(), threads: 2, ..Request::default() };
    let rows = run(&request, &mut |step| {
        counts.push(step.done);
        ControlFlow::Continue(())
    });
    let rows = rows.expect("threads are there");
    for (row, scene) in rows.iter().zip(&scenes) {
        assert_eq!(row.last.as_ref().expect("it ran").hash, alone(scene).hash);
    }
    assert!(counts.is_sorted() && counts.last() == Some(&3), "{counts:?}");
}

#[test]
fn a_scene_that_fails_is_a_row_with_its_sentence_and_the_others_go_on() {
    let wild = r#""integrator": "symplectic_euler", "substeps": 20, "allow_unstable": true"#;
    let timid = r#""integrator": "symplectic_euler", "substeps": 1"#;
    let good = sheet(5, 60, "");
    let scenes = vec![
        good.clone(),
        sheet(60, 60, wild).replace("\"pins\"", "\"springs\": {\"limiter\": \"none\"}, \"pins\""),
        sheet(12, 60, timid),
        sheet(1, 60, ""),
        "no scene".to_owned(),
        good,
    ];
    let rows = rows(scenes, 2);
    let endings: Vec<Ending> = rows.iter().map(|row| row.ending).collect();
    assert_eq!(endings, [Done, Diverged, Refused, Refused, Refused, Done]);
    let sentence = |row: usize| rows[row].error.clone().expect("a sentence");
    assert!(sentence(1).starts_with("diverged at frame "), "{}", sentence(1));
    let last = rows[1].last.as_ref().expect("the last good frame");
    assert!(sentence(1).contains(&format!("frame {},", last.frame + 1)), "{}", sentence(1));
    assert!(sentence(2).contains("stability bound"), "{}", sentence(2));
    assert!(sentence(3).contains("vertices"), "{}", sentence(3));
    assert!(sentence(4).contains("not JSON"), "{}", sentence(4));
    assert!(rows[4].first.is_none() && rows[4].last.is_none());
    assert_eq!(bits(&rows[0]), bits(&rows[5]));
}

#[test]
fn a_stopped_batch_ends_in_the_midst_of_a_frame() {
    let endless = r#""integrator": "symplectic_euler", "substeps": 200000"#;
    let scenes = vec![sheet(3, 2, ""), sheet(30, 100, endless), sheet(30, 100, endless)];
    let request = Request { scenes, threads: 2, ..Request::default() };
    let started = Instant::now();
    let rows = run(&request, &mut |step| {
        if step.done > 0 && step.seconds > 0.3 {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    let rows = rows.expect("threads are there");
    let endings: Vec<Ending> = rows.iter().map(|row| row.ending).collect();
    assert_eq!(endings, [Done, Stopped, Stopped]);
    assert!(started.elapsed() < Duration::from_secs(10));
}

#[test]
fn no_scenes_are_no_rows_and_too_many_threads_are_refused() {
    assert!(rows(Vec::new(), 0).is_empty());
    let request = Request { threads: 5000, ..Request::default() };
    let refused = run(&request, &mut |_| ControlFlow::Continue(())).expect_err("too many");
    assert!(refused.to_string().contains("1 to 1024"), "{refused}");
}
