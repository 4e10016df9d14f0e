"""Creases and bending friction through the Python module: a folded strip, kept checkpoints, bakes on several threads."""

import json
import math
from array import array

import boucle_core
import pytest

COLUMNS, ROWS, EDGE = 21, 5, 0.01
CREASED = {"yield_curvature": 40.0}
RUBBING = {"bend_hysteresis": 5e-3}


class Strip:
    """A strip that one end holds; the other is folded over it, and then let go."""

    def __init__(self, threads=1, **fabric):
        at = [(EDGE * c, EDGE * r, 0.0) for r in range(ROWS) for c in range(COLUMNS)]
        positions = array("d", [x for point in at for x in point])
        corners = array("i")
        for r in range(ROWS - 1):
            for c in range(COLUMNS - 1):
                a = COLUMNS * r + c
                corners.extend([a, a + 1, a + COLUMNS + 1, a + COLUMNS])
        self.rest = at
        self.left = [COLUMNS * r + c for r in range(ROWS) for c in (0, 1)]
        self.right = [COLUMNS * r + COLUMNS - 1 - c for r in range(ROWS) for c in (0, 1)]
        cloth = {
            "name": "strip",
            "density": 0.2,
            "pins": {"vertices": sorted(self.left + self.right)},
            "model": "fabric",
            "fabric": {"bend_warp": 5e-4, "bend_weft": 5e-4, "air_damping": 2e-4, **fabric},
        }
        scene = {
            "scene": {"frames": [1, 400], "gravity": [0.0, 0.0, 0.0]},
            "cloth": [cloth],
            "collision": {"enabled": False},
        }
        mesh = (positions, array("i", range(0, len(corners), 4)), corners)
        self.simulation = boucle_core.Simulation(json.dumps(scene), [mesh], threads)

    def fold(self, frames=48, fold=0.9 * math.pi):
        """Turn the right end over by half a turn, nearly, on a half circle about the middle."""
        middle = 0.5 * EDGE * (COLUMNS - 1)
        for frame in range(1, frames + 1):
            angle = fold * frame / frames
            targets = array("d")
            for x, y, _ in self.rest:
                reach = x - middle
                targets.extend(
                    [middle + reach * math.cos(angle), y, reach * math.sin(angle)]
                    if x > middle
                    else [x, y, 0.0]
                )
            self.simulation.set_pin_targets(0, targets)
            self.simulation.advance()

    def let_go(self, frames=96):
        """Release the right end and wait; how far (degrees) it is still folded."""
        self.simulation.release_pins(0, self.right)
        for _ in range(frames):
            self.simulation.advance()
        out = array("d", bytes(8 * 3 * len(self.rest)))
        self.simulation.read_positions(0, out)
        tip, before = (out[3 * (COLUMNS * 2 + c) :][:3] for c in (COLUMNS - 1, COLUMNS - 2))
        return math.degrees(math.atan2(tip[2] - before[2], tip[0] - before[0])) % 360.0


def test_a_folded_strip_keeps_its_crease_and_an_elastic_one_springs_flat():
    left = {}
    for name, fabric in {"elastic": {}, "creased": CREASED, "rubbing": RUBBING}.items():
        strip = Strip(**fabric)
        strip.fold()
        left[name] = strip.let_go()
    assert left["elastic"] < 0.5
    assert 35.0 < left["creased"] < 90.0
    # Friction holds a curvature of at most 2HB/2 over B.
    assert 5.0 < left["rubbing"] < math.degrees(0.5 * 5e-3 / 5e-4 * EDGE * (COLUMNS - 4))


@pytest.mark.parametrize("fabric", [CREASED, RUBBING, {**CREASED, **RUBBING, "hardening": 0.2}])
def test_what_bending_has_left_is_in_a_checkpoint(fabric):
    strip = Strip(**fabric)
    strip.fold(12)
    kept = strip.simulation.checkpoint()
    plain = Strip().simulation.checkpoint()
    assert len(kept) >= len(plain) + 8 * 6 * 2 * (COLUMNS - 1) * (ROWS - 1)
    expected = [strip.simulation.advance()["hash"] for _ in range(4)]
    other = Strip(threads=2, **fabric)
    other.simulation.restore(kept)
    assert other.simulation.checkpoint() == kept
    assert [other.simulation.advance()["hash"] for _ in range(4)] == expected


@pytest.mark.parametrize(
    ("fabric", "complaint"),
    [
        ({"yield_curvature": -1.0}, r"fabric.yield_curvature \(1/m\) is -1; accepted: 0 to 1e12"),
        ({"hardening": 1.0}, "fabric.hardening is 1; accepted: 0 to 0.99, as a part of the"),
        ({"bend_hysteresis": -1e-3}, r"fabric.bend_hysteresis \(N·m/m\) is -0.001; accepted: 0 to"),
        ({"bend_hysteresis": "much"}, "bend_hysteresis"),
        ({"yield_curve": 3.0}, "did you mean|yield_curvature"),
    ],
)
def test_numbers_that_cannot_be_are_refused_in_a_sentence(fabric, complaint):
    with pytest.raises(boucle_core.SceneError, match=complaint):
        Strip(**fabric)
