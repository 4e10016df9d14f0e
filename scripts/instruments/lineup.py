"""Several fabrics beside each other: of each one line, what was read and in brackets the fabric's own number.

A line is made of the numbers that a sheet leaves, so that a row of fabrics that was stopped can go on.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .sheet import DIRECTIONS, YARNS, Order, figure

HEADINGS = (
    "fabric",
    "Y warp N/m",
    "Y weft",
    "Y bias",
    "G N/m",
    "c warp cm",
    "c weft",
    "c bias",
    "DC %",
    "",
    "nodes",
)
"""Tensile and shear stiffness, bending length and drape coefficient."""


def row(numbers: Mapping[str, Any]) -> tuple[str, ...]:
    """The line of a fabric, from the numbers of its sheet; empty where nothing was measured."""

    def beside(law: str, way: str, key: str, own: str, scale: float = 1.0) -> str:
        read = numbers[law].get(way)
        if read is None:
            return ""
        return f"{figure(scale * read[key], 3)} ({figure(scale * read[own], 3)})"

    lengths = ("bending_length", "expected_bending_length", 100.0)
    return (
        numbers["fabric"],
        *(beside("tensile", way, "stiffness", "expected") for way in DIRECTIONS),
        beside("shear", YARNS[0], "stiffness", "expected"),
        *(beside("cantilever", way, *lengths) for way in DIRECTIONS),
        *drape_cells(numbers),
    )


def drape_cells(numbers: Mapping[str, Any]) -> tuple[str, str, str]:
    """The mean coefficient and between what it is said to lie, whether it does, and the mean number of nodes."""
    drapes = numbers["drape"]
    if not drapes:
        return "", "", ""
    coefficient = float(np.mean([one["coefficient_percent"] for one in drapes]))
    nodes = float(np.mean([one["nodes"] for one in drapes]))
    band = numbers["drape_band_percent"]
    if band is None:
        return f"{coefficient:.1f}", "", f"{nodes:.0f}"
    verdict = "in" if band[0] <= coefficient <= band[1] else "OUT"
    return f"{coefficient:.1f} ({band[0]:g} to {band[1]:g})", verdict, f"{nodes:.0f}"


def is_of(numbers: Mapping[str, Any], order: Order, changes: Mapping[str, float]) -> bool:
    """Whether numbers are what an order would measure, of a fabric with these changes."""
    return numbers.get("changes") == dict(changes) and numbers.get("order") == order.words()
