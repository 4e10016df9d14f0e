"""Figure 3: the springs of nine particles, from the list that the module returns."""

from __future__ import annotations

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from .deformations import bowed
from .looks import INK, KIND_COLORS, Plate, page
from .sheet import BEND, KINDS, SHEAR, STRETCH, Recipe, Sheet

RECIPE = Recipe(vertices=3, size=2.0)
BOW = 0.115
"""How far bend springs bow out, as a part of their length."""
WHAT = ("to the next particle", "across a square", "to the particle after next")


def make() -> Plate:
    """The diagram."""
    sheet = Sheet(RECIPE)
    springs = sheet.springs()
    places = sheet.rest[:, [0, 2]]
    drawing = page(5.6)
    axes, words = drawing.subplots(1, 2, width_ratios=[1.35, 1.0])
    starts, ends = places[springs.ends[:, 0]], places[springs.ends[:, 1]]
    lines = bowed(starts, ends, np.where(springs.kinds == BEND, outward(starts, ends), 0.0))
    for kind in (BEND, SHEAR, STRETCH):
        color = KIND_COLORS[kind]
        chosen = lines[springs.kinds == kind]
        axes.add_collection(LineCollection(chosen, colors=color, linewidths=2.6))
    axes.scatter(*places.T, s=420, color="white", edgecolor=INK, linewidth=1.6, zorder=3)
    for vertex, (x, z) in enumerate(places):
        axes.text(x, z, str(vertex), ha="center", va="center", fontsize=11, zorder=4)
    axes.set_xlim(-1.35, 1.35)
    axes.set_ylim(-1.35, 1.35)
    axes.set_aspect("equal")
    axes.set_axis_off()
    counts = [int((springs.kinds == kind).sum()) for kind in range(len(KINDS))]
    words.set_axis_off()
    handles = [Line2D([], [], color=color, lw=3.0) for color in KIND_COLORS]
    labels = [
        f"{count} {name} springs,\n{what}"
        for count, name, what in zip(counts, KINDS, WHAT, strict=True)
    ]
    words.legend(
        handles, labels, loc="center left", fontsize=12, labelspacing=1.4, handlelength=2.6
    )
    caption = (
        f"The {sum(counts)} springs of a sheet of 3 × 3 particles, drawn from the module's own spring list. Bend "
        "springs are straight; here they bow out so that they do not hide behind two stretch springs."
    )
    numbers = dict(zip(KINDS, counts, strict=True))
    return Plate(3, "spring_diagram", "the springs of nine particles", caption, drawing, numbers)


def outward(starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """How far each line bows, signed so that it bows away from the middle (and to one side through the middle)."""
    span = ends - starts
    aside = np.stack([-span[:, 1], span[:, 0]], axis=-1)
    middle = 0.5 * (starts + ends)
    return np.where((aside * middle).sum(axis=1) < -1e-9, -BOW, BOW)
