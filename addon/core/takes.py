"""Takes: results that are kept under a name, and what tells two of them apart, in words."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from . import drift
from .cache_paths import CacheFiles
from .certificate import percent
from .progress import duration

_KEY_SETTINGS = ("stretch", "shear", "bend", "deformation_rate", "integrator", "settle_frames")
"""What a take notes of its settings, by the last word of their key."""


class Summary(NamedTuple):
    """What the report of a bake comes to."""

    frames: int
    strain: float | None
    intersections: int
    seconds: float


def file_word(name: str) -> str:
    """A take's name as a part of a file name."""
    return "take-" + (re.sub(r"[^\w-]+", "_", name).strip("_") or "take")


def files_of(own: CacheFiles, name: str) -> CacheFiles:
    """Where a take lies that is made now: beside the cloth's own bake, under a name that is free."""
    word = file_word(name)
    number = 1
    while True:
        files = own.with_middle(word if number == 1 else f"{word}_{number}")
        if not files.existing():
            return files
        number += 1


def summary(report: Mapping[str, Any]) -> Summary:
    """The worst of a report's frames and the time that they took."""
    rows = report.get("frames", [])
    strains = [row.get("max_strain", 0.0) for row in rows]
    return Summary(
        len(rows),
        None if None in strains else max(strains, default=0.0),
        max((row.get("intersections") or 0 for row in rows), default=0),
        float(report.get("total_seconds") or 0.0),
    )


def note(record: Mapping[str, Any]) -> str:
    """The settings that say most about a take."""
    settings = record.get("settings", {})
    parts = [
        f"{drift.words_of(key)} {_value(settings[key])}"
        for word in _KEY_SETTINGS
        for key in settings
        if key.rpartition(".")[2] == word
    ]
    return ", ".join(parts)


def compare(one: Mapping[str, Any], other: Mapping[str, Any], names: tuple[str, str]) -> list[str]:
    """What tells two reports apart: frames, strain, intersections, time, and the settings that differ."""
    first, second = summary(one), summary(other)
    lines = [
        f"{names[0]} against {names[1]}",
        f"largest strain {percent(first.strain)} against {percent(second.strain)}",
        f"{first.intersections} against {second.intersections} intersections in the worst frame",
        f"{duration(first.seconds)} against {duration(second.seconds)} of simulation",
    ]
    if first.frames != second.frames:
        lines.append(f"{first.frames} against {second.frames} frames")
    then, now = one.get("bake", {}), other.get("bake", {})
    if not then or not now:
        return lines
    differing = drift.differences(then, {"vertices": 0, "topology": "", "settings": {}, **now})
    values = _values(then.get("settings", {}), now.get("settings", {}))
    lines += [values.get(words, words) for words in differing]
    if not differing:
        lines.append("the same settings")
    return lines


def _values(then: Mapping[str, Any], now: Mapping[str, Any]) -> dict[str, str]:
    """The differing numbers and words of two records by what they are called; lists of vertices have none."""
    out = {}
    for key in sorted(set(then) | set(now)):
        one, other = then.get(key), now.get(key)
        if one != other and not drift.is_list(key):
            out.setdefault(
                drift.words_of(key), f"{drift.words_of(key)} {_value(one)} against {_value(other)}"
            )
    return out


def _value(value: Any) -> str:
    if value is None:
        return "none"
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, list):
        return f"({', '.join(_value(part) for part in value)})"
    return str(value)
