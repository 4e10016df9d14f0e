"""Small sheets to explore with: the scene of one run, and the springs that the module makes of a mesh."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import boucle_core
import numpy as np

SIDE = 6
"""Vertices along each side of the sheets that are run by the thousand."""
EDGE = 0.1
"""Their mesh edges (m)."""
JITTER = 1e-5
"""How far, in edges, the rest shape is off the shape that runs start from: so every oscillation of the sheet is there at once,
and so small that it stays linear."""
FRAMES = 4
"""Frames that a run is cut into."""
JITTERED = "jittered.obj"


@dataclass(frozen=True)
class Lattice:
    """Stiffness of shear and bend springs, and of stretch springs, as multiples of the same number."""

    stretch: float = 1.0
    shear: float = 0.2
    bend: float = 0.01

    @property
    def words(self) -> str:
        """The three multiples."""
        return f"{self.stretch:g} : {self.shear:g} : {self.bend:g}"


PAPER = Lattice()
"""The ratios of the classic curtain: 500, 100 and 5 N/m."""


@dataclass(frozen=True)
class Point:
    """A point of the space that is explored."""

    integrator: str
    mass: float  # kg, each particle
    stiffness: float  # N/m, of stretch springs
    lattice: Lattice = PAPER
    damping_time: float = 0.0  # s: kd/k of every spring, along it

    def springs(self) -> dict[str, object]:
        """Keys of `[cloth.springs]`."""
        kinds = {kind: getattr(self.lattice, kind) for kind in ("stretch", "shear", "bend")}
        stiffness = {kind: self.stiffness * part for kind, part in kinds.items()}
        damping = {f"damping_{kind}": self.damping_time * k for kind, k in stiffness.items()}
        return {**stiffness, **damping, "damping_law": "axial", "limiter": "none"}

    def scene(self, step: float, steps: int) -> str:
        """A free sheet without gravity, for so many steps of this length (s) or a few more."""
        each = -(-steps // FRAMES)
        cloth = {
            "name": "sheet",
            "grid": {"size": [EDGE * (SIDE - 1)] * 2, "vertices": [SIDE, SIDE], "plane": "xy"},
            "rest": JITTERED,
            "mass_per_vertex": self.mass,
            "springs": self.springs(),
        }
        solver = {"integrator": self.integrator, "substeps": each, "allow_unstable": True}
        timing = {"frames": [1, 1 + FRAMES], "fps": 1.0 / (each * step), "gravity": [0.0, 0.0, 0.0]}
        return scene_text(timing, cloth, solver)


def scene_text(
    timing: Mapping[str, object], cloth: Mapping[str, object], solver: Mapping[str, object]
) -> str:
    """A scene of one cloth that touches nothing, as the module reads it."""
    touching = {"enabled": False}
    return json.dumps({"scene": timing, "cloth": [cloth], "solver": solver, "collision": touching})


@dataclass(frozen=True)
class Mesh:
    """Vertices and faces."""

    positions: np.ndarray  # (n, 3) m
    faces: np.ndarray  # (f, corners)

    def write(self, path: Path) -> None:
        """Write an OBJ file."""
        lines = ["v " + " ".join(map(repr, row)) for row in self.positions.tolist()]
        lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in self.faces]
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")

    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What the module takes."""
        starts = np.arange(0, self.faces.size, self.faces.shape[1], dtype=np.int32)
        return self.positions, starts, self.faces.astype(np.int32).reshape(-1)


def grid(side: int = SIDE, edge: float = EDGE) -> Mesh:
    """A square grid of quads in the plane z = 0, in the vertex order of the scene file's `grid`."""
    axis = edge * (np.arange(side) - 0.5 * (side - 1))
    x, y = np.meshgrid(axis, axis)
    positions = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    number = np.arange(side * side).reshape(side, side)
    corners = [number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]]
    return Mesh(positions, np.stack(corners, axis=-1).reshape(-1, 4))


def jittered(mesh: Mesh, part: float, seed: int = 1) -> Mesh:
    """The same with every vertex moved within the plane by up to a part of the edge."""
    moves = np.random.default_rng(seed).uniform(-part, part, (len(mesh.positions), 2)) * EDGE
    return Mesh(mesh.positions + np.pad(moves, ((0, 0), (0, 1))), mesh.faces)


def springs_of(mesh: Mesh, lattice: Lattice) -> tuple[np.ndarray, np.ndarray]:
    """The springs that the module makes of a mesh.

    Returns:
        Ends, int (s, 2), and stiffness as multiples, (s,).
    """
    springs = {"stretch": lattice.stretch, "shear": lattice.shear, "bend": lattice.bend}
    cloth = {"name": "sheet", "mass_per_vertex": 1.0, "springs": springs}
    text = scene_text({}, cloth, {})
    simulation = boucle_core.Simulation(text, [mesh.arrays()], 1)
    ends, _, _, stiffness, _ = simulation.read_springs(0)
    return np.frombuffer(ends, np.int32).reshape(-1, 2), np.frombuffer(stiffness, np.float64)
