"""Soft pins in scene files, and what Python may say of pins and grips."""

import json
from array import array

import boucle_core
import pytest

SCENE = """
[scene]
frames = [1, 30]
gravity = [0.0, 0.0, -9.81]
[[cloth]]
name = "sheet"
grid = {{ size = [1.0, 1.0], vertices = [9, 9], plane = "xz" }}
density = 0.2
pins = {pins}
pin_stiffness = 200.0
pin_damping = 3.0
[cloth.springs]
damping = 0.05
[collision]
enabled = false
"""


@pytest.fixture
def bake(tmp_path, run_bake, read_report):
    """Bake a sheet with pins and return the rows of its report and its frames."""

    def run(pins, *words):
        path = tmp_path / "sheet.toml"
        path.write_text(SCENE.format(pins=pins))
        done = run_bake(path, "--out", tmp_path / "out", "--quiet", *words)
        assert done.returncode == 0, done.stderr
        return read_report(tmp_path / "out")["frames"]

    return run


def heights(tmp_path, frame):
    """Height of the middle of the upper edge, and of the lower."""
    data = array("f")
    data.frombytes((tmp_path / "out" / "sheet.pc2").read_bytes()[32:])
    sample = data[(frame - 1) * 243 : frame * 243]
    return sample[3 * 76 + 2], sample[3 * 4 + 2]


def test_pins_of_a_scene_sag_by_their_weight_and_let_go_at_their_frame(bake, tmp_path):
    rows = bake('[ { names = ["top"], weight = 0.5, release = 20 } ]')
    top, _ = heights(tmp_path, 20)
    assert top == pytest.approx(0.5 - 0.2 * 9.81 / (0.5 * 200.0), abs=3e-3)
    fallen = heights(tmp_path, 30)[0]
    assert fallen < top - 0.5, "free fall of 10/24 s is 0.85 m"
    hard = bake('[ { names = ["top"], weight = 1.0 } ]')
    plain = bake('["top"]')
    assert [row["hash"] for row in hard] == [row["hash"] for row in plain]
    assert rows[5]["hash"] != plain[5]["hash"]


def test_each_pin_may_have_a_weight_of_its_own(bake, tmp_path):
    vertices = list(range(72, 81))
    weights = [1.0, 0.8, 0.5, 0.2, 0.0, 0.2, 0.5, 0.8, 1.0]
    bake(json.dumps([{"vertices": vertices, "weights": weights}]).replace(":", "="))
    middle, _ = heights(tmp_path, 30)
    assert middle < 0.499
    data = array("f")
    data.frombytes((tmp_path / "out" / "sheet.pc2").read_bytes()[32:])
    last = data[29 * 243 :]
    assert [last[3 * 72 + 2], last[3 * 80 + 2]] == [0.5, 0.5]


def test_python_weakens_stiffens_grabs_and_is_refused(simulation):
    count = simulation.vertex_count(0)
    simulation.set_pin_weights(0, array("f", [0.5] * count))
    simulation.set_pin_stiffness(0, 50.0)
    places = array("d", bytes(24 * count))
    simulation.read_positions(0, places)
    simulation.grab(0, [0, 1], places[:6], array("d", [1.0, 0.25]))
    simulation.advance()
    held = array("d", bytes(24 * count))
    simulation.read_positions(0, held)
    assert held[:3] == pytest.approx(places[:3], abs=0.01)
    checkpoint = simulation.checkpoint()
    simulation.let_go()
    one = simulation.advance()["hash"]
    simulation.restore(checkpoint)
    assert simulation.advance()["hash"] != one, "a grip is part of the state"
    refused = [
        (lambda: simulation.set_pin_weights(0, array("f", [2.0] * count)), "accepted: 0 to 1"),
        (lambda: simulation.set_pin_weights(0, array("f", [0.5])), f"accepted: ({count},)"),
        (lambda: simulation.set_pin_stiffness(0, -1.0), "accepted: 0 to 1e12"),
        (lambda: simulation.grab(0, [count], places[:3], array("d", [1])), "vertices holds"),
        (lambda: simulation.grab(0, [0], places[:6], array("d", [1])), "accepted: (1, 3)"),
        (lambda: simulation.grab(0, [0], places[:3], array("d", [0])), "accepted: above 0"),
        (
            lambda: simulation.grab(0, [0], array("d", [0, 0, float("nan")]), array("d", [1])),
            "no place",
        ),
    ]
    for act, words in refused:
        with pytest.raises(boucle_core.BoucleError) as caught:
            act()
        assert words in str(caught.value), str(caught.value)
