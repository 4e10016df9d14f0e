"""Cloths that the rows look at, moved by the compiled module.

A scene gives a flat sheet an unevenness of a millionth of an edge at its first step, so that it buckles. Closed forms know
nothing of that: a specimen is held for its first frame, when pinned vertices stay even, and let go afterwards.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import boucle_core
import numpy as np

G = 9.81
"""Standard gravity of the rows (m/s²)."""
FOREVER = 1_000_000
"""A last frame that no row reaches."""

STILL = {"stretch": 0.0, "shear": 0.0, "bend": 0.0, "damping": 0.0, "limiter": "none"}
"""Springs that do nothing, to be overridden one by one."""


@dataclass(frozen=True)
class Shape:
    """A mesh at rest."""

    positions: np.ndarray
    """Vertices (m), (n, 3)."""
    faces: np.ndarray
    """Corners, (f, 3) or (f, 4)."""

    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The mesh as the module takes it."""
        count, corners = self.faces.shape
        starts = np.arange(0, count * corners, corners, dtype=np.int32)
        positions = np.ascontiguousarray(self.positions, np.float64)
        return positions, starts, np.ascontiguousarray(self.faces, np.int32).reshape(-1)


def grid(columns: Sequence[float], rows: Sequence[float]) -> Shape:
    """Quads in the plane z = 0, with columns at these x and rows at these y (m); vertex row * columns + column."""
    x, y = np.meshgrid(columns, rows)
    positions = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    number = np.arange(x.size).reshape(x.shape)
    corners = [number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]]
    return Shape(positions, np.stack(corners, axis=-1).reshape(-1, 4))


def even_grid(columns: int, rows: int, spacing: float) -> Shape:
    """A grid of so many vertices, all one spacing (m) apart."""
    return grid(spacing * np.arange(columns), spacing * np.arange(rows))


def ladder(lengths: Sequence[float], width: float) -> Shape:
    """Two chains side by side that hang from z = 0, with links of these lengths (m) and rungs of one width (m) along y.

    Moved in the plane of x and z both chains move alike, and rungs stay as long as they are: each is one chain.
    """
    heights = -np.concatenate([[0.0], np.cumsum(lengths)])
    flat = grid([0.0, width], heights)
    return Shape(flat.positions[:, [2, 0, 1]], flat.faces)


@dataclass(frozen=True)
class Setting:
    """What a specimen is moved by."""

    integrator: str = "symplectic_euler"
    step: float | None = None
    """Each frame is one step of so many seconds, whether stable or not; if None, `fps` and `solver` say."""
    fps: float = 24.0
    gravity: Sequence[float] = (0.0, 0.0, 0.0)
    solver: Mapping[str, Any] = field(default_factory=dict)
    """More keys of the scene's `[solver]`."""
    forces: Sequence[Mapping[str, Any]] = ()
    collision: Mapping[str, Any] = field(default_factory=lambda: {"enabled": False})
    colliders: Sequence[Mapping[str, Any]] = ()

    def scene(self, cloth: Mapping[str, Any]) -> str:
        """The scene of one cloth as the module reads it."""
        fps, solver = self.fps, {"integrator": self.integrator, **self.solver}
        if self.step is not None:
            fps = 1.0 / self.step
            solver |= {"substeps": 1, "allow_unstable": True}
        head = {"frames": [1, FOREVER], "fps": fps, "gravity": list(self.gravity)}
        tables = {"force": list(self.forces), "collider": list(self.colliders)}
        keys = {"scene": head, "cloth": [cloth], "solver": solver, "collision": self.collision}
        return json.dumps(keys | {key: value for key, value in tables.items() if value})


class Specimen:
    """A cloth in motion."""

    def __init__(
        self,
        shape: Shape,
        cloth: Mapping[str, Any],
        setting: Setting,
        pins: Iterable[int] = (),
        start: np.ndarray | None = None,
        velocities: np.ndarray | None = None,
    ) -> None:
        """Let a cloth go.

        Args:
            shape: The mesh at rest.
            cloth: Keys of the scene's `[[cloth]]`, without name and pins.
            setting: What moves it.
            pins: Vertices that stay held.
            start: Positions (m) in which it is let go at rest; those at rest if None.
            velocities: With which it is let go (m/s), (n, 3), if not at rest; it has then moved for a frame.
        """
        self.rest = np.ascontiguousarray(shape.positions, np.float64)
        count = len(self.rest)
        keys = {"name": "specimen", **cloth, "pins": {"vertices": list(range(count))}}
        self.simulation = boucle_core.Simulation(setting.scene(keys), [shape.arrays()], threads=1)
        self.frame_duration = setting.step or 1.0 / setting.fps
        if velocities is not None:
            self.aim(self.rest + self.frame_duration * velocities)
        self.advance()
        self.pins = list(pins)
        self.simulation.release_pins(0, sorted(set(range(count)) - set(self.pins)))
        if start is not None:
            self.simulation.set_positions(0, np.ascontiguousarray(start))
            self.aim(start)

    def aim(self, targets: np.ndarray) -> None:
        """Say where pins are to be at the end of the next frame: positions (m) of all vertices."""
        self.simulation.set_pin_targets(0, np.ascontiguousarray(targets))

    def advance(self, frames: int = 1) -> dict[str, Any]:
        """Move on by some frames and return the last certificate."""
        certificate: dict[str, Any] = {}
        for _ in range(frames):
            certificate = self.simulation.advance()
        return certificate

    def positions(self) -> np.ndarray:
        """Positions (m), (n, 3)."""
        out = np.empty_like(self.rest)
        self.simulation.read_positions(0, out)
        return out

    def velocities(self) -> np.ndarray:
        """Velocities (m/s), (n, 3)."""
        out = np.empty_like(self.rest)
        self.simulation.read_velocities(0, out)
        return out

    def energy(self) -> float:
        """Kinetic and potential energy together (J)."""
        certificate = self.simulation.certificate()
        return certificate["kinetic_energy"] + certificate["potential_energy"]

    def springs(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Both ends of each spring, (s, 2), its rest length (m) and its stiffness (N/m)."""
        ends, _, lengths, stiffness, _ = self.simulation.read_springs(0)
        pairs = np.frombuffer(ends, np.int32).reshape(-1, 2)
        return pairs, np.frombuffer(lengths, np.float64), np.frombuffer(stiffness, np.float64)

    def tensions(self) -> np.ndarray:
        """With which force (N) each spring pulls."""
        ends, rest, stiffness = self.springs()
        x = self.positions()
        return stiffness * (np.linalg.norm(x[ends[:, 1]] - x[ends[:, 0]], axis=1) - rest)

    def mean_row(self, values: np.ndarray, columns: int = 2) -> np.ndarray:
        """Values of vertices, averaged over each row of so many."""
        return values.reshape(-1, columns, *values.shape[1:]).mean(axis=1)
