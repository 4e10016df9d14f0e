"""ASTM D1388, the cantilever: a strip is pushed over an edge until its tip reaches a line 41.5° below the level.

The overhang O then tells the bending length c = O/2 and the flexural rigidity B = weight c³, as 41.5° is where the heavy
elastica has weight O³/B = 8. Pushing is a row of strips of different overhang, each clamped and brought to rest; the next
one is as long as the last one says that it should be.

On the bias a strip bends with Peirce's mean if it is free to twist, that is, much narrower than long. A specimen of 25 mm
that hangs out by less is not: where warp and weft bend twice as unlike each other, it reads a few percent more.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .cutting import Cut, Kind, strip
from .elastica import FLAT_TIP, Hanging, Profile, gamma_of_chord, profile
from .fabric import GRAVITY, Fabric
from .resting import Load, Resting, Specimen, settle

WIDTH = 0.025
"""m, as D1388 cuts it."""
CLAMPED = 2
"""Rows of cells in the clamp."""
NEAR = 1.0
"""How near (degrees) to the line the tip must be for the overhang to be read."""
MOST_STRIPS = 4
STEP = 5e-4
"""s; where the solver lets a strip rest depends a little on its step: with half of this, by half a percent of B at the most."""
DIRECTIONS = {"warp": (1.0, 0.0), "weft": (0.0, 1.0), "bias": (1.0, 1.0)}
"""Which way the warp runs in a strip that is cut along x in this direction of the fabric."""


@dataclass(frozen=True)
class Overhang(Hanging):
    """A strip at rest over the edge."""

    length: float
    """m."""
    out: np.ndarray
    """Its middle line: how far from the edge (m)."""
    down: np.ndarray
    """How far below it (m)."""
    resting: Resting


@dataclass(frozen=True)
class Cantilever:
    """What the instrument reads in one direction."""

    direction: str
    overhang: float
    """O (m)."""
    rigidity: float
    """B (N·m)."""
    expected: float
    """B (N·m) of the fabric's own numbers."""
    expected_bending_length: float
    """c (m) of it."""
    strip: Overhang
    """The last one that hung there."""
    exact: Profile
    """The heavy elastica of the fabric's own B at its length."""

    @property
    def bending_length(self) -> float:
        """c (m)."""
        return 0.5 * self.overhang

    @property
    def error(self) -> float:
        """By how much the rigidity is off, as a part of that expected."""
        return self.rigidity / self.expected - 1.0


def expected_rigidity(fabric: Fabric, direction: str) -> float:
    """B (N·m) of a narrow strip: on the bias, Peirce's mean."""
    warp, weft = fabric.number("bend_warp"), fabric.number("bend_weft")
    if direction == "bias":
        return 4.0 / (warp**-0.5 + weft**-0.5) ** 2
    return warp if direction == "warp" else weft


def hang(
    fabric: Fabric, direction: str, length: float, cells: int, kind: Kind, guess: float
) -> Overhang:
    """Let so long (m) a strip hang over the edge, from the shape that it has if its rigidity (N·m) is `guess`."""
    edge = length / cells
    rows = max(2, 2 * round(0.5 * WIDTH / edge))
    clamp = CLAMPED * edge
    straight = [*range(CLAMPED + 1), -1]
    whole = strip(length + clamp, WIDTH, (cells + CLAMPED, rows), kind, straight)
    cut = Cut(whole.points - [clamp, 0.0], whole.faces)
    held = np.flatnonzero(cut.points[:, 0] < 0.01 * edge)
    specimen = Specimen(fabric, cut, held, DIRECTIONS[direction])
    shape = profile(fabric.weight * length**3 / guess)
    along = np.clip(cut.points[:, 0], 0.0, None) / length
    start = specimen.rest
    start[:, 0] = np.minimum(start[:, 0], 0.0) + length * np.interp(along, shape.along, shape.out)
    start[:, 2] = -length * np.interp(along, shape.along, shape.down)
    weight = fabric.weight * length * WIDTH
    load = Load(force=weight, energy=weight * length, gravity=GRAVITY, step=STEP)
    return read(settle(specimen, start, load), length, cells)


def read(resting: Resting, length: float, cells: int) -> Overhang:
    """The middle line of a strip: the mean over its width, in steps of a cell."""
    rest, now = resting.specimen.cut.points, resting.positions
    places = np.rint(rest[:, 0] * cells / length).astype(int)
    rows = [np.flatnonzero(places == place) for place in range(cells + 1)]
    rows[-1] = np.flatnonzero(rest[:, 0] > length * (1.0 - 1e-9))
    out, down = np.array([[now[row, 0].mean(), -now[row, 2].mean()] for row in rows]).T
    return Overhang(length, out, down, resting)


def measure(
    fabric: Fabric, direction: str, cells: int = 24, kind: Kind = "grid", guess: float | None = None
) -> Cantilever:
    """Find the overhang at which the tip reaches the line.

    Args:
        fabric: What is measured.
        direction: "warp", "weft" or "bias": along which the strip is cut.
        cells: Cells along the overhang.
        kind: Of the mesh.
        guess: The rigidity (N·m) that the first strip is cut for; that of the fabric's own numbers if None.
    """
    expected = expected_rigidity(fabric, direction)
    rigidity = expected if guess is None else guess
    read_at = gamma_of_chord(FLAT_TIP)
    for _ in range(MOST_STRIPS):
        length = (read_at * rigidity / fabric.weight) ** (1.0 / 3.0)
        hanging = hang(fabric, direction, length, cells, kind, rigidity)
        rigidity = fabric.weight * length**3 / gamma_of_chord(hanging.chord)
        if abs(hanging.chord - FLAT_TIP) < NEAR:
            break
    overhang = (read_at * rigidity / fabric.weight) ** (1.0 / 3.0)
    rigidity = fabric.weight * (0.5 * overhang) ** 3
    exact = profile(fabric.weight * hanging.length**3 / expected)
    bending_length = (expected / fabric.weight) ** (1.0 / 3.0)
    return Cantilever(direction, overhang, rigidity, expected, bending_length, hanging, exact)
