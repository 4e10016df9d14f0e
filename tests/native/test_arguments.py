"""What the module refuses: one sentence each, of the right kind, and nothing is changed."""

import json
import os
import subprocess
import sys
from array import array

import boucle_core
import numpy as np
import pytest


def refused(match):
    return pytest.raises(boucle_core.SceneError, match=match)


@pytest.mark.parametrize(
    "make",
    [
        lambda n: np.zeros((n, 3), np.float32),
        lambda n: np.zeros((n, 3), np.float64),
        lambda n: np.zeros(3 * n, np.float32),
        lambda n: array("f", [0.0] * (3 * n)),
        lambda n: array("d", [0.0] * (3 * n)),
        lambda n: memoryview(bytearray(12 * n)).cast("f"),
        lambda n: memoryview(bytearray(24 * n)).cast("B").cast("d", (n, 3)),
    ],
    ids=["f32", "f64", "flat", "array f", "array d", "memoryview", "memoryview (n, 3)"],
)
def test_every_array_of_floats_is_filled(simulation, sheet, make):
    out = make(36)
    simulation.read_positions(0, out)
    assert np.array_equal(
        np.asarray(out, np.float32).ravel(), np.asarray(sheet.positions, np.float32)
    )


@pytest.mark.parametrize(
    ("out", "match"),
    [
        (np.zeros((35, 3), np.float32), r"out has the shape \[35, 3\]; accepted: \(36, 3\)"),
        (np.zeros((36, 4), np.float32), r"shape \[36, 4\]"),
        (np.zeros((3, 36), np.float32), r"shape \[3, 36\]"),
        (np.zeros(107, np.float32), r"shape \[107\]"),
        (np.zeros((36, 3, 1), np.float32), r"shape \[36, 3, 1\]"),
        (np.zeros((), np.float32), r"out cannot be read|shape \[\]"),
        (np.zeros((36, 3), np.int32), 'format "i"; accepted: float32 or float64'),
        (np.zeros((36, 3), np.float16), 'format "e"'),
        (np.zeros((36, 3), ">f4"), 'format ">f"'),
        (np.zeros((36, 6), np.float32)[:, ::2], "not C-contiguous"),
        (np.zeros((3, 36), np.float32).T, "not C-contiguous"),
        (bytes(432), 'shape|format "B"'),
        (memoryview(bytes(432)).cast("f"), "read-only"),
    ],
)
def test_arrays_of_another_shape_or_type_are_refused(simulation, out, match):
    for read in (simulation.read_positions, simulation.read_velocities):
        with refused(match):
            read(0, out)


@pytest.mark.parametrize("out", [None, 3, [0.0] * 108, "text"])
def test_what_is_no_array_is_a_type_error(simulation, out):
    with pytest.raises(TypeError):
        simulation.read_positions(0, out)


def test_strain_and_tension_take_float32_only(simulation):
    for bad in (np.zeros(36), np.zeros(35, np.float32), np.zeros((36, 1), np.float32)):
        for read in (simulation.read_strain, simulation.read_tension):
            with refused("out"):
                read(0, bad)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e30])
def test_positions_and_targets_that_are_not_finite_are_refused(simulation, sheet, bad):
    before = simulation.certificate()["hash"]
    rows = np.array(sheet.positions).reshape(-1, 3)
    rows[sheet.top_corners[0], 1] = bad
    with refused("positions of vertex 30"):
        simulation.set_positions(0, rows)
    with refused("targets of vertex 30"):
        simulation.set_pin_targets(0, rows)
    assert simulation.certificate()["hash"] == before


@pytest.mark.parametrize("cloth", [-1, 1, 2**40])
def test_a_cloth_that_is_not_there_is_refused(simulation, cloth):
    for call in (simulation.vertex_count, simulation.spring_count, simulation.release_pins):
        with refused(f"cloth = {cloth}; accepted: 0 to 0"):
            call(cloth)


def test_a_pin_that_is_no_vertex_is_refused(simulation):
    for vertex in (-1, 36, 2**35):
        with refused(f"vertices holds {vertex}"):
            simulation.release_pins(0, [vertex])


@pytest.mark.parametrize(
    ("corners", "starts", "match"),
    [
        ([0, 1, 36], [0], "vertex 36; accepted: 0 to 35"),
        ([0, 1, -1], [0], "holds -1"),
        ([0, 1, 2, 1], [0], "passes through vertex 1 twice"),
        ([0, 1, 2, 3, 4, 5], [0, 2], "2 corners"),
        ([0, 1, 2, 3, 4, 5], [3, 0], "face starts"),
        ([0, 1, 2], [1], "face starts"),
        ([0, 1, 2], [0, 9], "face starts"),
        ([0, 1, 7], [0], "vertex 2|loose|no face"),
        ([], [], "vertex 0|face"),
    ],
)
def test_broken_meshes_are_refused(sheet, corners, starts, match):
    mesh = (sheet.positions, array("i", starts), array("i", corners))
    with refused(match):
        boucle_core.Simulation(sheet.scene(), [mesh])


def test_indices_may_have_4_or_8_bytes(sheet):
    for kind in (np.int32, np.int64, np.uint32, np.uint64):
        mesh = (sheet.positions, np.array(sheet.starts, kind), np.array(sheet.corners, kind))
        assert boucle_core.Simulation(sheet.scene(), [mesh]).vertex_count(0) == 36
    for kind in (np.float64, np.int16, np.uint8):
        mesh = (sheet.positions, sheet.starts, np.array(sheet.corners, kind))
        with refused("face corners .* accepted: int32"):
            boucle_core.Simulation(sheet.scene(), [mesh])


def test_meshes_and_cloths_must_pair(sheet):
    for meshes in ([], [sheet.mesh()] * 2):
        with refused(f"meshes holds {len(meshes)}; accepted: 1"):
            boucle_core.Simulation(sheet.scene(), meshes)


@pytest.mark.parametrize(
    ("cloth", "match"),
    [
        ({"grid": {"size": [1, 1], "vertices": [6, 6]}}, "grid, mesh or rest"),
        ({"mesh": "sheet.obj"}, "grid, mesh or rest"),
        ({"pins": ["top"]}, "names only for a grid"),
        ({"pins": {"vertices": [36]}}, r"cloth\.sheet\.pins\.vertices\.0 = 36; accepted: 0 to 35"),
        ({"pins": {"near": [9, 9, 9], "radius": 0.1}}, r"pins\.near"),
        ({"density": -1}, r"cloth\.sheet\.density = -1\.0"),
        ({"densty": 1}, 'did you mean "density"'),
        ({"springs": {"deformation_rate": 10}}, "did you mean 0.10"),
        ({"model": "felt"}, 'accepted: "springs", "fabric"'),
    ],
)
def test_scenes_are_refused_by_their_key(sheet, cloth, match):
    with refused(match) as caught:
        boucle_core.Simulation(sheet.scene(**cloth), [sheet.mesh()])
    assert "\n" not in str(caught.value)
    assert isinstance(caught.value, ValueError)


def test_zero_area_and_not_a_number_are_refused(sheet):
    for value, match in ((0.0, "area|apart"), (float("nan"), "NaN|nan")):
        rows = array("d", sheet.positions)
        for index in (0, 1, 2):
            rows[3 * 1 + index] = rows[index] if value == 0.0 else value
        with refused(match):
            boucle_core.Simulation(sheet.scene(), [(rows, sheet.starts, sheet.corners)])


def test_threads_out_of_range_are_refused(sheet):
    for threads in (-1, 100_000):
        with refused(f"threads = {threads}"):
            boucle_core.Simulation(sheet.scene(), [sheet.mesh()], threads=threads)


def test_a_step_beyond_the_bound_is_refused_with_what_would_hold(sheet):
    scene = json.loads(sheet.scene())
    scene["solver"] = {"integrator": "symplectic_euler", "substeps": 1}
    with refused(r"stability bound .* at least \d+ substeps"):
        boucle_core.Simulation(json.dumps(scene), [sheet.mesh()])


PANICS = """
import json
import sys
from array import array

import boucle_core

def caught(call, *words):
    try:
        call(*words)
    except boucle_core.InternalError as error:
        assert isinstance(error, RuntimeError)
        return str(error)
    raise AssertionError(f"{call} was not refused")

mesh = (array("f", [0, 0, 0, 1, 0, 0, 0, 0, 1]), array("i", [0]), array("i", [0, 1, 2]))
scene = json.dumps({"cloth": [{"name": "sheet"}]})
message = caught(boucle_core._panic_for_tests)
assert "asked to panic by a test" in message and "faults.rs:" in message, message
simulation = boucle_core.Simulation(scene, [mesh])
assert "asked to panic" in caught(boucle_core._panic_for_tests, simulation)
for call in (simulation.advance, simulation.certificate, simulation.checkpoint):
    assert "make a new one" in caught(call)
assert "make a new one" in caught(lambda: simulation.frame)
assert boucle_core.Simulation(scene, [mesh]).advance()["frame"] == 2
print("alive")
"""


def run_python(program, **environment):
    command = [sys.executable, "-c", program]
    return subprocess.run(
        command, env={**os.environ, **environment}, capture_output=True, text=True, check=False
    )


def test_a_panic_becomes_an_exception_breaks_only_its_simulation_and_prints_nothing():
    result = run_python(PANICS, BOUCLE_TEST_HOOKS="1")
    assert (result.returncode, result.stdout, result.stderr) == (0, "alive\n", "")


def test_the_hook_for_tests_is_not_there_without_being_asked_for():
    result = run_python("import boucle_core; print(hasattr(boucle_core, '_panic_for_tests'))")
    assert result.stdout == "False\n"
