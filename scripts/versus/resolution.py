"""Whether the same cloth behaves the same on finer grids: stiffness of the continuum, 32² to 256².

A sheet of 2 m x 2 m, held by the two ends of an edge, is let go from where it lies flat. Light air damping brings it
to rest. Compared with the finest grid: the depth of its lowest point at rest, that of the middle of its lower edge,
and the time of its first swing, from the first to the third time that it passes below the pins.
"""

from __future__ import annotations

import json
import sys
from typing import Any

import numpy as np

from bench import table

from . import boucle, cases
from .child import follow, tell
from .sheet import DENSITY, FPS, SIZE, Sheet

SIDES = (32, 64, 128, 256)
QUICK_SIDES = (32, 64)
SECONDS = 8.0
DAMPING_RATE = 1.0
"""1/s: air damping over mass, the same on every grid."""
TARGET_PERCENT = 3.0
MEASURES = {"lowest": "lowest point (m)", "edge": "lower edge (m)", "period": "first swing (s)"}


def main(side: int) -> None:
    """Measure one grid: its motion over some seconds."""
    sheet = Sheet(side)
    mass = DENSITY * SIZE**2 / side**2
    springs = {"stiffness_from": "continuum", "air_damping": DAMPING_RATE * mass}
    cloth = boucle.simulation(sheet, 0, springs=springs)
    middle, edge = [], []
    positions = np.empty((side * side, 3))

    def step() -> np.ndarray:
        cloth.advance()
        cloth.read_positions(0, positions)
        lower = positions.reshape(side, side, 3)[0]
        at = 0.5 * (lower[(side - 1) // 2] + lower[side // 2])
        middle.append(float(at[1]))
        edge.append(float(at[2]))
        return positions

    result = follow(sheet, round(SECONDS * FPS), step)
    tell(
        {
            **result,
            "lowest_at_rest": float(np.mean(result["lowest"][-FPS:])),
            "edge_at_rest": float(np.mean(edge[-FPS:])),
            "first_swing": period(np.array(middle)),
            "middle_y": middle,
            "edge_z": edge,
        }
    )


def period(along: np.ndarray) -> float:
    """Time (s) between the first and the third time that the middle of the lower edge passes below the pins.

    Between two frames it moves straight.
    """
    from_pins = along - 0.5 * SIZE
    before = np.flatnonzero(np.sign(from_pins[:-1]) != np.sign(from_pins[1:]))
    if len(before) < 3:
        return float("nan")
    part = from_pins[before] / (from_pins[before] - from_pins[before + 1])
    passes = (before + part) / FPS
    return float(passes[2] - passes[0])


def table_of(sides: tuple[int, ...]) -> dict[str, Any]:
    """Measure all grids, print them and their differences to the finest, and return the numbers."""
    keys = {"lowest": "lowest_at_rest", "edge": "edge_at_rest", "period": "first_swing"}
    rows = []
    for side in sides:
        result = cases.ask("resolution", {"side": side}, timeout=300.0)
        if "failed" in result:
            print(f"resolution, {side}²: {result['failed']}")
            continue
        measures = {name: result[key] for name, key in keys.items()}
        rows.append({"side": side, **measures, "motion": [result["middle_y"], result["edge_z"]]})
    if not rows:
        return {"rows": []}
    finest = rows[-1]
    for row in rows:
        for name in MEASURES:
            row[f"{name}_percent"] = 100.0 * (row[name] / finest[name] - 1.0)
    headings = ["continuum stiffness", *MEASURES.values(), *["%"] * len(MEASURES)]
    lines = [
        [
            f"{row['side']}²",
            *(f"{row[name]:.3f}" for name in MEASURES),
            *(f"{row[name + '_percent']:+.1f}" for name in MEASURES),
        ]
        for row in rows
    ]
    print(table(headings, lines))
    print(f"  % is against {finest['side']}²; wanted: within {TARGET_PERCENT:.0f} %")
    return {"rows": rows, "target_percent": TARGET_PERCENT}


if __name__ == "__main__":
    main(**json.loads(sys.argv[1]))
