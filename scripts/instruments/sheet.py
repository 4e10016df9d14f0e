"""The lab sheet: what all instruments read of one fabric, as a table and as numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from . import bending, cantilever, drape, shear, tensile
from .bending import Bending
from .cantilever import Cantilever
from .cutting import Kind
from .drape import Drape
from .fabric import Fabric
from .shear import Shear
from .tensile import Tensile

INSTRUMENTS = ("tensile", "shear", "bending", "cantilever", "drape")
DIRECTIONS = ("warp", "weft", "bias")
YARNS = ("warp", "weft")
HEADINGS = ("quantity", "unit", "warp", "weft", "bias", "method", "preset's own")


@dataclass(frozen=True)
class Order:
    """What is to be measured, and how finely."""

    instruments: Sequence[str] = INSTRUMENTS
    kind: Kind = "grid"
    cells: int | None = None
    """Along the longest side of every specimen; each instrument's own number if None."""
    specimens: int = 3
    """Discs to drape."""

    def words(self) -> dict[str, Any]:
        """As it is kept beside what was measured."""
        return {
            "instruments": list(self.instruments),
            "mesh": self.kind,
            "cells": self.cells,
            "specimens": self.specimens,
        }


@dataclass
class Sheet:
    """What the instruments read; empty where they were not asked."""

    fabric: Fabric
    order: Order
    tensile: dict[str, Tensile] = field(default_factory=dict)
    shear: dict[str, Shear] = field(default_factory=dict)
    bending: dict[str, Bending] = field(default_factory=dict)
    cantilever: dict[str, Cantilever] = field(default_factory=dict)
    drapes: list[Drape] = field(default_factory=list)

    @property
    def coefficient(self) -> float:
        """The mean drape coefficient (%)."""
        return float(np.mean([one.coefficient for one in self.drapes]))

    @property
    def is_in_band(self) -> bool | None:
        """Whether the drape coefficient lies where it is said to; None if nobody says where."""
        band = self.fabric.band
        return None if band is None else band[0] <= self.coefficient <= band[1]


def measure(fabric: Fabric, order: Order, say: Callable[[str], None] = lambda _: None) -> Sheet:
    """Put a fabric through the instruments that are ordered; `say` hears what is under way."""
    sheet = Sheet(fabric, order)
    finely = {} if order.cells is None else {"cells": order.cells}
    for name, directions in (
        ("tensile", DIRECTIONS),
        ("shear", YARNS),
        ("bending", YARNS),
        ("cantilever", DIRECTIONS),
    ):
        instruments = {"tensile": tensile, "shear": shear, "bending": bending}
        instrument = instruments.get(name, cantilever)
        for direction in directions if name in order.instruments else ():
            say(f"{name}, {direction}")
            read = instrument.measure(fabric, direction, kind=order.kind, **finely)
            getattr(sheet, name)[direction] = read
    edge = drape.FINE if order.cells is None else 2.0 * drape.DISC / order.cells
    for specimen in range(1, order.specimens + 1) if "drape" in order.instruments else ():
        say(f"drape, specimen {specimen} of {order.specimens}")
        sheet.drapes.append(drape.measure(fabric, edge, order.kind, specimen))
    return sheet


def rows(sheet: Sheet) -> list[tuple[str, ...]]:
    """The lines of the table, as HEADINGS has them."""
    parts = (tensile_rows, shear_rows, bending_rows, cantilever_rows, drape_rows)
    return [row for part in parts for row in part(sheet)]


def line(
    quantity: str,
    unit: str,
    values: dict[str, float],
    method: str,
    own: Sequence[float] = (),
    digits: int = 3,
) -> tuple[str, ...]:
    """One line: what was read in each direction, and the preset's own numbers."""
    read = [figure(values[way], digits) if way in values else "" for way in DIRECTIONS]
    return (quantity, unit, *read, method, " / ".join(figure(value, digits) for value in own))


def figure(value: float, digits: int) -> str:
    """A number with so many digits that count, and without an exponent."""
    if abs(value) < 0.5 * 10.0**-digits:
        return "0"
    places = max(0, digits - 1 - int(np.floor(np.log10(abs(value)))))
    return f"{value:.{places}f}"


def tensile_rows(sheet: Sheet) -> list[tuple[str, ...]]:
    """Stiffness, narrowing and the extensions of FAST."""
    read = sheet.tensile
    if not read:
        return []
    strip = "strip 50 x 200 mm"
    stiffness = {way: one.stiffness for way, one in read.items()}
    poisson = {way: one.poisson for way, one in read.items()}
    return [
        line(
            "tensile stiffness at 0.1 %",
            "N/m",
            stiffness,
            f"{strip}, between marks",
            [one.expected for one in read.values()],
            digits=4,
        ),
        line(
            "Poisson's ratio",
            "1",
            poisson,
            f"{strip}, between marks",
            [one.expected_poisson for one in read.values()],
        ),
        *(
            line(
                f"extension at {gram} gf/cm (E{gram})",
                "%",
                {way: 100.0 * one.extensions[gram] for way, one in read.items()},
                f"{strip}, between clamps",
            )
            for gram in tensile.FAST_LOADS
        ),
        line(
            "shear stiffness 123/EB5",
            "N/m",
            {"bias": 1.23 / read["bias"].extensions[5]},
            "FAST, from the bias strip",
            [sheet.fabric.number("shear")],
        ),
    ]


def shear_rows(sheet: Sheet) -> list[tuple[str, ...]]:
    """G of the frame and of KES."""
    read = sheet.shear
    if not read:
        return []
    own = [one.expected for one in read.values()]
    in_grams = [value * shear.KES_UNIT for value in own]
    return [
        line(
            "shear stiffness",
            "N/m",
            {way: one.stiffness for way, one in read.items()},
            "picture frame, 0.5°",
            own,
        ),
        line(
            "shear stiffness G",
            "gf/(cm·deg)",
            {way: one.kes * shear.KES_UNIT for way, one in read.items()},
            "KES-FB1, 0.5° to 2.5°",
            in_grams,
        ),
    ]


def bending_rows(sheet: Sheet) -> list[tuple[str, ...]]:
    """B and 2HB of KES-FB2."""
    read = sheet.bending
    if not read:
        return []
    return [
        line(
            "bending stiffness B",
            "µN·m",
            {way: 1e6 * one.rigidity for way, one in read.items()},
            "KES-FB2, 0.5 to 1.5 /cm",
            [1e6 * one.expected for one in read.values()],
        ),
        line(
            "bending hysteresis 2HB",
            "mN·m/m",
            {way: 1e3 * one.width for way, one in read.items()},
            "KES-FB2, 0.5 /cm",
            [1e3 * one.expected_width for one in read.values()],
        ),
    ]


def cantilever_rows(sheet: Sheet) -> list[tuple[str, ...]]:
    """Bending length, rigidity, and the droop beside the elastica's."""
    read = sheet.cantilever
    if not read:
        return []
    expected = [one.expected for one in read.values()]
    lengths = [100.0 * one.expected_bending_length for one in read.values()]
    return [
        line(
            "bending length",
            "cm",
            {way: 100.0 * one.bending_length for way, one in read.items()},
            "cantilever, ASTM D1388",
            lengths,
        ),
        line(
            "flexural rigidity",
            "µN·m",
            {way: 1e6 * one.rigidity for way, one in read.items()},
            "cantilever, ASTM D1388",
            [1e6 * own for own in expected],
        ),
        line(
            "droop over the elastica's",
            "%",
            {way: 100.0 * one.strip.droop / one.exact.droop for way, one in read.items()},
            "heavy elastica of its B",
            [100.0],
        ),
    ]


def drape_rows(sheet: Sheet) -> list[tuple[str, ...]]:
    """The coefficient, whose mean stands under warp, since a disc has no direction."""
    read = sheet.drapes
    if not read:
        return []
    each = ", ".join(f"{one.coefficient:.1f}" for one in read)
    nodes = ", ".join(str(one.nodes) for one in read)
    crossings = sum(one.intersections for one in read)
    band = sheet.fabric.band
    said = "" if band is None else f"{band[0]:g} to {band[1]:g}"
    method = f"Cusick, ISO 9073-9: {each}"
    touching = (
        f"folds pass through each other {crossings} times" if crossings else "no fold touches"
    )
    mean_nodes = f"{np.mean([one.nodes for one in read]):.1f}"
    return [
        ("drape coefficient", "%", f"{sheet.coefficient:.1f}", "", "", method, said),
        ("nodes", "1", mean_nodes, "", "", f"{nodes}; {touching}", ""),
    ]


def table(headings: Sequence[str], cells: Sequence[Sequence[str]]) -> str:
    """Rows as lines of text, in columns."""
    widths = [max(len(row[i]) for row in (headings, *cells)) for i in range(len(headings))]
    ruler = ["-" * width for width in widths]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in (headings, ruler, *cells)
    ]
    return "\n".join(lines)


def numbers(sheet: Sheet) -> dict[str, Any]:
    """All numbers of a sheet, in SI units but for percents."""
    return {
        "fabric": sheet.fabric.preset,
        "changes": dict(sheet.fabric.changes),
        "order": sheet.order.words(),
        "tensile": {way: tensile_numbers(one) for way, one in sheet.tensile.items()},
        "shear": {
            way: {
                "stiffness": one.stiffness,
                "expected": one.expected,
                "kes": one.kes,
                "curve": [list(pair) for pair in zip(one.degrees, one.stresses, strict=True)],
            }
            for way, one in sheet.shear.items()
        },
        "bending": {
            way: {
                "rigidity": one.rigidity,
                "expected": one.expected,
                "hysteresis": one.width,
                "expected_hysteresis": one.expected_width,
                "curve": [list(pair) for pair in zip(one.curvatures, one.moments, strict=True)],
            }
            for way, one in sheet.bending.items()
        },
        "cantilever": {
            way: {
                "overhang": one.overhang,
                "bending_length": one.bending_length,
                "expected_bending_length": one.expected_bending_length,
                "rigidity": one.rigidity,
                "expected": one.expected,
                "droop": one.strip.droop,
                "elastica_droop": one.exact.droop,
            }
            for way, one in sheet.cantilever.items()
        },
        "drape": [
            {
                "coefficient_percent": one.coefficient,
                "nodes": one.nodes,
                "intersections": one.intersections,
                "vertices": len(one.resting.positions),
                "speed_left": one.resting.speed,
                "unbalanced": one.resting.unbalanced,
            }
            for one in sheet.drapes
        ],
        "drape_band_percent": sheet.fabric.band,
    }


def tensile_numbers(read: Tensile) -> dict[str, Any]:
    """All numbers of one strip."""
    return {
        "stiffness": read.stiffness,
        "expected": read.expected,
        "poisson": read.poisson,
        "expected_poisson": read.expected_poisson,
        "extension_percent": {f"E{g}": 100.0 * e for g, e in read.extensions.items()},
        "curve": [[pull.clamps, pull.marks, pull.tension] for pull in read.pulls],
    }
