"""Figure 9, ours: the energy of a sheet that swings freely, under three integrators with the same springs."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass

import boucle_core
import numpy as np

from .looks import Plate, page
from .sheet import Recipe, Sheet

SECONDS = 2.0
TILT = 60.0
"""Degrees between the sheet and the vertical as it is let go."""
COLORS = {"symplectic_euler": "#7a7a7a", "bdf2": "#0072B2", "implicit_euler": "#D55E00"}
WORDS = {
    "symplectic_euler": "symplectic Euler",
    "bdf2": "BDF2 (default)",
    "implicit_euler": "implicit Euler",
}
DENSITY = 0.2
"""kg/m²."""
GRAVITY = 9.81


@dataclass
class Swing:
    """A sheet's swing under one integrator, as seen at every frame."""

    times: np.ndarray  # s
    energy: np.ndarray  # part of that at the start; 0 where it would hang straight
    angle: (
        np.ndarray
    )  # degrees between the vertical and the line from the edge held to the lower edge
    substeps: float  # steps a frame, mean
    worst_strain: float


def follow(integrator: str, vertices: int) -> Swing:
    """Let a sheet go that hangs by its whole upper edge, lifted to one side."""
    mass = DENSITY * 4.0 / vertices**2
    recipe = Recipe(vertices=vertices, mass=mass, stretch=1000.0, damping=0.0, fps=24)
    sheet = EdgeSheet(recipe, integrator)
    frames = round(SECONDS * recipe.fps)
    rows = [sheet.simulation.certificate()]
    angles = [sheet.angle()]
    for _ in range(frames):
        rows.append(sheet.simulation.advance())
        angles.append(sheet.angle())
    total = np.array([row["kinetic_energy"] + row["potential_energy"] for row in rows])
    swing = DENSITY * recipe.size**2 * GRAVITY * 0.5 * recipe.size
    swing *= 1.0 - math.cos(math.radians(TILT))
    return Swing(
        times=np.arange(frames + 1) / recipe.fps,
        energy=1.0 + (total - total[0]) / swing,
        angle=np.array(angles),
        substeps=float(np.mean([row["substeps"] for row in rows[1:]])),
        worst_strain=max(float(row["max_strain"]) for row in rows),
    )


class EdgeSheet(Sheet):
    """A sheet held at its whole upper edge, under any integrator."""

    def __init__(self, recipe: Recipe, integrator: str) -> None:
        super().__init__(recipe)
        n = recipe.vertices
        self.pins = list(range(n * (n - 1), n * n))
        scene = json.loads(recipe.scene(self.pins))
        scene["solver"] = {"integrator": integrator}
        starts = np.arange(0, self.faces.size, 4, dtype=np.int32)
        mesh = (self.rest, starts, self.faces.reshape(-1))
        self.simulation = boucle_core.Simulation(json.dumps(scene), [mesh])
        self.simulation.set_positions(0, self.tilted(math.radians(TILT)))

    def angle(self) -> float:
        """Degrees between the vertical and the line from the middle of the upper edge to that of the lower."""
        rows = self.positions().reshape(self.recipe.vertices, -1, 3)
        across = rows[0].mean(axis=0) - rows[-1].mean(axis=0)
        return math.degrees(math.atan2(across[1], -across[2]))


def make(quick: bool) -> Plate:
    """Energy on the left, the swing itself on the right."""
    vertices = 24 if quick else 64
    swings = {name: follow(name, vertices) for name in WORDS}
    drawing = page(3.9)
    energy, angle = drawing.subplots(1, 2, sharex=True)
    for name, swing in swings.items():
        label = f"{WORDS[name]}, {swing.substeps:.0f} steps a frame"
        look = {"color": COLORS[name], "lw": 4.5 if name == "symplectic_euler" else 2.0}
        look["alpha"] = 0.55 if name == "symplectic_euler" else 1.0
        energy.plot(swing.times, 100.0 * swing.energy, label=label, **look)
        angle.plot(swing.times, swing.angle, label=label, **look)
    energy.set_ylabel("energy (% of the swing's)")
    energy.set_xlabel("time (s)")
    every = 100.0 * np.concatenate([swing.energy for swing in swings.values()])
    energy.set_ylim(every.min() - 8.0, every.max() + 2.0)
    energy.legend(loc="lower left", fontsize=9)
    angle.set_ylabel("angle to the vertical (°)")
    angle.set_xlabel("time (s)")
    angle.axhline(0.0, color="#b5b5b5", lw=0.9, zorder=0.5)
    for axes in (energy, angle):
        axes.set_xlim(0.0, SECONDS)
    left = {name: 100.0 * float(swing.energy[-1]) for name, swing in swings.items()}
    swung = {name: float(swing.angle.max()) for name, swing in swings.items()}
    worst = 100.0 * max(swing.worst_strain for swing in swings.values())
    caption = (
        f"A sheet of {vertices} × {vertices} particles, 2 m × 2 m, {DENSITY:g} kg/m², stretch k 1000 N/m, without damping or "
        f"limiter, hung by its whole upper edge and let go at {TILT:.0f}° from the vertical; no edge is strained by more than "
        f"{worst:.1f} %. Left of the energy after {SECONDS:g} s: symplectic Euler {left['symplectic_euler']:.1f} %, BDF2 "
        f"{left['bdf2']:.1f} %, implicit Euler {left['implicit_euler']:.1f} %. Farthest on the other side: "
        f"{swung['symplectic_euler']:.1f}°, {swung['bdf2']:.1f}°, {swung['implicit_euler']:.1f}°. Steps as the "
        "automatic choice makes them."
    )
    numbers: dict[str, object] = {
        name: {
            "energy_left_percent": left[name],
            "swing_degrees": swung[name],
            "substeps": swing.substeps,
            "worst_strain_percent": 100.0 * swing.worst_strain,
        }
        for name, swing in swings.items()
    }
    return Plate(9, "energy", "energy of a free swing (ours)", caption, drawing, numbers)
