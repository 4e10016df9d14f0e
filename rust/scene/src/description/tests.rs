use super::*;

const GOOD: &str = r#"
[scene]
frames = [1, 10]
[[cloth]]
name = "flag"
grid = { size = [2, 1.0], vertices = [5, 4], plane = "xz", center = [0, 0, 0] }
transform = { location = [0, 0, 0], rotation_deg = [0, 0, 0], scale = 1 }
density = 0.2
pins = ["top_left", { vertices = [1, 2], release = 5 }]
model = "springs"
[cloth.springs]
stretch = 500
damping = 1.0
damping_bend = 0.5
limiter = "provot"
[solver]
integrator = "rk4"
substeps = 8
[[force]]
kind = "wind"
velocity = [0, 3, 0]
coefficient = 0.02
region = { box = [[0, 0, 0], [1, 1, 1]] }
"#;

fn refusal(text: &str) -> String {
    Scene::from_toml(text, &[]).expect_err(text).to_string()
}

/// The refusal of a good scene with one override.
fn refused(change: &str) -> String {
    Scene::from_toml(GOOD, &[change.to_owned()]).expect_err(change).to_string()
}

#[test]
fn a_scene_is_read_with_its_values_and_defaults() {
    let scene = Scene::from_toml(GOOD, &[]).expect("a good scene");
    let cloth = &scene.cloth[0];
    let material = cloth.springs.material(1.0);
    let bits = |numbers: [f64; 3]| numbers.map(f64::to_bits);
    assert_eq!(bits(material.stiffness), bits([500.0, 100.0, 5.0]));
    assert_eq!(bits(material.damping), bits([1.0, 1.0, 0.5]));
    assert_eq!(cloth.pins.groups.len(), 2);
    assert_eq!(cloth.pins.groups[1].release, Some(5));
    assert_eq!(scene.solver.integrator, boucle_solver::IntegratorKind::Rk4);
    assert!((scene.scene.fps - 24.0).abs() < f64::EPSILON);
    assert!(scene.force[0].region.as_ref().is_some_and(|region| region.r#box.is_some()));
}

#[test]
fn the_words_of_implicit_integrators_are_read_and_bdf2_is_the_default() {
    let solver = |changes: &[&str]| {
        let changes: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
        Scene::from_toml(GOOD, &changes).expect("a good scene")
    };
    let scene = solver(&[
        "solver.integrator=implicit_euler",
        "solver.substeps=auto",
        "solver.tolerance=1e-3",
        "solver.linear_solver=ldlt",
        "cloth.0.springs.stiffness_from=continuum",
    ]);
    assert_eq!(scene.solver.integrator, boucle_solver::IntegratorKind::ImplicitEuler);
    assert_eq!(scene.solver.tolerance, Some(1e-3));
    assert_eq!(scene.solver.linear_solver, boucle_solver::LinearSolver::Ldlt);
    let material = scene.cloth[0].springs.material(1.0);
    assert_eq!(material.stiffness_from, boucle_solver::StiffnessFrom::Continuum);
    let bare = "[[cloth]]\nname = \"a\"\ngrid = { size = [1, 1], vertices = [2, 2] }\n";
    let scene = Scene::from_toml(bare, &[]).expect("a good scene");
    assert_eq!(scene.solver.integrator, boucle_solver::IntegratorKind::Bdf2);
    assert_eq!(scene.solver.tolerance, None);
}

#[test]
fn json_reads_as_toml_does_and_null_is_a_missing_key() {
    let table: toml::Table = GOOD.parse().expect("good TOML");
    let mut json = serde_json::to_value(&table).expect("every value has JSON");
    json["solver"]["time_step"] = serde_json::Value::Null;
    let from_json = Scene::from_json(&json.to_string()).expect("a good scene");
    let from_toml = Scene::from_toml(GOOD, &[]).expect("a good scene");
    let text = |scene: &Scene| serde_json::to_string(scene).expect("every scene has JSON");
    assert_eq!(text(&from_json), text(&from_toml));
    for (text, expected) in [
        ("{", "not JSON"),
        ("[1]", "the scene = [1]; accepted: a table"),
        (r#"{"cloth": [null]}"#, "cloth.0 = null"),
        (r#"{"cloth": [{"nam": "a"}]}"#, "cloth.0.nam is an unknown key; did you mean \"name\"?"),
    ] {
        let error = Scene::from_json(text).expect_err(text).to_string();
        assert!(error.contains(expected), "{error}");
        assert!(!error.contains('\n'), "{error}");
    }
}

#[test]
fn unknown_keys_are_refused_by_name_with_what_was_perhaps_meant() {
    for (change, expected) in [
        ("cloth.0.densty=1", "cloth.flag.densty is an unknown key; did you mean \"density\"?"),
        (
            "cloth.0.springs.shaer=1",
            "cloth.flag.springs.shaer is an unknown key; did you mean \"shear\"?",
        ),
        ("scene.zzz=1", "scene.zzz is an unknown key; accepted: frames, fps, gravity"),
        ("solvr.substeps=1", "solvr is an unknown key; did you mean \"solver\"?"),
        ("cloth.0.grid.sizes=1", "cloth.flag.grid.sizes is an unknown key"),
        ("cloth.0.pins.1.vertex=1", "cloth.flag.pins.1.vertex is an unknown key"),
        ("force.0.region.boxes=1", "force.0.region.boxes is an unknown key"),
        ("collision.slef=true", "collision.slef is an unknown key; did you mean \"self\"?"),
        ("name.name=1", "name is an unknown key"),
        ("scene.scene=1", "scene.scene is an unknown key"),
    ] {
        let error = refused(change);
        assert!(error.starts_with(expected), "{error} for {change}");
    }
}

#[test]
fn keys_of_later_versions_are_refused_by_name() {
    for key in ["enabled", "force", "strain"] {
        assert_eq!(refused(&format!("tear.{key}=1")), format!("tear.{key} is not supported yet"));
    }
    assert_eq!(refusal(&format!("[tear]\n{GOOD}")), "tear is not supported yet");
}

/// An override of the good scene, and how its refusal begins.
const WRONG_VALUES: &[(&str, &str)] = &[
    ("scene.fps=\"fast\"", "scene.fps = \"fast\"; accepted: a number"),
    ("scene.fps=0", "scene.fps = 0.0; accepted: 0.01 to 1e6"),
    ("scene.fps=nan", "scene.fps = NaN; accepted"),
    ("scene.gravity=[0, 0, -inf]", "scene.gravity.2 = -inf; accepted"),
    ("scene.gravity=[0, 0]", "scene.gravity = [0, 0]; accepted: 3 numbers"),
    ("scene.gravity=9.81", "scene.gravity = 9.81; accepted: 3 numbers"),
    ("scene.frames=[10, 1]", "scene.frames = [10, 1]; accepted"),
    ("scene.frames=[1.5, 3]", "scene.frames.0 = 1.5; accepted: a whole number"),
    ("scene.frames=[1, 99999999999]", "scene.frames.1 = 99999999999; accepted: a whole number"),
    ("scene.frames=[1, 2000000]", "scene.frames.1 = 2000000; accepted"),
    ("cloth.0.name=\"\"", "cloth..name = \"\"; accepted: a name"),
    ("cloth.0.name=3", "cloth.0.name = 3; accepted: text in quotes"),
    ("cloth.0.density=-1", "cloth.flag.density = -1.0; accepted: above 0"),
    ("cloth.0.density=1e300", "cloth.flag.density = 1e300; accepted: above 0"),
    ("cloth.0.density=true", "cloth.flag.density = true; accepted: a number"),
    ("cloth.0.mass_per_vertex=0", "cloth.flag.mass_per_vertex = 0.0; accepted: above 0"),
    ("cloth.0.grid.size=[0, 1]", "cloth.flag.grid.size.0 = 0.0; accepted"),
    ("cloth.0.grid.vertices=[1, 5]", "cloth.flag.grid.vertices.0 = 1; accepted: 2 or more"),
    (
        "cloth.0.grid.vertices=[-4, 5]",
        "cloth.flag.grid.vertices.0 = -4; accepted: a whole number from 0",
    ),
    (
        "cloth.0.grid.vertices=[4000, 2500]",
        "cloth.flag.grid.vertices: 10000000 vertices; accepted: at most 4000000",
    ),
    ("cloth.0.grid.vertices=[4294967295, 4294967295]", "cloth.flag.grid.vertices: 184467"),
    ("cloth.0.grid.plane=zx", "cloth.flag.grid.plane = \"zx\"; accepted: \"xy\", \"xz\", \"yz\""),
    ("cloth.0.transform.scale=0", "cloth.flag.transform.scale = 0.0; accepted: above 0"),
    ("cloth.0.up=y", "cloth.flag.up: accepted only with mesh"),
    ("cloth.0.springs.stretch=-5", "cloth.flag.springs.stretch (N/m) is -5; accepted"),
    (
        "cloth.0.springs.deformation_rate=10",
        "cloth.flag.springs.deformation_rate is 10; accepted: 0 to below 1, as a fraction (did you mean 0.10",
    ),
    (
        "cloth.0.springs.limiter=projct",
        "cloth.flag.springs.limiter = \"projct\"; accepted: \"none\", \"stiffen\", \"provot\", \"project\" (did you mean \"project\"?)",
    ),
    (
        "cloth.0.springs.damping_law=3",
        "cloth.flag.springs.damping_law = 3; accepted: text in quotes",
    ),
    ("cloth.0.springs=5", "cloth.flag.springs = 5; accepted: a table"),
    ("cloth.0.pins=5", "cloth.flag.pins = 5; accepted: a list of names and tables, or one table"),
    (
        "cloth.0.pins=[5]",
        "cloth.flag.pins.0 = 5; accepted: a name such as \"top_left\", or a table",
    ),
    (
        "cloth.0.pins={vertices=[-1]}",
        "cloth.flag.pins.vertices.0 = -1; accepted: a whole number from 0",
    ),
    ("cloth.0.pins={near=[0,0,0]}", "cloth.flag.pins.radius is missing"),
    ("cloth.0.pins={radius=1}", "cloth.flag.pins accepts one of"),
    ("cloth.0.pins={near=[0,0,0], radius=-1}", "cloth.flag.pins.radius = -1.0; accepted"),
    ("cloth.0.pins=[{}]", "cloth.flag.pins.0 accepts one of"),
    ("cloth.0.pins.1.weight=2", "cloth.flag.pins.1.weight = 2.0; accepted: 0 to 1"),
    (
        "cloth.0.pins={vertices=[0, 1], weights=[1, nan]}",
        "cloth.flag.pins.weights.1 = NaN; accepted: 0 to 1",
    ),
    (
        "cloth.0.pins={vertices=[0, 1], weights=[1]}",
        "the length of cloth.flag.pins.weights = 1; accepted: 2, one for each of vertices",
    ),
    ("cloth.0.pin_stiffness=-1", "cloth.flag.pin_stiffness (N/m) is -1; accepted: 0 to 1e12"),
    ("cloth.0.pin_damping=nan", "cloth.flag.pin_damping is NaN; accepted: 0 to 1e12"),
    (
        "cloth.0.pins.1.motion=[{frame=3},{frame=3}]",
        "cloth.flag.pins.1.motion.1.frame = 3; accepted: a frame after 3",
    ),
    ("cloth.0.pins.1.motion=[{location=[0,0,0]}]", "cloth.flag.pins.1.motion.0.frame is missing"),
    (
        "cloth.0.pins.1.motion=[{frame=3, location=[0, 0, nan]}]",
        "cloth.flag.pins.1.motion.0.location.2 = NaN",
    ),
    ("solver.substeps=0", "solver.substeps = 0; accepted: \"auto\", or a whole number from 1"),
    ("solver.substeps=2.5", "solver.substeps = 2.5; accepted: \"auto\""),
    ("solver.substeps=fast", "solver.substeps = \"fast\"; accepted: \"auto\""),
    ("solver.time_step=-1", "solver.time_step = -1.0; accepted: above 0"),
    ("solver.time_step=1e-12", "solver.time_step = 1e-12; accepted: at least"),
    ("solver.allow_unstable=1", "solver.allow_unstable = 1; accepted: true or false"),
    (
        "solver.integrator=rk5",
        "solver.integrator = \"rk5\"; accepted: \"bdf2\", \"implicit_euler\", ",
    ),
    ("solver.tolerance=0", "solver.tolerance = 0.0; accepted: 1e-6 to 1"),
    ("solver.tolerance=1.5", "solver.tolerance = 1.5; accepted: 1e-6 to 1"),
    ("solver.tolerance=nan", "solver.tolerance = NaN; accepted: 1e-6 to 1"),
    (
        "solver.linear_solver=multgrid",
        "solver.linear_solver = \"multgrid\"; accepted: \"auto\", \"ldlt\", \"multigrid\" (did you mean \"multigrid\"?)",
    ),
    (
        "cloth.0.springs.stiffness_from=mesh",
        "cloth.flag.springs.stiffness_from = \"mesh\"; accepted: \"springs\", \"continuum\"",
    ),
    ("force.0.velocity=[0, 1e9, 0]", "force.0.velocity.1 = 1000000000.0; accepted"),
    ("force.0.coefficient=-1", "force.0.coefficient = -1.0; accepted: 0 to 1e6"),
    ("force.0.region={}", "force.0.region accepts either box or vertices"),
    (
        "force.0.region={box=[[0,0,1],[1,1,0]]}",
        "force.0.region.box.1.2 = 0.0; accepted: 1.0 or more",
    ),
    (
        "cloth.0.transform=[[0,0,0],[0,0,0],1]",
        "cloth.flag.transform = [[0, 0, 0], [0, 0, 0], 1]; accepted: a table",
    ),
    ("cloth.0.grid=[]", "cloth.flag.grid = []; accepted: a table"),
    ("cloth.0.pins.1.motion=[[1]]", "cloth.flag.pins.1.motion.0 = [1]; accepted: a table"),
    ("solver=[]", "solver = []; accepted: a table"),
    ("force=3", "force = 3; accepted: a list"),
    ("cloth.0.velocity=[0, 0, nan]", "cloth.flag.velocity.2 = NaN; accepted: -1e4 to 1e4 m/s"),
    ("cloth.0.velocity=[0, 0, -1e5]", "cloth.flag.velocity.2 = -100000.0; accepted"),
    ("cloth.0.velocity=-30", "cloth.flag.velocity = -30; accepted: 3 numbers"),
    ("collision=[]", "collision = []; accepted: a table"),
    ("collision.self=1", "collision.self = 1; accepted: true or false"),
    ("collision.enabled=\"no\"", "collision.enabled = \"no\"; accepted: true or false"),
    ("collision.thickness=0", "collision.thickness = 0.0; accepted: above 0 to 1e2 m"),
    ("collision.thickness=nan", "collision.thickness = NaN; accepted"),
    ("collision.thickness=101", "collision.thickness = 101.0; accepted"),
    ("collision.friction=-0.1", "collision.friction = -0.1; accepted: 0 to 100"),
    ("collision.friction=inf", "collision.friction = inf; accepted: 0 to 100"),
    ("collision.colliders=[]", "collision.colliders is an unknown key; accepted: enabled, self"),
    ("cloth.0.collision=false", "cloth.flag.collision = false; accepted: a table"),
    ("cloth.0.collision.self=\"on\"", "cloth.flag.collision.self = \"on\"; accepted: true or"),
    ("cloth.0.collision.thickness=-1", "cloth.flag.collision.thickness = -1.0; accepted: above 0"),
    ("cloth.0.collision.friction=nan", "cloth.flag.collision.friction = NaN; accepted: 0 to 100"),
    ("cloth.0.collision.slef=true", "cloth.flag.collision.slef is an unknown key; did you mean"),
    (
        "cloth.0.collision.excluded_from_self=[-1]",
        "cloth.flag.collision.excluded_from_self.0 = -1; accepted: a whole number from 0",
    ),
    (
        "cloth.0.collision.colliders=[\"ball\"]",
        "cloth.flag.collision.colliders.0 = \"ball\"; accepted: names of colliders, of which",
    ),
    ("collider=3", "collider = 3; accepted: a list"),
    ("collider=[[1]]", "collider.0 = [1]; accepted: a table"),
    ("cloth=[]", "cloth is missing; accepted: one [[cloth]] or more"),
    ("cloth=[3]", "cloth.0 = 3; accepted: a table"),
];

#[test]
fn wrong_types_and_ranges_are_refused_with_key_value_and_what_is_accepted() {
    for (change, expected) in WRONG_VALUES {
        let error = refused(change);
        assert!(error.starts_with(expected), "{error} for {change}");
        assert!(!error.contains('\n'), "{error}");
    }
}

#[test]
fn keys_that_exclude_each_other_or_are_missing_are_refused() {
    for (from, to, expected) in [
        (
            "density = 0.2",
            "density = 0.2\nmass_per_vertex = 0.1",
            "cloth.flag: density and mass_per_vertex",
        ),
        ("density = 0.2", "mesh = \"a.obj\"", "cloth.flag: grid and mesh"),
        ("substeps = 8", "substeps = 8\ntime_step = 0.1", "solver: substeps and time_step"),
        (
            "coefficient = 0.02",
            "coefficient = 0.02\nair_density = 1.2",
            "force.0: coefficient and air_density",
        ),
        ("coefficient = 0.02", "", "force.0.coefficient is missing"),
        ("velocity = [0, 3, 0]", "", "force.0.velocity is missing"),
        ("kind = \"wind\"", "", "force.0.kind is missing"),
        ("name = \"flag\"", "", "cloth.0.name is missing"),
        ("size = [2, 1.0], ", "", "cloth.flag.grid.size is missing"),
    ] {
        let error = refusal(&GOOD.replace(from, to));
        assert!(error.starts_with(expected), "{error} for {to}");
    }
    let twins = format!("{GOOD}\n[[cloth]]\nname = \"Flag\"\nmesh = \"a.obj\"\n");
    assert!(refusal(&twins).starts_with("cloth.1.name = \"Flag\"; accepted: a name that no other"));
    assert!(refusal("").starts_with("cloth is missing"));
}

#[test]
fn a_syntax_error_is_told_with_its_line_in_one_line() {
    for text in ["[scene\n", "a = \n", "[scene]\nfps = 24\nfps = 25\n", "x = \"unclosed\n", "{}"] {
        let error = refusal(text);
        assert!(error.starts_with("line "), "{error}");
        assert!(!error.contains('\n') && error.ends_with("accepted: TOML"), "{error}");
    }
    assert!(refusal("[scene]\nfps = 24\nfps = 25\n").starts_with("line 3, column 1"));
}

const BALL: &str = "[[collider]]\nname = \"ball\"\n";

/// The refusal of the good scene with a collider that is a ball and has these keys besides.
fn refused_ball(keys: &str) -> String {
    refusal(&format!("{GOOD}{BALL}sphere = {{ center = [0, 0, 0], radius = 0.5 }}\n{keys}\n"))
}

#[test]
fn cloth_collides_unless_it_is_told_not_to() {
    let collision = |changes: &[&str]| {
        let changes: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
        let scene = Scene::from_toml(GOOD, &changes).expect("a good scene");
        let own = &scene.cloth[0].collision;
        let preset = scene.cloth[0].named_fabric();
        let names: [&[&str]; 2] = [&["a", "b"], &[]];
        own.collision(&scene.collision, preset, names, 20, "at").expect("good vertices")
    };
    assert_eq!(collision(&[]), Some(boucle_solver::Collision::default()));
    assert_eq!(collision(&["collision.enabled=false"]), None);
    assert_eq!(collision(&["cloth.0.collision.enabled=false"]), None);
    let both = ["collision.enabled=false", "cloth.0.collision.enabled=true"];
    assert_eq!(collision(&both), Some(boucle_solver::Collision::default()));
    let general = ["collision.self=false", "collision.thickness=0.01", "collision.friction=0.7"];
    let expected = boucle_solver::Collision {
        with_self: false,
        thickness: 0.01,
        friction: 0.7,
        ..boucle_solver::Collision::default()
    };
    assert_eq!(collision(&general), Some(expected.clone()));
    let own = [&general[..], &["cloth.0.collision.friction=0", "cloth.0.collision.self=true"]];
    let expected = boucle_solver::Collision { with_self: true, friction: 0.0, ..expected };
    assert_eq!(collision(&own.concat()), Some(expected.clone()));
    let named = [&own.concat()[..], &["cloth.0.springs.preset=denim"]].concat();
    assert_eq!(collision(&named), Some(expected), "what the scene says comes before the preset");
    let denim = &crate::fabric_presets()["denim"];
    let expected = boucle_solver::Collision {
        thickness: 0.5 * denim.thickness,
        friction: denim.friction,
        ..boucle_solver::Collision::default()
    };
    for model in ["springs", "fabric"] {
        let named = format!("cloth.0.{model}.preset=denim");
        let model = format!("cloth.0.model={model}");
        assert_eq!(collision(&[&named, &model]), Some(expected.clone()));
    }
}

#[test]
fn excluded_vertices_must_be_there() {
    for key in ["excluded_from_self", "excluded_from_colliders"] {
        let change = format!("cloth.0.collision.{key}=[3, 20]");
        let scene = Scene::from_toml(GOOD, &[change]).expect("the mesh is not known yet");
        let own = &scene.cloth[0].collision;
        let met = |count| {
            own.collision(&scene.collision, None, [&[], &[]], count, "cloth.flag.collision")
        };
        let error = met(20).expect_err("vertex 20 of 20").to_string();
        assert_eq!(error, format!("cloth.flag.collision.{key}.1 = 20; accepted: 0 to 19"));
        assert!(met(21).is_ok());
    }
}

#[test]
fn a_cloth_may_name_the_colliders_that_it_meets() {
    let colliders = format!(
        "{GOOD}{BALL}sphere = {{ center = [0, 0, 0], radius = 0.5 }}\n\
         [[collider]]\nname = \"floor\"\nplane = {{ point = [0, 0, 0], normal = [0, 0, 3] }}\n"
    );
    let read = |names: &str| {
        Scene::from_toml(&colliders, &[format!("cloth.0.collision.colliders={names}")])
    };
    let scene = read("[\"floor\"]").expect("a good scene");
    let own = &scene.cloth[0].collision;
    let collision =
        own.collision(&scene.collision, None, [&["ball", "floor"], &[]], 20, "").expect("good");
    assert_eq!(collision.and_then(|collision| collision.colliders), Some(vec![1]));
    let error = read("[\"flor\"]").expect_err("no such collider").to_string();
    let expected = "cloth.flag.collision.colliders.0 = \"flor\"; accepted: \"ball\", \"floor\"";
    assert_eq!(error, expected);
}

#[test]
fn a_cloth_may_name_the_cloths_that_it_meets_and_a_wind_the_one_that_it_blows_on() {
    let read = |changes: &[&str]| {
        let changes: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
        Scene::from_toml(GOOD, &changes)
    };
    let scene = read(&["cloth.0.collision.cloths=[\"flag\"]"]).expect("a good scene");
    let own = &scene.cloth[0].collision;
    let collision = own.collision(&scene.collision, None, [&[], &["other", "flag"]], 20, "");
    assert_eq!(collision.expect("good").and_then(|collision| collision.cloths), Some(vec![1]));
    let region = "force.0.region={cloth=\"flag\", vertices=[3]}";
    let scene = read(&[region]).expect("a good scene");
    let region = scene.force[0].region.as_ref().expect("a region");
    assert_eq!(
        (region.cloth.as_deref(), region.vertices.as_deref()),
        (Some("flag"), Some(&[3][..]))
    );
    assert!(read(&["force.0.region={cloth=\"flag\"}"]).is_ok());
    for (change, expected) in [
        (
            "cloth.0.collision.cloths=[\"flga\"]",
            "cloth.flag.collision.cloths.0 = \"flga\"; accepted: \"flag\"",
        ),
        ("force.0.region={cloth=\"flga\"}", "force.0.region.cloth = \"flga\"; accepted: \"flag\""),
        (
            "force.0.region={cloth=\"flag\", box=[[0,0,0],[1,1,1]]}",
            "force.0.region accepts either box or vertices, cloth or both",
        ),
    ] {
        assert_eq!(read(&[change]).expect_err(change).to_string(), expected);
    }
}

#[test]
fn wrong_colliders_are_refused_by_their_name() {
    for (keys, expected) in [
        ("radius = 1", "collider.ball.radius is an unknown key"),
        ("mesh = \"a.obj\"", "collider.ball: sphere and mesh; accepted: one of sphere, plane, box"),
        ("friction = -1", "collider.ball.friction = -1.0; accepted: 0 to 100"),
        ("thickness = -0.1", "collider.ball.thickness = -0.1; accepted: 0 to 100 m"),
        ("thickness = nan", "collider.ball.thickness = NaN; accepted: 0 to 100 m"),
        ("up = \"y\"", "collider.ball.up: accepted only with mesh"),
        ("cache = \"a.pc2\"", "collider.ball.cache: accepted only with mesh"),
        ("transform = { scale = 0 }", "collider.ball.transform.scale = 0.0; accepted: above 0"),
        ("motion = [{ location = [0, 0, 0] }]", "collider.ball.motion.0.frame is missing"),
        (
            "motion = [{ frame = 2 }, { frame = 1 }]",
            "collider.ball.motion.1.frame = 1; accepted: a frame after 2",
        ),
        (
            "motion = [{ frame = 2, location = [nan, 0, 0] }]",
            "collider.ball.motion.0.location.0 = NaN; accepted",
        ),
        (BALL, "collider.1.name = \"ball\"; accepted: a name that no other collider has"),
    ] {
        let error = refused_ball(keys);
        assert!(error.starts_with(expected), "{error} for {keys}");
        assert!(!error.contains('\n'), "{error}");
    }
    let missing =
        format!("{GOOD}[[collider]]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}");
    assert_eq!(refusal(&missing), "collider.0.name is missing");
    let both = "mesh = \"a.obj\"\ncache = \"a.pc2\"\nmotion = [{ frame = 1 }]\n";
    let error = refusal(&format!("{GOOD}{BALL}{both}"));
    assert_eq!(error, "collider.ball: motion and cache; accepted: one of the two");
}

#[test]
fn wrong_shapes_are_refused_with_key_and_value() {
    for (shape, expected) in [
        ("sphere = { center = [0, 0, 0] }", "sphere.radius is missing"),
        ("sphere = { center = [0, 0, 0], radius = 0 }", "sphere.radius = 0.0; accepted: above 0"),
        ("sphere = { center = [0, 0, 0], radius = nan }", "sphere.radius = NaN; accepted: above 0"),
        ("sphere = { center = [0, inf, 0], radius = 1 }", "sphere.center.1 = inf; accepted"),
        ("sphere = { center = [0, 0], radius = 1 }", "sphere.center = [0, 0]; accepted: 3 numbers"),
        ("sphere = 1", "sphere = 1; accepted: a table"),
        ("plane = { point = [0, 0, 0] }", "plane.normal is missing"),
        (
            "plane = { point = [0, 0, 0], normal = [0, 0, 0] }",
            "plane.normal = [0.0, 0.0, 0.0]; accepted: a vector with a length",
        ),
        ("plane = { point = [0, 0, 0], normal = [0, 0, nan] }", "plane.normal.2 = NaN; accepted"),
        ("box = { center = [0, 0, 0], size = [1, 0, 1] }", "box.size.1 = 0.0; accepted: above 0"),
        (
            "box = { center = [0, 0, 0], size = [1, 1, 1], rotation_deg = [inf, 0, 0] }",
            "box.rotation_deg.0 = inf; accepted",
        ),
        ("box = { center = [0, 0, 0], sizes = [1, 1, 1] }", "box.sizes is an unknown key; did you"),
        (
            "capsule = { a = [0, 0, 1], b = [0, 0, 1], radius = 1 }",
            "capsule.b = [0.0, 0.0, 1.0]; accepted: another point than a",
        ),
        ("capsule = { a = [0, 0, 1], b = [0, 0, 0], radius = -1 }", "capsule.radius = -1.0"),
        ("mesh = 3", "mesh = 3; accepted: text in quotes"),
    ] {
        let error = refusal(&format!("{GOOD}{BALL}{shape}\n"));
        assert!(error.starts_with(&format!("collider.ball.{expected}")), "{error} for {shape}");
    }
}

/// A scene with a second force.
fn with_force(keys: &str) -> Result<Scene> {
    Scene::from_toml(&format!("{GOOD}\n[[force]]\n{keys}\n"), &[])
}

#[test]
fn fields_are_read_with_their_values_and_defaults() {
    let keys = "kind = \"harmonic\"\nstrength = 2\nrest_length = 0.5\naxis = [1, 0, 0]\nshape = \"plane\"\n\
                falloff = { shape = \"cone\", side = \"negative\", power = 2, max = 3, radial_min = 10 }";
    let scene = with_force(keys).expect("a field");
    assert!(scene.force[0].field("").expect("a wind").is_none());
    let field = scene.force[1].field("force.1").expect("a field").expect("a field");
    let plain = Field::new(boucle_solver::FieldKind::Harmonic { rest_length: 0.5 }, 2.0);
    let range = |power, min, max| boucle_solver::Range { power, min, max };
    let falloff = boucle_solver::Falloff {
        shape: boucle_solver::FalloffShape::Cone,
        side: boucle_solver::Side::Negative,
        distance: range(2.0, None, Some(3.0)),
        radial: range(0.0, Some(10.0), None),
    };
    let (axis, shape) = ([1.0, 0.0, 0.0].into(), boucle_solver::FieldShape::Plane);
    assert_eq!(field, Field { axis, shape, falloff, ..plain });
    for (kind, _) in
        force::ForceKind::WORDS.iter().filter(|(word, _)| !["wind", "water"].contains(word))
    {
        let scene = with_force(&format!("kind = \"{kind}\"\nstrength = 1")).expect(kind);
        assert!(scene.force[1].field("").expect(kind).is_some());
    }
}

#[test]
fn a_field_refuses_keys_of_other_kinds_and_values_out_of_their_ranges() {
    for (keys, expected) in [
        ("kind = \"point\"", "force.1.strength is missing"),
        (
            "kind = \"point\"\nstrength = 1\nvelocity = [0, 0, 1]",
            "force.1.velocity is no key of \"point\"",
        ),
        (
            "kind = \"drag\"\nstrength = 1\nflow = 1",
            "force.1.flow is no key of \"drag\"; accepted: strength",
        ),
        ("kind = \"vortex\"\nstrength = 1\nsize = 1", "force.1.size is no key of \"vortex\""),
        ("kind = \"vortex\"\nstrength = inf", "force.1: force field: strength is inf; accepted"),
        (
            "kind = \"vortex\"\nstrength = 1\naxis = [0, 0, 0]",
            "force.1: force field: length of the axis is 0",
        ),
        (
            "kind = \"vortex\"\nstrength = 1\nshape = \"ring\"",
            "force.1.shape = \"ring\"; accepted: \"point\"",
        ),
        (
            "kind = \"wind\"\nvelocity = [0, 0, 1]\ncoefficient = 1\nstrength = 1",
            "force.1.strength is no key",
        ),
        ("kind = \"vortx\"\nstrength = 1", "force.1.kind = \"vortx\"; accepted"),
        (
            "kind = \"point\"\nstrength = 1\nfalloff = { powr = 1 }",
            "force.1.falloff.powr is an unknown key",
        ),
    ] {
        let error = with_force(keys).expect_err(keys).to_string();
        assert!(error.starts_with(expected), "{error} for {keys}");
    }
}

#[test]
fn fields_come_as_json_from_frame_to_frame() {
    let fields = fields_from_json(r#"[{"kind": "drag", "strength": 1, "damping": 0.5}]"#);
    assert_eq!(fields.expect("a field").len(), 1);
    assert!(fields_from_json("[]").expect("none").is_empty());
    for (text, expected) in [
        ("[", "the fields are not JSON"),
        ("{}", "force = {}; accepted: a list"),
        (r#"[{"kind": "drag"}]"#, "force.0.strength is missing"),
        (
            r#"[{"kind": "wind", "velocity": [0, 0, 1], "coefficient": 1}]"#,
            "force.0.kind = \"wind\" is no field",
        ),
    ] {
        let error = fields_from_json(text).expect_err(text).to_string();
        assert!(error.starts_with(expected), "{error}");
    }
}

#[test]
fn a_named_fabric_gives_what_the_scene_does_not_say() {
    let creased = ["fabric.yield_curvature=120", "fabric.bend_hysteresis=3e-4"];
    let changes =
        [&["model=fabric", "fabric.preset=denim", "fabric.shear=7"][..], &creased].concat();
    let changes: Vec<String> = changes.iter().map(|change| format!("cloth.0.{change}")).collect();
    let scene = Scene::from_toml(GOOD, &changes).expect("a good scene");
    let cloth = &scene.cloth[0];
    let denim = &crate::fabric_presets()["denim"];
    let fabric = cloth.fabric.fabric();
    let bits = |numbers: &[f64]| numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&[fabric.shear]), bits(&[7.0]));
    assert_eq!(bits(&fabric.stretch), bits(&[denim.stretch_warp, denim.stretch_weft]));
    let compression = [denim.compression_warp, denim.compression_weft].map(|of| of.expect("yarns"));
    assert_eq!(bits(&fabric.compression), bits(&compression));
    let rate = cloth.fabric.material().deformation_rate;
    assert_eq!(bits(&[rate]), bits(&[denim.deformation_rate]));
    let said = (fabric.yield_curvature, fabric.hardening, fabric.bend_hysteresis);
    assert_eq!(said, (Some(120.0), 0.0, 3e-4));
}

#[test]
fn fabrics_that_cannot_be_are_refused() {
    for (change, expected) in [
        ("cloth.0.fabric.preset=demin", "cloth.flag.fabric.preset = \"demin\""),
        ("cloth.0.fabric.stretch_warp=-1", "cloth.flag.fabric.stretch_warp (N/m)"),
        ("cloth.0.fabric.bend_weft=nan", "cloth.flag.fabric.bend_weft (N·m)"),
        ("cloth.0.fabric.yield_curvature=-1", "cloth.flag.fabric.yield_curvature (1/m) is -1; acc"),
        ("cloth.0.fabric.hardening=1", "cloth.flag.fabric.hardening is 1; accepted: 0 to 0.99"),
        ("cloth.0.fabric.bend_hysteresis=nan", "cloth.flag.fabric.bend_hysteresis (N·m/m) is NaN"),
        ("cloth.0.fabric.bend_hysteresis=-1", "cloth.flag.fabric.bend_hysteresis (N·m/m) is -1; a"),
        ("cloth.0.fabric.deformation_rate=1", "cloth.flag.fabric.deformation_rate"),
        ("cloth.0.fabric.limiter=stiffen", "cloth.flag.fabric.limiter = \"stiffen\""),
        ("cloth.0.fabric.warp=[0,0,0]", "cloth.flag.fabric.warp = [0, 0, 0]; accepted: a direc"),
        ("cloth.0.fabric.warp=vt", "cloth.flag.fabric.warp = \"vt\"; accepted: \"uv\", or 3 numb"),
        (
            "cloth.0.fabric.warp=[0,1]",
            "cloth.flag.fabric.warp = [0, 1]; accepted: \"uv\", or 3 num",
        ),
        ("cloth.0.fabric.warp=3", "cloth.flag.fabric.warp = 3; accepted: \"uv\", or 3 numbers"),
        ("cloth.0.fabric.warp=[0,true,1]", "cloth.flag.fabric.warp.1 = true; accepted: a number"),
        ("cloth.0.springs.preset=demin", "cloth.flag.springs.preset = \"demin\"; accepted: one of"),
    ] {
        let error = refused(change);
        assert!(error.starts_with(expected), "{error} for {change}");
    }
}

#[test]
fn springs_of_a_named_fabric_take_what_the_scene_does_not_say() {
    let material = |changes: &[&str]| {
        let changes: Vec<String> =
            changes.iter().map(|change| format!("cloth.0.springs.{change}")).collect();
        let bare = "[[cloth]]\nname = \"a\"\ngrid = { size = [1, 1], vertices = [2, 2] }\n";
        let scene = Scene::from_toml(bare, &changes).expect("a good scene");
        (scene.cloth[0].springs.material(0.02), scene.cloth[0].mass())
    };
    let denim = &crate::fabric_presets()["denim"];
    let lattice = denim.lattice(0.02);
    let (named, mass) = material(&["preset=denim"]);
    let expected = boucle_solver::SpringMaterial {
        stiffness: lattice.stiffness,
        stiffness_from: boucle_solver::StiffnessFrom::Continuum,
        damping: lattice.damping,
        damping_law: boucle_solver::DampingLaw::Axial,
        deformation_rate: denim.deformation_rate,
        ..boucle_solver::SpringMaterial::default()
    };
    assert_eq!(named, expected);
    assert_eq!(mass, boucle_solver::Mass::Density(denim.density));
    let (own, _) = material(&[
        "preset=denim",
        "shear=7",
        "damping=0.5",
        "damping_bend=0.1",
        "damping_law=relative",
        "stiffness_from=springs",
        "deformation_rate=0.2",
    ]);
    let [stretch, _, bend] = lattice.stiffness;
    let expected = boucle_solver::SpringMaterial {
        stiffness: [stretch, 7.0, bend],
        damping: [0.5, 0.5, 0.1],
        deformation_rate: 0.2,
        ..boucle_solver::SpringMaterial::default()
    };
    assert_eq!(own, expected);
}

#[test]
fn the_warp_is_a_direction_or_follows_the_map() {
    for (change, expected) in [
        ("warp=[1, 0, 2.5]", Some(WarpDescription::Along([1.0, 0.0, 2.5]))),
        ("warp=uv", Some(WarpDescription::Uv)),
        ("shear=1", None),
    ] {
        let change = format!("cloth.0.fabric.{change}");
        let scene = Scene::from_toml(GOOD, &[change]).expect("a good scene");
        assert_eq!(scene.cloth[0].fabric.warp, expected);
        let json = serde_json::to_value(expected).expect("it has JSON");
        let again: Option<WarpDescription> = serde_json::from_value(json).expect("what we wrote");
        assert_eq!(again, expected);
    }
}
