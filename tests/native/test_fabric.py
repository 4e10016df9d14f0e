"""The model "fabric" and its presets in scene files and in the class `Simulation`; presets as springs."""

import json
import math
import struct
from array import array

import boucle_core
import pytest

PRESETS = boucle_core.fabric_presets()
GRAVITY = 9.81


class Strip:
    """A strip of n x rows vertices in the plane y = 0, which hangs by its top row."""

    def __init__(self, n=6, rows=26, edge=0.02):
        self.n, self.rows, self.edge = n, rows, edge
        self.positions = array("d")
        for i in range(n * rows):
            self.positions.extend([edge * (i % n), 0.0, edge * (i // n)])
        self.corners, self.uvs = array("i"), array("f")
        for row in range(rows - 1):
            for column in range(n - 1):
                vertex = row * n + column
                self.corners.extend([vertex, vertex + 1, vertex + n + 1, vertex + n])
                for across, along in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    self.uvs.extend([(column + across) / (n - 1), (row + along) / (rows - 1)])
        self.starts = array("i", range(0, len(self.corners), 4))

    def hang(self, load, uvs=(), frames=80, **cloth):
        """The heights of the rows after it has come to rest, with `load` (N/m²) of weight."""
        top = list(range(self.n * (self.rows - 1), self.n * self.rows))
        cloth = {"name": "strip", "density": load / GRAVITY, "pins": {"vertices": top}, **cloth}
        scene = {
            "scene": {"frames": [1, frames + 1], "gravity": [0.0, 0.0, -GRAVITY]},
            "cloth": [cloth],
            "solver": {"integrator": "implicit_euler", "substeps": 4},
            "collision": {"enabled": False},
        }
        mesh = (self.positions, self.starts, self.corners)
        simulation = boucle_core.Simulation(json.dumps(scene), [mesh], 1, uvs=uvs)
        for _ in range(frames):
            simulation.advance()
        out = array("d", bytes(8 * len(self.positions)))
        simulation.read_positions(0, out)
        heights = out[2::3]
        n = self.n
        return [sum(heights[n * row : n * (row + 1)]) / n for row in range(self.rows)]

    def stiffness(self, load, **more):
        """Tension over strain (N/m) of its middle half, under its own weight."""
        heights = self.hang(load, **more)
        low, high = self.rows // 4, 3 * self.rows // 4
        length = (high - low) * self.edge
        tension = load * 0.5 * (low + high) * self.edge
        return tension / ((heights[high] - heights[low]) / length - 1.0)


def mean_stretch(name):
    return 0.5 * (PRESETS[name]["stretch_warp"] + PRESETS[name]["stretch_weft"])


@pytest.mark.parametrize(
    ("name", "tolerance"), [("denim", 0.01), ("silk_chiffon", 0.01), ("rubber_sheet", 0.02)]
)
def test_springs_of_a_preset_stretch_as_its_fabric_does(name, tolerance):
    wanted = mean_stretch(name)
    for strip in (Strip(), Strip(n=11, rows=51, edge=0.01)):
        springs = {"preset": name, "limiter": "none"}
        got = strip.stiffness(0.04 * wanted, model="springs", springs=springs)
        assert abs(got / wanted - 1.0) < tolerance, f"{got} N/m, not {wanted}"


def test_fabric_stretches_along_warp_and_weft_by_direction_and_by_map():
    denim, strip = PRESETS["denim"], Strip()
    load = 0.02 * denim["stretch_warp"]

    def stiffness(warp, uvs=()):
        fabric = {"preset": "denim", "limiter": "none", "warp": warp}
        return strip.stiffness(load, uvs=uvs, model="fabric", fabric=fabric)

    turned = array("f")  # u up, v across
    for u, v in zip(strip.uvs[::2], strip.uvs[1::2], strict=True):
        turned.extend([v, -u])
    for key, found in (
        ("stretch_warp", (stiffness([0, 0, 1]), stiffness("uv", [strip.uvs]))),
        ("stretch_weft", (stiffness([1, 0, 0]), stiffness("uv", [turned]))),
    ):
        one, other = found
        assert abs(one / denim[key] - 1.0) < 0.03, (key, found)
        assert one == pytest.approx(other, rel=1e-6), "a map says the same as a direction"


SCENE = """
[scene]
frames = [1, 6]
[[cloth]]
name = "sheet"
{mesh}
pins = ["top"]
model = "fabric"
[cloth.fabric]
preset = "linen"
warp = {warp}
[collision]
enabled = false
"""
GRID = 'grid = { size = [0.6, 0.4], vertices = [5, 4], plane = "xz" }'


def obj_of(strip, with_uvs):
    lines = [
        "v {} {} {}".format(*strip.positions[k : k + 3]) for k in range(0, len(strip.positions), 3)
    ]
    if with_uvs:
        lines += [f"vt {strip.uvs[k]} {strip.uvs[k + 1]}" for k in range(0, len(strip.uvs), 2)]
    for face in range(0, len(strip.corners), 4):
        words = (
            f"{strip.corners[face + i] + 1}" + (f"/{face + i + 1}" if with_uvs else "")
            for i in range(4)
        )
        lines.append("f " + " ".join(words))
    return "\n".join([*lines, ""])


@pytest.fixture
def bake(tmp_path):
    """Bake a scene of one sheet of fabric and return its last hash."""

    def run(mesh, warp):
        path = tmp_path / "scene.toml"
        path.write_text(SCENE.format(mesh=mesh, warp=warp))
        return boucle_core.bake(str(path), str(tmp_path / "out"), threads=1)["frames"][-1]["hash"]

    return run


def test_a_grid_has_a_map_of_its_own_whose_v_grows_with_the_rows(bake):
    assert bake(GRID, '"uv"') == bake(GRID, "[0, 0, 1]")
    assert bake(GRID, '"uv"') != bake(GRID, "[1, 0, 0]")


def test_the_map_of_a_mesh_file_is_read_and_missed_where_it_is_not_there(tmp_path):
    strip = Strip(n=5, rows=4, edge=0.1)
    held = 'mesh = "sheet.obj"'
    (tmp_path / "sheet.obj").write_text(obj_of(strip, with_uvs=True))
    pins = SCENE.replace('["top"]', "{{ vertices = [15, 19] }}")
    path = tmp_path / "scene.toml"

    def last(warp):
        path.write_text(pins.format(mesh=held, warp=warp))
        return boucle_core.bake(str(path), str(tmp_path / "out"), threads=1)["frames"][-1]["hash"]

    assert last('"uv"') == last("[0, 0, 1]")
    (tmp_path / "sheet.obj").write_text(obj_of(strip, with_uvs=False))
    with pytest.raises(boucle_core.SceneError) as error:
        last('"uv"')
    said = 'cloth.sheet.fabric.warp = "uv", but its mesh has no UV coordinates; accepted: a mesh'
    assert said in str(error.value)


def test_a_resumed_bake_of_another_map_is_refused(tmp_path):
    strip = Strip(n=5, rows=4, edge=0.1)
    text = SCENE.replace('["top"]', "{{ vertices = [15, 19] }}")
    path = tmp_path / "scene.toml"
    path.write_text(text.format(mesh='mesh = "sheet.obj"', warp='"uv"'))
    (tmp_path / "sheet.obj").write_text(obj_of(strip, with_uvs=True))

    def stop(row):
        if row["frame"] == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        boucle_core.bake(str(path), str(tmp_path / "out"), threads=1, progress=stop)
    strip.uvs[0] += 0.25
    (tmp_path / "sheet.obj").write_text(obj_of(strip, with_uvs=True))
    with pytest.raises(boucle_core.SceneError, match="another scene"):
        boucle_core.bake(str(path), str(tmp_path / "out"), threads=1, resume=True)


@pytest.mark.parametrize(
    ("uvs", "match"),
    [
        ([None, None], "uvs holds 2; accepted: 1, one a cloth"),
        ([array("f", [0.0] * 7)], r"UV coordinates of cloth \"strip\" has the shape \[7\]; accepted: \(500, 2\)"),
        ([array("f", [math.nan] * 1000)], r"UV coordinates of cloth \"strip\" hold NaN"),
        ([array("i", [0] * 1000)], "accepted: float32 or float64"),
        ([None], "has no UV coordinates"),
        ([], "has no UV coordinates"),
    ],
)  # fmt: skip
def test_maps_that_do_not_fit_are_refused(uvs, match):
    with pytest.raises(boucle_core.SceneError, match=match):
        Strip().hang(1.0, uvs=uvs, frames=1, model="fabric", fabric={"warp": "uv"})


def test_a_preset_gives_mass_friction_and_thickness_that_the_scene_does_not_name(tmp_path):
    def lying(cloth="", collision=""):
        text = f"""
[scene]
frames = [1, 40]
[[cloth]]
name = "sheet"
grid = {{ size = [0.2, 0.2], vertices = [5, 5], plane = "xy", center = [0, 0, 0.02] }}
model = "springs"
{cloth}
[cloth.springs]
preset = "felt"
{collision}
[[collider]]
name = "floor"
plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
"""
        path = tmp_path / "scene.toml"
        path.write_text(text)
        boucle_core.bake(str(path), str(tmp_path / "out"), threads=1)
        data = (tmp_path / "out" / "sheet.pc2").read_bytes()
        return struct.unpack("<75f", data[-300:])[2::3]

    half = 0.5 * PRESETS["felt"]["thickness"]
    assert max(abs(z - half) for z in lying()) < 0.25 * half
    general = lying(collision="[collision]\nthickness = 0.005")
    assert max(abs(z - 0.005) for z in general) < 1e-3, "what the scene says comes first"


def test_springs_of_a_fabric_are_told_by_name():
    springs = boucle_core.fabric_springs("denim", 0.02)
    denim = PRESETS["denim"]
    assert springs["shear"] == denim["shear"]
    bend = 18.0 * (denim["bend_warp"] + denim["bend_weft"]) / 0.02**2
    assert springs["bend"] == pytest.approx(bend)
    assert (springs["damping_law"], springs["stiffness_from"]) == ("axial", "continuum")
    assert springs["deformation_rate"] == denim["deformation_rate"]
    with pytest.raises(boucle_core.SceneError, match=r'preset = "demin"; accepted: cashmere'):
        boucle_core.fabric_springs("demin", 0.02)
    for edge in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(boucle_core.SceneError, match="edge = "):
            boucle_core.fabric_springs("denim", edge)
