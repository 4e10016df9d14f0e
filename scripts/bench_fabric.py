"""`bench fabric`: fabric beside springs of the same cloth, on one hanging sheet, in one run and on one thread.

A sheet of 1 m x 1 m lies in a plane, held by two corners, and swings down for a second (24 frames). Springs take a named
fabric by conversion; the last row has the defaults of both models, as stiff as each other. `BOUCLE_BENCH=quick` measures
64² alone.
"""

from __future__ import annotations

import json
import math
import os
from typing import Any

import boucle_core
import numpy as np

from bench import median, seconds_each, table, verdict
from validation.specimen import grid

FRAMES = 24
SIDES = (64, 128)
PRESETS = ("cotton_poplin", "denim", "silk_crepe_de_chine", "nylon_ripstop", "jersey_knit")
AS_STIFF = {"stretch": 2000.0, "shear": 100.0, "stiffness_from": "continuum"}
"""Springs like the fabric's defaults."""
TARGET = 1.5
"""What fabric may take, in times of springs."""


def bench() -> dict[str, Any]:
    """Measure every cloth in both models, print the table and return the numbers."""
    sides = SIDES[:1] if os.environ.get("BOUCLE_BENCH") == "quick" else SIDES
    rows = [row(side, preset) for side in sides for preset in (*PRESETS, None)]
    head = ["cloth", "side", "fabric ms", "springs ms", "ratio", "steps", "steps", "iterations"]
    cells = [
        [
            each["cloth"],
            each["side"],
            each["fabric"]["ms"],
            each["springs"]["ms"],
            each["ratio"],
            each["fabric"]["substeps"],
            each["springs"]["substeps"],
            f"{each['fabric']['iterations']:.0f} {each['springs']['iterations']:.0f}",
        ]
        for each in rows
    ]
    print(table(head, cells))
    for side in sides:
        ratios = [each["ratio"] for each in rows if each["side"] == side]
        mean = math.exp(sum(map(math.log, ratios)) / len(ratios))
        print(verdict(f"{TARGET} at {side}² (geometric mean {mean:.2f})", mean <= TARGET))
    return {"frames": FRAMES, "target": TARGET, "rows": rows}


def row(side: int, preset: str | None) -> dict[str, Any]:
    """One cloth in both models; none is the defaults."""
    material = {} if preset is None else {"preset": preset}
    fabric = run(side, {"model": "fabric", "fabric": {**material, "warp": [0.0, 0.0, 1.0]}})
    springs = run(side, {"springs": material or AS_STIFF})
    ratio = fabric["ms"] / springs["ms"]
    name = preset or "defaults"
    return {"cloth": name, "side": side, "fabric": fabric, "springs": springs, "ratio": ratio}


def run(side: int, cloth: dict[str, Any]) -> dict[str, Any]:
    """Mean time of a frame (ms), and what a frame takes."""
    line = np.linspace(0.0, 1.0, side)
    sheet = grid(line, line)
    flat, starts, corners = sheet.arrays()
    upright = np.ascontiguousarray(np.column_stack([flat[:, 0], flat[:, 2], flat[:, 1]]))
    pins = {"vertices": [side * (side - 1), side * side - 1]}
    scene = {
        "scene": {"frames": [1, FRAMES + 1]},
        "cloth": [{"name": "sheet", "pins": pins, **cloth}],
        "collision": {"self": False},
    }
    simulation = boucle_core.Simulation(json.dumps(scene), [(upright, starts, corners)], 1)
    frames = []

    def advance() -> None:
        frames.append(simulation.advance())

    times = seconds_each(advance, FRAMES, warm_up=0)
    return {
        "ms": 1e3 * sum(times) / FRAMES,
        "median_ms": 1e3 * median(times),
        "substeps": sum(frame["substeps"] for frame in frames) / FRAMES,
        "iterations": sum(frame["iterations"] for frame in frames) / FRAMES,
        "max_strain": frames[-1]["max_strain"],
    }
