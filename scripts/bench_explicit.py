"""`bench explicit`: the explicit kernel beside the same algorithm in vectorised numpy, in one run.

Both move the paper's hanging cloth of 128 x 128 vertices (12 neighbours each) by the same steps of symplectic
Euler, in float64, from the same rest pose; the positions after the first frame must agree.
"""

from __future__ import annotations

import json
import os
from typing import Any

import boucle_core
import numpy as np
from bench import median, seconds_each, table, verdict
from numpy_cloth import ALL_STEPS, Cloth, GridStep, PlainStep, Sheet

STEPS_PER_FRAME = 256
FRAMES_TIMED = 9
NUMPY_STEPS_TIMED = 15
NUMPY_REPEATS = 7
SAME_POSITION = 1e-9
"""m; the two add forces in another order, and rounding grows over a frame's 256 steps by some orders."""
TARGET_NANOSECONDS = 2.0
TARGET_RATIO = 60.0


def bench() -> dict[str, Any]:
    """Time both, print the table and return the numbers."""
    sheet = Sheet(time_step=1.0 / 24.0 / STEPS_PER_FRAME)
    springs = sheet.spring_count()
    difference = check_same_motion(sheet)
    print(f"{sheet.vertices}² vertices, {springs} springs; positions agree to {difference:.1e} m")
    ours = [time_ours(sheet, threads) for threads in sorted({1, min(2, os.cpu_count() or 1)})]
    yardsticks = [time_numpy(step, sheet) for step in ALL_STEPS]
    for row in ours + yardsticks:
        row["nanoseconds"] = row["seconds_per_step"] / springs * 1e9
        row["nanoseconds_core"] = row["nanoseconds"] * row["threads"]
    best = min(ours, key=lambda row: row["seconds_per_step"])
    for row in yardsticks:
        row["ratio"] = row["seconds_per_step"] / best["seconds_per_step"]
    print_table(ours, yardsticks)
    plain = next(row for row in yardsticks if row["name"] == PlainStep.name)
    single = ours[0]["nanoseconds_core"]
    print(
        verdict(
            f"below {TARGET_NANOSECONDS} ns per spring, step and core", single < TARGET_NANOSECONDS
        )
    )
    for row in yardsticks:
        print(verdict(f"{TARGET_RATIO:.0f} times {row['name']}", row["ratio"] >= TARGET_RATIO))
    return {
        "vertices": sheet.vertices**2,
        "springs": springs,
        "largest_difference_m": difference,
        "ours": ours,
        "numpy": yardsticks,
        "ratio": plain["ratio"],
    }


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
        "solver": {"integrator": "symplectic_euler", "substeps": STEPS_PER_FRAME},
    }
    positions = np.ascontiguousarray(sheet.rest_positions().reshape(3, -1).T)
    index = np.arange(n * n, dtype=np.int32).reshape(n, n)
    corners = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1)
    starts = np.arange(0, corners.size, 4, dtype=np.int32)
    meshes = [(positions, starts, np.ascontiguousarray(corners).reshape(-1))]
    return boucle_core.Simulation(json.dumps(scene), meshes, threads)


def check_same_motion(sheet: Sheet) -> float:
    """Move both by one frame and return the largest difference of a coordinate (m).

    Raises:
        SystemExit: They do not compute the same thing, so comparing their speed says nothing.
    """
    ours, theirs = simulation(sheet, 0), GridStep(sheet)
    if ours.spring_count(0) != sheet.spring_count():
        raise SystemExit(f"{ours.spring_count(0)} springs of ours, {sheet.spring_count()} in numpy")
    ours.advance()
    for _ in range(STEPS_PER_FRAME):
        theirs.step()
    positions = np.empty((sheet.vertices**2, 3))
    ours.read_positions(0, positions)
    difference = float(np.abs(positions - theirs.positions()).max())
    if not difference < SAME_POSITION:
        raise SystemExit(f"positions differ by {difference} m, {SAME_POSITION} is allowed")
    return difference


def time_ours(sheet: Sheet, threads: int) -> dict[str, Any]:
    """Median time of a step of ours, over whole frames, certificates included."""
    cloth = simulation(sheet, threads)
    times = [t / STEPS_PER_FRAME for t in seconds_each(cloth.advance, FRAMES_TIMED)]
    return {"name": "Boucle", "threads": threads, "seconds_per_step": median(times)}


def time_numpy(make: type[Cloth], sheet: Sheet) -> dict[str, Any]:
    """Median time of a step of numpy's, each time over several steps."""
    cloth = make(sheet)

    def work() -> None:
        for _ in range(NUMPY_STEPS_TIMED):
            cloth.step()

    times = [t / NUMPY_STEPS_TIMED for t in seconds_each(work, NUMPY_REPEATS)]
    return {"name": make.name, "threads": 1, "seconds_per_step": median(times)}


def print_table(ours: list[dict[str, Any]], yardsticks: list[dict[str, Any]]) -> None:
    """Print all rows, ours first."""
    headings = [
        "",
        "threads",
        "ms/step",
        "ns/spring/step",
        "ns/spring/step/core",
        "ours is faster by",
    ]
    rows = [
        [
            row["name"],
            row["threads"],
            row["seconds_per_step"] * 1e3,
            row["nanoseconds"],
            row["nanoseconds_core"],
            f"{row['ratio']:.0f}x" if "ratio" in row else "",
        ]
        for row in ours + yardsticks
    ]
    print(table(headings, rows))
