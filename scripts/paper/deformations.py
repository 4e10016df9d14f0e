"""Figure 2: the deformations that a cloth's springs resist, on our own spring list."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from .looks import INK, KIND_COLORS, PALE, Plate, page
from .sheet import BEND, KINDS, SHEAR, STRETCH, Recipe, Sheet, Springs
from .view import View

ELONGATION = 0.25
"""Of the stretched sheet."""
SHEAR_DEGREES = 20.0
"""How far the sheared sheet's corners are from right angles."""
BEND_DEGREES = 28.0
"""Between neighbouring rows of the bent sheet."""
CHANGED = 1e-3
"""Relative change of length above which a spring is drawn as working."""
RECIPE = Recipe(vertices=5, size=1.0)
VIEW = View(width=1.5, height=1.35, turn=26.0, lift=16.0)


def stretched(rest: np.ndarray) -> np.ndarray:
    """Pulled apart along its width."""
    return rest * np.array([1.0 + ELONGATION, 1.0, 1.0])


def sheared(rest: np.ndarray) -> np.ndarray:
    """Columns leant over, each edge as long as before."""
    lean = math.radians(SHEAR_DEGREES)
    x, y, z = rest.T
    return np.stack([x + z * math.sin(lean), y, z * math.cos(lean)], axis=-1)


def bent(rest: np.ndarray) -> np.ndarray:
    """Columns turned row by row, each edge as long as before."""
    heights = np.unique(rest[:, 2])
    step = heights[1] - heights[0]
    angles = math.radians(BEND_DEGREES) * (np.arange(len(heights) - 1) - 0.5 * (len(heights) - 2))
    y = np.concatenate([[0.0], np.cumsum(step * np.sin(angles))])
    z = np.concatenate([[0.0], np.cumsum(step * np.cos(angles))])
    row = np.searchsorted(heights, rest[:, 2])
    return np.stack([rest[:, 0], (y - y.mean())[row], (z - z.mean())[row]], axis=-1)


def changes(springs: Springs, positions: np.ndarray) -> np.ndarray:
    """Relative change of every spring's length."""
    return springs.lengths(positions) / springs.rest_lengths - 1.0


def energy_shares(springs: Springs, positions: np.ndarray) -> list[float]:
    """Which part of the elastic energy the springs of each kind hold."""
    extension = springs.lengths(positions) - springs.rest_lengths
    energy = 0.5 * springs.stiffnesses * extension**2
    by_kind = np.array([energy[springs.kinds == kind].sum() for kind in range(len(KINDS))])
    return (by_kind / max(by_kind.sum(), 1e-300)).tolist()


def draw_sheet(axes: Axes, springs: Springs, positions: np.ndarray) -> None:
    """Draw the springs, those that work in the colour of their kind, and the particles."""
    flat, _ = VIEW.project(positions)
    works = np.abs(changes(springs, positions)) > CHANGED
    bow = np.where(springs.kinds == BEND, 0.13, 0.0)
    lines = bowed(flat[springs.ends[:, 0]], flat[springs.ends[:, 1]], bow)
    idle = ~works & (springs.kinds != BEND)
    axes.add_collection(LineCollection(lines[idle], colors=PALE, linewidths=1.0))
    for kind in (BEND, SHEAR, STRETCH):
        chosen = works & (springs.kinds == kind)
        axes.add_collection(LineCollection(lines[chosen], colors=KIND_COLORS[kind], linewidths=1.7))
    axes.plot(*flat.T, "o", color=INK, ms=4.0, zorder=3)
    VIEW.frame(axes)


def bowed(start: np.ndarray, end: np.ndarray, bow: np.ndarray, steps: int = 24) -> np.ndarray:
    """Lines from start to end (each (s, 2)) that bow out to the side by a part of their length, (s, steps, 2)."""
    along = np.linspace(0.0, 1.0, steps)[None, :, None]
    span = (end - start)[:, None, :]
    aside = np.stack([-span[..., 1], span[..., 0]], axis=-1)
    arch = 4.0 * along * (1.0 - along)
    return start[:, None, :] + along * span + bow[:, None, None] * arch * aside


def draw_shares(axes: Axes, shares: list[float]) -> None:
    """One bar: which kinds of springs hold the elastic energy."""
    axes.set_axis_off()
    axes.set_xlim(-0.12, 1.12)
    axes.set_ylim(0.0, 1.0)
    if sum(shares) == 0.0:
        axes.text(0.5, 0.75, "no elastic energy", ha="center", va="center", color="#666666")
        return
    left = 0.0
    words = []
    for kind, share in enumerate(shares):
        axes.barh(0.75, share, 0.3, left, color=KIND_COLORS[kind])
        left += share
        if share > 0.0005:
            words.append(f"{KINDS[kind]} {100.0 * share:.0f} %")
    words_below = axes.text(0.5, 0.36, " · ".join(words), ha="center", va="center", fontsize=9)
    words_below.set_in_layout(False)


def make() -> Plate:
    """The sheet at rest, stretched, sheared and bent."""
    sheet = Sheet(RECIPE)
    springs = sheet.springs()
    shapes = {
        "rest": ("at rest", sheet.rest),
        "stretched": (f"stretched by {100 * ELONGATION:.0f} %", stretched(sheet.rest)),
        "sheared": (f"sheared by {SHEAR_DEGREES:.0f}°", sheared(sheet.rest)),
        "bent": (f"bent by {BEND_DEGREES:.0f}° a row", bent(sheet.rest)),
    }
    drawing = page(4.6)
    panels = drawing.subplots(3, 4, height_ratios=[5.0, 1.0, 0.5])
    numbers: dict[str, object] = {"springs": len(springs.kinds)}
    for (name, (title, positions)), column in zip(shapes.items(), panels[:2].T, strict=True):
        draw_sheet(column[0], springs, positions)
        column[0].set_title(title)
        shares = energy_shares(springs, positions)
        draw_shares(column[1], shares)
        numbers[name] = {
            "energy_shares": shares,
            "largest_change": largest_changes(springs, positions),
        }
    handles = [Line2D([], [], color=c, lw=2.0) for c in (*KIND_COLORS, PALE)]
    labels = [*(f"{kind} springs" for kind in KINDS), "springs as long as at rest"]
    for axes in panels[2]:
        axes.remove()
    words = drawing.add_subplot(panels[2, 0].get_gridspec()[2, :])
    words.set_axis_off()
    legend = words.legend(handles, labels, loc="center", ncols=4, fontsize=10, columnspacing=3.0)
    legend.set_in_layout(False)
    caption = (
        f"Springs of a sheet of {RECIPE.words('damping', 'mass')}, as the module lists them "
        f"({len(springs.kinds)}). Springs whose length the deformation changes are coloured by kind; the bars show "
        "which kinds hold the elastic energy. Leaning over keeps every edge, so that shear springs alone resist it; "
        "turning row by row keeps edges and diagonals, so that bend springs alone resist it."
    )
    title = "the deformations that a cloth's springs resist"
    return Plate(2, "deformations", title, caption, drawing, numbers)


def largest_changes(springs: Springs, positions: np.ndarray) -> dict[str, float]:
    """Largest relative change of length of each kind of spring."""
    change = np.abs(changes(springs, positions))
    return {name: float(change[springs.kinds == kind].max()) for kind, name in enumerate(KINDS)}
