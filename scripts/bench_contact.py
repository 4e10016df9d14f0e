"""`bench contact`: a sheet that falls on a ball and on itself, beside Blender's cloth; and every scene of contact at full size.

A sheet of 2 m x 2 m falls on a ball of 0.5 m radius for 36 frames. Ours has its default settings and is measured before and
after Blender's, which has its own with self-collision on. Both are compared over the frames that both did in their time.
Intersections of both are counted exactly by our own count, and the last frames are shown to ipctk as well.
`BOUCLE_BENCH=quick` measures 64² alone, no scenes.
"""

from __future__ import annotations

import math
import os
from typing import Any

from bench import table, verdict
from versus import cases, full_size
from versus.boucle import RATE
from versus.targets import OVER_RATE, target

FRAMES = 36
SIDES = (64, 128)
QUICK_SIDES = (64,)
THREADS = 2
SECONDS = {64: 60.0, 128: 120.0}
"""No frame of ours begins later."""
BLENDER_SECONDS = {64: 60.0, 128: 180.0}
"""No frame of Blender's begins later."""
SCENE_SECONDS = 45.0
"""A scene at full size is stopped after as long."""
FASTER = {64: 10.0, 128: 20.0}
"""Times the speed of Blender's cloth, as the mean over frames."""
STEADY = 3.0
"""Times the mean that the slowest frame may take."""


def bench() -> dict[str, Any]:
    """Measure everything, print the tables and return the numbers."""
    quick = os.environ.get("BOUCLE_BENCH") == "quick"
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    rows, found = [], []
    for side in QUICK_SIDES if quick else SIDES:
        pair = compared(side)
        rows += pair
        found += verdicts(side, *pair)
        print_rows(pair)
    for each in found:
        print(verdict(f"{each['target']} (reached {each['reached']})", each["met"]))
    scenes = [] if quick else full_size.rows(THREADS, SCENE_SECONDS)
    if scenes:
        print_scenes(scenes)
    return {
        "frames": FRAMES,
        "load_at_start": load,
        "rows": rows,
        "scenes": scenes,
        "verdicts": found,
    }


def compared(side: int) -> list[dict[str, Any]]:
    """Rows of one resolution: ours, then Blender's."""
    of_all = {"side": side, "frames": FRAMES}
    of_ours = {**of_all, "seconds": SECONDS[side], "threads": THREADS}
    of_theirs = {**of_all, "seconds": BLENDER_SECONDS[side]}

    def measure_ours() -> dict[str, Any]:
        return cases.ask("boucle_drop", of_ours, timeout=3.0 * SECONDS[side] + 120.0)

    before = measure_ours()
    theirs = cases.ask("blender_drop", of_theirs, timeout=3.0 * BLENDER_SECONDS[side] + 120.0)
    ours = averaged(before, measure_ours())
    common = min(len(ours.get("ms", [])), len(theirs.get("ms", [])))
    return [row("Boucle", side, ours, common), row("Blender's cloth", side, theirs, common)]


def averaged(before: dict[str, Any], after: dict[str, Any]) -> dict[str, Any]:
    """Two equal runs of ours as one, each frame with the mean of its times, because the load of a machine changes."""
    if "failed" in before or "failed" in after:
        return before if "failed" in before else after
    pairs = zip(before["ms"], after["ms"], strict=False)
    return {**before, "ms": [0.5 * (a + b) for a, b in pairs]}


def row(name: str, side: int, result: dict[str, Any], common: int) -> dict[str, Any]:
    """The numbers of a case; `ms_common` is the mean over the first frames, which both did."""
    times = result.get("ms", [])
    found = {"name": name, "side": side, "failed": result.get("failed"), "frames": len(times)}
    if not times or found["failed"]:
        return found
    return found | {
        "ms_common": sum(times[:common]) / max(1, common),
        "common": common,
        "ms_mean": sum(times) / len(times),
        "ms_most": max(times),
        "max_strain": max(result["max_strain"]),
        "intersections": sum(count or 0 for count in result["intersections"]),
        "worst_intersections": max(count or 0 for count in result["intersections"]),
        "ipctk": sum(result["ipctk"]),
        "ipctk_frames": len(result["ipctk"]),
        "depth_m": result["depth"],
        "set_up_ms": result["set_up_ms"],
        "peak_bytes": result["peak_bytes"],
        "run": result,
    }


def verdicts(side: int, ours: dict[str, Any], theirs: dict[str, Any]) -> list[dict[str, Any]]:
    """Every target that one resolution speaks about."""
    if ours["failed"] or "ms_mean" not in ours:
        return [target(f"{side}²: it runs", False, str(ours["failed"]))]
    ratio = theirs.get("ms_common", math.nan) / ours["ms_common"]
    uneven = ours["ms_most"] / ours["ms_mean"]
    strain, most = ours["max_strain"], RATE + OVER_RATE
    count, seen = ours["intersections"], ours["ipctk"]
    text = f"{side}²: {FASTER[side]:.0f} times the speed of Blender's cloth"
    return [
        target(text, ratio >= FASTER[side], f"{ratio:.1f}"),
        target(f"{side}²: all {FRAMES} frames in time", ours["frames"] == FRAMES, ours["frames"]),
        target(f"{side}²: slowest frame {STEADY:.0f} means", uneven <= STEADY, f"{uneven:.1f}"),
        target(f"{side}²: no intersection", count == 0, f"{count}"),
        target(f"{side}²: none that ipctk finds", seen == 0, f"{seen} of {ours['ipctk_frames']}"),
        target(f"{side}²: strain {100 * most:.1f} %", strain <= most, f"{100 * strain:.2f} %"),
    ]


def print_rows(rows: list[dict[str, Any]]) -> None:
    """A table of both programs; a case that failed says why in its first cell."""
    headings = [
        "",
        "grid",
        "frames",
        "ms/frame, same frames",
        "ms/frame",
        "slowest",
        "slowest/mean",
    ]
    headings += ["max strain %", "intersections", "most a frame", "ipctk", "depth mm", "MB"]
    print(table(headings, [cells(row, len(headings)) for row in rows]), flush=True)


def cells(row: dict[str, Any], count: int) -> list[object]:
    """A row as it is printed."""
    name = row["name"] + (f" ({row['failed']})" if row["failed"] else "")
    first = [name, f"{row['side']}²", row["frames"]]
    if "ms_mean" not in row:
        return [*first, *[""] * (count - len(first))]
    times = [f"{row[key]:.0f}" for key in ("ms_common", "ms_mean", "ms_most")]
    return [
        *first,
        *times,
        f"{row['ms_most'] / row['ms_mean']:.1f}",
        f"{100.0 * row['max_strain']:.2f}",
        row["intersections"],
        row["worst_intersections"],
        f"{row['ipctk']} of {row['ipctk_frames']}",
        f"{1e3 * row['depth_m']:.2f}",
        f"{row['peak_bytes'] / 1e6:.0f}",
    ]


def print_scenes(scenes: list[dict[str, Any]]) -> None:
    """A table of the scenes at full size."""
    headings = ["scene", "vertices", "frames", "ms/frame", "slowest", "intersections", "clipped"]
    headings += ["max strain %", "MB"]
    rows = []
    for scene in scenes:
        name = scene["name"] + (f" ({scene['failed']})" if scene["failed"] else "")
        if "ms_mean" not in scene:
            rows.append([name, *[""] * (len(headings) - 1)])
            continue
        counts = [scene[key] for key in ("intersections", "clipped")]
        times = [f"{scene[key]:.0f}" for key in ("ms_mean", "ms_most")]
        ends = [f"{100 * scene['max_strain']:.2f}", f"{scene['peak_bytes'] / 1e6:.0f}"]
        rows.append([name, scene["vertices"], scene["frames"], *times, *counts, *ends])
    print(table(headings, rows), flush=True)
