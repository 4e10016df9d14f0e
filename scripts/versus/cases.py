"""Start the measured processes and gather what they tell."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

from bench import median
from environment import SCRIPTS, VENV, venv_program

from .child import MARK


def ask(
    module: str, arguments: dict[str, Any], *, timeout: float, venv: Path = VENV
) -> dict[str, Any]:
    """Run `python -m versus.MODULE` and return its result, or `failed` with one line that says why."""
    command = [venv_program(venv, "python"), "-m", f"versus.{module}", json.dumps(arguments)]
    try:
        done = subprocess.run(
            command, cwd=SCRIPTS, capture_output=True, text=True, timeout=timeout, check=False
        )
    except subprocess.TimeoutExpired:
        return {"failed": f"stopped after {timeout:.0f} s"}
    lines = done.stdout.splitlines()
    results = [line.removeprefix(MARK) for line in lines if line.startswith(MARK)]
    if results:
        return json.loads(results[-1])
    last = (done.stderr.strip() or done.stdout.strip() or "no output").splitlines()[-1]
    return {"failed": f"exit code {done.returncode}: {last[:160]}"}


def row(name: str, side: int, results: list[dict[str, Any]], **more: Any) -> dict[str, Any]:
    """The numbers of a case out of one or more equal runs."""
    failed = next((result["failed"] for result in results if "failed" in result), None)
    times = [ms for result in results for ms in result.get("ms", [])]
    found: dict[str, Any] = {"name": name, "side": side, "failed": failed, **more}
    if not times:
        return found
    first = results[0]
    middle = median(times)
    found |= {
        "frames": len(first["ms"]),
        "ms_median": middle,
        "ms_least": min(times),
        "ms_most": max(times),
        "cpu_ms_median": median([ms for result in results for ms in result["cpu_ms"]]),
        "max_strain": max(first["max_strain"], default=None),
        "p99_strain": max(first["p99_strain"], default=None),
        "lowest_m": min(first["lowest"], default=None),
        "set_up_ms": min(map(set_up, results)),
        "peak_bytes": max(result["peak_bytes"] for result in results),
        "substeps": median(first["substeps"]) if "substeps" in first else None,
        "iterations": median(first["iterations"]) if "iterations" in first else None,
        "runs": results,
    }
    return found


def set_up(result: dict[str, Any]) -> float:
    """Milliseconds before the first frame, and those that the first frame takes beyond the middle one."""
    return result["set_up_ms"] + max(0.0, result["ms"][0] - median(result["ms"]))
