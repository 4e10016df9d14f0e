"""Strips of fabric that bend: under their weight, and by a moment at their end."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any

import numpy as np
from scipy.optimize import brentq

from . import reference, strips
from .row import Curve, Finding, Range, Row, Tolerance
from .specimen import STILL, G, Setting, Shape, Specimen, grid

CHAPTER = "bending"

LENGTH, DENSITY, BEND = 0.3, 0.2, 2e-4
"""Of the cantilever: length (m), areal density (kg/m²), bending stiffness (N·m)."""
CELLS, WIDE = 30, 3
"""Cells along and across."""
GAMMAS = (0.1, 1.0, 10.0, 100.0, 1000.0)

RESTS = {"verlet": 3e-5, "bdf2": 2e-3}
"""A droop that changes no more than this part of itself in three radians rests; implicit steps leave a jitter of 5e-4."""
LONGEST = 200
"""Radians until then at the most."""

ALIGNED = Tolerance(0.02)
ANY_MESH = Tolerance(0.15)
CIRCLE = Tolerance(0.01)
CLOSED = Tolerance(0.01, is_relative=False)
"""What is wanted."""
MEMBRANE = Tolerance(1e-3)
"""Strains of up to 5e-5, whose square the Green strain adds, and corners that weigh uneven."""
CONTROL = 0.15
"""By how much the springs that skip a vertex must miss, at the least."""


def columns_of(gamma: float) -> np.ndarray:
    """Columns (m) of a cantilever: even, but finer at its root where that is sharply bent."""
    part = np.linspace(0.0, 1.0, CELLS + 1)
    free = part if gamma <= 100.0 else part * (0.3 + 0.7 * part**2)
    return LENGTH * np.concatenate([[-2.0 * free[1], -free[1]], free])


def mesh_of(kind: str, gamma: float) -> Shape:
    """The mesh of a cantilever, which is clamped up to x = 0."""
    columns, cell = columns_of(gamma), LENGTH / CELLS
    if kind == "diagonal":
        return strips.diagonal(columns, 2 * WIDE + 1)
    make = strips.aligned if kind == "aligned" else strips.unstructured
    return make(columns, (cell if gamma <= 100.0 else 0.5 * cell) * np.arange(WIDE + 1))


def hung(shape: Shape, gamma: float) -> np.ndarray:
    """Where a cantilever is let go: it leaves its clamp in an arc, and then hangs nearly straight down."""
    s, y, _ = shape.positions.T
    radius = 1.2 * LENGTH * math.sqrt(2.0 / gamma)
    steepest = 0.475 * math.pi
    angle = np.clip(s / radius, 0.0, steepest)
    rest = np.maximum(s - radius * steepest, 0.0)
    x = radius * np.sin(angle) + rest * math.cos(steepest)
    z = -radius * (1.0 - np.cos(angle)) - rest * math.sin(steepest)
    return np.stack([np.where(s < 0.0, s, x), y, z], axis=-1)


def middle_line(strip: Specimen) -> np.ndarray:
    """Where the columns of a cantilever are, from the clamp on: x and z (m)."""
    x, places = strip.positions(), np.unique(strip.rest[:, 0].round(9))
    columns = [x[np.abs(strip.rest[:, 0] - place) < 1e-8].mean(axis=0) for place in places]
    return np.array(columns)[places > -1e-9][:, [0, 2]]


def settled(strip: Specimen, frames: int = 1, rests: float = RESTS["verlet"]) -> np.ndarray:
    """The middle line (m) of a cantilever at rest, for whose slowest motion so many frames are a radian."""
    strip.advance(6 * frames)
    droops = [ratio(middle_line(strip))]
    while len(droops) < LONGEST:
        strip.advance(frames)
        line = middle_line(strip)
        droops.append(ratio(line))
        if len(droops) > 3 and np.ptp(droops[-3:]) < rests * droops[-1]:
            return line
    raise RuntimeError(f"a cantilever still moves after {LONGEST} radians: H/W {droops[-3:]}")


@cache
def cantilever(kind: str, gamma: float, integrator: str = "verlet") -> np.ndarray:
    """The middle line (m) of a cantilever of fabric whose weight is `gamma` times what its stiffness bears.

    It can hardly be stretched, by its weight a thousandth at most.
    """
    gravity = gamma * BEND / (DENSITY * LENGTH**3)
    stretch = 1e3 * max(gamma, 1.0) * BEND / LENGTH**2
    slowest = 3.516 / LENGTH**2 * math.sqrt(BEND / DENSITY * (1.0 + 0.12 * gamma))
    shape = mesh_of(kind, gamma)
    mass = strips.masses(shape, DENSITY)
    damping = 1.4 * slowest * float((mass**2).sum() / mass.sum())
    cloth = strips.fabric(stretch, BEND, DENSITY, air_damping=damping)
    is_explicit = integrator == "verlet"
    setting = Setting(
        integrator, fps=slowest if is_explicit else 24.0, gravity=(0.0, 0.0, -gravity)
    )
    pins = np.flatnonzero(shape.positions[:, 0] < 1e-9)
    strip = Specimen(shape, cloth, setting, pins=pins, start=hung(shape, gamma))
    return settled(strip, math.ceil(setting.fps / slowest), RESTS[integrator])


def ratio(line: np.ndarray) -> float:
    """How far a tip hangs over how far it stands out."""
    return float(-line[-1, 1] / line[-1, 0])


@cache
def elastica() -> dict[float, float]:
    """H/W of the heavy elastica by Gamma."""
    return {
        float(line["Gamma"]): float(line["H_over_W"])
        for line in reference.table(reference.ELASTICA)
    }


def along_the_table(gammas: Sequence[float], results: Sequence[float]) -> Curve:
    """Droops beside the whole table."""
    known = elastica()
    line = (list(known), list(known.values()))
    expected = [known[gamma] for gamma in gammas]
    return Curve(gammas, results, expected, "Gamma", "H / W", line, "xy")


def profile(gamma: float) -> Callable[[Any], None]:
    """The shape of a cantilever beside the elastica's, where that is tabled, else its droop in the table."""
    points = [line for line in reference.table(reference.PROFILES) if float(line["Gamma"]) == gamma]
    shape = cantilever("aligned", gamma) / LENGTH
    if not points:
        return along_the_table([gamma], [ratio(shape)])
    expected = [[float(line["x_over_L"]), -float(line["drop_over_L"])] for line in points]
    x, z = np.array(expected).T
    return Curve(shape[:, 0], shape[:, 1], shape[:, 1], "x / L", "z / L", (x, z))


@cache
def by_default(gamma: float) -> float:
    """H/W under standard gravity with all settings of the solver as they are by default, of a fabric of usual stiffness.

    Three seconds pass; over a fourth the mean is taken, for implicit steps leave a jitter.
    """
    stretch = 2000.0
    length = (gamma * BEND / (DENSITY * G)) ** (1.0 / 3.0)
    cell = length / CELLS
    shape = strips.aligned(cell * np.arange(-2, CELLS + 1), cell * np.arange(WIDE + 1))
    slowest = 3.516 / length**2 * math.sqrt(BEND / DENSITY * (1.0 + 0.12 * gamma))
    mass = strips.masses(shape, DENSITY)
    damping = 1.4 * slowest * float((mass**2).sum() / mass.sum())
    cloth = strips.fabric(stretch, BEND, DENSITY, damping_ratio=0.02, air_damping=damping)
    pins = np.flatnonzero(shape.positions[:, 0] < 1e-9)
    strip = Specimen(shape, cloth, Setting("bdf2", gravity=(0.0, 0.0, -G)), pins=pins)
    strip.advance(72)
    droops = []
    for _ in range(24):
        strip.advance()
        droops.append(ratio(middle_line(strip)))
    return float(np.mean(droops))


def usual() -> Finding:
    """Three lengths of a usual fabric by default settings: 4.7, 10 and 22 cm."""
    gammas = (1.0, 10.0, 100.0)
    return along_the_table(gammas, [by_default(gamma) for gamma in gammas]).worst(ALIGNED)


def single(gamma: float) -> Finding:
    """The droop of an aligned cantilever."""
    return Finding(ratio(cantilever("aligned", gamma)), elastica()[gamma], profile(gamma))


def of_mesh(kind: str, integrator: str, gammas: Sequence[float], tolerance: Tolerance) -> Finding:
    """The worst droop of a mesh at several weights."""
    results = [ratio(cantilever(kind, gamma, integrator)) for gamma in gammas]
    return along_the_table(gammas, results).worst(tolerance)


@cache
def springs_droop(load: float) -> float:
    """H/W of a cantilever of classic springs under so many times standard gravity, bend springs (i, i+2) included."""
    cell = 0.03
    shape = grid(cell * np.arange(-2, 9), cell * np.arange(3))
    slowest = 3.0 * math.sqrt(load * G / 0.24)
    springs = {"stretch": 500.0, "shear": 100.0, "bend": 200.0, "air_damping": 1.4e-3 * slowest}
    cloth = {"mass_per_vertex": 1e-3, "springs": {**STILL, **springs}}
    setting = Setting("verlet", fps=slowest, gravity=(0.0, 0.0, -load * G))
    pins = np.flatnonzero(shape.positions[:, 0] < 1e-9)
    return ratio(settled(Specimen(shape, cloth, setting, pins=pins)))


def control() -> Finding:
    """Springs that skip a vertex, weighted until they droop as the elastica of Gamma 1; then a tenth of that weight."""
    known = elastica()

    def excess(exponent: float) -> float:
        return springs_droop(math.exp(exponent)) - known[1.0]

    load = math.exp(brentq(excess, math.log(2e-5), math.log(1e-4), xtol=0.05))
    gammas = (0.1, 1.0, 10.0)
    droops = [springs_droop(load * gamma) for gamma in gammas]
    miss = droops[0] / known[0.1] - 1.0
    note = f"H/W {droops[0]:.4f} in the place of {known[0.1]:.4f}: such springs have no linear bending stiffness"
    return Finding(miss, Range(low=CONTROL), along_the_table(gammas, droops), note)


@cache
def rolled() -> tuple[np.ndarray, float]:
    """A strip that the moment 2 pi B/L closes: its middle line (m), and the angle (rad) of its tip.

    The moment is a couple of forces on its last two columns, across its last cell as that lies: L ends in that cell's
    middle. The forces are those of goal springs, whose goals are set anew in every frame. Out of its plane they hold the
    tip in place with no force at all, once it is there.
    """
    cells, wide, length, frames = 30, 3, 0.2, 600
    cell = length / (cells - 0.5)
    shape = strips.aligned(cell * np.arange(-1, cells + 1), cell * np.arange(wide + 1))
    count, columns = len(shape.positions), cells + 2
    mass = strips.masses(shape, DENSITY)
    damping = 7.0 / length**2 * math.sqrt(BEND / DENSITY) * float(mass.mean())
    cloth = strips.fabric(1000.0, BEND, DENSITY, air_damping=damping)
    hold = 0.05 * count
    keys = {**cloth, "pin_stiffness": hold, "pin_damping": 0.0}
    strip = Specimen(shape, keys, Setting("implicit_euler"), pins=range(count))
    ends = np.arange(wide + 1) * columns + columns - 1
    ends, befores = ends, ends - 1
    weights = np.zeros(count)
    weights[np.arange(count) % columns < 2] = 1.0
    weights[ends] = weights[befores] = 0.5
    strip.simulation.set_pin_weights(0, weights)
    spring = 0.5 * hold * mass / mass.sum()
    share = np.array([0.5, *[1.0] * (wide - 1), 0.5]) / wide
    force = 2.0 * math.pi * BEND / length * wide * share
    for frame in range(frames):
        x = strip.positions()
        along = (x[ends] - x[befores]).mean(axis=0)
        across = np.array([-along[2], 0.0, along[0]]) / np.linalg.norm(along)
        pull = min(1.0, 2.0 * (frame + 1) / frames) * force[:, None] * across
        targets = x.copy()
        targets[ends] += pull / spring[ends, None]
        targets[befores] -= pull / spring[befores, None]
        targets[:, 1] = strip.rest[:, 1]
        strip.aim(targets)
        strip.advance()
    x = strip.positions().reshape(wide + 1, columns, 3).mean(axis=0)
    steps = np.diff(x[1:], axis=0)
    turns = np.unwrap(np.arctan2(steps[:, 2], steps[:, 0]))
    return x[1:], float(turns[-1])


def draw_roll(axes: Any) -> None:
    """The rolled strip beside its circle."""
    line, _ = rolled()
    angle = np.linspace(0.0, 2.0 * math.pi, 100)
    radius = 0.1 / math.pi
    axes.plot(
        radius * np.sin(angle),
        radius * (1.0 - np.cos(angle)),
        color="C0",
        lw=2.2,
        label="reference",
    )
    axes.plot(line[:, 0], line[:, 2], "o", color="C1", mfc="none", ms=4, label="result")
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("z (m)")


def tip_angle() -> Finding:
    """By how much the moment turns the strip's tip."""
    return Finding(math.degrees(rolled()[1]), 360.0, draw_roll)


def gap() -> Finding:
    """How far the tip is from the root, as a part of the length."""
    line, _ = rolled()
    tip = 0.5 * (line[-1] + line[-2])
    return Finding(float(np.linalg.norm((tip - line[0])[[0, 2]])) / 0.2, 0.0, draw_roll)


def hanging_strip() -> Finding:
    """The drop of the tip of a strip of fabric that hangs under its weight, on three grids."""
    length, stretch = 0.5, 2e4
    expected = 0.5 * DENSITY * G * length**2 / stretch
    cells, drops = [4, 8, 16], []
    for count in cells:
        cell = length / count
        flat = strips.aligned(cell * np.arange(4), -cell * np.arange(count + 1))
        shape = Shape(flat.positions[:, [0, 2, 1]], flat.faces[:, ::-1])
        slowest = 0.5 * math.pi / length * math.sqrt(stretch / DENSITY)
        mass = float(strips.masses(shape, DENSITY).mean())
        cloth = strips.fabric(
            stretch, 1e-6, DENSITY, air_damping=2.0 * mass * slowest, warp=[0.0, 0.0, 1.0]
        )
        setting = Setting("verlet", fps=100.0, gravity=(0.0, 0.0, -G))
        hung = Specimen(shape, cloth, setting, pins=range(4))
        hung.advance(8)
        fallen = (hung.rest - hung.positions())[-4:, 2]
        drops.append(float(np.average(fallen, weights=[0.5, 1.0, 1.0, 0.5])))
    return Curve(cells, drops, [expected] * 3, "cells", "drop of the tip (m)").worst(MEMBRANE)


def rows() -> list[Row]:
    """All rows of the chapter."""
    source = reference.SOURCES[reference.ELASTICA]
    test = "a_cantilever_droops_as_the_heavy_elastica_on_any_mesh, "
    test += "test_a_cantilever_of_fabric_droops_as_the_elastica_under_any_weight"
    defaults = "test_a_cantilever_of_fabric_droops_as_the_elastica_by_default_settings"
    any_mesh = "test_a_cantilever_of_fabric_droops_as_the_elastica_on_meshes_that_do_not_suit_it"
    rolls = "test_a_moment_at_its_end_closes_a_strip_of_fabric_to_a_circle"
    controls = "test_springs_that_skip_a_vertex_do_not_bend_as_the_elastica"
    moderate = (0.1, 1.0, 10.0)
    found = [
        Row(CHAPTER, f"cantilever of fabric, aligned mesh, Gamma {gamma:g}", "H/W", "", source, test,
            partial(single, gamma), ALIGNED)
        for gamma in GAMMAS
    ]  # fmt: skip
    return [
        *found,
        Row(CHAPTER, "cantilever of usual fabric, aligned mesh, default settings", "H/W", "", source, defaults,
            usual, ALIGNED),
        Row(CHAPTER, "cantilever of fabric, mesh at 45°", "H/W", "", source, any_mesh,
            partial(of_mesh, "diagonal", "bdf2", moderate, ANY_MESH), ANY_MESH),
        Row(CHAPTER, "cantilever of fabric, unstructured (Delaunay) mesh", "H/W", "", source, any_mesh,
            partial(of_mesh, "unstructured", "bdf2", moderate, ANY_MESH), ANY_MESH),
        Row(CHAPTER, "control: springs (i, i+2) must miss the elastica", "relative error of H/W", "", source,
            controls, control),
        Row(CHAPTER, "moment 2 pi B/L at the end of a strip: angle of the tip", "angle", "°",
            "closed form: curvature M/B, a whole turn over L", rolls, tip_angle, CIRCLE),
        Row(CHAPTER, "moment 2 pi B/L at the end of a strip: gap between tip and root", "gap / L", "",
            "closed form: a circle is closed", rolls, gap, CLOSED),
        Row(CHAPTER, "hanging strip of fabric: drop of the tip", "drop of the tip", "m",
            "closed form: sigma g L²/(2Y)", "test_a_strip_of_fabric_hangs_as_the_continuum", hanging_strip, MEMBRANE),
    ]  # fmt: skip
