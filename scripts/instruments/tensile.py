"""The strip test: a strip clamped at both ends is pulled, step by step, along warp, weft and bias.

The force is that on the clamp (`Resting.slope`). Strain is read between two marks on the middle line, as a video extensometer
does, since a strip cut on the bias does not stretch evenly near its clamps; extensions at the loads of FAST-2 are read between
the clamps too, as FAST does. The strip stays in its plane, as if between two panes,
where no yarn can buckle either: compression is resisted as tension is.

A fabric whose yarns do not feel each other (no Poisson's ratio along them) and that shears with G has, on the bias,

    1/E = (1/Y_warp + 1/Y_weft)/4 + 1/(4 G)        nu = E (1/(4 G) - (1/Y_warp + 1/Y_weft)/4)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from .cantilever import DIRECTIONS
from .cutting import Kind, strip
from .fabric import Fabric
from .resting import Load, Resting, Specimen, settle

LENGTH = 0.2
"""m between the clamps."""
WIDTH = 0.05
MARKS = (0.35, 0.65)
"""Where the marks are, as parts of the length."""
SMALL = 1e-3
"""The strain at which stiffness is read."""
STEEPER = 2.0
"""Each strain is so many times the last."""
MOST_STRAIN = 1.0
GRAM_FORCE_PER_CENTIMETRE = 0.980665
"""N/m."""
FAST_LOADS = (5, 20, 100)
"""gf/cm, of FAST-2: E5, E20 and E100."""
STEP = 5e-3
"""s."""
REACH = 1e-6
"""By how much (m) the clamp is moved to and fro to feel its force."""
EXACT = 5e-3
"""How near to a load of FAST the strip is pulled, as a part of it."""
TRIES = 8


@dataclass(frozen=True)
class Pulled:
    """The strip at one strain."""

    clamps: float
    """Strain between the clamps."""
    marks: float
    """Strain between the marks."""
    narrowing: float
    """By how much it is narrower between the marks, as a part of its width."""
    tension: float
    """Force over width (N/m)."""


@dataclass(frozen=True)
class Tensile:
    """What the instrument reads in one direction."""

    direction: str
    pulls: tuple[Pulled, ...]
    """From the smallest on; the first is at SMALL."""
    stiffness: float
    """N/m at SMALL."""
    expected: float
    """N/m of the fabric's own numbers."""
    poisson: float
    """Narrowing over strain, between the marks at SMALL."""
    expected_poisson: float
    extensions: dict[int, float]
    """Strain between the clamps at the loads of FAST (gf/cm)."""

    @property
    def error(self) -> float:
        """By how much the stiffness is off, as a part of that expected."""
        return self.stiffness / self.expected - 1.0


def expected_stiffness(fabric: Fabric, direction: str) -> tuple[float, float]:
    """Stiffness (N/m) and Poisson's ratio of a long strip, by the closed forms above."""
    along = {side: fabric.number(f"stretch_{side}") for side in ("warp", "weft")}
    if direction != "bias":
        return along[direction], 0.0
    yarns = 0.25 * (1.0 / along["warp"] + 1.0 / along["weft"])
    shear = 0.25 / fabric.number("shear")
    return 1.0 / (yarns + shear), (shear - yarns) / (shear + yarns)


class Machine:
    """A strip between two clamps that move apart."""

    def __init__(self, fabric: Fabric, direction: str, cells: int, kind: Kind) -> None:
        rows = max(4, 2 * round(0.5 * cells * WIDTH / LENGTH))
        turn = 45.0 if direction == "bias" else 0.0
        cut = strip(LENGTH, WIDTH, (cells, rows), kind, turn=turn)
        x = cut.points[:, 0]
        self.left = np.flatnonzero(x < 1e-9)
        self.right = np.flatnonzero(x > LENGTH - 1e-9)
        held = np.concatenate([self.left, self.right])
        self.specimen = Specimen(fabric.pressed(), cut, held, DIRECTIONS[direction])
        self.stiffness, poisson = expected_stiffness(fabric, direction)
        flat = Pulled(0.0, 0.0, 0.0, 0.0)
        self.shapes = [(flat, poisson, self.specimen.rest)]
        """What was pulled so far: what it showed, how it narrows with strain, and positions (m)."""

    def pull(self, strain: float) -> Pulled:
        """Bring the clamps to a strain, and the strip to rest."""
        below = [shape for shape in self.shapes if shape[0].clamps <= strain]
        last, narrowing, positions = max(below, key=lambda shape: shape[0].clamps)
        start = positions.copy()
        start[:, 0] *= (1.0 + strain) / (1.0 + last.clamps)
        free = np.setdiff1d(np.arange(len(start)), self.specimen.held)
        start[free, 1] *= 1.0 - min(narrowing * (strain - last.clamps), 0.5)
        force = self.stiffness * strain * WIDTH
        load = Load(force, 0.5 * force * strain * LENGTH, step=STEP, is_flat=True)
        resting = settle(self.specimen, start, load)
        pulled = self.read(resting, strain)
        self.shapes.append((pulled, pulled.narrowing / strain, resting.positions))
        return pulled

    def read(self, resting: Resting, strain: float) -> Pulled:
        """What the strip at rest shows."""
        motion = np.zeros_like(resting.positions)
        motion[self.right, 0] = 1.0
        tension = resting.slope(motion, REACH) / WIDTH
        rest, now = self.specimen.cut.points, resting.positions
        moved = now[:, :2] - rest
        middle = (rest[:, 0] > MARKS[0] * LENGTH) & (rest[:, 0] < MARKS[1] * LENGTH)
        # The even strain that fits best between the marks.
        base = np.column_stack([rest[middle], np.ones(middle.sum())])
        slopes = np.linalg.lstsq(base, moved[middle], rcond=None)[0]
        return Pulled(strain, float(slopes[0, 0]), float(-slopes[1, 1]), tension)


def measure(fabric: Fabric, direction: str, cells: int = 40, kind: Kind = "grid") -> Tensile:
    """Pull a strip until all loads of FAST are passed.

    Args:
        fabric: What is measured.
        direction: "warp", "weft" or "bias": along which the strip is cut.
        cells: Cells along the strip.
        kind: Of the mesh.
    """
    machine = Machine(fabric, direction, cells, kind)
    pulls = [machine.pull(SMALL)]
    loads = {gram: gram * GRAM_FORCE_PER_CENTIMETRE for gram in FAST_LOADS}
    while pulls[-1].tension < max(loads.values()) and pulls[-1].clamps * STEEPER <= MOST_STRAIN:
        pulls.append(machine.pull(pulls[-1].clamps * STEEPER))
    for load in loads.values():
        for _ in range(TRIES):
            pulls.append(machine.pull(strain_at(pulls, load)))
            if abs(pulls[-1].tension / load - 1.0) < EXACT:
                break
    pulls.sort(key=lambda one: one.clamps)
    expected, expected_poisson = expected_stiffness(fabric, direction)
    first = next(one for one in pulls if one.clamps == SMALL)
    return Tensile(
        direction,
        tuple(pulls),
        stiffness=first.tension / first.marks,
        expected=expected,
        poisson=first.narrowing / first.marks,
        expected_poisson=expected_poisson,
        extensions={gram: strain_at(pulls, load) for gram, load in loads.items()},
    )


def strain_at(pulls: list[Pulled], load: float) -> float:
    """The strain between the clamps at a load (N/m): in proportion below what was read, on a smooth curve between.

    Raises:
        ValueError: The load lies beyond the curve.
    """
    read = sorted({one.tension: one.clamps for one in pulls}.items())
    tensions, strains = zip(*read, strict=True)
    if load > tensions[-1]:
        raise ValueError(
            f"a load of {load:g} N/m; accepted: up to {tensions[-1]:g}, at a strain of 1"
        )
    if load <= tensions[0]:
        return strains[0] * load / tensions[0]
    # Cloth on the bias stiffens by orders of magnitude.
    return float(PchipInterpolator(np.log(tensions), strains)(np.log(load)))
