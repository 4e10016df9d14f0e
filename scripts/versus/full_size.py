"""The scenes of tests/scenes at their full size, which each names in its head, baked by `bake.py` once each."""

from __future__ import annotations

import contextlib
import json
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from environment import ROOT, SCRIPTS, VENV, venv_program

SCENES = ROOT / "tests" / "scenes"
NAMES = (
    "sphere",
    "box_corner",
    "needles",
    "folding_strip",
    "two_sheets",
    "twist",
    "funnel",
    "tablecloth",
    "closing_plates",
    "layers",
    "fast_sphere",
    "moving_body",
    "incline",
    "cs184_plane",
    "cs184_sphere",
    "cs184_self_collision",
)
"""Scenes in which something touches something."""
RECOVERIES = (
    "crossed_sheets",
    "folded",
    "rolled",
    "sheet_in_ball",
    "sheet_in_box",
    "pinch",
    "pinch_boxes",
)
"""Scenes that are tangled for a while, and come free."""
GRACE = 60.0
"""Seconds that a stopped bake has for the frame under way."""


def settings(scene: Path) -> list[str]:
    """What the head of a scene overrides for its full size."""
    comments = []
    for line in scene.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        comments.append(line.removeprefix("#").strip())
    _, _, full = " ".join(comments).partition("Full size:")
    return re.findall(r"--set (\S+)", full)


def measure(name: str, threads: int, seconds: float) -> dict[str, Any]:
    """Bake a scene at its full size, stop it after some seconds, and return what its report says."""
    scene = SCENES / f"{name}.toml"
    overrides = settings(scene)
    if any("tube_full.obj" in each for each in overrides):
        make_meshes()
    with tempfile.TemporaryDirectory() as folder:
        command = [venv_program(VENV, "python"), SCRIPTS / "bake.py", scene, "--out", folder]
        command += ["--quiet", "--threads", threads]
        if overrides:
            command += ["--set", *overrides]
        process = subprocess.Popen(
            list(map(str, command)), cwd=ROOT, stderr=subprocess.PIPE, text=True
        )
        complaint = end_of(process, seconds)
        report = Path(folder) / "report.json"
        if not report.exists():
            return {"name": name, "failed": complaint or "no report"}
        found = row(name, json.loads(report.read_text(encoding="utf-8")))
    if process.returncode not in (0, 130, -signal.SIGTERM):
        found["failed"] = complaint
    return found


def end_of(process: subprocess.Popen, seconds: float) -> str:
    """Wait for a bake, stop it when its time is up, and return the last line of its complaint."""
    with contextlib.suppress(subprocess.TimeoutExpired):
        return last_line(process.communicate(timeout=seconds)[1])
    process.terminate()
    with contextlib.suppress(subprocess.TimeoutExpired):
        return last_line(process.communicate(timeout=GRACE)[1])
    process.kill()
    return last_line(process.communicate()[1])


def last_line(text: str) -> str:
    """The last line of a text; nothing of none."""
    return (text.strip().splitlines() or [""])[-1][:160]


def row(name: str, report: dict[str, Any]) -> dict[str, Any]:
    """The numbers of a bake; its first frame is the rest pose and costs nothing."""
    frames = [frame for frame in report["frames"] if frame["substeps"]]
    times = [1e3 * frame["seconds"] for frame in frames]
    return {
        "name": name,
        "failed": None,
        "vertices": sum(cloth["vertices"] for cloth in report["cloths"]),
        "frames": len(frames),
        "ms_mean": sum(times) / max(1, len(times)),
        "ms_most": max(times, default=0.0),
        "intersections": sum(frame["intersections"] or 0 for frame in frames),
        "clipped": sum(frame["clipped"] or 0 for frame in frames),
        "max_strain": max((frame["max_strain"] for frame in frames), default=0.0),
        "peak_bytes": report["peak_memory_bytes"],
        "hash": frames[-1]["hash"] if frames else None,
    }


def make_meshes() -> None:
    """Make the meshes that only full sizes need, as they are now."""
    subprocess.run([sys.executable, SCRIPTS / "scene_meshes.py", "--full"], check=True)


def rows(threads: int, seconds: float, names: tuple[str, ...] = NAMES) -> list[dict[str, Any]]:
    """A row of every scene, told as soon as it is there."""
    found = []
    for name in names:
        started = time.monotonic()
        found.append(measure(name, threads, seconds))
        print(f"  {name}: {time.monotonic() - started:.0f} s", flush=True)
    return found
