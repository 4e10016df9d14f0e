"""The report beside a cache: what was simulated, how fast, and the certificate of every frame."""

from __future__ import annotations

import hashlib
import json
import math
import sys
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from . import whole_file

_LARGEST = frozenset({"frame", "substeps", "max_strain", "p99_strain", "max_shear_strain"})
"""Parts of a certificate of which several cloths have the largest, not the sum."""

_SHARED = frozenset({"seconds", "substeps", "iterations", "intersections", "clipped", "contacts"})
"""Parts that every cloth of a simulation has in common: they count once."""


_MOST_NAMED = 8
"""How many overstretched edges a row names."""


class Report:
    """The content of report.json, as the scene contract names it; `record` is the add-on's own part."""

    def __init__(self, version: str, scene: str, threads: int, cloth: Mapping[str, Any]) -> None:
        """An empty report of one cloth: {"name", "vertices", "triangles", "springs"}."""
        self.head: dict[str, Any] = {"boucle": version, "scene": scene, "threads": threads}
        self.cloth = dict(cloth)
        self.frames: list[dict[str, Any]] = []
        self.record: dict[str, Any] = {}

    def add(
        self,
        certificate: Mapping[str, Any],
        seconds: float,
        sample: str,
        numbers: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        """Add the row of a frame: its certificate, the seconds that it took, digests of its sample and of other numbers."""
        row = {"frame": certificate["frame"], "seconds": round(seconds, 6), **certificate}
        row["sample_hashes"], row["number_hashes"] = [sample], dict(numbers)
        self.frames.append({key: _strict(value) for key, value in row.items()})

    def as_dict(self) -> dict[str, Any]:
        """The whole report."""
        return {**_whole(self.head, [self.cloth], self.frames), "bake": self.record}

    def write(self, path: str) -> None:
        """Replace the report file."""
        whole_file.replace(path, encode(self.as_dict()))


def joined(reports: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """One report of several cloths, simulated one by one or together.

    A frame's row holds the largest strain, the worst edges, substeps of the cloth that took most, and sums of everything else
    (of intersections: over the cloths that collide); its hash is a 64-bit BLAKE2b digest of the cloths' hashes, in order. The
    report of a single cloth is left as it is.
    """
    if len(reports) == 1:
        return dict(reports[0])
    rows: dict[int, list[Mapping[str, Any]]] = {}
    for report in reports:
        is_first = report["cloths"][0]["name"] == report.get("together", [""])[0]
        left_out = _SHARED if "together" in report and not is_first else frozenset()
        for row in report["frames"]:
            own = {key: row[key] for key in row if key not in left_out}
            rows.setdefault(row["frame"], []).append(own)
    head = {key: value for key, value in reports[0].items() if key not in {"bake", "together"}}
    cloths = [cloth for report in reports for cloth in report["cloths"]]
    return _whole(head, cloths, [_joined_row(rows[frame]) for frame in sorted(rows)])


def _whole(
    head: Mapping[str, Any], cloths: list[dict[str, Any]], frames: list[dict[str, Any]]
) -> dict[str, Any]:
    return {
        **head,
        "cloths": cloths,
        "frames": frames,
        "total_seconds": sum(float(row["seconds"] or 0.0) for row in frames),
        "peak_memory_bytes": peak_memory(),
    }


def _joined_row(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    out: dict[str, Any] = {}
    for key in dict.fromkeys(key for row in rows for key in row):
        values = [row[key] for row in rows if key in row]
        if key == "number_hashes":
            continue
        if key == "overstretched":
            out[key] = _worst([edge for edges in values for edge in edges or ()])
        elif key == "sample_hashes":
            out[key] = [one for own in values for one in own]
        elif key == "overstretched_count":
            out[key] = sum(count or 0 for count in values)
        elif key == "hash":
            digest = hashlib.blake2b("".join(map(str, values)).encode(), digest_size=8)
            out[key] = values[0] if len(values) == 1 else f"blake2b-64:{digest.hexdigest()}"
        elif key == "intersections":
            counted = [value for value in values if value is not None]
            out[key] = sum(counted) if counted else None
        elif None in values:
            out[key] = None
        else:
            out[key] = max(values) if key in _LARGEST else sum(values)
    return out


def _worst(edges: list[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """The longest edges of several cloths, as many as a row names."""
    return sorted(edges, key=lambda edge: -(edge["strain"] or 0.0))[:_MOST_NAMED]


def encode(report: Mapping[str, Any]) -> bytes:
    """A report as strict JSON."""
    return (json.dumps(report, allow_nan=False, indent=1) + "\n").encode()


def read(path: str) -> dict[str, Any]:
    """A report file's content; empty if it is missing or damaged."""
    try:
        with open(path, "rb") as file:
            content = json.load(file)
    except (OSError, ValueError, RecursionError):
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
