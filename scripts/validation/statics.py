"""Chains, strips and catenaries that hang at rest, and a strip that a moment bends."""

from __future__ import annotations

import math
from functools import cache, partial
from typing import Any

import numpy as np
from scipy.optimize import brentq

from .row import Curve, Finding, Row, Tolerance
from .specimen import STILL, G, Setting, Specimen, grid, ladder

CHAPTER = "statics"

CHAIN = Tolerance(1e-6)
"""What is wanted; 40 e-foldings of the slowest motion pass."""
TIP = Tolerance(1e-6)
ORDER = Tolerance(0.01, is_relative=False)
"""The next term of the error's series at 5 to 20 cells."""
CATENARY = Tolerance(1e-4)
"""Links stretch by 1e-5."""

LINK, MASS, SPRING = 0.1, 0.01, 98.1
"""Links of a chain (m), its masses (kg) and springs (N/m): each mass draws its spring out by a millimetre."""


def hang(specimen: Specimen, seconds: int) -> Specimen:
    """Let what hangs come to rest."""
    specimen.advance(seconds)
    return specimen


def falling(integrator: str = "symplectic_euler") -> Setting:
    """Weight, in frames of a second, in steps as the rule bears."""
    return Setting(integrator, fps=1.0, gravity=(0.0, 0.0, -G))


@cache
def chain_drop(count: int, has_half_end: bool) -> float:
    """How far (m) the tip of a chain of so many links hangs below its rest length."""
    shape = ladder([LINK] * count, 0.1)
    slowest = 0.5 * math.pi / count * math.sqrt(SPRING / MASS)
    springs = {**STILL, "stretch": SPRING, "air_damping": 2.0 * MASS * slowest}
    # By density, each particle weighs its share of the faces around it: the last half of the others.
    mass = {"density": MASS / (0.05 * LINK)} if has_half_end else {"mass_per_vertex": MASS}
    chain = Specimen(shape, {**mass, "springs": springs}, falling(), pins=[0, 1])
    tip = hang(chain, 10).mean_row(chain.positions())[-1]
    return -float(tip[2]) - count * LINK


def chains(has_half_end: bool) -> Finding:
    """The drop of chains of 1 to 40 links."""
    counts = [1, 5, 20, 40]

    def expected(n: float) -> float:
        return MASS * G / SPRING * 0.5 * (n * n if has_half_end else n * (n + 1))

    drops = [chain_drop(count, has_half_end) for count in counts]
    fine = np.linspace(1, 40, 100)
    line = (fine, [expected(n) for n in fine])
    curve = Curve(counts, drops, [expected(n) for n in counts], "links", "drop (m)", line)
    return curve.worst(CHAIN)


DENSITY, LENGTH, STIFFNESS = 0.2, 1.0, 50.0
"""The strip's areal density (kg/m²), length (m) and membrane stiffness (N/m)."""


@cache
def strip(cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Heights at rest (m) of a hanging strip's rows, and how far each drops."""
    spacing = LENGTH / cells
    shape = grid(spacing * np.arange(4), -spacing * np.arange(cells + 1))
    upright = type(shape)(shape.positions[:, [0, 2, 1]], shape.faces)
    slowest = 0.5 * math.pi / LENGTH * math.sqrt(STIFFNESS / DENSITY)
    damping = 2.0 * DENSITY * spacing * spacing * slowest
    springs = {**STILL, "stretch": STIFFNESS, "stiffness_from": "continuum", "air_damping": damping}
    cloth = {"density": DENSITY, "springs": springs}
    hung = hang(Specimen(upright, cloth, falling(), pins=range(4)), 8)
    heights = hung.mean_row(hung.rest, 4)[:, 2]
    return heights, heights - hung.mean_row(hung.positions(), 4)[:, 2]


def strip_tip() -> Finding:
    """The drop of the strip's tip on three grids."""
    expected = 0.5 * DENSITY * G * LENGTH**2 / STIFFNESS
    cells = [5, 10, 20]
    drops = [strip(count)[1][-1] for count in cells]
    return Curve(cells, drops, [expected] * 3, "cells", "drop of the tip (m)").worst(TIP)


def strip_order() -> Finding:
    """At which order the strip's mean drop converges to sigma g L²/(3 Y)."""
    expected, cells, errors = DENSITY * G * LENGTH**2 / (3.0 * STIFFNESS), [5, 10, 20, 40], []
    for count in cells:
        _, drops = strip(count)
        mean = (0.5 * (drops[1:] + drops[:-1])).mean()
        errors.append(abs(mean / expected - 1.0))
    order = math.log2(errors[-2] / errors[-1])
    line = [errors[0] * (cells[0] / count) ** 2 for count in cells]
    return Finding(
        order, 2.0, Curve(cells, errors, line, "cells", "relative error", logarithmic="xy")
    )


SLACK = 1.5
"""Length of the catenary over its span, which is 1 m."""


def continuous_catenary() -> tuple[float, float]:
    """Sag and largest tension of a chain without links, over the span and the span's weight."""
    a = brentq(lambda a: 2.0 * a * math.sinh(0.5 / a) - SLACK, 0.1, 50.0, xtol=1e-15)
    return a * (math.cosh(0.5 / a) - 1.0), a * math.cosh(0.5 / a)


def linked_catenary(count: int) -> tuple[float, np.ndarray]:
    """Horizontal pull, in weights of a mass, and heights (m) of all ends of stiff links with equal masses between them."""
    link, load = SLACK / count, np.arange(count) - 0.5 * (count - 1)
    pull = brentq(lambda h: (link * h / np.hypot(h, load)).sum() - 1.0, 1e-6, 1e6, xtol=1e-12)
    return pull, np.concatenate([[0.0], np.cumsum(link * load / np.hypot(pull, load))])


@cache
def catenary(count: int) -> tuple[np.ndarray, float]:
    """Where the ends of the links hang (m), and the pull of a pin over the weight of a span.

    A pin carries half a link more than the last link pulls it with.
    """
    link, mass = SLACK / count, 0.3 / count
    weight = mass * G
    stiffness = 0.6 * count * weight / (1e-5 * link)
    springs = {**STILL, "stretch": stiffness, "air_damping": 8.0 * mass}
    shape = ladder([link] * count, 0.1)
    # It starts as a V of its own length.
    along = np.linspace(-1.0, 1.0, count + 1)
    depth = math.sqrt((0.5 * SLACK) ** 2 - 0.25) * (1.0 - np.abs(along))
    start = shape.positions.copy()
    start[:, 0] = np.repeat(0.5 + 0.5 * along, 2)
    start[:, 2] = np.repeat(-depth, 2)
    cloth = {"mass_per_vertex": mass, "springs": springs}
    pins = [0, 1, 2 * count, 2 * count + 1]
    hung = hang(Specimen(shape, cloth, falling(), pins=pins, start=start), 12)
    ends = hung.mean_row(hung.positions())
    first = ends[1] - ends[0]
    tension = stiffness * (np.linalg.norm(first) - link)
    level, upright = tension * np.array([first[0], -first[2]]) / np.linalg.norm(first)
    return ends, math.hypot(level, upright + 0.5 * weight) / (weight / link)


def catenary_plot(count: int) -> Any:
    """The shape of a catenary of links, and that of the closed form."""
    ends, _ = catenary(count)
    a = continuous_catenary()[1] - continuous_catenary()[0]
    x = np.linspace(0.0, 1.0, 100)
    z = a * (np.cosh((x - 0.5) / a) - math.cosh(0.5 / a))
    return Curve(ends[:, 0], ends[:, 2], ends[:, 2], "x (m)", "z (m)", (x, z))


def linked_sag(count: int) -> Finding:
    """Sag of a chain of links beside the root of its own equation."""
    _, heights = linked_catenary(count)
    return Finding(
        -float(catenary(count)[0][:, 2].min()), -float(heights.min()), catenary_plot(count)
    )


def catenary_limit(part: int) -> Finding:
    """Sag (part 0) or largest tension (part 1) as links become many, from 32 and 64 of them."""
    counts = [8, 16, 32, 64]
    values = [
        (-float(catenary(count)[0][:, 2].min()), catenary(count)[1])[part] for count in counts
    ]
    expected = continuous_catenary()[part]
    limit = values[-1] + (values[-1] - values[-2]) / 3.0
    label = ("sag / span", "Tmax / (w span)")[part]
    plot = Curve(counts, values, [expected] * 4, "links", label)
    return Finding(limit, expected, plot, "from 32 and 64 links, whose error falls as 1/N²")


def rows() -> list[Row]:
    """All rows of the chapter."""
    closed = "closed form: "
    test = "the_tip_of_a_hanging_chain_drops_by_the_sum_of_its_springs_elongations"
    strips = "a_hanging_strip_drops_as_the_continuum_and_converges_at_order_two"
    hangs = "test_a_chain_hangs_as_the_catenary"
    return [
        Row(CHAPTER, "hanging chain: drop of the tip", "drop of the tip", "m",
            closed + "(m g/k) N(N+1)/2", test, partial(chains, False), CHAIN),
        Row(CHAPTER, "hanging chain, half a mass at the end: drop of the tip", "drop of the tip", "m",
            closed + "(m g/k) N²/2", test, partial(chains, True), CHAIN),
        Row(CHAPTER, "hanging strip: drop of the tip", "drop of the tip", "m",
            closed + "sigma g L²/(2Y)", strips, strip_tip, TIP),
        Row(CHAPTER, "hanging strip: order of convergence", "order", "",
            closed + "linear elements of u = sigma g/Y (L s - s²/2): 2", strips, strip_order, ORDER),
        Row(CHAPTER, "catenary of 32 links: sag / span", "sag / span", "",
            closed + "equal masses between stiff links, root of the span's equation", hangs,
            partial(linked_sag, 32), CATENARY),
        Row(CHAPTER, "catenary: sag / span", "sag / span", "",
            closed + "a (cosh(1/2a) - 1) with 2a sinh(1/2a) = 1.5", hangs, partial(catenary_limit, 0), CATENARY),
        Row(CHAPTER, "catenary: largest tension", "Tmax / (w span)", "",
            closed + "a cosh(1/2a)", hangs, partial(catenary_limit, 1), CATENARY),
    ]  # fmt: skip
