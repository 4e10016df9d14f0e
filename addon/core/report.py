"""The report beside a cache: what was simulated, how fast, and the certificate of every frame."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping
from typing import Any

from . import whole_file


class Report:
    """The content of report.json, as the scene contract names it; `record` is the add-on's own part."""

    def __init__(self, version: str, scene: str, threads: int, cloth: Mapping[str, Any]) -> None:
        """An empty report of one cloth: {"name", "vertices", "triangles", "springs"}."""
        self.head: dict[str, Any] = {"boucle": version, "scene": scene, "threads": threads}
        self.cloth = dict(cloth)
        self.frames: list[dict[str, Any]] = []
        self.record: dict[str, Any] = {}

    def add(self, certificate: Mapping[str, Any], seconds: float) -> None:
        """Add the row of a frame: its certificate and the seconds that it took."""
        row = {"frame": certificate["frame"], "seconds": round(seconds, 6), **certificate}
        self.frames.append({key: _strict(value) for key, value in row.items()})

    def keep_first(self, rows: int, other: Mapping[str, Any]) -> None:
        """Take over the first rows of an earlier report, on resume."""
        self.frames = list(other.get("frames", []))[:rows]

    def as_dict(self) -> dict[str, Any]:
        """The whole report."""
        return {
            **self.head,
            "cloths": [self.cloth],
            "frames": self.frames,
            "total_seconds": sum(float(row["seconds"] or 0.0) for row in self.frames),
            "peak_memory_bytes": peak_memory(),
            "bake": self.record,
        }

    def write(self, path: str) -> None:
        """Replace the report file."""
        whole_file.replace(path, encode(self.as_dict()))


def encode(report: Mapping[str, Any]) -> bytes:
    """A report as strict JSON."""
    return (json.dumps(report, allow_nan=False, indent=1) + "\n").encode()


def read(path: str) -> dict[str, Any]:
    """A report file's content; empty if it is missing or damaged."""
    try:
        with open(path, "rb") as file:
            content = json.load(file)
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def peak_memory() -> int | None:
    """The largest memory that this process held so far (bytes); None where the system does not say."""
    try:
        import resource
    except ImportError:
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak


def _strict(value: Any) -> Any:
    """JSON has no infinity and no NaN: null stands for them."""
    return None if isinstance(value, float) and not math.isfinite(value) else value
