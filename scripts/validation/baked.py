"""What a bake of a scene file left, looked at by ipctk and numpy, which know nothing of the solver.

They see the baked file: positions as they are stored, colliders placed by reading the scene anew.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import boucle_core
import ipctk
import numpy as np

from .obstacles import Obstacle, read_obj, read_pc2, read_sides

SCENES = Path(__file__).resolve().parents[2] / "tests" / "scenes"


@dataclass
class Baked:
    """A scene and what its bake left."""

    name: str
    out: Path
    rows: list[dict[str, Any]]
    frames: np.ndarray
    """Positions (m) of all cloths, one after the other: frame, vertex, axis."""
    triangles: np.ndarray
    edges: np.ndarray
    rates: np.ndarray
    """Deformation rate of each edge."""
    obstacles: list[Obstacle]

    @property
    def numbers(self) -> list[int]:
        """The numbers of its frames."""
        return [row["frame"] for row in self.rows]

    @property
    def strains(self) -> np.ndarray:
        """The largest strain in each frame beyond that which the rate of its edge allows."""
        ends = self.frames[:, self.edges].astype(float)
        lengths = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=-1)
        return (lengths / lengths[0] - 1.0 - self.rates).max(1)

    def counted(self) -> dict[int, int]:
        """The intersections that the bake counted, by frame, where there are any."""
        return {
            row["frame"]: row["intersections"] for row in self.rows if row["intersections"] != 0
        }

    def crossed(self) -> list[int]:
        """The frames in which ipctk finds an intersection among cloths and meshes."""
        solid = [obstacle for obstacle in self.obstacles if obstacle.triangles is not None]
        groups = [[each] for each in solid] or [[]]  # colliders may pass through each other
        found = []
        for group in groups:
            rest = np.concatenate([self.frames[0], *(each.points for each in group)])
            triangles = [self.triangles, *(each.triangles + len(self.frames[0]) for each in group)]
            triangles = np.concatenate(triangles)
            mesh = ipctk.CollisionMesh(rest.astype(float), ipctk.edges(triangles), triangles)
            for number, frame in zip(self.numbers, self.frames, strict=True):
                places = np.concatenate([frame, *(each.at(number) for each in group)])
                if ipctk.has_intersections(mesh, places.astype(float)):
                    found.append(number)
        return sorted(set(found))

    def sunk(self) -> list[int]:
        """The frames in which cloth lies in a plane, sphere or capsule, deeper than stored numbers are fine."""
        found = []
        for number, frame in zip(self.numbers, self.frames, strict=True):
            corners = frame.astype(float)[self.triangles]
            finest = float(np.spacing(np.abs(frame).max()))
            smooth = [obstacle for obstacle in self.obstacles if obstacle.triangles is None]
            if any(obstacle.depth(corners, number) > finest for obstacle in smooth):
                found.append(number)
        return found


def bake(name: str, out: Path, threads: int, overrides: Sequence[str] = ()) -> Mapping[str, Any]:
    """Bake a scene into a folder."""
    scene = str(SCENES / f"{name}.toml")
    return boucle_core.bake(scene, str(out), threads=threads, overrides=overrides)


def read(
    name: str, out: Path, report: Mapping[str, Any], scene: Mapping[str, Any] | None = None
) -> Baked:
    """What a bake has left; of the scene as it is written, if nothing else is given."""
    if scene is None:
        scene = tomllib.loads((SCENES / f"{name}.toml").read_text(encoding="utf-8"))
    frames, triangles, edges, rates, base = [], [], [], [], 0
    for cloth in scene["cloth"]:
        mesh = out / f"{cloth['name']}.obj"
        sides = read_sides(mesh)
        edges.append(base + sides)
        triangles.append(base + read_obj(mesh)[1])
        rates.append(np.full(len(sides), cloth.get("springs", {}).get("deformation_rate", 0.1)))
        frames.append(read_pc2(mesh.with_suffix(".pc2"))[2])
        base += frames[-1].shape[1]
    obstacles = [Obstacle.of(keys, SCENES) for keys in scene.get("collider", [])]
    joined = [np.concatenate(parts) for parts in (triangles, edges, rates)]
    return Baked(name, out, report["frames"], np.concatenate(frames, axis=1), *joined, obstacles)
