"""What the solver is meant to reach, and whether it does."""

from __future__ import annotations

import math
from typing import Any

from .boucle import RATE

FASTER = {64: 20.0, 128: 35.0, 256: 45.0}
"""Times the speed of Blender's cloth, with two threads."""
SECONDS_512 = 0.6
BYTES_512 = 1.5e9
OVER_RATE = 1e-3
"""Strain beyond the rate that is allowed: 0.1 percentage points."""
EXPONENT = 1.15
SET_UP_FRAMES = 10.0
SPEED_UP = 1.6
SPEED_UP_SIDE = 256


def verdicts(rows: list[dict[str, Any]], same: dict[int, bool]) -> list[dict[str, Any]]:
    """Every target that the measured rows speak about."""
    measured = {(row["name"], row["side"], row.get("threads")): row for row in rows}
    ours = {side: row for (name, side, n), row in measured.items() if (name, n) == ("Boucle", 2)}
    found = [found for side, row in ours.items() for found in of_side(side, row, measured)]
    timed = {side: row["ms_median"] for side, row in ours.items() if "ms_median" in row}
    if len(timed) > 1:
        exponent = slope({side * side: ms for side, ms in timed.items()})
        text = f"time grows at most with vertices^{EXPONENT}"
        found.append(target(text, exponent <= EXPONENT, f"{exponent:.3f}"))
    for side, is_same in same.items():
        text = f"{side}²: same bits for any number of threads"
        found.append(target(text, is_same, "same" if is_same else "not the same"))
    return found


def of_side(
    side: int, row: dict[str, Any], measured: dict[Any, dict[str, Any]]
) -> list[dict[str, Any]]:
    """Targets of one resolution."""
    if "ms_median" not in row or row["failed"]:
        return [target(f"{side}²: it runs", False, str(row["failed"]))]
    ms = row["ms_median"]
    found = []
    for name in ("Blender's cloth", "Blender's cloth, default mass") if side in FASTER else ():
        ratio = measured.get((name, side, "its own"), {}).get("ms_median", math.nan) / ms
        text = f"{side}²: {FASTER[side]:.0f} times the speed of {name}"
        found.append(target(text, ratio >= FASTER[side], f"{ratio:.1f}"))
    if side == 512:
        text = f"{side}²: at most {SECONDS_512} s a frame"
        found.append(target(text, ms <= 1e3 * SECONDS_512, f"{1e-3 * ms:.2f} s"))
        peak = row["peak_bytes"]
        text = f"{side}²: at most {BYTES_512 / 1e9} GB"
        found.append(target(text, peak <= BYTES_512, f"{peak / 1e9:.2f} GB"))
    strain = row["max_strain"]
    text = f"{side}²: strain at most {100 * (RATE + OVER_RATE):.1f} %"
    found.append(target(text, strain <= RATE + OVER_RATE, f"{100 * strain:.2f} %"))
    text = f"{side}²: set-up takes less than {SET_UP_FRAMES:.0f} frames"
    found.append(
        target(text, row["set_up_ms"] < SET_UP_FRAMES * ms, f"{row['set_up_ms'] / ms:.1f}")
    )
    if side == SPEED_UP_SIDE:
        speed_up = measured[("Boucle", side, 1)].get("ms_median", math.nan) / ms
        text = f"{side}²: two threads are {SPEED_UP} times as fast as one"
        found.append(target(text, speed_up >= SPEED_UP, f"{speed_up:.2f}"))
    return found


def target(text: str, is_met: bool, reached: str) -> dict[str, Any]:
    """A target: what it asks for, what was reached, and whether that is enough."""
    return {"target": text, "reached": reached, "met": bool(is_met)}


def slope(values: dict[int, float]) -> float:
    """The exponent p of value ~ count^p, by least squares of the logarithms."""
    points = [(math.log(count), math.log(value)) for count, value in values.items()]
    middle = [sum(axis) / len(points) for axis in zip(*points, strict=True)]
    top = sum((x - middle[0]) * (y - middle[1]) for x, y in points)
    return top / sum((x - middle[0]) ** 2 for x, _ in points)
