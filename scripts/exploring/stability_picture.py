"""The stability map as one picture: the measured boundary beside the theoretical one."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, LogNorm
from matplotlib.figure import Figure

from integrator_words import WORDS
from paper.looks import INK, page

from .boundary import GROWN
from .sheet import PAPER
from .stability import Boundary, Falling, Map, fastest
from .theory import UNDAMPED_LIMIT

COLORS = {
    "forward_euler": "#7a7a7a",
    "symplectic_euler": "#0072B2",
    "verlet": "#56B4E9",
    "leapfrog": "#009E73",
    "midpoint": "#CC79A7",
    "rk4": "#D55E00",
    "implicit_euler": "#E69F00",
    "bdf2": "#222222",
}
MARKS = {"symplectic_euler": "o", "verlet": "+", "leapfrog": "x", "rk4": "D"}
GROWTH_MAP = LinearSegmentedColormap.from_list("growth", ["#a9cfe8", "#f6f3ec", "#f0b583"])
"""Pale, so that the boundaries stand out; from energy lost to energy gained."""


def draw(undamped: Boundary, damped: Boundary, maps: list[Map], falling: Falling) -> Figure:
    """The whole picture."""
    figure = page(10.5)
    axes = figure.subplots(3, 3)
    _over(axes[0, 0], undamped, "stiffness", falling)
    _over(axes[0, 1], undamped, "mass", None)
    _errors(axes[0, 2], undamped)
    shaded = None
    for place, each in zip(axes[1:].flat, maps, strict=True):
        shaded = _map(place, each, damped.of(integrator=each.integrator))
    axes[1, 0].legend(loc="lower right", fontsize=8)
    if shaded is not None:
        bar = figure.colorbar(shaded, ax=axes[1:], shrink=0.5, extend="max", pad=0.01)
        bar.set_label("energy at the end / at the start of a run; above 1000: unstable")
    return figure


def _over(axes: Axes, found: Boundary, name: str, falling: Falling | None) -> None:
    """The boundary over one quantity, for the middle value of the other."""
    other = "mass" if name == "stiffness" else "stiffness"
    values = sorted({getattr(point, other) for point in found.points})
    kept = found.of(lattice=PAPER, **{other: values[len(values) // 2]})
    for integrator in UNDAMPED_LIMIT:
        part = kept.of(integrator=integrator)
        x = [getattr(point, name) for point in part.points]
        color, mark = COLORS[integrator], MARKS[integrator]
        axes.plot(x, 1000 * part.theory, color=color, lw=1.0)
        size = {"o": 7.0, "D": 4.0}.get(mark, 5.0)
        axes.plot(
            x, 1000 * part.measured, mark, color=color, ms=size, mfc="none", label=WORDS[integrator]
        )
        if integrator == "symplectic_euler":
            axes.plot(x, 1000 * part.safe, ":", color=color, label="its safe step in the panel")
    if falling is not None:
        # Steps go with the root of the mass: shown as if these sheets had the mass of the others.
        part = np.sqrt(values[len(values) // 2] / 0.01)
        y = 1000 * part * falling.measured
        axes.plot(falling.stiffness, y, "*", color=INK, ms=5, label="the same sheet, falling")
    unit, held = ("N/m", "kg") if name == "stiffness" else ("kg", "N/m")
    word = "stretch stiffness" if name == "stiffness" else "mass of a particle"
    axes.set(
        xscale="log", yscale="log", xlabel=f"{word} ({unit})", ylabel="largest stable step (ms)"
    )
    axes.set_title(f"{other} {values[len(values) // 2]:.3g} {held}; lines: theory", fontsize=10)
    axes.legend(fontsize=7, labelspacing=0.2)


def _errors(axes: Axes, found: Boundary) -> None:
    """Measured over theoretical, of all undamped points."""
    axes.axhspan(-5.0, 5.0, color="#f0ead8", lw=0, label="within 5 %")
    for number, integrator in enumerate(UNDAMPED_LIMIT):
        errors = 100 * found.of(integrator=integrator).errors
        x = number + np.linspace(-0.35, 0.35, len(errors))
        axes.plot(x, errors, ".", color=COLORS[integrator], ms=2)
    axes.axhline(0.0, color=INK, lw=0.8)
    names = [
        WORDS[integrator].replace("Runge-Kutta 4", "RK4").replace(" ", "\n")
        for integrator in UNDAMPED_LIMIT
    ]
    axes.set_xticks(range(len(names)), names, fontsize=8)
    axes.set(ylim=(-8, 8), ylabel="measured - theory (%)")
    axes.set_title(f"all {len(found.points)} undamped boundaries", fontsize=10)
    axes.legend(loc="upper right", fontsize=8)


def _map(axes: Axes, each: Map, found: Boundary) -> object:
    """Where the energy grows, over damping ratio and step."""
    w = fastest(found.points[0])
    growth = np.clip(np.nan_to_num(each.growth, posinf=1e12), 1e-6, 1e12)
    shaded = axes.pcolormesh(
        each.dampings,
        each.steps,
        growth.T,
        norm=LogNorm(GROWN**-1, GROWN),
        cmap=GROWTH_MAP,
        shading="nearest",
        rasterized=True,
    )
    ratios = [0.5 * w * point.damping_time for point in found.points]
    axes.plot(ratios, w * found.theory, color=INK, lw=1.4, label="theory")
    axes.plot(ratios, w * found.measured, "o", color=INK, mfc="white", ms=3.5, label="measured")
    axes.plot(ratios, w * found.safe, ":", color=INK, lw=1.2, label="safe step, any shape")
    limit = UNDAMPED_LIMIT.get(each.integrator)
    axes.set(xscale="log", yscale="log", ylim=(each.steps[0], each.steps[-1]))
    axes.set(xlabel="damping ratio", ylabel="w_max h")
    undamped = f"{limit:.3g} undamped" if limit else "none undamped"
    axes.set_title(f"{WORDS[each.integrator]} ({undamped})", fontsize=10)
    return shaded
