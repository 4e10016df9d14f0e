"""What every measured process does: time its frames, and print one line of JSON at the end."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from .sheet import Sheet

MARK = "RESULT "
"""Begins the line that holds the result; programs print lines of their own before it."""


def follow(
    sheet: Sheet, frames: int, step: Callable[[], np.ndarray], *, seconds: float | None = None
) -> dict[str, Any]:
    """Move a sheet on by some frames and time each one, the reading of its positions included.

    Args:
        sheet: What moves.
        frames: How many, at most.
        step: Moves on by a frame and returns the positions (m).
        seconds: No frame begins after as many; no limit by default.

    Returns:
        For each frame: wall-clock and processor time (ms), largest strain and its 99th percentile (fractions), height (m)
        of the lowest vertex.
    """
    keys = ("ms", "cpu_ms", "max_strain", "p99_strain", "lowest")
    rows: dict[str, list[float]] = {key: [] for key in keys}
    begun = time.perf_counter()
    for _ in range(frames):
        started, used = time.perf_counter(), time.process_time()
        positions = step()
        rows["ms"].append(1e3 * (time.perf_counter() - started))
        rows["cpu_ms"].append(1e3 * (time.process_time() - used))
        if not np.isfinite(positions).all():
            return {**rows, "failed": "positions are no longer numbers"}
        largest, most = sheet.strain(positions)
        rows["max_strain"].append(largest)
        rows["p99_strain"].append(most)
        rows["lowest"].append(float(positions.reshape(-1, 3)[:, 2].min()))
        if seconds is not None and time.perf_counter() - begun > seconds:
            break
    return dict(rows)


def peak_memory() -> int:
    """The most memory (bytes) that this process ever held."""
    try:
        with open("/proc/self/status", encoding="ascii") as lines:
            return 1024 * next(int(line.split()[1]) for line in lines if line.startswith("VmHWM"))
    except OSError:
        import resource

        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss  # bytes on macOS


def tell(result: dict[str, Any]) -> None:
    """Print the result for the process that asked."""
    print(MARK + json.dumps({"peak_bytes": peak_memory(), **result}), flush=True)
