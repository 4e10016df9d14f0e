"""Wrong scenes and meshes: each ends with exit code 2 and one line that names the culprit."""

import json
import os
import re
import subprocess
import sys

import pytest

GOOD = """\
[scene]
frames = [1, 3]
fps = 24
gravity = [0.0, 0.0, -9.81]

[[cloth]]
name = "flag"
mesh = "flag.obj"
density = 0.2
pins = { vertices = [0] }

[cloth.springs]
stretch = 500.0
limiter = "project"

[solver]
substeps = "auto"
"""

QUADS = """\
v 0 0 0
v 1 0 0
v 2 0 0
v 0 1 0
v 1 1 0
v 2 1 0
f 1 2 5 4
f 2 3 6 5
"""

GRID = "grid = { size = [1, 1], vertices = [3, 3] }"
OBJ = 'mesh = "flag.obj"'
DENSITY = "density = 0.2"
PINS = "pins = { vertices = [0] }"
COLLIDER = '[[collider]]\nname = "ball"\nsphere = { center = [0, 0, 0], radius = 0.5 }\n'
WIND = '[[force]]\nkind = "wind"\nvelocity = [0, 3, 0]\ncoefficient = 0.02\n'

# fmt: off
# What is wrong, the text that is replaced in the good scene, what by, and what the complaint must hold.
SCENES = [
    # not a number, infinite, huge
    ("density nan", DENSITY, "density = nan", "cloth.flag.density = NaN; accepted: above 0"),
    ("density inf", DENSITY, "density = inf", "cloth.flag.density = inf"),
    ("density huge", DENSITY, "density = 1e300", "cloth.flag.density = 1e300"),
    ("integer huge", DENSITY, "density = 99999999999999999999", "line 9"),
    ("gravity nan", "-9.81]", "nan]", "scene.gravity.2 = NaN"),
    ("gravity huge", "-9.81]", "-1e200]", "scene.gravity.2 = -1e200"),
    ("stretch nan", "500.0", "nan", "cloth.flag.springs.stretch (N/m) is NaN"),
    ("stretch inf", "500.0", "inf", "cloth.flag.springs.stretch (N/m) is inf"),
    ("stretch huge", "500.0", "1e300", "cloth.flag.springs.stretch (N/m) is 1"),
    ("damping too strong to step", 'limiter = "project"\n\n[solver]', 'damping = 1e9\n[solver]\nintegrator = "verlet"',
     "solver: verlet needs"),
    ("tolerance too large", '"auto"', '"auto"\ntolerance = 2.0', "solver.tolerance = 2.0; accepted: 1e-6 to 1"),
    ("tolerance zero", '"auto"', '"auto"\ntolerance = 0.0', "solver.tolerance = 0.0; accepted: 1e-6 to 1"),
    ("unknown linear solver", '"auto"', '"auto"\nlinear_solver = "lu"', 'solver.linear_solver = "lu"; accepted: "auto"'),
    ("unknown stiffness", "500.0", '500.0\nstiffness_from = "cloth"', 'springs.stiffness_from = "cloth"; accepted: "springs"'),
    ("location huge", OBJ, OBJ + "\ntransform = { location = [1e30, 0, 0] }", "transform.location.0"),
    # negative, zero, out of range
    ("density negative", DENSITY, "density = -0.2", "cloth.flag.density = -0.2; accepted: above 0"),
    ("density zero", DENSITY, "density = 0", "cloth.flag.density = 0"),
    ("mass negative", DENSITY, "mass_per_vertex = -1", "cloth.flag.mass_per_vertex = -1"),
    ("stretch negative", "500.0", "-500.0", "cloth.flag.springs.stretch (N/m) is -500; accepted"),
    ("damping negative", "500.0", "500.0\ndamping = -1", "cloth.flag.springs.damping_stretch"),
    ("air damping negative", "500.0", "500.0\nair_damping = -1", "springs.air_damping"),
    ("rate in percent", "500.0", "500.0\ndeformation_rate = 10", "did you mean 0.10"),
    ("scale zero", OBJ, OBJ + "\ntransform = { scale = 0 }", "cloth.flag.transform.scale = 0"),
    ("fps zero", "fps = 24", "fps = 0", "scene.fps = 0.0; accepted: 0.01 to"),
    ("fps negative", "fps = 24", "fps = -24", "scene.fps = -24.0"),
    ("frames reversed", "[1, 3]", "[3, 1]", "scene.frames = [3, 1]; accepted: the first frame before"),
    ("frames beyond", "[1, 3]", "[1, 99999999]", "scene.frames.1 = 99999999; accepted"),
    ("substeps zero", '"auto"', "0", 'solver.substeps = 0; accepted: "auto"'),
    ("substeps unstable", '"auto"', '1\nintegrator = "symplectic_euler"', "solver: the step of"),
    ("time step zero", 'substeps = "auto"', "time_step = 0", "solver.time_step = 0"),
    ("time step tiny", 'substeps = "auto"', "time_step = 1e-30", "solver.time_step = 1e-30"),
    # wrong types
    ("density text", DENSITY, 'density = "heavy"', 'cloth.flag.density = "heavy"; accepted: a number'),
    ("density list", DENSITY, "density = [0.2]", "cloth.flag.density = [0.2]; accepted: a number"),
    ("density date", DENSITY, "density = 2026-01-01", "cloth.flag.density = 2026-01-01"),
    ("name number", '"flag"\n', "7\n", "cloth.0.name = 7; accepted: text in quotes"),
    ("gravity number", "[0.0, 0.0, -9.81]", "-9.81", "scene.gravity = -9.81; accepted: 3 numbers"),
    ("gravity short", "[0.0, 0.0, -9.81]", "[0, -9.81]", "scene.gravity = [0, -9.81]; accepted: 3"),
    ("frames fraction", "[1, 3]", "[1.5, 3]", "scene.frames.0 = 1.5; accepted: a whole number"),
    ("cloth table", "[[cloth]]", "[cloth]", "cloth = "),
    ("springs list", "[cloth.springs]", "[[cloth.springs]]", "cloth.flag.springs = "),
    ("mesh number", OBJ, "mesh = 3", "cloth.flag.mesh = 3; accepted: text in quotes"),
    ("unstable text", '"auto"', '"auto"\nallow_unstable = "yes"', "solver.allow_unstable = \"yes\""),
    # unknown words and keys
    ("unknown key", DENSITY, "densty = 0.2", 'cloth.flag.densty is an unknown key; did you mean "density"?'),
    ("unknown table", "[solver]", "[slover]", 'slover is an unknown key; did you mean "solver"?'),
    ("unknown spring key", "stretch =", "strength =", "cloth.flag.springs.strength is an unknown key"),
    ("unknown limiter", '"project"', '"projekt"', 'limiter = "projekt"; accepted: "none"'),
    ("unknown integrator", '"auto"', '"auto"\nintegrator = "rk5"', 'integrator = "rk5"; accepted'),
    ("unknown model", DENSITY, 'density = 0.2\nmodel = "rubber"', 'cloth.flag.model = "rubber"'),
    ("unknown plane", OBJ, GRID.replace("3] }", '3], plane = "xw" }'), 'grid.plane = "xw"; accepted'),
    ("unknown up", OBJ, OBJ + '\nup = "x"', 'cloth.flag.up = "x"; accepted: "z", "y"'),
    ("unknown force", "[solver]", WIND.replace("wind", "winde") + "[solver]", 'force.0.kind = "winde"'),
    ("key twice", "fps = 24", "fps = 24\nfps = 25", "line 4, column 1: duplicate key"),
    # missing and excluding
    ("no cloth", GOOD, "[scene]\nframes = [1, 2]\n", "cloth is missing"),
    ("empty file", GOOD, "", "cloth is missing"),
    ("no name", 'name = "flag"\n', "", "cloth.0.name is missing"),
    ("empty name", '"flag"\n', '""\n', 'name = ""; accepted: a name'),
    ("name with a slash", '"flag"\n', '"../flag"\n', 'cloth.0.name = "../flag"; accepted: a file name'),
    ("name twice", "[solver]", '[[cloth]]\nname = "flag"\n' + GRID + "\n[solver]", "cloth.1.name"),
    ("no shape", OBJ + "\n", "", "cloth.flag.grid is missing; accepted: it or mesh"),
    ("two shapes", OBJ, OBJ + "\n" + GRID, "cloth.flag: grid and mesh; accepted: one"),
    ("two masses", DENSITY, DENSITY + "\nmass_per_vertex = 0.1", "density and mass_per_vertex"),
    ("two steps", '"auto"', '"auto"\ntime_step = 0.001', "solver: substeps and time_step"),
    ("wind without law", "[solver]", WIND.replace("coefficient = 0.02\n", "") + "[solver]", "force.0.coe"),
    ("wind region reversed", "[solver]", WIND + "region = { box = [[1, 0, 0], [0, 1, 1]] }\n[solver]",
     "force.0.region.box.1.0 = 0.0; accepted: 1.0 or more"),
    ("wind region vertex", "[solver]", WIND + "region = { vertices = [99] }\n[solver]", "vertex 99"),
    # grids
    ("ten million vertices", OBJ, GRID.replace("[3, 3]", "[4000, 2500]"), "10000000 vertices; accepted"),
    ("ten million in two", OBJ, GRID.replace("[3, 3]", "[2000, 1500]") + '\n[[cloth]]\nname = "b"\n'
     + GRID.replace("[3, 3]", "[2000, 1500]"), "6000000 vertices; accepted: at most 4000000"),
    ("overflowing grid", OBJ, GRID.replace("[3, 3]", "[4294967295, 4294967295]"), "grid.vertices"),
    ("a million by a million", OBJ, GRID.replace("[3, 3]", "[1000000, 1000000]"),
     "cloth.flag.grid.vertices: 1000000000000 vertices; accepted: at most 4000000 a scene"),
    ("grid of one row", OBJ, GRID.replace("[3, 3]", "[3, 1]"), "grid.vertices.1 = 1; accepted: 2"),
    ("grid of negative size", OBJ, GRID.replace("[1, 1]", "[1, -1]"), "grid.size.1 = -1"),
    ("grid without size", OBJ, "grid = { vertices = [3, 3] }", "cloth.flag.grid.size is missing"),
    ("grid as list", OBJ, "grid = [[1, 1], [3, 3]]", "cloth.flag.grid = [[1, 1], [3, 3]]; accepted"),
    # pins
    ("pin out of range", "[0] }", "[6] }", "cloth.flag.pins.vertices.0 = 6; accepted: 0 to 5"),
    ("pin negative", "[0] }", "[-1] }", "cloth.flag.pins.vertices.0 = -1; accepted: a whole number"),
    ("pin by name on a mesh", PINS, 'pins = ["top"]', 'cloth.flag.pins.0 = "top"; accepted: names only'),
    ("pin by wrong name", OBJ + "\n" + DENSITY + "\n" + PINS, GRID + '\npins = ["topp"]',
     'cloth.flag.pins.0 = "topp"; accepted: top_left'),
    ("pin near nothing", PINS, "pins = { near = [9, 9, 9], radius = 0.1 }", "cloth.flag.pins.near = "),
    ("pin without radius", PINS, "pins = { near = [0, 0, 0] }", "cloth.flag.pins.radius is missing"),
    ("pin motion reversed", "[0] }", "[0], motion = [{ frame = 5 }, { frame = 2 }] }",
     "cloth.flag.pins.motion.1.frame = 2; accepted: a frame after 5"),
    ("pin weight", "[0] }", "[0], weight = 1.5 }", "cloth.flag.pins.weight = 1.5; accepted: 0 to 1"),
    ("pin weights", "[0] }", "[0], weights = [1, 1] }", "the length of cloth.flag.pins.weights = 2; accepted: 1, one"),
    ("pin stiffness", DENSITY, DENSITY + "\npin_stiffness = -5", "cloth.flag.pin_stiffness (N/m) is -5; accepted: 0 to"),
    # what collides
    ("thickness zero", "[solver]", "[collision]\nthickness = 0\n[solver]", "collision.thickness = 0.0; accepted: above 0"),
    ("friction nan", "[solver]", "[collision]\nfriction = nan\n[solver]", "collision.friction = NaN; accepted: 0 to 100"),
    ("self number", "[solver]", "[collision]\nself = 1\n[solver]", "collision.self = 1; accepted: true or false"),
    ("unknown collision", "[solver]", "[collision]\nslef = true\n[solver]",
     'collision.slef is an unknown key; did you mean "self"?'),
    ("excluded vertex", "[solver]", "[cloth.collision]\nexcluded_from_self = [6]\n[solver]",
     "cloth.flag.collision.excluded_from_self.0 = 6; accepted: 0 to 5"),
    ("unknown collider", "[solver]", '[cloth.collision]\ncolliders = ["bal"]\n' + COLLIDER + "[solver]",
     'cloth.flag.collision.colliders.0 = "bal"; accepted: "ball"'),
    ("collider twice", "[solver]", COLLIDER + COLLIDER + "[solver]",
     'collider.1.name = "ball"; accepted: a name that no other'),
    ("collider radius", "[solver]", COLLIDER.replace("0.5", "-0.5") + "[solver]",
     "collider.ball.sphere.radius = -0.5; accepted"),
    ("two colliders", "[solver]", COLLIDER + 'mesh = "flag.obj"\n[solver]', "collider.ball: sphere and mesh; accepted: one of"),
    ("no collider", "[solver]", '[[collider]]\nname = "ball"\n[solver]', "collider.ball has no shape; accepted: one of sphere"),
    ("collider file", "[solver]", '[[collider]]\nname = "ball"\nmesh = "no.obj"\n[solver]',
     'collider.ball.mesh = "no.obj": it cannot be read: No such file'),
    ("collider cache", "[solver]", '[[collider]]\nname = "ball"\nmesh = "flag.obj"\ncache = "no.pc2"\n[solver]',
     'collider.ball.cache = "no.pc2": it cannot be read: No such file'),
    ("collider no cache", "[solver]", '[[collider]]\nname = "ball"\nmesh = "flag.obj"\ncache = "flag.obj"\n[solver]',
     'collider.ball.cache = "flag.obj": it is no point cache; accepted: a POINTCACHE2 file'),
    ("velocity huge", DENSITY, DENSITY + "\nvelocity = [0, 0, -1e9]", "cloth.flag.velocity.2 = -1000000000.0; accepted"),
    # files elsewhere
    ("mesh out of the folder", OBJ, 'mesh = "../flag.obj"',
     'cloth.flag.mesh = "../flag.obj": it leads out of the scene\'s folder; accepted: a file in that folder'),
    ("rest out of the folder", OBJ, OBJ + '\nrest = "a/../../flag.obj"', "it leads out of the scene's folder"),
    ("collider out of the folder", "[solver]", '[[collider]]\nname = "ball"\nmesh = "./../a.obj"\n[solver]',
     'collider.ball.mesh = "./../a.obj": it leads out of the scene\'s folder'),
    ("cache out of the folder", "[solver]",
     '[[collider]]\nname = "ball"\nmesh = "flag.obj"\ncache = "../../etc/passwd"\n[solver]',
     'collider.ball.cache = "../../etc/passwd": it leads out'),
    # syntax
    ("unclosed table", "[solver]", "[solver", "line 16"),
    ("unclosed text", '"flag"\n', '"flag\n', "line 7"),
    ("no value", "fps = 24", "fps =", "line 3"),
    ("not TOML at all", GOOD, "<html>\n<body>hello</body>\n</html>\n", "line 1"),
    # fabric
    ("other model", DENSITY, 'density = 0.2\nmodel = "felt"', 'cloth.flag.model = "felt"; accepted: "springs", "fabric"'),
    ("fabric shear", "[solver]", "[cloth.fabric]\nshear = -100.0\n[solver]", "cloth.flag.fabric.shear (N/m)"),
    ("fabric preset", "[solver]", '[cloth.fabric]\npreset = "demin"\n[solver]', 'cloth.flag.fabric.preset = "demin"'),
    ("fabric warp", "[solver]", "[cloth.fabric]\nwarp = [0, 0, 0]\n[solver]", "cloth.flag.fabric.warp = [0, 0, 0]"),
    # tearing
    ("tear force", "[solver]", "[tear]\nforce = -1\n[solver]", "tear.force = -1.0; accepted: 0 to 1e12"),
    ("tear without a threshold", "[solver]", "[tear]\nenabled = true\n[solver]",
     "cloth.flag.tear.enabled = true, but nothing says when it tears"),
    ("tear of no edge", "[solver]", "[cloth.tear]\nenabled = true\nopenings = [{ frame = 2, pairs = [[1, 1]] }]\n[solver]",
     "vertices 1 and 1 are to part"),
    # water
    ("strength of water", "[solver]", '[[force]]\nkind = "water"\nstrength = 1\n[solver]',
     'force.0.strength is no key of "water"'),
    ("bulk density", "[solver]", "[cloth.water]\nbulk_density = 0\n[solver]",
     'cloth "flag": bulk_density (kg/m³) in water is 0; accepted: 1 to 1e5'),
    ("hull with a border", "[solver]", "[cloth.water]\nhull = true\n[solver]", "hull is true, but its mesh has a border"),
]

# What is wrong with the mesh file, its content (None: there is none), and what the complaint must hold.
MESHES = [
    ("missing", None, "flag.obj\": it cannot be read: No such file"),
    ("empty", "", "there are no vertices"),
    ("no faces", QUADS[: QUADS.index("f")], "there are no faces"),
    ("truncated vertex", QUADS[: QUADS.index("v 2 1") + 3], "line 6: a vertex with 1 coordinates"),
    ("truncated face", QUADS[: QUADS.rindex(" 3 6 5")], "line 8: a face with 1 corners"),
    ("truncated faces", QUADS[: QUADS.rindex("f")], "vertex 2 (from 0; line 3) is used by no face"),
    ("nan", QUADS.replace("v 2 1 0", "v 2 nan 0"), "line 6: coordinate nan"),
    ("inf", QUADS.replace("v 2 1 0", "v 2 -inf 0"), "line 6: coordinate -inf"),
    ("huge", QUADS.replace("v 2 1 0", "v 2 1e300 0"), "line 6: coordinate 1e300"),
    ("text", QUADS.replace("v 2 1 0", "v 2 x 0"), 'line 6: "x" is not a number'),
    ("garbage", "\x89PNG and so on\n" * 9, "line 1: "),
    ("another format", "ply\nformat ascii 1.0\n", 'line 1: "ply" is no OBJ statement'),
    ("not UTF-8", b"v 0 0 0\n# caf\xe9\n", "line 2 is not UTF-8"),
    ("binary", bytes(range(256)) * 40, "line 1"),
    ("endless line", b"v" * 3_000_000, "line 1 is too long"),
    ("face out of range", QUADS + "f 1 2 7\n", 'line 9: the face names vertex 7; accepted: 1 to 6'),
    ("face zero", QUADS + "f 0 1 2\n", 'line 9: corner "0"'),
    ("face far back", QUADS + "f -7 -1 -2\n", 'line 9: corner "-7"'),
    ("face words", QUADS + "f a b c\n", 'line 9: corner "a"'),
    ("face of two", QUADS + "f 1 2\n", "line 9: a face with 2 corners; accepted: 3 or more"),
    ("polygon with a hole", QUADS + "f 1 2 5 2 4\n", "line 9: the face passes through vertex 2 twice"),
    ("loose vertex", QUADS.replace("f 1", "v 5 5 5\nf 1"), "vertex 6 (from 0; line 7) is used by no face"),
    ("zero-area face", QUADS.replace("v 2 0 0", "v 1 0 0").replace("v 2 1 0", "v 1 1 0"), "cloth \"flag\": "),
    ("two vertices in one place", QUADS.replace("v 2 1 0", "v 1 1 0"), "cloth \"flag\": "),
    ("a folder", "folder", "it is a folder"),
]
# fmt: on


def refused(run_bake, tmp_path):
    result = run_bake("scene.toml", "--out", "out")
    assert result.returncode == 2, result
    assert result.stdout == ""
    assert re.fullmatch(r"bake\.py: scene\.toml: [^\n]+\n", result.stderr), result.stderr
    assert not (tmp_path / "out").exists(), "nothing is written"
    return result.stderr


def test_the_good_scene_bakes(run_bake, tmp_path):
    (tmp_path / "scene.toml").write_text(GOOD)
    (tmp_path / "flag.obj").write_text(QUADS)
    result = run_bake("scene.toml", "--out", "out")
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize(
    ("old", "new", "expected"), [row[1:] for row in SCENES], ids=[row[0] for row in SCENES]
)
def test_a_bad_scene_is_refused_in_one_line(run_bake, tmp_path, old, new, expected):
    assert GOOD.count(old) == 1
    (tmp_path / "scene.toml").write_text(GOOD.replace(old, new))
    (tmp_path / "flag.obj").write_text(QUADS)
    assert expected in refused(run_bake, tmp_path)


@pytest.mark.parametrize(
    ("content", "expected"), [row[1:] for row in MESHES], ids=[row[0] for row in MESHES]
)
def test_a_bad_mesh_is_refused_in_one_line(run_bake, tmp_path, content, expected):
    (tmp_path / "scene.toml").write_text(GOOD)
    path = tmp_path / "flag.obj"
    if content == "folder":
        path.mkdir()
    elif content is not None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    line = refused(run_bake, tmp_path)
    assert expected in line
    assert "flag" in line


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (GOOD.encode() + b"# caf\xe9\n", "line 18 is not UTF-8"),
        (GOOD.encode("utf-16"), "line 1 is not UTF-8"),
        (b"\x00" * 1000, "line 1"),
        (b"# " + b"x" * (65 << 20), "it is too long"),
    ],
    ids=["latin-1", "utf-16", "zeros", "65 MiB"],
)
def test_a_scene_that_is_no_text_is_refused_in_one_line(run_bake, tmp_path, content, expected):
    (tmp_path / "scene.toml").write_bytes(content)
    assert expected in refused(run_bake, tmp_path)


def test_ten_million_vertices_of_a_mesh_are_refused_before_they_fill_the_memory(run_bake, tmp_path):
    (tmp_path / "scene.toml").write_text(GOOD)
    (tmp_path / "flag.obj").write_text("v 0 0 0\n" * 10_000_000)
    assert "line 4000001: more than 4000000 vertices" in refused(run_bake, tmp_path)


def test_a_mesh_elsewhere_is_read_where_it_is_given_absolutely(run_bake, tmp_path):
    (tmp_path / "scenes").mkdir()
    (tmp_path / "meshes").mkdir()
    path = tmp_path / "meshes" / "flag.obj"
    path.write_text(QUADS)
    (tmp_path / "scenes" / "scene.toml").write_text(
        GOOD.replace('"flag.obj"', json.dumps(str(path)))
    )
    result = run_bake("scenes/scene.toml", "--out", "out")
    assert result.returncode == 0, result.stderr


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with a name here")
def test_a_pipe_that_nobody_writes_to_is_no_mesh(run_bake, tmp_path):
    (tmp_path / "scene.toml").write_text(GOOD)
    os.mkfifo(tmp_path / "flag.obj")
    assert "it is no file; accepted" in refused(run_bake, tmp_path)


NO_ROOM = """
import json, resource, boucle_core
resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))
cloth = {"name": "flag", "model": "fabric", "grid": {"size": [1, 1], "vertices": [700, 700]}}
print(boucle_core.run_batch([json.dumps({"cloth": [cloth]})], threads=1)[0]["error"])
"""


@pytest.mark.skipif(sys.platform != "linux", reason="memory is limited by Linux's means")
def test_cloth_that_the_memory_does_not_hold_is_refused_with_its_size():
    done = subprocess.run(
        [sys.executable, "-c", NO_ROOM], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    assert (
        "490000 vertices need about 5.9 GB of memory, which the system does not give" in done.stdout
    )
