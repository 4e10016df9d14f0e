"""`bench solver`: our solver beside Blender's cloth and other simulators, on one hanging sheet, in one run.

A sheet of 2 m x 2 m and 0.2 kg/m² lies flat, held by two corners, and falls for a second (24 frames). Each program
runs in a process of its own, with its own material: Blender's is its default, and peers are tuned as their notes say,
so that speed stands beside the strain that it bought. `BOUCLE_BENCH=quick` measures 64² alone.
"""

from __future__ import annotations

import os
from typing import Any

from bench import table, verdict
from environment import Failed, Missing
from versus import cases, peers, resolution, targets

FRAMES = 24
SIDES = (64, 128, 256, 512)
QUICK_SIDES = (64,)
THREADS = (1, 2)
ROUNDS = {64: 2, 128: 2}
"""Ours is measured before and after Blender where it is quick, because the load of a machine changes; elsewhere once."""
SECONDS = 60.0
"""No frame of ours begins later."""
BLENDER_SECONDS = {64: 30.0, 128: 30.0, 256: 60.0, 512: 45.0}
"""No frame of Blender's begins later; it is stopped after twice as long and a minute."""
BLENDER_FRAMES = {512: 4}
"""Elsewhere as many as ours."""
SAME_BITS_THREADS = (1, 2, 3, 4, 8)
SAME_BITS_FRAMES = {64: 100, 128: 100, 256: 24}


def bench() -> dict[str, Any]:
    """Measure everything, print the tables and return the numbers."""
    quick = os.environ.get("BOUCLE_BENCH") == "quick"
    sides = QUICK_SIDES if quick else SIDES
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    rows = []
    for side in sides:
        rows += ours_and_blenders(side)
        print_rows(rows[-len(THREADS) - 2 :])
    same = {side: same_bits(side) for side in sides if side in SAME_BITS_FRAMES}
    others = peer_rows(sides[:1], 8.0) if quick else peer_rows(sides[:2], 25.0)
    found = targets.verdicts(rows, same)
    for each in found:
        print(verdict(f"{each['target']} (reached {each['reached']})", each["met"]))
    sags = resolution.table_of(resolution.QUICK_SIDES if quick else resolution.SIDES)
    return {
        "frames": FRAMES,
        "load_at_start": load,
        "rows": rows,
        "peers": others,
        "same_bits": same,
        "resolution": sags,
        "verdicts": found,
    }


def ours_and_blenders(side: int) -> list[dict[str, Any]]:
    """Rows of one resolution: ours for each number of threads, then Blender's."""
    runs: dict[int, list[dict[str, Any]]] = {threads: [] for threads in THREADS}

    def ours() -> None:
        for threads, results in runs.items():
            arguments = {"side": side, "threads": threads, "frames": FRAMES, "seconds": SECONDS}
            results.append(cases.ask("boucle", arguments, timeout=180.0))

    ours()
    theirs = [blender(side, default_mass) for default_mass in (False, True)]
    for _ in range(ROUNDS.get(side, 1) - 1):
        ours()
    rows = [cases.row("Boucle", side, results, threads=n) for n, results in runs.items()]
    names = ("Blender's cloth", "Blender's cloth, default mass")
    return rows + [
        cases.row(name, side, [result], threads="its own")
        for name, result in zip(names, theirs, strict=True)
    ]


def blender(side: int, default_mass: bool) -> dict[str, Any]:
    """Blender's cloth on a grid, with our mass or its default."""
    seconds = BLENDER_SECONDS[side]
    frames = BLENDER_FRAMES.get(side, FRAMES)
    arguments = {"side": side, "frames": frames, "seconds": seconds}
    arguments["default_mass"] = default_mass
    return cases.ask("blender", arguments, timeout=2.0 * seconds + 60.0)


def same_bits(side: int) -> bool:
    """Whether every number of threads gives the same positions at every frame."""
    frames = SAME_BITS_FRAMES[side]
    hashes = set()
    for threads in SAME_BITS_THREADS:
        arguments = {"side": side, "threads": threads, "frames": frames, "seconds": 2.0 * SECONDS}
        result = cases.ask("boucle", arguments, timeout=180.0)
        if "failed" in result or len(result["hash"]) != frames:
            print(
                f"same bits, {side}², {threads} threads: {result.get('failed', 'frames missing')}"
            )
            return False
        hashes.add(tuple(result["hash"]))
    return len(hashes) == 1


def peer_rows(sides: tuple[int, ...], seconds: float) -> list[dict[str, Any]]:
    """Rows of the other simulators, or a line that says why there are none."""
    try:
        peers.install()
    except (Failed, Missing) as fault:
        print(f"peers: not installed: {fault}")
        return []
    rows = [row for side in sides for row in peers.rows(side, FRAMES, seconds)]
    print_rows(rows)
    for peer in peers.PEERS:
        print(f"  {peer.name}: {peer.note}")
    print(f"  {peers.LEFT_OUT}")
    return rows


def print_rows(rows: list[dict[str, Any]]) -> None:
    """A table of rows; a case that failed says why in its first cell."""
    headings = ["", "grid", "threads", "frames", "ms/frame", "least", "most", "processor ms"]
    headings += ["set-up ms", "max strain %", "p99 %", "lowest m", "MB", "substeps", "iterations"]
    print(table(headings, [cells(row) for row in rows]), flush=True)


def cells(row: dict[str, Any]) -> list[object]:
    """A row as it is printed."""
    name = row["name"] + (f" ({row['failed']})" if row["failed"] else "")
    if "ms_median" not in row:
        return [name, f"{row['side']}²", row.get("threads", ""), *[""] * 12]
    return [
        name,
        f"{row['side']}²",
        row.get("threads", ""),
        row["frames"],
        *(row[key] for key in ("ms_median", "ms_least", "ms_most", "cpu_ms_median", "set_up_ms")),
        *(f"{100.0 * row[key]:.2f}" for key in ("max_strain", "p99_strain")),
        f"{row['lowest_m']:.2f}",
        f"{row['peak_bytes'] / 1e6:.0f}",
        *("" if row[key] is None else f"{row[key]:g}" for key in ("substeps", "iterations")),
    ]
