"""The certificate of a frame in words: a row of report.json, as one line, and what is wrong with it as another."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Row = Mapping[str, Any]
"""A certificate; numbers that are not finite are None in a report."""

_DIGITS = 8
"""Digits of the hash that a panel shows."""


def line(row: Row) -> str:
    """What the frame can be held to."""
    parts = [
        f"stretch {percent(row['max_strain'])} (99 % of edges below {percent(row['p99_strain'])})"
    ]
    if row["iterations"]:
        parts.append(_count(row["iterations"], "iteration"))
    parts.append(_count(row["substeps"], "substep"))
    crossings = row.get("intersections")
    if crossings is not None:
        parts.append(_count(crossings, "intersection") if crossings else "no intersections")
    kinetic, potential = row["kinetic_energy"], row["potential_energy"]
    if kinetic is not None and potential is not None:
        parts.append(f"energy {kinetic + potential:.3g} J")
    digits = str(row["hash"]).rpartition(":")[2]
    parts.append(f"hash {digits[:_DIGITS]}…")
    return f"Frame {row['frame']}: {', '.join(parts)}"


def warning(row: Row) -> str:
    """Which edges are longer than the deformation rate allows; empty if none is."""
    worst = next(iter(row.get("overstretched") or ()), None)
    if worst is None:
        return ""
    count = max(int(row.get("overstretched_count") or 0), len(row["overstretched"]))
    edges = "1 edge exceeds" if count == 1 else f"{count} edges exceed"
    one, other = worst["vertices"]
    return (
        f"{edges} the deformation rate: {'it' if count == 1 else 'the worst'} stretches "
        f"{percent(worst['strain'])}, from vertex {one} to {other}; pins too far apart or steps too "
        "long do that"
    )


def percent(part: float | None) -> str:
    """A fraction as a percentage: "4.9 %"."""
    if part is None:
        return "beyond all numbers"
    value = 100.0 * part
    return f"{value if abs(value) >= 0.05 else 0.0:.1f} %"


def _count(number: int, word: str) -> str:
    return f"{number} {word}" if number == 1 else f"{number} {word}s"
