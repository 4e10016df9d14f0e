"""The colliders of a scene file, read and placed apart from the module's own reading."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from .nearness import edge_triangle, point_triangle

HEAD = 32
"""Bytes at the head of a PC2."""

Samples = tuple[float, float, np.ndarray]
"""First frame, frames from sample to sample, and positions (m): sample, vertex, axis."""


def read_pc2(path: Path) -> Samples:
    """A point cache as it is stored."""
    data = Path(path).read_bytes()
    points, samples = np.frombuffer(data, "<i4", 1, 16)[0], np.frombuffer(data, "<i4", 1, 28)[0]
    first, rate = np.frombuffer(data, "<f4", 2, 20)
    return first, rate, np.frombuffer(data, "<f4", offset=HEAD).reshape(samples, points, 3)


def read_obj(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (m) and triangles, each face a fan around its first corner."""
    vertices, triangles = [], []
    for line in Path(path).read_text(encoding="utf-8").splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            vertices.append([float(number) for number in rest[:3]])
        elif word == "f":
            corners = [int(corner.partition("/")[0]) - 1 for corner in rest]
            triangles += [[corners[0], *pair] for pair in pairwise(corners[1:])]
    return np.array(vertices), np.array(triangles)


def read_sides(path: Path) -> np.ndarray:
    """The edges of the faces of an OBJ, once each."""
    sides = set()
    for line in Path(path).read_text(encoding="utf-8").splitlines():
        if line.startswith("f "):
            corners = [int(corner.partition("/")[0]) - 1 for corner in line.split()[1:]]
            pairs = zip(corners, corners[1:] + corners[:1], strict=True)
            sides |= {(min(pair), max(pair)) for pair in pairs}
    return np.array(sorted(sides))


def turned(points: np.ndarray, rotation_deg: Sequence[float]) -> np.ndarray:
    """Points turned about the x, then the y, then the z axis of the world."""
    points = np.array(points, dtype=float)
    for axis, angle in enumerate(np.radians(rotation_deg)):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        along, across = points[..., a].copy(), points[..., b].copy()
        points[..., a] = np.cos(angle) * along - np.sin(angle) * across
        points[..., b] = np.sin(angle) * along + np.cos(angle) * across
    return points


def placed(points: np.ndarray, keys: Mapping[str, Any]) -> np.ndarray:
    """Points where the `transform` of a cloth or collider puts them."""
    transform = keys.get("transform", {})
    points = transform.get("scale", 1.0) * np.array(points, dtype=float)
    points = turned(points, transform.get("rotation_deg", (0.0, 0.0, 0.0)))
    return points + transform.get("location", (0.0, 0.0, 0.0))


def motion_at(keyframes: Sequence[Mapping[str, Any]], frame: float) -> list[np.ndarray]:
    """Displacement (m) and angles (degrees) at a frame."""
    frames = [keyframe["frame"] for keyframe in keyframes]
    tracks = [
        [keyframe.get(key, (0.0, 0.0, 0.0)) for keyframe in keyframes]
        for key in ("location", "rotation_deg")
    ]
    return [
        np.array([np.interp(frame, frames, [value[axis] for value in track]) for axis in range(3)])
        for track in tracks
    ]


BOX_TRIANGLES = np.array(
    [
        [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
        [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5],
    ]
)  # fmt: skip
"""Corner i of a box is at the larger end of axis a if bit a of i is set."""


@dataclass
class Obstacle:
    """A collider: points (m), joined to triangles, or with a radius, or a plane's point and normal."""

    keys: Mapping[str, Any]
    points: np.ndarray
    triangles: np.ndarray | None = None
    samples: Samples | None = None

    @classmethod
    def of(cls, keys: Mapping[str, Any], folder: Path) -> Obstacle:
        """Read from the table of a scene."""
        samples = triangles = None
        if "mesh" in keys:
            points, triangles = read_obj(folder / keys["mesh"])
            samples = read_pc2(folder / keys["cache"]) if "cache" in keys else None
        elif box := keys.get("box"):
            ends = np.array([[i & 1, i >> 1 & 1, i >> 2 & 1] for i in range(8)]) - 0.5
            points = turned(ends * box["size"], box.get("rotation_deg", (0, 0, 0))) + box["center"]
            triangles = BOX_TRIANGLES
        elif capsule := keys.get("capsule"):
            points = [capsule["a"], capsule["b"]]
        elif plane := keys.get("plane"):
            points = [plane["point"], np.add(plane["point"], plane["normal"])]
        else:
            points = [keys["sphere"]["center"]]
        return cls(keys, placed(points, keys), triangles, samples)

    def at(self, frame: float) -> np.ndarray:
        """Where its points are (m)."""
        if self.samples is not None:
            first, rate, samples = self.samples
            place = np.clip((frame - first) / rate, 0, len(samples) - 1)
            before = int(place)
            after = min(before + 1, len(samples) - 1)
            ends = samples[[before, after]].astype(float)
            return placed(ends[0] + (place - before) * (ends[1] - ends[0]), self.keys)
        if "motion" not in self.keys:
            return self.points
        location, rotation = motion_at(self.keys["motion"], frame)
        return turned(self.points, rotation) + location

    def depth(self, corners: np.ndarray, frame: float) -> float:
        """How deep (m) triangles, corner by corner, lie in a plane, sphere or capsule; 0 or less outside."""
        points = self.at(frame)
        if "plane" in self.keys:
            normal = points[1] - points[0]
            return -((corners - points[0]) @ (normal / np.linalg.norm(normal))).min()
        if "sphere" in self.keys:
            radius, distances = self.keys["sphere"]["radius"], point_triangle(points[0], corners)
        else:
            radius, distances = self.keys["capsule"]["radius"], edge_triangle(points, corners)
        return self.keys.get("transform", {}).get("scale", 1.0) * radius - distances.min()
