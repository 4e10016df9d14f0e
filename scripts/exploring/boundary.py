"""The largest stable step, measured: thousands of runs in one batched call, bisected between a stable step and one that is not.

A run starts from a sheet whose rest shape is off by a hundred-thousandth of an edge, so all its oscillations have a little
energy. It counts as stable if it ends with less than a thousand times that: what only beats, by at most
(1 + wh/2)/(1 - wh/2), stays below.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import boucle_core
import numpy as np

from .sheet import JITTER, JITTERED, Point, grid, jittered

GROWN = 1000.0
"""Times the energy at the start: above it a run counts as unstable."""
STEPS = 300
"""Of a run: 2 % beyond 2/w_max the energy grows by a factor of 2 a step."""
SLOW_STEPS = {"forward_euler": 8000, "midpoint": 4000}
"""Of rules that lose their stability slowly."""

Say = Callable[[str, int, int], None]
"""Hears of a batch: what it is for, runs done, all runs."""


@dataclass
class Runs:
    """Runs batches of scenes, and counts them."""

    folder: Path
    say: Say
    threads: int = 0
    count: int = 0
    seconds: float = 0.0
    safe_steps: dict[Point, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        jittered(grid(), JITTER).write(self.folder / JITTERED)

    def run(self, what: str, scenes: Sequence[str]) -> list[dict]:
        """The rows of some scenes."""
        began = time.perf_counter()
        rows = boucle_core.run_batch(
            scenes,
            folder=str(self.folder),
            threads=self.threads,
            progress=lambda told: self.say(what, told["done"], told["total"]),
        )
        self.count += len(scenes)
        self.seconds += time.perf_counter() - began
        return rows

    def growths(self, what: str, points: Sequence[Point], steps: Sequence[float]) -> np.ndarray:
        """By what factor the energy of each point grows at its step (s); infinite where it diverges."""
        counts = [SLOW_STEPS.get(point.integrator, STEPS) for point in points]
        taken = zip(points, steps, counts, strict=True)
        rows = self.run(what, [point.scene(step, count) for point, step, count in taken])
        for point, row in zip(points, rows, strict=True):
            if row["safe_time_step"] is None:
                raise RuntimeError(f"a run that should not be refused: {row['error']}")
            self.safe_steps[point] = row["safe_time_step"]
        return np.array([growth(row) for row in rows])

    def bisect(
        self,
        what: str,
        points: Sequence[Point],
        low: Sequence[float],
        high: Sequence[float],
        rounds: int,
    ) -> np.ndarray:
        """The largest stable step (s) of each point; NaN where `low` is not stable or `high` is."""
        low, high = np.array(low, float), np.array(high, float)
        is_inside = self.growths(what, points, low) < GROWN
        is_inside &= ~(self.growths(what, points, high) < GROWN)
        for number in range(1, rounds + 1):
            middle = np.sqrt(low * high)
            is_stable = self.growths(f"{what}, {number} of {rounds}", points, middle) < GROWN
            low, high = np.where(is_stable, middle, low), np.where(is_stable, high, middle)
        return np.where(is_inside, np.sqrt(low * high), math.nan)


def growth(row: dict) -> float:
    """By what factor the energy of a run grew; infinite if it diverged."""
    if row["ending"] != "done":
        return math.inf
    start, end = (_energy(row[name]) for name in ("first", "last"))
    return end / start if math.isfinite(end) else math.inf


def _energy(certificate: dict) -> float:
    parts = [certificate["kinetic_energy"], certificate["potential_energy"]]
    return math.inf if None in parts else sum(parts)
