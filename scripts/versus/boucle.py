"""Our simulation of the sheet: `python -m versus.boucle '{"side": 64, "threads": 1, "frames": 24, ...}'`."""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import boucle_core
import numpy as np

from .child import follow, tell
from .sheet import DENSITY, FPS, Sheet

STIFFNESS = {"stretch": 500.0, "shear": 100.0, "bend": 5.0}
RATE = 0.05


def simulation(
    sheet: Sheet,
    threads: int,
    *,
    springs: dict[str, Any] | None = None,
    solver: dict[str, Any] | None = None,
    pins: list[int] | None = None,
    transform: dict[str, Any] | None = None,
) -> boucle_core.Simulation:
    """The sheet with our defaults, but for what is given."""
    material = {**STIFFNESS, "deformation_rate": RATE, "limiter": "project"}
    cloth = {
        "name": "sheet",
        "density": DENSITY,
        "pins": {"vertices": sheet.pins if pins is None else pins},
        "springs": {**material, **(springs or {})},
        "transform": transform or {},
    }
    scene = {
        "scene": {"frames": [1, 1_000_000], "fps": FPS},
        "cloth": [cloth],
        "collision": {"enabled": False},
        "solver": solver or {},
    }
    starts = np.arange(0, sheet.faces.size, 4, dtype=np.int32)
    mesh = (sheet.rest, starts, np.ascontiguousarray(sheet.faces).reshape(-1))
    return boucle_core.Simulation(json.dumps(scene), [mesh], threads)


def main(side: int, threads: int, frames: int, seconds: float) -> None:
    """Measure as many frames as begin within some seconds; the certificates go along."""
    sheet = Sheet(side)
    started = time.perf_counter()
    cloth = simulation(sheet, threads)
    set_up = time.perf_counter() - started
    certificates = []
    positions = np.empty((side * side, 3), dtype=np.float32)

    def step() -> np.ndarray:
        certificates.append(cloth.advance())
        cloth.read_positions(0, positions)
        return positions

    result = follow(sheet, frames, step, seconds=seconds)
    for key in ("max_strain", "p99_strain", "substeps", "iterations", "hash"):
        result[key] = [certificate[key] for certificate in certificates]
    tell({**result, "set_up_ms": 1e3 * set_up})


if __name__ == "__main__":
    main(**json.loads(sys.argv[1]))
