"""Rest shapes, shrink, pressure and sewing in scene files and in the class `Simulation`."""

import math
import struct
from array import array

import boucle_core
import pytest

GRID = 4

SCENE = """
[scene]
frames = [1, 24]
gravity = [0.0, 0.0, 0.0]

[[cloth]]
name = "sheet"
mesh = "start.obj"
{keys}

[cloth.springs]
damping = 0.05
air_damping = 0.05
limiter = "none"

[collision]
enabled = false
{tables}
"""


def obj(width, lines="", faces=None, turn=0.0):
    """A grid of 4 x 4 vertices, 1 m high and so wide (m), rolled by a part of a turn, as an OBJ file."""
    vertices = []
    for i in range(GRID * GRID):
        x, y = width * (i % GRID) / 3, (i // GRID) / 3
        angle, radius = math.tau * turn * x / width, width / (math.tau * turn) if turn else 0.0
        rolled = (radius * math.sin(angle), y, radius * math.cos(angle))
        vertices.append("v {} {} {}".format(*(rolled if turn else (x, y, 0.0))))
    if faces is None:
        corners = [row * GRID + column + 1 for row in range(3) for column in range(3)]
        faces = [f"f {i} {i + 1} {i + GRID + 1} {i + GRID}" for i in corners]
    return "\n".join([*vertices, *faces, lines, ""])


@pytest.fixture
def bake(tmp_path):
    """Bake a sheet of 1 m with further keys and return its report and the last frame's positions."""

    def run(keys="", tables="", lines="", turn=0.0, **options):
        (tmp_path / "start.obj").write_text(obj(1.0, lines, turn=turn))
        path = tmp_path / "scene.toml"
        path.write_text(SCENE.format(keys=keys, tables=tables))
        report = boucle_core.bake(str(path), str(tmp_path / "out"), **options)
        data = (tmp_path / "out" / "sheet.pc2").read_bytes()
        numbers = struct.unpack(f"<{3 * GRID * GRID}f", data[-12 * GRID * GRID :])
        return report, [numbers[3 * i : 3 * i + 3] for i in range(GRID * GRID)]

    return run


def distance(points, a, b):
    return sum((x - y) ** 2 for x, y in zip(points[a], points[b], strict=True)) ** 0.5


def test_a_rest_file_is_the_shape_that_a_mesh_comes_to(bake, tmp_path):
    (tmp_path / "rest.obj").write_text(obj(1.2))
    report, points = bake('rest = "rest.obj"')
    assert report["frames"][0]["max_strain"] < 1e-9, "the start is narrower than the rest shape"
    assert abs(distance(points, 0, 3) - 1.2) < 0.02
    assert abs(report["frames"][-1]["max_strain"]) < 0.01


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (obj(1.0, faces=["f 1 2 6 5"]), "accepted: vertices of faces"),
        (obj(1.0).replace("f 1 2 6 5", "f 2 6 5 1"), "its face 0 (from 0) joins other vertices"),
        (obj(1.0) + "v 0 0 9\nf 1 2 17\n", "it has 17 vertices and 10 faces; accepted: 16 and 9"),
        (None, "cannot be read"),
    ],
)
def test_a_rest_file_of_another_mesh_is_refused(bake, tmp_path, text, expected):
    if text is not None:
        (tmp_path / "rest.obj").write_text(text)
    with pytest.raises(boucle_core.SceneError) as error:
        bake('rest = "rest.obj"')
    assert 'cloth.sheet.rest = "rest.obj"' in str(error.value)
    assert expected in str(error.value)


def test_keyframes_shrink_a_sheet_and_a_stopped_bake_goes_on_bit_equal(bake):
    weights = ", ".join("1.0" if i % GRID < 2 else "0.0" for i in range(GRID * GRID))
    keys = f"shrink = {{ weights = [{weights}], keyframes = [{{ frame = 2 }}, {{ frame = 12, max = 0.4 }}] }}"
    report, points = bake(keys)
    assert abs(distance(points, 0, 1) - 0.6 / 3) < 0.01
    assert abs(distance(points, 2, 3) - 1.0 / 3) < 0.02
    hashes = [row["hash"] for row in report["frames"]]

    def stop(step):
        if step["frame"] == 6:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        bake(keys, progress=stop)
    resumed, _ = bake(keys, resume=True)
    assert [row["hash"] for row in resumed["frames"]] == hashes


def test_pressure_pushes_along_normals_from_its_keyframe_on(bake):
    table = "pressure = { keyframes = [{ frame = 12, uniform = 0 }, { frame = 13, uniform = 3 }] }"
    report, points = bake(table)
    assert all(row["kinetic_energy"] < 1e-9 for row in report["frames"][:11])
    assert all(point[2] > 0.01 for point in points)


def test_lines_of_a_mesh_file_are_sewn(bake):
    keys = "sewing = { force_max = 0.5, weld_distance = 0.001 }"
    lines = "l 1 4\nl 5 8\nl 9 12\nl 13 16"
    report, points = bake(keys, lines=lines, turn=0.7)
    assert all(distance(points, row * GRID, row * GRID + 3) < 0.001 for row in range(GRID))
    assert report["frames"][0]["max_strain"] < 1e-9
    _, unsewn = bake("", lines="l 1 4")
    assert abs(distance(unsewn, 0, 3) - 1.0) < 1e-3


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ("shrink = { min = 1.0 }", "cloth.sheet.shrink.min = 1.0; accepted: -10 to 0.99"),
        ("shrink = { weights = [2.0] }", "shrink.weights.0 = 2; accepted: 0 to 1"),
        ("shrink = { max = 0.1, weights = [1.0] }", "shrink.weights holds 1; accepted: 16"),
        ("shrink = { most = 1.0 }", "most"),
        ("pressure = { factor = -1.0 }", "pressure.factor = -1.0; accepted: 0 to 1e12 N/m²"),
        (
            "pressure = { keyframes = [{ frame = 5 }, { frame = 5 }] }",
            "pressure.keyframes.1.frame = 5; accepted: a frame after 5",
        ),
        ("pressure = { volume = 1.0 }", "volume"),
        ("sewing = { force_max = -1.0 }", "sewing.force_max = -1.0; accepted: 0 to 1e12 N"),
        ("sewing = { seams = [[0, 99]] }", "a seam joins vertices 0 and 99"),
        ("sewing = { seams = [[0, 1]] }", "which an edge of a face joins"),
        ("sewing = { force = 1.0 }", "force"),
    ],
)
def test_wrong_keys_and_numbers_are_refused(bake, keys, expected):
    with pytest.raises(boucle_core.SceneError) as error:
        bake(keys)
    assert expected in str(error.value) and "\n" not in str(error.value)


def test_a_simulation_takes_a_rest_shape_shrink_and_pressure(sheet):
    wide = array("d", (1.5 * x if k % 3 == 0 else x for k, x in enumerate(sheet.positions)))
    make = boucle_core.Simulation
    simulation = make(sheet.scene(pressure={}), [sheet.mesh()], 1, [], [wide])
    first = memoryview(simulation.read_springs(0)[2]).cast("d")[0]
    assert abs(first - 1.5 * 0.2) < 1e-12
    simulation.set_rest(0, sheet.positions, (0.5, 0.0))
    simulation.set_pressure(0, 2.0)
    simulation.advance()
    first = memoryview(simulation.read_springs(0)[2]).cast("d")[0]
    assert abs(first - 0.5 * 0.2) < 1e-12
    for wrong, expected in [
        (lambda: simulation.set_rest(0, wide[:3]), "shape has the shape [3]"),
        (lambda: simulation.set_rest(0, None, (2.0, 0.0)), "shrinks by 2; accepted: -10 to 0.99"),
        (lambda: simulation.set_pressure(0, float("nan")), "pressure uniform (N/m²) is NaN"),
        (lambda: make(sheet.scene(), [sheet.mesh()], 1, [], [wide[:9]]), "rest positions of cloth"),
        (lambda: make(sheet.scene(), [sheet.mesh()], 1, [], [None, None]), "rests holds 2"),
    ]:
        with pytest.raises(boucle_core.SceneError) as error:
            wrong()
        assert expected in str(error.value)
