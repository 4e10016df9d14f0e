"""Limiters against each other: what a hung sheet overshoots, what energy it gains, what that costs.

Besides the four that the module has, a biphasic spring (stiffer by a factor beyond the allowed length) is run here by numpy,
with the module's springs and symplectic Euler; with a factor of 1 it is the sheet without a limiter. Its cost is that of the
sheet without a limiter, a step, times its steps.

Source: Provot 1995; Zhong & Xu 2009 (position and velocity); biphasic springs after Choi & Ko 2002 and Bridson et al. 2003.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass

import boucle_core
import numpy as np
from matplotlib.figure import Figure

from paper.looks import LIMITER_COLORS, page

from .sheet import grid, scene_text

VERTICES, EDGE = 16, 1.0 / 15.0
MASS = 0.005
"""kg, each particle: so heavy that springs alone stretch by half beside the pins."""
STRETCH, SHEAR, BEND, DAMPING = 500.0, 100.0, 5.0, 0.02
RATE = 0.10
FPS = 24.0
GRAVITY = 9.81
FACTORS = (10.0, 100.0)
"""By which biphasic springs are stiffer beyond the allowed length."""
COLORS = {**LIMITER_COLORS, "biphasic 10": "#009E73", "biphasic 100": "#E69F00"}


@dataclass
class Hung:
    """A sheet hung with one limiter."""

    limiter: str
    integrator: str
    strain: np.ndarray  # largest elongation at each frame's end
    energy: np.ndarray  # J, kinetic and potential, above that at the start
    steps: float  # mean of the frames
    milliseconds: float  # a frame

    @property
    def overshoot(self) -> float:
        """Percentage points beyond the allowed elongation, the worst."""
        return 100.0 * (float(self.strain.max()) - RATE)

    @property
    def gain(self) -> float:
        """Energy above that at the start, the most, in % of m g size."""
        return 100.0 * float(self.energy.max()) / (VERTICES**2 * MASS * GRAVITY)


def simulation(limiter: str, integrator: str) -> boucle_core.Simulation:
    """The sheet, upright, held at its two top corners."""
    mesh = grid(VERTICES, EDGE)
    upright = mesh.positions[:, [0, 2, 1]].copy()
    springs = {"stretch": STRETCH, "shear": SHEAR, "bend": BEND, "damping": DAMPING}
    cloth = {
        "name": "sheet",
        "pins": {"vertices": [VERTICES * (VERTICES - 1), VERTICES**2 - 1]},
        "mass_per_vertex": MASS,
        "springs": {**springs, "limiter": limiter, "deformation_rate": RATE},
    }
    text = scene_text({"fps": FPS}, cloth, {"integrator": integrator})
    return boucle_core.Simulation(text, [(upright, *mesh.arrays()[1:])], 1)


def hang(limiter: str, integrator: str, frames: int) -> Hung:
    """Let it fall with a limiter of the module."""
    sheet = simulation(limiter, integrator)
    start = sheet.certificate()
    began = time.perf_counter()
    rows = [sheet.advance() for _ in range(frames)]
    seconds = time.perf_counter() - began
    energy = np.array([row["kinetic_energy"] + row["potential_energy"] for row in [start, *rows]])
    return Hung(
        limiter,
        integrator,
        np.array([row["max_strain"] for row in rows]),
        energy - energy[0],
        float(np.mean([row["substeps"] for row in rows])),
        1000.0 * seconds / frames,
    )


class Biphasic:
    """The same sheet with springs that are stiffer beyond the allowed length, by numpy."""

    def __init__(self, factor: float) -> None:
        sheet = simulation("none", "symplectic_euler")
        ends, kinds, lengths, stiffness, damping = sheet.read_springs(0)
        self.ends = np.frombuffer(ends, np.int32).reshape(-1, 2)
        self.lengths, self.stiffness, self.damping = (
            np.frombuffer(values, np.float64) for values in (lengths, stiffness, damping)
        )
        self.is_edge = np.frombuffer(kinds, np.uint8) == 0
        self.extra = np.where(self.is_edge, (factor - 1.0) * self.stiffness, 0.0)
        mesh = grid(VERTICES, EDGE)
        self.positions = mesh.positions[:, [0, 2, 1]].copy()
        self.velocities = np.zeros_like(self.positions)
        self.pins = [VERTICES * (VERTICES - 1), VERTICES**2 - 1]
        # No spring is stiffer than its second phase.
        self.substeps = math.ceil(sheet.substeps * math.sqrt(factor))

    def beyond(self) -> np.ndarray:
        """How far (m) each spring is beyond the allowed length."""
        along = self.positions[self.ends[:, 1]] - self.positions[self.ends[:, 0]]
        return np.maximum(np.linalg.norm(along, axis=1) - (1.0 + RATE) * self.lengths, 0.0)

    def step(self, h: float) -> None:
        """Take one step of symplectic Euler (s)."""
        first, second = self.ends.T
        along = self.positions[second] - self.positions[first]
        length = np.linalg.norm(along, axis=1)
        tension = self.stiffness * (length - self.lengths) + self.extra * self.beyond()
        force = (tension / length)[:, None] * along
        force += self.damping[:, None] * (self.velocities[second] - self.velocities[first])
        total = np.zeros_like(self.positions)
        np.add.at(total, first, force)
        np.add.at(total, second, -force)
        self.velocities += h * (total / MASS + [0.0, 0.0, -GRAVITY])
        self.velocities[self.pins] = 0.0
        self.positions += h * self.velocities

    def energy(self) -> float:
        """Kinetic and potential energy (J)."""
        along = self.positions[self.ends[:, 1]] - self.positions[self.ends[:, 0]]
        stretch = np.linalg.norm(along, axis=1) - self.lengths
        springs = 0.5 * self.stiffness @ stretch**2 + 0.5 * self.extra @ self.beyond() ** 2
        height = MASS * GRAVITY * self.positions[:, 2].sum()
        return float(0.5 * MASS * (self.velocities**2).sum() + springs + height)

    def strain(self) -> float:
        """Largest elongation of the edges."""
        along = self.positions[self.ends[:, 1]] - self.positions[self.ends[:, 0]]
        ratios = np.linalg.norm(along, axis=1) / self.lengths
        return float(ratios[self.is_edge].max()) - 1.0


def hang_biphasic(factor: float, frames: int, plain: Hung) -> Hung:
    """Let it fall with biphasic springs."""
    sheet = Biphasic(factor)
    h = 1.0 / FPS / sheet.substeps
    energy, strain = [sheet.energy()], []
    for _ in range(frames):
        for _ in range(sheet.substeps):
            sheet.step(h)
        energy.append(sheet.energy())
        strain.append(sheet.strain())
    cost = plain.milliseconds / plain.steps * sheet.substeps
    above = np.array(energy) - energy[0]
    name = f"biphasic {factor:g}"
    return Hung(name, "symplectic_euler", np.array(strain), above, sheet.substeps, cost)


def measure(frames: int = 48) -> list[Hung]:
    """Every limiter, with the classic integrator and with the default one."""
    words = ("none", "stiffen", "provot", "project")
    found = [hang(word, "symplectic_euler", frames) for word in words]
    found += [hang_biphasic(factor, frames, found[0]) for factor in FACTORS]
    return found + [hang(word, "bdf2", frames) for word in words]


def draw(found: Sequence[Hung]) -> Figure:
    """Strain and energy over time, with the classic integrator."""
    figure = page(4.2)
    left, right = figure.subplots(1, 2)
    for each in found:
        if each.integrator != "symplectic_euler":
            continue
        times = np.arange(1, len(each.strain) + 1) / FPS
        look = {"color": COLORS[each.limiter], "lw": 1.3}
        label = f"{each.limiter}: {each.milliseconds:.2g} ms a frame"
        left.plot(times, 100.0 * each.strain, label=label, **look)
        scale = VERTICES**2 * MASS * GRAVITY
        right.plot([0.0, *times], 100.0 * each.energy / scale, label=each.limiter, **look)
    left.axhline(100.0 * RATE, color="#222222", lw=0.8, ls=":")
    left.set(xlabel="time (s)", ylabel="largest elongation (%)", ylim=(0.0, 42.0))
    left.set_title("a sheet hung by two corners, 10 % allowed")
    right.set(xlabel="time (s)", ylabel="energy above the start (% of m g size)")
    right.set_title("energy: only damping and limiters change it")
    left.legend(fontsize=7.5, ncols=2)
    return figure


def table(found: Sequence[Hung]) -> str:
    """Overshoot, energy and cost as a Markdown table."""
    lines = [
        "| limiter | integrator | overshoot (points) | energy gained (%) | energy at end (%) | steps a frame | ms a frame |",
        "|---|---|---|---|---|---|---|",
    ]
    scale = VERTICES**2 * MASS * GRAVITY
    for each in found:
        end = 100.0 * float(each.energy[-1]) / scale
        cells = [f"{each.overshoot:.2f}", f"{each.gain:.2f}", f"{end:.1f}"]
        cells += [f"{each.steps:.3g}", f"{each.milliseconds:.2g}"]
        lines.append(f"| {each.limiter} | {each.integrator} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def numbers(found: Sequence[Hung]) -> list[dict[str, object]]:
    """The runs as rows for a file."""
    rows = []
    for each in found:
        row = dict(vars(each), overshoot_points=each.overshoot, energy_gain_percent=each.gain)
        rows.append(row | {"strain": each.strain.tolist(), "energy": each.energy.tolist()})
    return rows
