"""Named fabrics on the instruments of scripts/instruments: the Cusick drape test and the cantilever of ASTM D1388.

The instruments are imported where a row needs them. Where they are not there, the chapter has no rows and the report says so.
"""

from __future__ import annotations

import math
from functools import cache, partial
from importlib.util import find_spec
from itertools import pairwise
from typing import Any

import numpy as np

from .row import EXACTLY, Curve, Finding, Range, Row, Tolerance

CHAPTER = "drape"

FABRICS = {
    "silk_crepe_de_chine": ("silk", Range(20.0, 40.0)),
    "wool_worsted": ("worsted wool", Range(40.0, 70.0)),
    "cotton_poplin": ("cotton", Range(60.0, 76.0)),
    "denim": ("denim", Range(70.0, 90.0)),
}
"""Presets, what they are called, and between what drape coefficients (%) such fabrics have been found, limp ones first."""
SPREAD = Tolerance(5.0, is_relative=False)
"""Points, between two densities and two kinds of mesh: what is wanted."""
RIGIDITY = Tolerance(0.02)
"""As of a cantilever on an aligned mesh."""
KINDS = ("grid", "delaunay")
EDGES = (0.0125, 0.008)
"""m: coarse and fine, both a little coarser than the instrument's own."""
SPECIMENS = (1, 2, 3)
"""As in the standard, a coefficient is the mean of several: each rests in other folds."""
TEST = "tests/test_instruments.py"


@cache
def draped(preset: str, edge: float, kind: str, specimen: int = 1) -> Any:
    """A specimen of 30 cm on plates of 18 cm."""
    from instruments import drape
    from instruments.fabric import Fabric

    return drape.measure(Fabric(preset), edge, kind, specimen)


@cache
def coefficients(preset: str) -> dict[str, float]:
    """The drape coefficient (%) on meshes of two densities and two kinds."""
    return {
        f"{kind}, {1e3 * edge:g} mm": float(
            np.mean([draped(preset, edge, kind, number).coefficient for number in SPECIMENS])
        )
        for kind in KINDS
        for edge in EDGES
    }


def mean(preset: str) -> float:
    """The mean drape coefficient (%) over all meshes."""
    return float(np.mean(list(coefficients(preset).values())))


def told(preset: str) -> str:
    """Every coefficient in words."""
    return ", ".join(f"{mesh}: {value:.1f} %" for mesh, value in coefficients(preset).items())


def band(preset: str) -> Finding:
    """The drape coefficient, with the shadow of the finest grid as its plot."""
    shadow = draped(preset, EDGES[-1], KINDS[0]).shadow

    def draw(axes: Any) -> None:
        half = 50.0 * shadow.shape[0] * 2.5e-4
        axes.contourf(
            np.linspace(-half, half, shadow.shape[1]),
            np.linspace(-half, half, shadow.shape[0]),
            shadow,
            levels=[0.5, 1.5],
            colors=["C1"],
        )
        angle = np.linspace(0.0, math.tau, 100)
        for radius in (9.0, 15.0):
            axes.plot(radius * np.cos(angle), radius * np.sin(angle), color="C0", lw=1.2)
        axes.set_aspect("equal")
        axes.set_xlabel("top view (cm), plates and flat disc")

    return Finding(mean(preset), FABRICS[preset][1], draw, told(preset))


def spread(preset: str) -> Finding:
    """The difference between the largest and the least coefficient."""
    values = coefficients(preset)

    def draw(axes: Any) -> None:
        axes.bar(range(len(values)), list(values.values()), color="C1", width=0.6)
        axes.set_xticks(range(len(values)), [name.replace(", ", "\n") for name in values])
        axes.set_ylabel("drape coefficient (%)")

    return Finding(max(values.values()) - min(values.values()), 0.0, draw, told(preset))


def order() -> Finding:
    """How many neighbours in the order of the fabrics drape the wrong way round."""
    means = [mean(preset) for preset in FABRICS]
    wrong = sum(a >= b for a, b in pairwise(means))

    def draw(axes: Any) -> None:
        for place, (_, known) in enumerate(FABRICS.values()):
            axes.bar(place, known.high - known.low, bottom=known.low, color="C0", alpha=0.3)
        axes.plot(range(len(means)), means, "o", color="C1", mfc="none", mew=1.6)
        axes.set_xticks(range(len(means)), [words for words, _ in FABRICS.values()])
        axes.set_ylabel("drape coefficient (%)")

    return Finding(wrong, 0.0, draw)


def rigidities() -> Finding:
    """The flexural rigidity that the cantilever reads along the warp, beside that of the fabric's own numbers."""
    from instruments import cantilever
    from instruments.fabric import Fabric

    read = [cantilever.measure(Fabric(preset), "warp") for preset in FABRICS]
    results, expected = [each.rigidity for each in read], [each.expected for each in read]
    places = range(1, len(read) + 1)
    return Curve(places, results, expected, "fabric", "B (N·m)", logarithmic="y").worst(RIGIDITY)


def rows() -> list[Row]:
    """All rows of the chapter; none without the instruments."""
    if find_spec("instruments") is None:
        return []
    source = "ISO 9073-9; the band in which such fabrics have been found"
    meshes = "one fabric has one drape coefficient, whatever its mesh"
    found = [
        Row(CHAPTER, f"Cusick drape of {words}", "drape coefficient", "%", source, TEST, partial(band, preset))
        for preset, (words, _) in FABRICS.items()
    ]  # fmt: skip
    found += [
        Row(CHAPTER, f"Cusick drape of {words}: two densities, two kinds of mesh", "spread", "points", meshes, TEST,
            partial(spread, preset), SPREAD)
        for preset, (words, _) in FABRICS.items()
    ]  # fmt: skip
    return [
        *found,
        Row(CHAPTER, "Cusick drape: silk, worsted wool, cotton, denim in this order", "neighbours the wrong way", "",
            source, TEST, order, EXACTLY),
        Row(CHAPTER, "cantilever of ASTM D1388: rigidity of four fabrics", "B", "N·m",
            "the bending stiffness that the fabric was given", TEST, rigidities, RIGIDITY),
    ]  # fmt: skip
