"""Our simulation of the falling sheet: `python -m versus.boucle_drop '{"side": 64, "threads": 2, "frames": 36, ...}'`."""

from __future__ import annotations

import json
import sys
import time

import boucle_core
import numpy as np

from .boucle import RATE, STIFFNESS
from .child import follow, peak_memory, tell
from .drop import CHECKED, RADIUS, Drop
from .sheet import DENSITY, FPS

FRICTION = 0.3
CERTIFIED = ("substeps", "iterations", "intersections", "clipped", "contacts", "hash")


def simulation(sheet: Drop, threads: int, *, with_ball: bool = True) -> boucle_core.Simulation:
    """The sheet with our defaults, above the ball or alone."""
    material = {**STIFFNESS, "deformation_rate": RATE, "limiter": "project"}
    ball = {"name": "ball", "sphere": {"center": [0.0, 0.0, 0.0], "radius": RADIUS}}
    scene = {
        "scene": {"frames": [1, 1_000_000], "fps": FPS},
        "cloth": [{"name": "sheet", "density": DENSITY, "springs": material}],
        "collision": {"thickness": sheet.thickness, "friction": FRICTION},
        "collider": [{**ball, "friction": FRICTION}] if with_ball else [],
    }
    starts = np.arange(0, sheet.faces.size, 4, dtype=np.int32)
    mesh = (sheet.rest, starts, np.ascontiguousarray(sheet.faces).reshape(-1))
    return boucle_core.Simulation(json.dumps(scene), [mesh], threads)


def self_intersections(sheet: Drop, frames: list[np.ndarray]) -> list[int]:
    """How often the sheet passes through itself at some positions (m), whoever made them: exactly."""
    counter = simulation(sheet, 1, with_ball=False)
    counts = []
    for positions in frames:
        counter.set_positions(0, np.ascontiguousarray(positions, np.float64).reshape(-1, 3))
        counts.append(counter.certificate()["intersections"])
    return counts


def main(side: int, threads: int, frames: int, seconds: float) -> None:
    """Measure as many frames as begin within some seconds; the certificates go along."""
    sheet = Drop(side)
    started = time.perf_counter()
    cloth = simulation(sheet, threads)
    set_up = time.perf_counter() - started
    certificates, shapes = [], []

    def step() -> np.ndarray:
        certificates.append(cloth.advance())
        positions = np.empty((side * side, 3), dtype=np.float32)
        cloth.read_positions(0, positions)
        shapes.append(positions)
        return positions

    result = follow(sheet, frames, step, seconds=seconds)
    result["peak_bytes"] = peak_memory()  # before the checks
    for key in CERTIFIED:
        result[key] = [certificate[key] for certificate in certificates]
    result["depth"] = max(map(sheet.depth, shapes))
    result["ipctk"] = sheet.crosses_itself(shapes[-CHECKED:])
    tell({**result, "set_up_ms": 1e3 * set_up})


if __name__ == "__main__":
    main(**json.loads(sys.argv[1]))
