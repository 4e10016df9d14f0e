"""Recommended ranges, out of the measured boundaries: a table, and a file that the add-on's panel warns by."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np

from .stability import Boundary, fastest
from .theory import EXPLICIT, UNDAMPED_LIMIT

HALF = 0.5
"""A damping ratio is recommended if it leaves this part of the integrator's longest stable step."""
SAFE = 0.95
"""Part of the stable step that automatic substeps take."""
FPS = 24.0


def ranges(damped: Boundary) -> dict[str, dict[str, object]]:
    """For each explicit integrator the recommended damping ratios, and the step by 1/w_max that is stable with all of them."""
    found = {}
    for integrator in EXPLICIT:
        part = damped.of(integrator=integrator)
        w = fastest(part.points[0])
        ratios = np.array([0.5 * w * point.damping_time for point in part.points])
        steps = w * part.measured
        limit = UNDAMPED_LIMIT.get(integrator)
        best = max(float(np.nanmax(steps)), limit or 0.0)
        is_good = steps >= HALF * best
        good = ratios[is_good]
        shortest = min([float(steps[is_good].min()), *([limit] if limit else [])])
        found[integrator] = {
            "damping_ratio": [0.0 if limit else _rounded(good[0]), _rounded(good[-1])],
            "step_by_fastest": _rounded(shortest),
        }
    return found


def _rounded(value: float) -> float:
    return float(f"{value:.2g}")


def table(found: dict[str, dict[str, object]]) -> str:
    """The ranges as a Markdown table.

    k/m: stretch stiffness by mass of a particle, of a square grid with the paper's ratios, whose w_max is 2.11 sqrt(k/m).
    """
    from .sheet import Point

    by_root = fastest(Point("verlet", 1.0, 1.0))
    lines = [
        "| integrator | damping ratio | step x w_max | k/m for 10, 100, 1000 substeps a frame (1/s²) |",
        "|---|---|---|---|",
    ]
    for integrator, row in found.items():
        low, high = row["damping_ratio"]
        step = row["step_by_fastest"]
        reach = [(SAFE * step * FPS * count / by_root) ** 2 for count in (10, 100, 1000)]
        limits = ", ".join(f"{value:.1e}" for value in reach)
        lines.append(f"| {integrator} | {low:g} to {high:g} | {step:g} | {limits} |")
    lines.append("| implicit_euler, bdf2 | any | any | any: the step decides how exact they are |")
    return "\n".join(lines)


def keep(found: dict[str, dict[str, object]], path: Path) -> None:
    """Write the file that the add-on reads."""
    if not all(math.isfinite(row["step_by_fastest"]) for row in found.values()):
        raise ValueError("a boundary was not found")
    path.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
