"""KES-FB2, pure bending: two clamps roll a strip to 2.5 /cm, back to -2.5 /cm and flat again, and feel its moment.

B is the slope of the moment over the curvature between 0.5 and 1.5 /cm, 2HB how far the two branches are apart at 0.5 /cm;
both are means of the two sides. The strip is rolled from the shape that it has, step by step, so that friction and creases
remember how they came there.

The clamps stand where the ends of an arc as long as the strip are, whose cells keep their length.
"""

from __future__ import annotations

from dataclasses import dataclass

import boucle_core
import numpy as np

from .cantilever import DIRECTIONS
from .cutting import Kind, strip
from .fabric import Fabric
from .resting import Load, Specimen

LENGTH = 0.01
"""m between the clamps."""
WIDTH = 0.01
MOST = 250.0
"""1/m, where a branch turns."""
STEPS = 50
"""Of a branch from flat to there."""
READ = (50.0, 150.0)
"""1/m, between which the slope is read; the width at the first."""
FRAMES = 3
"""That a strip has to come to rest after each."""
STEP = 1e-3
"""s."""
AIR = 1000.0
"""1/s: a strip as short as this swings a thousand times a second."""
REACH = 1e-3
"""By how much (1/m) clamps are turned to and fro to feel the moment."""


@dataclass(frozen=True)
class Bending:
    """What the instrument reads along one system of yarns."""

    direction: str
    curvatures: tuple[float, ...]
    """1/m, in the order in which the strip was bent."""
    moments: tuple[float, ...]
    """By width (N·m/m), at them."""
    expected: float
    """B (N·m) of the fabric's own numbers."""
    expected_width: float
    """2HB (N·m/m) of the fabric's own numbers."""

    def branch(self, is_falling: bool, curvature: float) -> float:
        """The moment by width (N·m/m) at a curvature (1/m) while that falls, or while it rises again."""
        turn = STEPS if is_falling else 3 * STEPS
        part = slice(turn, turn + 2 * STEPS + 1)
        order = np.argsort(self.curvatures[part])
        curvatures, moments = (np.array(of[part])[order] for of in (self.curvatures, self.moments))
        return float(np.interp(curvature, curvatures, moments))

    @property
    def rigidity(self) -> float:
        """B (N·m): of bending further, to either side."""
        low, high = READ
        up = self.branch(False, high) - self.branch(False, low)
        down = self.branch(True, -low) - self.branch(True, -high)
        return 0.5 * (up + down) / (high - low)

    @property
    def width(self) -> float:
        """2HB (N·m/m)."""
        apart = [self.branch(False, at) - self.branch(True, at) for at in (READ[0], -READ[0])]
        return float(np.mean(apart))

    @property
    def error(self) -> float:
        """By how much the rigidity is off, as a part of that expected."""
        return self.rigidity / self.expected - 1.0


def rolled(rest: np.ndarray, curvature: float, cell: float) -> np.ndarray:
    """Where the points (m) of a strip are whose middle is an arc of so long cells, and whose ends go on straight."""
    columns = round(LENGTH / cell)
    edges = cell * np.arange(-1, columns + 2)
    headings = curvature * np.clip(edges[:-1] + 0.5 * cell, 0.0, LENGTH)
    headings -= 0.5 * curvature * LENGTH
    out, up = (np.cumsum([0.0, *(cell * turn)]) for turn in (np.cos(headings), np.sin(headings)))
    middle = np.interp(0.5 * LENGTH, edges, out), np.interp(0.5 * LENGTH, edges, up)
    along = rest[:, 0]
    x, z = (
        np.interp(along, edges, of) - shift for of, shift in zip((out, up), middle, strict=True)
    )
    return np.column_stack([x, rest[:, 1], z])


def moment(
    running: boucle_core.Simulation, specimen: Specimen, curvature: float, cell: float
) -> float:
    """The moment by width (N·m/m) that the clamps feel, of the energy as they alone turn."""
    positions = np.empty_like(specimen.rest)
    running.read_positions(0, positions)
    ahead, behind = (rolled(specimen.rest, curvature + side, cell) for side in (REACH, -REACH))
    energies = []
    for clamps in (ahead, behind):
        moved = positions.copy()
        moved[specimen.held] = clamps[specimen.held]
        running.set_positions(0, moved)
        energies.append(float(running.certificate()["potential_energy"]))
    running.set_positions(0, positions)
    # The clamps turn against each other by the heading of the first cell and of the last.
    return (energies[0] - energies[1]) / (2.0 * REACH * LENGTH * WIDTH)


def measure(fabric: Fabric, direction: str, cells: int = 10, kind: Kind = "grid") -> Bending:
    """Bend a fabric both ways.

    Args:
        fabric: What is measured.
        direction: "warp" or "weft": the yarns that are bent.
        cells: Cells between the clamps.
        kind: Of the mesh.
    """
    cell = LENGTH / cells
    cut = strip(LENGTH + 2.0 * cell, WIDTH, (cells + 2, cells), kind, (0, 1, -2, -1))
    cut = type(cut)(cut.points - [cell, 0.0], cut.faces)
    x = cut.points[:, 0]
    held = np.flatnonzero((x < 0.01 * cell) | (x > LENGTH - 0.01 * cell))
    specimen = Specimen(fabric, cut, held, DIRECTIONS[direction])
    there = np.linspace(0.0, MOST, STEPS + 1)
    curvatures = [*there, *there[-2::-1], *-there[1:], *-there[-2::-1], *there[1:]]
    load = Load(force=1.0, energy=1.0, air=AIR, step=STEP)
    running = specimen.simulation(rolled(specimen.rest, 0.0, cell), load)
    moments = []
    for curvature in curvatures:
        running.set_pin_targets(0, rolled(specimen.rest, curvature, cell))
        for _ in range(FRAMES):
            running.advance()
        moments.append(moment(running, specimen, curvature, cell))
    own, width = fabric.number(f"bend_{direction}"), fabric.changes.get("bend_hysteresis", 0.0)
    bent = tuple(float(curvature) for curvature in curvatures)
    return Bending(direction, bent, tuple(moments), own, float(width))
