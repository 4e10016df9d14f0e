"""Benchmarks: `bench.py NAME|all`. Each prints a table and leaves out/bench/NAME.json."""

from __future__ import annotations

import json
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable
from typing import Any

from environment import OUT, ROOT


def seconds_each(work: Callable[[], object], repeats: int, warm_up: int = 1) -> list[float]:
    """Seconds that each of `repeats` calls takes, after some that are not counted."""
    for _ in range(warm_up):
        work()
    times = []
    for _ in range(repeats):
        started = time.perf_counter()
        work()
        times.append(time.perf_counter() - started)
    return times


def median(times: list[float]) -> float:
    """The middle one of some durations (s)."""
    return statistics.median(times)


def table(headings: list[str], rows: list[list[object]]) -> str:
    """Rows of cells as lines of text: the first column to the left, numbers to the right."""
    cells = [headings, *([f"{c:.3g}" if isinstance(c, float) else str(c) for c in r] for r in rows)]
    widths = [max(len(row[i]) for row in cells) for i in range(len(headings))]
    lines = [
        "  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in cells
    ]
    return "\n".join([lines[0], "  ".join("-" * width for width in widths), *lines[1:]])


def machine() -> dict[str, Any]:
    """What the numbers were measured on."""
    return {
        "processor": processor_name(),
        "cores": os.cpu_count(),
        "system": platform.platform(terse=True),
        "python": platform.python_version(),
    }


def processor_name() -> str:
    """The processor's own name, where the system tells it."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            return next(line.split(":", 1)[1].strip() for line in lines if "model name" in line)
    except (OSError, StopIteration):
        return platform.processor() or "unknown"


def keep(name: str, result: dict[str, Any]) -> None:
    """Write a benchmark's numbers beside the machine's name to out/bench/NAME.json."""
    file = OUT / "bench" / f"{name}.json"
    file.parent.mkdir(parents=True, exist_ok=True)
    content = {"benchmark": name, "machine": machine(), **result}
    file.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
    print(f"written: {file.relative_to(ROOT)}")


def verdict(text: str, is_met: bool) -> str:
    """A target and whether it was met."""
    return f"target {text}: {'met' if is_met else 'MISSED'}"


def main(words: list[str]) -> int:
    """Run the benchmarks that `words` names."""
    import bench_batch
    import bench_bridge
    import bench_contact
    import bench_explicit
    import bench_fabric
    import bench_solver
    import bench_sweep

    entries = {
        "explicit": bench_explicit.bench,
        "bridge": bench_bridge.bench,
        "solver": bench_solver.bench,
        "contact": bench_contact.bench,
        "fabric": bench_fabric.bench,
        "sweep": bench_sweep.bench,
        "batch": bench_batch.bench,
    }
    names = list(entries) if words == ["all"] else words
    unknown = [name for name in names if name not in entries]
    if unknown or not names:
        what = f"no benchmark {unknown[0]!r}" if unknown else "no benchmark named"
        print(f"bench.py: {what}: one of {', '.join(entries)}, all", file=sys.stderr)
        return 2
    for name in names:
        print(f"== {name}", flush=True)
        keep(name, entries[name]())
    return 0


if __name__ == "__main__":
    code = main(sys.argv[1:])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # Blender, where a benchmark used it, may hang at its own end
