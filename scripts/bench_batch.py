"""`bench batch`: what one call for many scenes gains over the same scenes one call each, and how it uses the cores.

Hanging sheets, BDF2, no contact: many small ones (16²), some middling (96²) and two large (192², beyond the size from which
on scenes run one after the other with all threads). Three ways take turns, so that each meets the same load of the machine,
and the middle of all rounds counts: one call a scene with one thread, one call a scene with all threads, and one call for all.
The last rows must be equal to the bit. `BOUCLE_BENCH=quick` takes fewer scenes and rounds.
"""

from __future__ import annotations

import json
import os
import time
from typing import Any

import boucle_core

from bench import median, table, verdict
from bench_sweep import ratios

GROUPS = (("small", 16, 24, 192), ("middling", 96, 6, 6), ("large", 192, 3, 2))
"""Name, vertices along a side, frames, scenes."""
ROUNDS = 5
QUICK_ROUNDS, QUICK_PART = 2, 4
TARGET = 1.5
"""Of small scenes on two cores or more: what one call for all gains over one call each with one thread."""


def scenes(side: int, frames: int, count: int) -> list[str]:
    """Sheets that differ in their density."""
    return [
        json.dumps(
            {
                "scene": {"frames": [1, frames]},
                "cloth": [
                    {
                        "name": "sheet",
                        "grid": {"size": [1.0, 1.0], "vertices": [side, side], "plane": "xz"},
                        "pins": ["top_left", "top_right"],
                        "density": 0.15 + 0.1 * number / count,
                    }
                ],
                "collision": {"enabled": False},
            }
        )
        for number in range(count)
    ]


def timed(batches: list[list[str]], threads: int) -> tuple[float, list[str]]:
    """Seconds of one call a batch, and the last frame's hash of each scene."""
    started = time.perf_counter()
    rows = [row for batch in batches for row in boucle_core.run_batch(batch, threads=threads)]
    seconds = time.perf_counter() - started
    failed = [row["error"] for row in rows if row["ending"] != "done"]
    if failed:
        raise RuntimeError(f"{len(failed)} of {len(rows)} scenes failed: {failed[0]}")
    return seconds, [row["last"]["hash"] for row in rows]


def bench() -> dict[str, Any]:
    """Measure, print the table and return the numbers."""
    is_quick = os.environ.get("BOUCLE_BENCH") == "quick"
    rounds = QUICK_ROUNDS if is_quick else ROUNDS
    found = []
    for name, side, frames, count in GROUPS:
        texts = scenes(side, frames, max(2, count // QUICK_PART) if is_quick else count)
        each = [[text] for text in texts]
        ways = {"one": (each, 1), "all": (each, 0), "batch": ([texts], 0)}
        times: dict[str, list[float]] = {way: [] for way in ways}
        bits = set()
        for _ in range(rounds):
            for way, (batches, threads) in ways.items():
                seconds, hashes = timed(batches, threads)
                times[way].append(seconds)
                bits.add(tuple(hashes))
        found.append(
            {
                "scenes": f"{len(texts)} {name} ({side}², {frames} frames)",
                "one_thread_seconds": median(times["one"]),
                "all_threads_seconds": median(times["all"]),
                "batch_seconds": median(times["batch"]),
                "ratio": median(ratios(times["one"], times["batch"])),
                "ratio_of_all_threads": median(ratios(times["all"], times["batch"])),
                "same_bits": len(bits) == 1,
            }
        )
    print(f"{rounds} rounds, {os.cpu_count()} cores")
    head = ["scenes", "1 thread, s", "all, s", "batch, s", "gain", "over all", "same bits"]
    print(table(head, [[*row.values()] for row in found]))
    ratio = found[0]["ratio"]
    print(
        verdict(f"small scenes {TARGET} times as fast in one call ({ratio:.2f})", ratio >= TARGET)
    )
    return {"rounds": rounds, "target": TARGET, "rows": found}
