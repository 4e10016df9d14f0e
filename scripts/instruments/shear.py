"""Shear: a picture frame, whose four sides hold the cloth, and KES-FB1, whose two clamps leave the other sides free.

Both turn the yarns of one system by an angle and keep the length of all. The energy then grows with the angle by the moment
M. In the frame every bit of cloth shears alike, U·V = sin a, so that the law stores G sin²a/2 on every area and

    M = G area sin a cos a

gives G at any angle. KES reads the shear force M/(length · width) between 0.5° and 2.5°, under a pull of 10 gf/cm. Its free
sides shear less, and yarns that its pull has lengthened shear more: it reads G of a stiff woven within a hundredth, of felt or
a knit not so well.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .cutting import Cut, Kind, strip
from .fabric import Fabric
from .resting import Load, Specimen, settle
from .tensile import DIRECTIONS, GRAM_FORCE_PER_CENTIMETRE, STEP

SIDE = 0.1
"""m, of the frame."""
FRAME_DEGREES = (0.5, 2.5, 5.0, 8.0)
KES_LENGTH = 0.05
"""m between the clamps of KES-FB1."""
KES_WIDTH = 0.2
KES_DEGREES = (0.5, 2.5)
KES_PULL = 10.0 * GRAM_FORCE_PER_CENTIMETRE
"""N/m."""
KES_UNIT = float(np.radians(1.0)) / GRAM_FORCE_PER_CENTIMETRE
"""gf/(cm·degree) in a N/m."""
REACH = 1e-5
"""By how much (rad) the clamps are turned to and fro to feel their moment."""


@dataclass(frozen=True)
class Shear:
    """What both instruments read, clamped across one system of yarns."""

    direction: str
    degrees: tuple[float, ...]
    """Angles of the frame."""
    stresses: tuple[float, ...]
    """Shear stress (N/m) in the frame at them."""
    stiffness: float
    """G (N/m) of the frame at its smallest angle."""
    expected: float
    """G (N/m) of the fabric's own numbers."""
    kes: float
    """G (N/m) as KES-FB1 reads it."""

    @property
    def error(self) -> float:
        """By how much the frame's stiffness is off, as a part of that expected."""
        return self.stiffness / self.expected - 1.0


def turned(points: np.ndarray, angle: float, longer: float) -> np.ndarray:
    """Where points (m) are when all that ran along x has turned by an angle (rad) and is longer by a part."""
    along, across = points.T
    reach = along * (1.0 + longer)
    flat = np.zeros_like(along)
    return np.column_stack([reach * np.cos(angle), across + reach * np.sin(angle), flat])


def moment(specimen: Specimen, angle: float, longer: float = 0.0) -> float:
    """M (N·m) at an angle (rad) of the vertices that are held."""
    points, area = specimen.cut.points, specimen.cut.area()
    stiffness = specimen.fabric.number("shear")
    start = turned(points, angle, longer)
    # What is not held starts less turned than it will be.
    free = np.setdiff1d(np.arange(len(points)), specimen.held)
    start[free] = turned(points, 0.8 * angle, longer)[free]
    length = float(np.ptp(points[:, 0]))
    torque = stiffness * area * np.sin(angle)
    load = Load(torque / length, 0.5 * torque * angle, step=STEP, is_flat=True)
    resting = settle(specimen, start, load)
    motion = np.zeros_like(start)
    ahead, behind = (turned(points, angle + side, longer) for side in (REACH, -REACH))
    motion[specimen.held] = ((ahead - behind) / (2.0 * REACH))[specimen.held]
    return resting.slope(motion, REACH)


def measure(fabric: Fabric, direction: str, cells: int = 20, kind: Kind = "grid") -> Shear:
    """Shear a fabric.

    Args:
        fabric: What is measured.
        direction: "warp" or "weft": the yarns that turn.
        cells: Cells along a side of the frame, and half of those along KES-FB1's clamps.
        kind: Of the mesh.
    """
    pressed, warp = fabric.pressed(), DIRECTIONS[direction]
    square = strip(SIDE, SIDE, (cells, cells), kind)
    frame = Specimen(pressed, square, sides(square, SIDE), warp)
    stresses = [
        moment(frame, angle) / (square.area() * np.cos(angle))
        for angle in np.radians(FRAME_DEGREES)
    ]
    wide = strip(KES_LENGTH, KES_WIDTH, (max(4, cells // 2), 2 * cells), kind)
    x = wide.points[:, 0]
    clamps = np.flatnonzero((x < 1e-9) | (x > KES_LENGTH - 1e-9))
    sample = Specimen(pressed, wide, clamps, warp)
    longer = KES_PULL / fabric.number(f"stretch_{direction}")
    low, high = (moment(sample, angle, longer) for angle in np.radians(KES_DEGREES))
    kes = (high - low) / (wide.area() * np.ptp(np.radians(KES_DEGREES)))
    stiffness = stresses[0] / np.sin(np.radians(FRAME_DEGREES[0]))
    expected = fabric.number("shear")
    return Shear(direction, FRAME_DEGREES, tuple(stresses), stiffness, expected, float(kes))


def sides(cut: Cut, side: float) -> np.ndarray:
    """The vertices on all four sides of a square."""
    along, across = cut.points.T
    at_ends = (along < 1e-9) | (along > side - 1e-9)
    return np.flatnonzero(at_ends | (np.abs(across) > 0.5 * side - 1e-9))
