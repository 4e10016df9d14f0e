use super::*;
use crate::checkpoint;
use crate::description::UpAxis;
use crate::{obj, pc2};

const SCENE: &str = r#"
[scene]
frames = [1, 12]
[collision]
enabled = false
[[cloth]]
name = "sheet"
grid = { size = [1, 1], vertices = [6, 6], plane = "xy" }
pins = [{ names = ["left"], motion = [{ frame = 1 }, { frame = 8, location = [0.2, 0, 0.3], rotation_deg = [20, 0, 0] }], release = 9 }, "top_right"]
[[cloth]]
name = "other"
grid = { size = [1, 1], vertices = [5, 4], plane = "xz", center = [3, 0, 0] }
pins = ["top"]
"#;

/// A folder with a scene file in it.
struct Place(tempfile::TempDir);

impl Place {
    fn new(scene: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("scene.toml"), scene).expect("there is room");
        Self(folder)
    }

    fn request(&self, out: &str) -> Request {
        let scene = self.0.path().join("scene.toml");
        Request { scene, out: self.0.path().join(out), threads: 1, ..Request::default() }
    }

    fn bytes(&self, file: &str) -> Vec<u8> {
        std::fs::read(self.0.path().join(file)).expect(file)
    }

    /// The hashes of all frames of a report, each with its frame.
    fn hashes(&self, out: &str) -> Vec<(i64, String)> {
        let text = self.bytes(&format!("{out}/report.json"));
        let report: serde_json::Value = serde_json::from_slice(&text).expect("strict JSON");
        let row = |row: &serde_json::Value| {
            let hash = row["hash"].as_str().expect("a hash").to_owned();
            (row["frame"].as_i64().expect("a frame"), hash)
        };
        report["frames"].as_array().expect("rows").iter().map(row).collect()
    }
}

fn whole(request: &Request) -> Report {
    let (ending, report) = bake(request, &mut |_| ControlFlow::Continue(())).expect("a good scene");
    assert_eq!(ending, Ending::Done);
    report
}

/// Bakes until a frame is done, and stops.
fn stopped_at(request: &Request, frame: i32) {
    let mut observe = |step: &Progress| {
        if step.frame == frame { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let (ending, _) = bake(request, &mut observe).expect("a good scene");
    assert_eq!(ending, Ending::Stopped);
}

#[test]
fn a_bake_leaves_a_cache_a_mesh_and_a_row_for_every_frame() {
    let place = Place::new(SCENE);
    let mut told = Vec::new();
    let mut observe = |step: &Progress| {
        told.push(step.frame);
        assert_eq!((step.first, step.last), (1, 12));
        ControlFlow::Continue(())
    };
    bake(&place.request("out"), &mut observe).expect("a good scene");
    assert_eq!(told, (1..=12).collect::<Vec<_>>());
    let (header, numbers) = pc2::read(&place.0.path().join("out/sheet.pc2")).expect("a cache");
    let expected = pc2::Header { vertex_count: 36, first_frame: 1, sample_count: 12 };
    assert_eq!(header, expected);
    assert_eq!(&numbers[..3], &[-0.5, -0.5, 0.0]);
    let frames: Vec<i64> = place.hashes("out").iter().map(|row| row.0).collect();
    assert_eq!(frames, (1..=12).collect::<Vec<_>>());
    let mesh = place.bytes("out/other.obj");
    let mesh = crate::obj::read(&mesh[..], UpAxis::default()).expect("our own file").mesh;
    assert_eq!((mesh.vertex_count(), mesh.face_count()), (20, 12));
}

#[test]
fn moved_pins_are_where_their_keyframes_say_and_fall_after_their_release() {
    let place = Place::new(SCENE);
    whole(&place.request("out"));
    let (_, numbers) = pc2::read(&place.0.path().join("out/sheet.pc2")).expect("a cache");
    let vertex = |frame: usize, vertex: usize| {
        let start = 3 * (36 * (frame - 1) + vertex);
        [numbers[start], numbers[start + 1], numbers[start + 2]]
    };
    // Vertex 0 rests at (-0.5, -0.5, 0): turned by 20 degrees about x, then moved.
    let (sine, cosine) = 20_f64.to_radians().sin_cos();
    let expected = [-0.5 + 0.2, -0.5 * cosine, -0.5 * sine + 0.3];
    for frame in [8, 9] {
        for (have, want) in vertex(frame, 0).iter().zip(expected) {
            assert!((f64::from(*have) - want).abs() < 1e-6, "{have} {want} at {frame}");
        }
    }
    assert!(vertex(12, 0)[2] < vertex(9, 0)[2] - 0.01, "released at the end of frame 9, it falls");
    let bits = |frame| vertex(frame, 35).map(f32::to_bits);
    assert_eq!(bits(12), bits(1), "the other pin stays");
}

#[test]
fn a_bake_that_is_stopped_at_any_frame_and_resumed_is_equal_to_the_bit() {
    let place = Place::new(SCENE);
    whole(&place.request("whole"));
    for frame in 1..12 {
        let out = format!("stopped_{frame}");
        stopped_at(&place.request(&out), frame);
        assert_eq!(place.hashes(&out).last().map(|row| row.0), Some(i64::from(frame)));
        whole(&Request { resume: true, threads: 2, ..place.request(&out) });
        assert_eq!(place.hashes(&out), place.hashes("whole"), "stopped at {frame}");
        for cache in ["sheet.pc2", "other.pc2"] {
            let same =
                place.bytes(&format!("{out}/{cache}")) == place.bytes(&format!("whole/{cache}"));
            assert!(same, "{cache} stopped at {frame}");
        }
    }
}

#[test]
fn caches_that_are_ahead_of_the_checkpoint_are_cut_back_to_it() {
    let place = Place::new(SCENE);
    whole(&place.request("whole"));
    stopped_at(&place.request("out"), 4);
    let old = place.bytes("out/boucle.checkpoint");
    stopped_at(&Request { resume: true, ..place.request("out") }, 7);
    std::fs::write(place.0.path().join("out/boucle.checkpoint"), old).expect("there is room");
    whole(&Request { resume: true, ..place.request("out") });
    assert_eq!(place.bytes("out/sheet.pc2"), place.bytes("whole/sheet.pc2"));
    assert_eq!(place.hashes("out"), place.hashes("whole"));
}

#[test]
fn kept_frames_are_those_of_the_whole_bake() {
    let place = Place::new(SCENE);
    whole(&place.request("whole"));
    whole(&Request { frames: Some([5, 9]), ..place.request("part") });
    assert_eq!(place.hashes("part"), place.hashes("whole")[4..9]);
    let (header, _) = pc2::read(&place.0.path().join("part/sheet.pc2")).expect("a cache");
    assert_eq!((header.first_frame, header.sample_count), (5, 5));
    stopped_at(&Request { frames: Some([5, 9]), ..place.request("later") }, 3);
    assert!(place.hashes("later").is_empty());
    whole(&Request { frames: Some([5, 9]), resume: true, ..place.request("later") });
    assert_eq!(place.bytes("later/sheet.pc2"), place.bytes("part/sheet.pc2"));
    for frames in [[0, 5], [5, 13], [9, 5]] {
        let request = Request { frames: Some(frames), ..place.request("never") };
        let error = bake(&request, &mut |_| ControlFlow::Continue(())).expect_err("out of range");
        assert!(error.to_string().contains("accepted: A:B within 1:12"), "{error}");
        assert!(!place.0.path().join("never").exists());
    }
}

#[test]
fn a_checkpoint_of_another_scene_or_other_settings_is_refused() {
    let place = Place::new(SCENE);
    stopped_at(&place.request("out"), 3);
    let changes =
        ["cloth.sheet.density=0.3", "scene.frames=[1, 13]", "cloth.sheet.grid.size=[1, 2]"];
    for change in changes {
        let overrides = vec![change.to_owned()];
        let request = Request { resume: true, overrides, ..place.request("out") };
        let error = bake(&request, &mut |_| ControlFlow::Continue(())).expect_err(change);
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("another scene"), "{error}");
    }
    // The same scene in other words goes on.
    std::fs::write(place.0.path().join("scene.toml"), format!("# a comment\n{SCENE}"))
        .expect("room");
    whole(&Request { resume: true, ..place.request("out") });
}

#[test]
fn a_resumed_bake_that_is_whole_stays_as_it_is_and_one_without_a_checkpoint_starts() {
    let place = Place::new(SCENE);
    whole(&Request { resume: true, ..place.request("out") });
    let (cache, hashes) = (place.bytes("out/sheet.pc2"), place.hashes("out"));
    std::fs::remove_file(place.0.path().join("out/report.json")).expect("it is there");
    whole(&Request { resume: true, ..place.request("out") });
    assert_eq!((place.bytes("out/sheet.pc2"), place.hashes("out")), (cache, hashes));
}

#[test]
fn a_bake_that_starts_anew_forgets_the_old_checkpoint() {
    let place = Place::new(SCENE);
    stopped_at(&place.request("out"), 6);
    let blocked = place.0.path().join("out/sheet.pc2");
    std::fs::remove_file(&blocked).expect("it is there");
    std::fs::create_dir(&blocked).expect("a folder in the way");
    let error =
        bake(&place.request("out"), &mut |_| ControlFlow::Continue(())).expect_err("blocked");
    assert_eq!(error.exit_code(), 4);
    assert!(!place.0.path().join("out").join(checkpoint::FILE_NAME).exists());
}

#[test]
fn a_divergence_keeps_the_frames_before_it() {
    let place = Place::new(SCENE);
    let unstable = [
        "solver.integrator=forward_euler",
        "solver.substeps=1",
        "solver.allow_unstable=true",
        "cloth.sheet.springs.limiter=none",
        "scene.frames=[1, 2000]",
        "cloth.sheet.springs.stretch=1e6",
    ];
    let overrides = unstable.map(str::to_owned).to_vec();
    let request = Request { overrides, ..place.request("out") };
    let error = bake(&request, &mut |_| ControlFlow::Continue(())).expect_err("unstable");
    let Error::Diverged { frame, ref cloth, .. } = error else { panic!("{error}") };
    assert_eq!(cloth, "sheet");
    let kept = place.hashes("out").len();
    assert_eq!(place.hashes("out").last().map(|row| row.0), Some(i64::from(frame - 1)));
    let (header, _) = pc2::read(&place.0.path().join("out/sheet.pc2")).expect("a cache");
    assert_eq!(header.sample_count as usize, kept);
    let again = bake(&Request { resume: true, ..request }, &mut |_| ControlFlow::Continue(()));
    assert_eq!(again.expect_err("it diverges again"), error);
}

/// Equation 6 makes strained springs stiffer, until the steps that rest allows are too long.
#[test]
fn a_step_that_becomes_unstable_names_its_frame_and_keeps_those_before_it() {
    let place = Place::new(SCENE);
    let soft = [
        "cloth.sheet.springs={ stretch = 5, shear = 1, bend = 0.1, limiter = \"stiffen\" }",
        "scene.frames=[1, 60]",
    ];
    // Only explicit steps can be too long.
    let explicit = "solver.integrator=symplectic_euler";
    let with = |substeps: &str| {
        let overrides = [soft[0], soft[1], explicit, substeps].map(str::to_owned).to_vec();
        Request { overrides, ..place.request("out") }
    };
    let run = |request: &Request| bake(request, &mut |_| ControlFlow::Continue(()));
    let refusal = run(&with("solver.substeps=1")).expect_err("too few at rest").to_string();
    let least = refusal.split("at least ").nth(1).and_then(|rest| rest.split(' ').next());
    let request = with(&format!("solver.substeps={}", least.expect("a number of substeps")));
    let error = run(&request).expect_err("too few when stretched");
    assert_eq!(error.exit_code(), 3);
    let Error::Unstable { frame, .. } = error else { panic!("{error}") };
    assert!(error.to_string().starts_with(&format!("frame {frame} cannot be simulated: solver: ")));
    assert!(frame > 2, "{error}");
    assert_eq!(place.hashes("out").last().map(|row| row.0), Some(i64::from(frame - 1)));
    let (header, _) = pc2::read(&place.0.path().join("out/sheet.pc2")).expect("a cache");
    assert_eq!(i64::from(header.sample_count), i64::from(frame - 1));
    assert!(place.0.path().join("out").join(checkpoint::FILE_NAME).exists());
    assert_eq!(run(&Request { resume: true, ..request }).expect_err("it does again"), error);
}

#[test]
fn names_that_cannot_name_a_file_are_refused() {
    for name in ["a/b", "..", ".hidden", "a\\\\b", "ends ", "a:b", "tab\\t"] {
        let place = Place::new(&SCENE.replace("name = \"sheet\"", &format!("name = \"{name}\"")));
        let error =
            bake(&place.request("out"), &mut |_| ControlFlow::Continue(())).expect_err(name);
        assert!(error.to_string().contains("cloth.0.name = "), "{error}");
        assert_eq!(error.exit_code(), 2);
    }
}

#[test]
fn edges_that_pins_alone_pull_too_far_are_counted_and_the_worst_are_named() {
    let scene = r#"
[scene]
frames = [1, 4]
[[cloth]]
name = "held"
grid = { size = [1, 1], vertices = [6, 6], plane = "xz" }
pins = ["left", { names = ["right"], motion = [{ frame = 1 }, { frame = 3, location = [0.5, 0, 0] }] }]
[[cloth]]
name = "free"
grid = { size = [1, 1], vertices = [3, 3], plane = "xy" }
"#;
    let place = Place::new(scene);
    whole(&place.request("out"));
    let report: serde_json::Value =
        serde_json::from_slice(&place.bytes("out/report.json")).expect("strict JSON");
    let frames = report["frames"].as_array().expect("rows");
    assert!(frames[0].get("overstretched").is_none() && frames[0]["frame"] == 1);
    // Six rows of five edges each, pulled from 1 m to 1.5 m.
    let last = &frames[3];
    assert!(last["overstretched_count"].as_u64().is_some_and(|count| count >= 6), "{last}");
    let worst = last["overstretched"].as_array().expect("edges");
    assert!((6..=8).contains(&worst.len()));
    let strains: Vec<f64> =
        worst.iter().map(|edge| edge["strain"].as_f64().expect("a strain")).collect();
    assert!(strains.is_sorted_by(|one, other| one >= other), "{strains:?}");
    assert_eq!(worst[0]["strain"], last["max_strain"]);
    assert!(worst.iter().all(|edge| edge["cloth"] == "held"));
    assert_eq!(worst[0]["vertices"].as_array().map(Vec::len), Some(2));

    let unlimited =
        scene.replace("plane = \"xz\" }\n", "plane = \"xz\" }\nsprings = { limiter = \"none\" }\n");
    let place = Place::new(&unlimited);
    whole(&place.request("out"));
    let text = String::from_utf8(place.bytes("out/report.json")).expect("text");
    assert!(!text.contains("overstretched"));
}

/// A scene of a sheet at a height of 9 m whose collider deforms by a cache.
const COLLIDING: &str = r#"
[scene]
frames = [1, 4]
[[cloth]]
name = "sheet"
grid = { size = [1, 1], vertices = [4, 4], plane = "xy", center = [0, 0, 9] }
velocity = [0, 0, -2]
pins = ["left"]
[[collider]]
name = "body"
mesh = "body.obj"
cache = "body.pc2"
"#;

fn colliding(heights: &[f64]) -> Place {
    let place = Place::new(COLLIDING);
    let folder = place.0.path();
    std::fs::write(folder.join("body.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("room");
    let mut cache = pc2::Writer::create(&folder.join("body.pc2"), 3, 1).expect("there is room");
    for &z in heights {
        let corners = [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
        cache.append(&corners.map(boucle_geometry::Vector::from)).expect("there is room");
    }
    place
}

#[test]
fn a_checkpoint_is_bound_to_the_files_of_the_colliders() {
    let place = colliding(&[8.95, 8.97, 8.99]);
    stopped_at(&place.request("out"), 2);
    let resumed = Request { resume: true, ..place.request("out") };
    let other = colliding(&[8.95, 8.97, 8.98]);
    std::fs::copy(other.0.path().join("body.pc2"), place.0.path().join("body.pc2")).expect("room");
    let error = bake(&resumed, &mut |_| ControlFlow::Continue(())).expect_err("another cache");
    assert!(error.to_string().contains("another scene"), "{error}");
    let same = colliding(&[8.95, 8.97, 8.99]);
    std::fs::copy(same.0.path().join("body.pc2"), place.0.path().join("body.pc2")).expect("room");
    whole(&resumed);
    whole(&place.request("whole"));
    assert_eq!(place.hashes("out"), place.hashes("whole"));
    let (_, numbers) = pc2::read(&place.0.path().join("whole/sheet.pc2")).expect("a cache");
    assert!(numbers[3 * 48 + 3 * 10 + 2] > 9.0, "the body has thrown it up");
}

#[test]
fn a_cloth_starts_with_its_velocity_but_for_its_pins() {
    let place = colliding(&[0.0]);
    let report = whole(&place.request("out"));
    let row: serde_json::Value = serde_json::from_str(&report.rows()[0]).expect("strict JSON");
    // 0.2 kg, of which the pinned row has a sixth, at 2 m/s.
    let energy = row["kinetic_energy"].as_f64().expect("an energy");
    assert!((energy - 0.5 * 0.2 * 5.0 / 6.0 * 4.0).abs() < 1e-12, "{energy}");
    let (_, numbers) = pc2::read(&place.0.path().join("out/sheet.pc2")).expect("a cache");
    // After one frame: 2 m/s and gravity for 1/24 s.
    let fallen = 9.0 - f64::from(numbers[48 + 3 * 3 + 2]);
    assert!((fallen - 2.0 / 24.0 - 0.5 * 9.81 / 576.0).abs() < 2e-3, "{fallen}");
}

const TORN: &str = r#"
[scene]
frames = [1, 16]
[collision]
enabled = false
[tear]
enabled = true
strain = 0.3
[[cloth]]
name = "sheet"
grid = { size = [1, 1], vertices = [7, 9], plane = "xz" }
pins = ["top"]
springs = { stretch = 20, shear = 5, bend = 0.1, limiter = "none" }
[cloth.tear]
openings = [{ frame = 6, pairs = [[28, 29], [29, 30], [30, 31], [31, 32], [32, 33], [33, 34]] }]
"#;

/// The points of each corner of each face in each sample.
fn played(place: &Place, out: &str) -> Vec<Vec<[u32; 3]>> {
    let object = place.bytes(&format!("{out}/sheet.obj"));
    let content = obj::read(object.as_slice(), UpAxis::Z).expect("a mesh");
    let (header, numbers) =
        pc2::read(&place.0.path().join(format!("{out}/sheet.pc2"))).expect("a cache");
    assert_eq!(header.vertex_count as usize, content.positions.len());
    let samples = numbers.chunks_exact(3 * header.vertex_count as usize);
    let at = |sample: &[f32], v: u32| [0, 1, 2].map(|axis| sample[3 * v as usize + axis].to_bits());
    samples.map(|sample| content.mesh.faces().flatten().map(|&v| at(sample, v)).collect()).collect()
}

#[test]
fn a_torn_cloth_is_left_with_all_its_vertices_and_the_same_whether_stopped_or_not() {
    let place = Place::new(TORN);
    whole(&place.request("at_once"));
    let at_once = played(&place, "at_once");
    assert_eq!(at_once.len(), 16);
    // Row 4 of 7 columns has opened at frame 6: its corners below and above are in two places from frame 7 on.
    let object = place.bytes("at_once/sheet.obj");
    let content = obj::read(object.as_slice(), UpAxis::Z).expect("a mesh");
    assert!(content.positions.len() >= 63 + 7, "{}", content.positions.len());
    for frame in [3, 9] {
        stopped_at(&place.request("in_parts"), frame);
        let parts = played(&place, "in_parts");
        assert_eq!(parts[..], at_once[..frame as usize]);
        whole(&Request { resume: true, ..place.request("in_parts") });
        assert_eq!(played(&place, "in_parts"), at_once);
        assert_eq!(place.bytes("in_parts/sheet.pc2"), place.bytes("at_once/sheet.pc2"));
        assert_eq!(place.bytes("in_parts/sheet.obj"), place.bytes("at_once/sheet.obj"));
        assert_eq!(place.hashes("in_parts"), place.hashes("at_once"));
    }
}

#[test]
fn a_bake_that_would_write_over_its_own_mesh_is_refused_and_loses_nothing() {
    let scene = TORN.replace(
        r#"grid = { size = [1, 1], vertices = [7, 9], plane = "xz" }"#,
        r#"mesh = "sheet.obj""#,
    );
    let place = Place::new(
        scene.replace(r#"pins = ["top"]"#, "").split("[cloth.tear]").next().expect("a scene"),
    );
    let mesh = "# mine\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    std::fs::write(place.0.path().join("sheet.obj"), mesh).expect("room");
    let error = bake(&place.request("."), &mut |_| ControlFlow::Continue(())).expect_err("refused");
    let message = error.to_string();
    assert!(
        message.contains("cloth.sheet.mesh = \"sheet.obj\"; accepted: a file that the bake"),
        "{message}"
    );
    assert_eq!(place.bytes("sheet.obj"), mesh.as_bytes());
    assert!(!place.0.path().join("report.json").exists());
    whole(&place.request("out"));
    assert_eq!(place.bytes("sheet.obj"), mesh.as_bytes());
}

#[test]
fn the_corners_of_a_bake_that_tore_go_with_the_next_that_does_not() {
    let place = Place::new(TORN);
    whole(&place.request("out"));
    let corners = place.0.path().join("out/sheet.corners.pc2");
    assert!(corners.exists());
    let changed =
        Request { overrides: vec!["tear.enabled=false".to_owned()], ..place.request("out") };
    whole(&changed);
    assert!(!corners.exists());
    assert_eq!(played(&place, "out").len(), 16);
}
