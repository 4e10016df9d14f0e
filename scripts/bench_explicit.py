"""`bench explicit`: the explicit kernel beside the same algorithm in vectorised numpy, in one run.

Both move the paper's hanging cloth of 128 x 128 vertices (12 neighbours each) by the same steps of symplectic
Euler, in float64; after a frame from the same state, their positions must agree.
"""

from __future__ import annotations

import json
import os
from typing import Any

import boucle_core
import numpy as np

from bench import median, seconds_each, table, verdict
from numpy_cloth import ALL_STEPS, Cloth, GridStep, Sheet

STEPS_PER_FRAME = 256
ROUNDS = 9
NUMPY_STEPS = 9
SAME_POSITION = 1e-9
"""m; the two add forces in another order, and rounding grows over a frame's 256 steps by some orders."""
LEAST_MOTION = 1e-3
"""m; a free fall of one frame is 8.5 mm."""
TARGET_NANOSECONDS = 2.0
TARGET_RATIO = 60.0


def bench() -> dict[str, Any]:
    """Time all of them in turns, so that each meets the same load; print the table and return the numbers."""
    sheet = Sheet(time_step=1.0 / 24.0 / STEPS_PER_FRAME)
    springs = sheet.spring_count()
    difference = check_same_motion(sheet)
    print(f"{sheet.vertices}² vertices, {springs} springs; positions agree to {difference:.1e} m")
    threads = sorted({1, min(2, os.cpu_count() or 1)})
    runners = [Ours(sheet, count) for count in threads] + [Numpy(make, sheet) for make in ALL_STEPS]
    rounds = [[runner.seconds_per_step() for runner in runners] for _ in range(ROUNDS + 1)][1:]
    rows = [row_of(runner, rounds, i, springs) for i, runner in enumerate(runners)]
    compare(rows, rounds, len(threads))
    print_table(rows)
    verdicts = verdicts_of(rows, len(threads))
    for each in verdicts:
        print(verdict(each["target"], each["met"]))
    return {
        "vertices": sheet.vertices**2,
        "springs": springs,
        "largest_difference_m": difference,
        "rounds": ROUNDS,
        "threads": threads,
        "cores": os.cpu_count(),
        "rows": rows,
        "verdicts": verdicts,
    }


def verdicts_of(rows: list[dict[str, Any]], ours: int) -> list[dict[str, Any]]:
    """Each target: what it asks for, what was reached, with how many threads, and whether that is enough."""
    best = min(rows[:ours], key=lambda row: row["nanoseconds_core"])
    speed = {
        "target": f"below {TARGET_NANOSECONDS} ns per spring, step and core",
        "wanted": TARGET_NANOSECONDS,
        "reached": best["nanoseconds_core"],
        "threads": best["threads"],
        "met": best["nanoseconds_core"] < TARGET_NANOSECONDS,
    }
    ratios = [
        {
            "target": f"{TARGET_RATIO:.0f} times the speed of {row['name']}",
            "wanted": TARGET_RATIO,
            "reached": row["ratio"],
            "threads": rows[ours - 1]["threads"],
            "met": row["ratio"] >= TARGET_RATIO,
        }
        for row in rows[ours:]
    ]
    return [speed, *ratios]


class Ours:
    """Our simulation; a turn is one frame, its certificate included."""

    def __init__(self, sheet: Sheet, threads: int) -> None:
        self.name, self.threads = "Boucle", threads
        self.simulation = simulation(sheet, threads)

    def seconds_per_step(self) -> float:
        """Seconds of a step, over one turn."""
        return seconds_each(self.simulation.advance, 1, warm_up=0)[0] / STEPS_PER_FRAME


class Numpy:
    """One of the yardsticks; a turn is some steps."""

    def __init__(self, make: type[Cloth], sheet: Sheet) -> None:
        self.name, self.threads = make.name, 1
        self.cloth = make(sheet)

    def seconds_per_step(self) -> float:
        """Seconds of a step, over one turn."""
        return median(seconds_each(self.cloth.step, NUMPY_STEPS, warm_up=0))


def row_of(runner: Ours | Numpy, rounds: list[list[float]], i: int, springs: int) -> dict[str, Any]:
    """The numbers of one runner over all rounds: median, and the least that the machine allowed."""
    times = [times[i] for times in rounds]
    nanoseconds = median(times) / springs * 1e9
    return {
        "name": runner.name,
        "threads": runner.threads,
        "seconds_per_step": median(times),
        "least_seconds_per_step": min(times),
        "nanoseconds": nanoseconds,
        "nanoseconds_core": nanoseconds * runner.threads,
    }


def compare(rows: list[dict[str, Any]], rounds: list[list[float]], ours: int) -> None:
    """Add to each yardstick how many times faster ours is on all threads: the median over the rounds."""
    for i, row in enumerate(rows):
        if i >= ours:
            row["ratio"] = median([times[i] / times[ours - 1] for times in rounds])


def simulation(sheet: Sheet, threads: int) -> boucle_core.Simulation:
    """Our simulation of the sheet."""
    n = sheet.vertices
    stretch, shear, bend = sheet.stiffness
    springs = {
        "stretch": stretch,
        "shear": shear,
        "bend": bend,
        "damping": sheet.damping,
        "damping_law": "relative",
        "limiter": "none",
    }
    cloth = {
        "name": "sheet",
        "mass_per_vertex": sheet.mass,
        "pins": {"vertices": [n * n - n, n * n - 1]},
        "model": "springs",
        "springs": springs,
    }
    scene = {
        "scene": {"frames": [1, 1000], "fps": 24, "gravity": [0.0, 0.0, sheet.gravity]},
        "cloth": [cloth],
        "collision": {"enabled": False},
        "solver": {"integrator": "symplectic_euler", "substeps": STEPS_PER_FRAME},
    }
    positions = np.ascontiguousarray(sheet.rest_positions().reshape(3, -1).T)
    index = np.arange(n * n, dtype=np.int32).reshape(n, n)
    corners = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1)
    starts = np.arange(0, corners.size, 4, dtype=np.int32)
    meshes = [(positions, starts, np.ascontiguousarray(corners).reshape(-1))]
    return boucle_core.Simulation(json.dumps(scene), meshes, threads)


def state_of(cloth: boucle_core.Simulation, sheet: Sheet) -> tuple[np.ndarray, np.ndarray]:
    """Positions (m) and velocities (m/s) of our cloth, shape (3, vertices)."""
    positions, velocities = np.empty((2, sheet.vertices**2, 3))
    cloth.read_positions(0, positions)
    cloth.read_velocities(0, velocities)
    return positions.T, velocities.T


def difference_after_a_frame(sheet: Sheet, make: type[Cloth]) -> float:
    """Move both by one frame from the same state and return the largest difference of a coordinate (m).

    The state is that of ours after its first frame, at whose start it makes the sheet a little uneven.

    Raises:
        ValueError: The springs are not the same ones, or nothing moved.
    """
    ours, theirs = simulation(sheet, 0), make(sheet)
    if ours.spring_count(0) != sheet.spring_count():
        raise ValueError(f"{ours.spring_count(0)} springs of ours, {sheet.spring_count()} in numpy")
    ours.advance()
    theirs.x[...], theirs.v[...] = before, _ = state_of(ours, sheet)
    ours.advance()
    for _ in range(STEPS_PER_FRAME):
        theirs.step()
    after, _ = state_of(ours, sheet)
    moved = float(np.abs(after - before).max())
    if not moved > LEAST_MOTION:
        raise ValueError(f"the cloth moved by {moved} m in a frame; {LEAST_MOTION} is the least")
    return float(np.abs(after - theirs.x).max())


def check_same_motion(sheet: Sheet) -> float:
    """The difference (m) of ours and the fastest yardstick after a frame, if it is rounding.

    Raises:
        SystemExit: They do not compute the same thing, so comparing their speed says nothing.
    """
    difference = difference_after_a_frame(sheet, GridStep)
    if not difference < SAME_POSITION:
        raise SystemExit(f"positions differ by {difference} m, {SAME_POSITION} is allowed")
    return difference


def print_table(rows: list[dict[str, Any]]) -> None:
    """Print all rows, ours first."""
    headings = [
        "",
        "threads",
        "ms/step",
        "least",
        "ns/spring",
        "ns/spring/core",
        "ours is faster by",
    ]
    cells = [
        [
            row["name"],
            row["threads"],
            row["seconds_per_step"] * 1e3,
            row["least_seconds_per_step"] * 1e3,
            row["nanoseconds"],
            row["nanoseconds_core"],
            f"{row['ratio']:.0f}x" if "ratio" in row else "",
        ]
        for row in rows
    ]
    print(table(headings, cells))
