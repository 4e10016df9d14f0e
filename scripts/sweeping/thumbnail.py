"""A small picture of a bake's last frame, drawn from its caches: no Blender needed.

Faces are painted from the farthest to the nearest, in parallel projection from the front, right and above; the nearer to the
light, the brighter, with another colour for backs. What the cloth lies on is in no cache and is not seen.
"""

from __future__ import annotations

import functools
import math
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

HEADER = struct.Struct("<12siiffi")
AZIMUTH, ELEVATION = math.radians(30.0), math.radians(20.0)
TOWARDS_US = np.array(
    [
        math.sin(AZIMUTH) * math.cos(ELEVATION),
        -math.cos(AZIMUTH) * math.cos(ELEVATION),
        math.sin(ELEVATION),
    ]
)
RIGHT = np.array([math.cos(AZIMUTH), math.sin(AZIMUTH), 0.0])
UP = np.cross(TOWARDS_US, RIGHT)
LIGHT = np.array([-0.3, -0.6, 0.74]) / math.hypot(0.3, 0.6, 0.74)
AMBIENT = 0.35
FRONTS = np.array([[196, 74, 60], [66, 112, 168], [98, 150, 84], [182, 140, 60]], float)
"""Colours of cloths, one after another."""
BACKS = 0.45 * FRONTS + 0.55 * 190.0
BACKGROUND = (246, 246, 244)
OVERSAMPLING = 2
MARGIN = 0.05


class Torn(Exception):
    """A cache or a mesh cannot be drawn; one sentence."""


@dataclass(frozen=True)
class Shape:
    """A cloth at one frame."""

    positions: np.ndarray
    """(n, 3), m."""
    faces: tuple[np.ndarray, ...]
    """Vertices of the faces, (f, corners) for each number of corners."""


def last_frame(folder: Path) -> list[Shape]:
    """The cloths of a bake's folder, each at its last frame.

    Raises:
        Torn: A file is missing or damaged.
    """
    shapes = []
    for cache in sorted(folder.glob("*.pc2")):
        try:
            positions = _last_sample(cache)
            faces = _faces(cache.with_suffix(".obj").read_text(encoding="utf-8"))
        except (OSError, ValueError, IndexError, struct.error) as error:
            raise Torn(f"{cache} cannot be drawn ({error})") from error
        if any(corners.max(initial=-1) >= len(positions) for corners in faces):
            raise Torn(f"{cache} cannot be drawn (its mesh has other vertices)")
        shapes.append(Shape(positions, faces))
    return shapes


def _last_sample(path: Path) -> np.ndarray:
    with path.open("rb") as file:
        magic, _version, count, _start, _rate, samples = HEADER.unpack(file.read(HEADER.size))
        if magic != b"POINTCACHE2\0" or samples < 1:
            raise ValueError("it is no PC2 with a frame")
        file.seek(HEADER.size + 12 * count * (samples - 1))
        numbers = np.frombuffer(file.read(12 * count), "<f4")
    return numbers.reshape(count, 3).astype(float)


@functools.lru_cache(maxsize=8)  # the runs of a sweep mostly share their mesh's faces
def _parsed_faces(text: str) -> tuple[np.ndarray, ...]:
    by_corners: dict[int, list[list[int]]] = {}
    for line in text.splitlines():
        corners = [int(word.partition("/")[0]) - 1 for word in line.split()[1:]]
        by_corners.setdefault(len(corners), []).append(corners)
    return tuple(np.array(rows) for rows in by_corners.values())


def _faces(obj: str) -> tuple[np.ndarray, ...]:
    return _parsed_faces("\n".join(line for line in obj.splitlines() if line.startswith("f ")))


@dataclass(frozen=True)
class Frame:
    """What of the projection's plane is in the picture: its middle and the side of a square (m)."""

    x: float
    y: float
    side: float


def frame_around(many: list[list[Shape]]) -> Frame:
    """The frame that holds all of some bakes, so that their pictures have one scale."""
    corners = []
    for shape in (shape for shapes in many for shape in shapes):
        flat = shape.positions @ np.array([RIGHT, UP]).T
        if np.isfinite(flat).all():
            corners += [flat.min(axis=0), flat.max(axis=0)]
    if not corners:
        return Frame(0.0, 0.0, 1.0)
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    middle = (low + high) / 2
    side = max(float((high - low).max()), 1e-9) * (1 + 2 * MARGIN)
    return Frame(float(middle[0]), float(middle[1]), side)


def draw(shapes: list[Shape], frame: Frame, size: int) -> Image.Image:
    """A square picture of some cloths, `size` pixels wide."""
    fine = size * OVERSAMPLING
    image = Image.new("RGB", (fine, fine), BACKGROUND)
    canvas = ImageDraw.Draw(image)
    for _, polygon, colour in sorted(_polygons(shapes, frame, fine), key=lambda each: each[0]):
        canvas.polygon(polygon, fill=colour, outline=colour)
    return image.resize((size, size), Image.Resampling.LANCZOS)


def _polygons(
    shapes: list[Shape], frame: Frame, size: int
) -> list[tuple[float, list[float], tuple[int, ...]]]:
    """Depth, corners (pixels) and colour of every face."""
    found = []
    for number, shape in enumerate(shapes):
        x = ((shape.positions @ RIGHT - frame.x) / frame.side + 0.5) * size
        y = (0.5 - (shape.positions @ UP - frame.y) / frame.side) * size
        pixels, depths = np.column_stack([x, y]), shape.positions @ TOWARDS_US
        front, back = FRONTS[number % len(FRONTS)], BACKS[number % len(BACKS)]
        for faces in shape.faces:
            corners = shape.positions[faces]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, -1] - corners[:, 0])
            normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
            is_front = normals @ TOWARDS_US > 0
            towards_light = np.where(is_front, 1.0, -1.0) * (normals @ LIGHT)
            shade = AMBIENT + (1 - AMBIENT) * np.clip(0.5 + 0.5 * towards_light, 0.0, 1.0)
            colours = np.where(is_front[:, None], front, back) * shade[:, None]
            found += zip(
                depths[faces].mean(axis=1).tolist(),
                pixels[faces].reshape(len(faces), -1).tolist(),
                map(tuple, colours.astype(int).tolist()),
                strict=True,
            )
    return found
