"""The campaign: which steps are stable over mass, stiffness and damping, for every explicit integrator.

- Undamped: the boundary for four integrators, twelve stiffnesses, six masses and four ratios of stretch, shear and bend.
- Damped: for all six integrators a map of the damping ratio and the step, and its boundary.
- In motion: the boundary of a sheet that falls from one corner, which stretches and folds.

The brackets of the bisections are multiples of sqrt(m/k): what theory says is only compared with, afterwards.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from .boundary import Runs
from .sheet import EDGE, PAPER, SIDE, Lattice, Point, scene_text
from .theory import EXPLICIT, UNDAMPED_LIMIT, grid_eigenvalues, largest_step

LATTICES = (PAPER, Lattice(1.0, 0.0, 0.0), Lattice(1.0, 0.5, 0.0), Lattice(1.0, 1.0, 1.0))
MASS, STIFFNESS = 0.01, 500.0
"""Of the damped runs (kg, N/m): what matters is the damping ratio."""
FELL = 1.0
"""Seconds that sheets fall."""
TORN = 2.0
"""Elongation beyond which a falling sheet counts as unstable."""


@dataclass(frozen=True)
class Size:
    """How many points are run."""

    stiffnesses: int = 12
    masses: int = 6
    lattices: int = 4
    dampings: int = 28
    steps: int = 40
    rounds: int = 11
    falling: int = 8

    def stiffness(self) -> np.ndarray:
        """N/m."""
        return np.geomspace(30.0, 1e5, self.stiffnesses)

    def mass(self) -> np.ndarray:
        """kg, each particle."""
        return np.geomspace(0.001, 0.3, self.masses)

    def damping(self) -> np.ndarray:
        """Damping ratios of the fastest oscillation."""
        return np.geomspace(0.1, 4.0, self.dampings)

    def step(self) -> np.ndarray:
        """Steps of the maps, as multiples of 1/w_max."""
        return np.geomspace(0.06, 6.0, self.steps)


QUICK = Size(stiffnesses=2, masses=2, lattices=2, dampings=4, steps=6, rounds=8, falling=2)
"""For tests."""


@dataclass
class Boundary:
    """Measured and theoretical largest stable steps (s) of some points."""

    points: Sequence[Point]
    measured: np.ndarray
    theory: np.ndarray
    safe: np.ndarray

    @property
    def errors(self) -> np.ndarray:
        """Of the measured against the theoretical one, as fractions."""
        return self.measured / self.theory - 1.0

    def of(self, **wanted: object) -> Boundary:
        """Those points that have certain values."""
        chosen = [
            number
            for number, point in enumerate(self.points)
            if all(getattr(point, name) == value for name, value in wanted.items())
        ]
        parts = (self.measured[chosen], self.theory[chosen], self.safe[chosen])
        return Boundary([self.points[number] for number in chosen], *parts)


@dataclass
class Map:
    """By what factor the energy grew, over damping ratio (rows) and step (columns), for one integrator."""

    integrator: str
    dampings: np.ndarray  # damping ratios
    steps: np.ndarray  # w_max h
    growth: np.ndarray


@dataclass
class Falling:
    """Largest stable steps (s) of sheets that fall from a corner, by symplectic Euler."""

    stiffness: np.ndarray  # N/m
    measured: np.ndarray
    safe: np.ndarray


def fastest(point: Point) -> float:
    """w_max (1/s) of a point's flat sheet."""
    return math.sqrt(grid_eigenvalues(point.lattice)[-1] * point.stiffness / point.mass)


def boundary(runs: Runs, what: str, points: Sequence[Point], rounds: int) -> Boundary:
    """Bisect the boundary of some points, and set it beside theory."""
    scale = np.array([math.sqrt(point.mass / point.stiffness) for point in points])
    measured = runs.bisect(what, points, 0.01 * scale, 8.0 * scale, rounds)
    theory = [
        largest_step(
            point.integrator,
            grid_eigenvalues(point.lattice) * point.stiffness / point.mass,
            point.damping_time,
        )
        for point in points
    ]
    safe = np.array([runs.safe_steps[point] for point in points])
    return Boundary(points, measured, np.array(theory), safe)


def undamped(runs: Runs, size: Size) -> Boundary:
    """The boundary without damping."""
    axes = (UNDAMPED_LIMIT, size.mass(), size.stiffness(), LATTICES[: size.lattices])
    return boundary(runs, "undamped", [Point(*axis) for axis in product(*axes)], size.rounds)


def damped_point(integrator: str, ratio: float) -> Point:
    """The point of a damping ratio of the fastest oscillation."""
    time = 2.0 * ratio / fastest(Point(integrator, MASS, STIFFNESS))
    return Point(integrator, MASS, STIFFNESS, damping_time=time)


def damped(runs: Runs, size: Size) -> Boundary:
    """The boundary over the damping ratio, for every explicit integrator."""
    axes = product(EXPLICIT, size.damping())
    return boundary(runs, "damped", [damped_point(*axis) for axis in axes], size.rounds)


def maps(runs: Runs, size: Size) -> list[Map]:
    """The maps over damping ratio and step."""
    w = fastest(Point("verlet", MASS, STIFFNESS))
    found = []
    for integrator in EXPLICIT:
        axes = list(product(size.damping(), size.step()))
        points = [damped_point(integrator, ratio) for ratio, _ in axes]
        growth = runs.growths(f"map of {integrator}", points, [step / w for _, step in axes])
        shape = (size.dampings, size.steps)
        found.append(Map(integrator, size.damping(), size.step(), growth.reshape(shape)))
    return found


def falling_scene(stiffness: float, step: float) -> str:
    """A sheet held at one corner that falls, in so long steps (s)."""
    cloth = {
        "name": "sheet",
        "grid": {"size": [EDGE * (SIDE - 1)] * 2, "vertices": [SIDE, SIDE], "plane": "xy"},
        "pins": ["top_left"],
        "mass_per_vertex": MASS,
        "springs": Point("symplectic_euler", MASS, stiffness).springs(),
    }
    count = math.ceil(FELL / (24.0 * step))
    solver = {"integrator": "symplectic_euler", "substeps": count, "allow_unstable": True}
    return scene_text({"frames": [1, 25], "fps": 1.0 / (count * step)}, cloth, solver)


def falling(runs: Runs, size: Size) -> Falling:
    """The boundary in motion."""
    # Softer sheets are pulled apart by their own fall.
    stiffness = np.geomspace(1000.0, 1e5, size.falling)
    scale = np.sqrt(MASS / stiffness)
    safe = np.zeros_like(stiffness)

    def is_stable(steps: np.ndarray) -> np.ndarray:
        scenes = [falling_scene(k, step) for k, step in zip(stiffness, steps, strict=True)]
        rows = runs.run("falling", scenes)
        safe[:] = [row["safe_time_step"] for row in rows]
        strains = [row["largest_strain"] if row["ending"] == "done" else None for row in rows]
        return np.array([strain is not None and strain < TORN for strain in strains])

    low, high = 0.1 * scale, 4.0 * scale
    is_inside = is_stable(low) & ~is_stable(high)
    for _ in range(size.rounds):
        middle = np.sqrt(low * high)
        stable = is_stable(middle)
        low, high = np.where(stable, middle, low), np.where(stable, high, middle)
    return Falling(stiffness, np.where(is_inside, low, math.nan), safe)


def numbers(found: Boundary) -> list[dict[str, object]]:
    """A boundary as rows for a file."""
    rows = []
    for point, *steps in zip(found.points, found.measured, found.theory, found.safe, strict=True):
        names = ("measured_s", "theory_s", "safe_time_step_s")
        row = {
            "integrator": point.integrator,
            "mass_kg": float(point.mass),
            "stretch_N_m": float(point.stiffness),
            "stretch_shear_bend": point.lattice.words,
            "damping_time_s": float(point.damping_time),
        }
        row |= {
            name: float(step) if math.isfinite(step) else None
            for name, step in zip(names, steps, strict=True)
        }
        rows.append(row)
    return rows


def text(value: object) -> str:
    """Strict JSON."""
    return json.dumps(value, indent=1, allow_nan=False) + "\n"
