"""`bench sweep`: how many runs a minute a sweep bakes with one process, and with more of them up to the number of cores.

A Latin hypercube of a hanging curtain of 24² vertices and 24 frames, whole sweeps with everything that belongs to them but the
table and the sheet: processes that start, folders, certificates. One process and more take turns, so that each meets the
same load of the machine; the middle of all rounds counts, and every run must have the same bits in all of them.
Other work on the machine takes from what more processes can gain: `bare` is that gain for processes that only count, in the
same rounds, and `CPU s` what all processes together took. `BOUCLE_BENCH=quick` takes fewer runs and rounds.
"""

from __future__ import annotations

import multiprocessing
import os
import tempfile
import time
from pathlib import Path
from typing import Any

import boucle_core

from bench import median, table, verdict
from environment import ROOT
from sweep import core_count
from sweeping import description, local
from sweeping.folder import Folder
from sweeping.run import Job

SWEEP = """
[sweep]
scene = '{scene}'
method = "latin_hypercube"
samples = {runs}
set = {{ "cloth.0.grid.vertices" = [24, 24], "scene.frames" = [1, 24] }}
[parameters]
"cloth.0.density" = {{ from = 0.15, to = 0.25 }}
"cloth.0.springs.shear" = {{ from = 80, to = 120 }}
"""
RUNS, ROUNDS = 32, 5
QUICK_RUNS, QUICK_ROUNDS = 16, 2
COUNTS = 120_000_000
"""Steps of the bare count: some seconds."""
TARGET = 1.8
"""What two processes on two cores bake, in times of one."""


def bench() -> dict[str, Any]:
    """Measure, print the table and return the numbers."""
    is_quick = os.environ.get("BOUCLE_BENCH") == "quick"
    runs, rounds = (QUICK_RUNS, QUICK_ROUNDS) if is_quick else (RUNS, ROUNDS)
    cores = core_count()
    counts = [count for count in (1, 2, 4, 8, 16) if count <= max(2, cores)]
    times: dict[int, list[float]] = {count: [] for count in counts}
    bare: dict[int, list[float]] = {count: [] for count in counts}
    cpu: dict[int, list[float]] = {count: [] for count in counts}
    hashes = set()
    with tempfile.TemporaryDirectory() as folder:
        scene = ROOT / "tests" / "scenes" / "curtain.toml"
        file = Path(folder) / "sweep.toml"
        file.write_text(SWEEP.format(scene=scene, runs=runs), encoding="utf-8")
        plan = description.read(file)
        for number in range(rounds):
            for count in counts:
                out = Path(folder) / f"{number}_{count}"
                cpu_before = cpu_of_children()
                seconds, bits = sweep_once(plan, out, count)
                cpu[count].append(cpu_of_children() - cpu_before)
                times[count].append(seconds)
                bare[count].append(count_up(count))
                hashes.add(bits)
    rows = [
        {
            "processes": count,
            "seconds": median(times[count]),
            "seconds_least": min(times[count]),
            "seconds_most": max(times[count]),
            "runs_per_minute": 60 * runs / median(times[count]),
            "cpu_seconds": median(cpu[count]),
            "ratio": median(ratios(times[1], times[count])),
            "bare_ratio": median(ratios(bare[1], bare[count])),
        }
        for count in counts
    ]
    print(f"{runs} runs, {rounds} rounds, {cores} cores; the same bits: {len(hashes) == 1}")
    head = ["processes", "s", "least", "most", "runs/min", "CPU s", "ratio", "bare"]
    print(table(head, [[*row.values()] for row in rows]))
    ratio = rows[1]["ratio"]
    print(verdict(f"{TARGET} times one process with two ({ratio:.2f})", ratio >= TARGET))
    return {
        "runs": runs,
        "rounds": rounds,
        "target": TARGET,
        "same_bits": len(hashes) == 1,
        "rows": rows,
    }


def ratios(ones: list[float], many: list[float]) -> list[float]:
    """How many times as fast the second was, round by round."""
    return [one / other for one, other in zip(ones, many, strict=True)]


def cpu_of_children() -> float:
    """Seconds of processor that the processes took which this one started and which have ended."""
    times = os.times()
    return times.children_user + times.children_system


def count_up(processes: int) -> float:
    """Seconds in which some processes do a fixed amount of work that needs nothing but processors."""
    context = multiprocessing.get_context("spawn")
    parts = [context.Process(target=_count, args=(COUNTS // processes,)) for _ in range(processes)]
    started = time.perf_counter()
    for part in parts:
        part.start()
    for part in parts:
        part.join()
    return time.perf_counter() - started


def _count(steps: int) -> None:
    for _ in range(steps):
        pass


def sweep_once(plan: description.Sweep, out: Path, processes: int) -> tuple[float, tuple[str, ...]]:
    """Bake all runs anew; seconds, and the last frame's hash of each run."""
    folder = Folder(out)
    started = time.perf_counter()
    folder.prepare({"boucle": boucle_core.__version__, "digest": plan.digest()}, resume=False)
    with folder.session() as session:
        jobs = [
            Job(
                run=run.name,
                scene=str(plan.scene),
                out=str(out),
                session=str(session),
                boucle=boucle_core.__version__,
                overrides=plan.overrides(run),
                parameters=run.parameters,
                frames=None,
                timeout=None,
                blender=None,
            )
            for run in plan.runs
        ]
        found = {outcome["run"]: outcome for outcome in local.outcomes(jobs, processes)}
    seconds = time.perf_counter() - started
    failed = [outcome["error"] for outcome in found.values() if outcome["status"] != "done"]
    if failed or len(found) != len(jobs):
        raise RuntimeError(
            f"{len(found)} of {len(jobs)} runs ended, {len(failed)} failed: {failed[:1]}"
        )
    return seconds, tuple(found[run.name]["certificate"]["hash"] for run in plan.runs)
