"""One picture of many small plots, each with a green tick or a red cross."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt

from .drawing import STYLE
from .row import Result

GREEN, RED = "#1a7f37", "#c4261d"
COLUMNS = 6
WIDTH = 1400
"""Pixels of the small copy."""
SHOWN = (
    "symplectic Euler: period ratio T/T0",
    "Runge-Kutta 4: energy factor a step",
    "BDF2: energy factor a step",
    "Verlet: swing of the energy",
    "lattice (ks, kd, kb) = (1, 1, 0): largest stable step",
    "lattice drawn out: Young's modulus Y",
    "hanging chain: drop of the tip",
    "hanging strip: order of convergence",
    "catenary of 32 links: sag / span",
    "catenary: largest tension",
    "cantilever of fabric, aligned mesh, Gamma 10",
    "cantilever of fabric, aligned mesh, Gamma 1000",
    "cantilever of fabric, unstructured (Delaunay) mesh",
    "control: springs (i, i+2) must miss the elastica",
    "moment 2 pi B/L at the end of a strip: angle of the tip",
    "pendulum of 90°",
    "first swing of a hanging strip of 50 masses",
    "linear drag: terminal speed",
    "quadratic drag: speed on the way to the terminal one",
    "damped spring, axial damping",
    "momentum of a free sheet",
    "force = -gradient of the energy",
    "the scene turned: the same motion after 24 frames",
    "patch on an incline: where it begins to slide",
    "patch on an incline of 35°, friction 0.5",
    "patch of 2 m/s slides to a stop, friction 0.4",
    "sheet dropped on a ball: frames with an intersection",
    "table-cloth pulled away: frames with an intersection",
    "fifty layers: frames with an intersection",
    "Cusick drape of silk",
    "Cusick drape of worsted wool",
    "Cusick drape of cotton",
    "Cusick drape of denim",
    "Cusick drape: silk, worsted wool, cotton, denim in this order",
    "cantilever of ASTM D1388: rigidity of four fabrics",
    "sheet on two corners: elongation at the end",
    "sheet on four corners: the sag falls as ks rises from 50 to 50 000",
    "sheet on a ball: elongation at the end",
    "sheet on a plane and on itself: frames with an intersection",
    "numpy demo, 14 x 14, after two seconds",
)
"""Names of the rows that have a place in the picture, in its order."""


def chosen(results: Sequence[Result]) -> list[Result]:
    """The results that are shown: those that have a place, and every one that failed with a plot."""
    drawn = [result for result in results if result.finding and result.finding.plot]
    return [result for result in drawn if result.row.name in SHOWN or not result.has_passed]


def draw(results: Sequence[Result], path: Path) -> None:
    """Write the picture as a PNG file."""
    shown = chosen(results)
    rows = max(1, math.ceil(len(shown) / COLUMNS))
    with mpl.rc_context({**STYLE, "font.size": 6.5, "axes.labelsize": 6.5}):
        figure, grid = plt.subplots(
            rows,
            COLUMNS,
            figsize=(2.3 * COLUMNS, 1.8 * rows + 0.3),
            layout="constrained",
            squeeze=False,
        )
        for axes in grid.flat[len(shown) :]:
            axes.set_axis_off()
        for axes, result in zip(grid.flat, shown, strict=False):
            result.finding.plot(axes)
            mark, colour = ("✓", GREEN) if result.has_passed else ("✗", RED)
            axes.set_title(wrapped(result.row.name), fontsize=6.5, loc="left", pad=3.0, x=0.04)
            place = {"transform": axes.transAxes, "ha": "right", "va": "bottom"}
            axes.text(0.02, 1.0, mark, color=colour, fontsize=12, weight="bold", **place)
        passed = sum(result.has_passed for result in results)
        title = f"{passed} of {len(results)} rows hold; of these: results (rings) against references (lines)"
        figure.suptitle(title, fontsize=10, x=0.01, ha="left")
        figure.savefig(path, dpi=120, facecolor="white")
        plt.close(figure)


def shrink(picture: Path, target: Path) -> None:
    """Write a smaller copy with few colours, the rare green and red among them."""
    from PIL import Image

    with Image.open(picture) as image:
        size = (WIDTH, round(image.height * WIDTH / image.width))
        small = image.convert("RGB").resize(size, Image.Resampling.LANCZOS)
    flat = small.quantize(128, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    flat.save(target, optimize=True)


def wrapped(name: str, width: int = 36) -> str:
    """A name in two lines at the most."""
    if len(name) <= width:
        return name
    at = name.rfind(" ", 0, width)
    rest = name[at + 1 :]
    return f"{name[:at]}\n{rest if len(rest) <= width else rest[: width - 1] + '…'}"
