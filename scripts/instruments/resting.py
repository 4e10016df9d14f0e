"""Specimens at rest: what is held, what pulls, and how the solver is brought to the shape in which nothing moves.

The solver has no statics of its own, so that a specimen moves through thick air until what is left of its speed is a force
too small to matter. Energy can only fall on the way: where a step has raised it, the step was too long for the solver, and
it goes on from the last good shape with one half as long.
"""

from __future__ import annotations

import contextlib
import json
import math
from dataclasses import dataclass, replace

import boucle_core
import numpy as np

from .cutting import Cut
from .fabric import Fabric

SUBSTEPS = 8
"""Steps between two looks at the energy."""
SLACK = 1e-4
"""How much energy may rise between two looks, as a part of what there is and of `Load.energy`."""
HALVINGS = 6
STALL = 1500
"""Steps without any gain, before shorter ones are tried."""
LAST_FRAME = 1_000_000
"""A last frame that no specimen reaches."""


class Restless(RuntimeError):
    """A specimen did not come to rest."""


@dataclass(frozen=True)
class Load:
    """What a specimen is under, and how finely it matters."""

    force: float
    """A force (N) that is large in this test: its weight, or the pull of the clamp."""
    energy: float
    """An energy (J) that is large in this test."""
    gravity: float = 0.0
    """m/s², downward."""
    air: float = 30.0
    """Damping of every particle as a part of its mass (1/s)."""
    step: float = 1e-3
    """The time step (s) to begin with."""
    left: float = 2e-4
    """The unbalanced force at which it rests, as a part of `force`."""
    is_flat: bool = False
    """Whether it stays in its plane, as if between two panes."""


@dataclass(frozen=True)
class Specimen:
    """A cut of a fabric with some vertices held."""

    fabric: Fabric
    cut: Cut
    held: np.ndarray
    """Numbers of the vertices in clamps."""
    warp: tuple[float, float] = (0.0, 1.0)
    """Which way the warp runs in the plane of the cut."""

    @property
    def rest(self) -> np.ndarray:
        """(n, 3) (m), in the plane z = 0."""
        return np.column_stack([self.cut.points, np.zeros(len(self.cut.points))])

    @property
    def mass(self) -> float:
        """kg."""
        return self.fabric.number("density") * self.cut.area()

    def simulation(self, positions: np.ndarray, load: Load) -> boucle_core.Simulation:
        """The solver with this specimen at rest at `positions` (m), its clamps where they are there."""
        corners = np.ascontiguousarray(self.cut.faces, dtype=np.int32)
        starts = np.arange(0, corners.size, corners.shape[1], dtype=np.int32)
        mesh = (positions, starts, corners.reshape(-1))
        air = load.air * self.mass / len(self.cut.points)
        cloth = {
            "name": "specimen",
            "model": "fabric",
            "density": self.fabric.number("density"),
            "pins": {"vertices": self.held.tolist()},
            "fabric": {**self.fabric.keys(), "warp": [*self.warp, 0.0], "air_damping": air},
        }
        gravity = [0.0, 0.0, -load.gravity]
        scene = {
            "scene": {
                "frames": [1, LAST_FRAME],
                "fps": 1.0 / (SUBSTEPS * load.step),
                "gravity": gravity,
            },
            "cloth": [cloth],
            "collision": {"enabled": False},
            "solver": {"substeps": SUBSTEPS},
        }
        made = boucle_core.Simulation(json.dumps(scene), [mesh], 1, (), [self.rest])
        if load.is_flat:
            # In its first frame the solver makes every cloth a little uneven, so that it can buckle.
            with contextlib.suppress(boucle_core.DivergedError):
                made.advance()
        made.set_positions(0, positions)
        return made


@dataclass(frozen=True)
class Resting:
    """A specimen that has come to rest."""

    specimen: Specimen
    load: Load
    positions: np.ndarray
    """(n, 3) (m)."""
    energy: float
    """Elastic and of height (J)."""
    unbalanced: float
    """The force that still moves it, as a part of the load's."""
    speed: float
    """Root mean square (m/s)."""
    steps: int

    def slope(self, motion: np.ndarray, reach: float) -> float:
        """How the stored energy (J) grows as vertices follow a motion (n, 3) and all others stay: that is the force, or moment.

        For a clamp that moves by a metre it is the sum of the forces (N) on its vertices, exactly, also where the rest is not
        quite at rest. Central differences over `reach` of the motion.
        """
        probe = self.specimen.simulation(self.positions, self.load)
        energies = []
        for side in (reach, -reach):
            probe.set_positions(0, self.positions + side * motion)
            energies.append(float(probe.certificate()["potential_energy"]))
        return (energies[0] - energies[1]) / (2.0 * reach)


def fall(specimen: Specimen, start: np.ndarray, load: Load, seconds: float) -> np.ndarray:
    """Where a specimen (m) is that has moved from `start` (m) for some time.

    Raises:
        Restless: Its energy rises however short the steps.
    """
    for _ in range(HALVINGS + 1):
        running = specimen.simulation(start, load)
        energy, left = float(running.certificate()["potential_energy"]), seconds
        while left > 0.0:
            now, _speed = advanced(running, specimen.mass)
            if not is_allowed(now, energy, load):
                break
            energy, left = now, left - SUBSTEPS * load.step
        else:
            positions = np.empty_like(start)
            running.read_positions(0, positions)
            return positions
        load = replace(load, step=0.5 * load.step)
    raise Restless(f"{specimen.fabric.preset} gains energy as it falls, however short the steps")


def settle(specimen: Specimen, start: np.ndarray, load: Load) -> Resting:
    """Let a specimen move from `start` (m) until it rests.

    Raises:
        Restless: Its energy rises, or it never comes to rest, however short the steps.
    """
    kept = np.array(start, dtype=np.float64)
    steps = 0
    for _ in range(HALVINGS + 1):
        running = specimen.simulation(kept, load)
        energy, speed = float(running.certificate()["potential_energy"]), 0.0
        mark, since = energy, 0
        while since < STALL:
            steps += SUBSTEPS
            now, next_speed = advanced(running, specimen.mass)
            if not is_allowed(now, energy, load):
                break
            running.read_positions(0, kept)
            gain = abs(next_speed - speed) / (SUBSTEPS * load.step)
            energy, speed = now, next_speed
            unbalanced = specimen.mass * (load.air * speed + gain) / load.force
            if unbalanced < load.left:
                return Resting(specimen, load, kept, now, unbalanced, speed, steps)
            is_better = now < mark - SLACK * load.energy
            mark, since = (now, 0) if is_better else (mark, since + SUBSTEPS)
        load = replace(load, step=0.5 * load.step)
    raise Restless(f"{specimen.fabric.preset} does not come to rest in {steps} steps")


def is_allowed(now: float, before: float, load: Load) -> bool:
    """Whether an energy (J) may follow another: it has not risen, nor become no number."""
    return now <= before + SLACK * (load.energy + abs(before))


def advanced(running: boucle_core.Simulation, mass: float) -> tuple[float, float]:
    """Go on by a frame: the whole energy (J) then, infinite if it has burst, and the speed (m/s)."""
    try:
        told = running.advance()
    except boucle_core.DivergedError:
        return math.inf, math.inf
    kinetic = float(told["kinetic_energy"])
    return float(told["potential_energy"]) + kinetic, math.sqrt(2.0 * kinetic / mass)
