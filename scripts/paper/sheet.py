"""A square sheet of springs, simulated by the compiled module."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import boucle_core
import numpy as np

STRETCH, SHEAR, BEND = 0, 1, 2
KINDS = ("stretch", "shear", "bend")
FOREVER = 1_000_000
"""A last frame that no figure reaches."""


class Springs(NamedTuple):
    """The spring list that the module returns, one row a spring."""

    ends: np.ndarray  # (s, 2) vertices
    kinds: np.ndarray  # (s,) STRETCH, SHEAR or BEND
    rest_lengths: np.ndarray  # (s,) m
    stiffnesses: np.ndarray  # (s,) N/m

    def lengths(self, positions: np.ndarray) -> np.ndarray:
        """Length (m) of every spring when the vertices are at `positions` (m)."""
        return np.linalg.norm(positions[self.ends[:, 0]] - positions[self.ends[:, 1]], axis=1)

    def between(self, a: int, b: int) -> int:
        """The number of the spring that joins two vertices."""
        joins = (self.ends == sorted((a, b))).all(axis=1)
        (found,) = np.flatnonzero(joins)
        return int(found)


@dataclass(frozen=True)
class Recipe:
    """What a sheet is made of and how it is moved. The defaults are the paper's, where it gives them."""

    vertices: int = 16  # along each side
    size: float = 2.0  # m
    mass: float = 0.1  # kg, each particle
    stretch: float = 500.0  # N/m
    shear: float = 100.0
    bend: float = 5.0
    damping: float = 1.0  # N·s/m, every spring
    limiter: str = "none"
    rate: float = 0.10  # allowed elongation
    fps: int = 60
    time_step: float | None = None  # s, kept even beyond the safe one; None keeps to the safe one
    tilt: float = 0.0  # degrees that the sheet is lifted about its top edge at the start

    def scene(self, pins: list[int]) -> str:
        """The scene as the module reads it."""
        solver: dict[str, object] = {"integrator": "symplectic_euler"}
        if self.time_step is not None:
            solver |= {"time_step": self.time_step, "allow_unstable": True}
        springs = {
            "stretch": self.stretch,
            "shear": self.shear,
            "bend": self.bend,
            "damping": self.damping,
            "limiter": self.limiter,
            "deformation_rate": self.rate,
        }
        cloth = {
            "name": "sheet",
            "mass_per_vertex": self.mass,
            "pins": {"vertices": pins},
            "springs": springs,
        }
        scene = {"frames": [1, FOREVER], "fps": self.fps}
        touches_nothing = {"enabled": False}
        return json.dumps(
            {"scene": scene, "cloth": [cloth], "collision": touches_nothing, "solver": solver}
        )

    def words(self, *leave_out: str) -> str:
        """Its numbers for a caption, without those that the figure varies."""
        n = self.vertices
        parts: Mapping[str, str] = {
            "grid": f"{n} × {n} particles",
            "size": f"{self.size:g} m × {self.size:g} m",
            "mass": f"{self.mass:g} kg a particle",
            "stretch": f"stretch k {self.stretch:g} N/m",
            "shear": f"shear k {self.shear:g} N/m",
            "bend": f"bend k {self.bend:g} N/m",
            "damping": f"damping {self.damping:g} N·s/m",
        }
        return ", ".join(text for name, text in parts.items() if name not in leave_out)


class Sheet:
    """A sheet in the plane y = 0, held at its two top corners."""

    def __init__(self, recipe: Recipe) -> None:
        n = recipe.vertices
        axis = np.linspace(-0.5 * recipe.size, 0.5 * recipe.size, n)
        x, z = np.meshgrid(axis, axis)
        self.recipe = recipe
        self.rest = np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3)
        number = np.arange(n * n).reshape(n, n)
        rows = [number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]]
        self.faces = np.stack(rows, axis=-1).reshape(-1, 4).astype(np.int32)
        self.pins = [n * (n - 1), n * n - 1]
        starts = np.arange(0, self.faces.size, 4, dtype=np.int32)
        mesh = (self.rest, starts, self.faces.reshape(-1))
        self.simulation = boucle_core.Simulation(recipe.scene(self.pins), [mesh])
        self.start = self.tilted(math.radians(recipe.tilt))
        self.simulation.set_positions(0, self.start)

    def tilted(self, angle: float) -> np.ndarray:
        """The sheet at rest, turned by an angle (rad) about its top edge."""
        top = 0.5 * self.recipe.size
        below = self.rest[:, 2] - top
        turned = [self.rest[:, 0], below * math.sin(angle), top + below * math.cos(angle)]
        return np.stack(turned, axis=-1)

    def bring_pins_together(self, part: float) -> None:
        """Move the pins inward, by a part of the rest width, during the next frame."""
        targets = self.start * np.array([1.0 - part, 1.0, 1.0])
        self.simulation.set_pin_targets(0, targets)

    def advance(self) -> None:
        """Move on by one frame."""
        self.simulation.advance()

    def positions(self) -> np.ndarray:
        """Positions (m), (n, 3)."""
        out = np.empty_like(self.rest)
        self.simulation.read_positions(0, out)
        return out

    def strain(self) -> np.ndarray:
        """Largest elongation of the edges at each vertex, as a fraction, (n,)."""
        out = np.empty(len(self.rest), dtype=np.float32)
        self.simulation.read_strain(0, out)
        return out

    def springs(self) -> Springs:
        """The spring list, with the stiffness that the limiter gives it now."""
        ends, kinds, lengths, stiffnesses, _ = self.simulation.read_springs(0)
        return Springs(
            np.frombuffer(ends, np.int32).reshape(-1, 2),
            np.frombuffer(kinds, np.uint8),
            np.frombuffer(lengths, np.float64),
            np.frombuffer(stiffnesses, np.float64),
        )


def hang(recipe: Recipe, seconds: float, inward: float) -> Sheet:
    """Let a sheet hang while its pins come together, and return it at the end.

    Args:
        recipe: What it is made of.
        seconds: Duration; the pins arrive at half of it.
        inward: Part of the width that the pins come together by.
    """
    sheet = Sheet(recipe)
    frames = round(seconds * recipe.fps)
    for frame in range(1, frames + 1):
        way = min(1.0, 2.0 * frame / frames)
        sheet.bring_pins_together(inward * way * way * (3.0 - 2.0 * way))
        sheet.advance()
    return sheet


def shear_angles(sheet: Sheet) -> np.ndarray:
    """Largest shear (degrees) of the faces' corners at each vertex: how far they are from a right angle."""
    positions = sheet.positions()
    corners = positions[sheet.faces]
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    lengths = np.linalg.norm(ahead, axis=2) * np.linalg.norm(behind, axis=2)
    cosines = (ahead * behind).sum(axis=2) / lengths
    shear = np.abs(90.0 - np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))))
    largest = np.zeros(len(positions))
    np.maximum.at(largest, sheet.faces.ravel(), shear.ravel())
    return largest
