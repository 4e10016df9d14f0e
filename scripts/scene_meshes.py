"""Make the meshes that scenes in tests/scenes need: `python scripts/scene_meshes.py [--full] [--out DIR]`.

- `needles.obj`: 5 x 5 thin cones that stand on z = 0
- `tube.obj`: a cylinder of cloth, open at both ends
- `funnel.obj`: a cone that narrows to a pipe, open at both ends
- `body.obj`, `body.pc2`: a ball that sways and breathes, sampled every second frame
- `fold.obj`: a sheet folded in two, whose upper half bulges down through the lower
- `roll.obj`: a sheet that is rolled up so far that its end passes through its beginning

They lie beside the scenes in a small size. `--full` makes what benchmarks need besides: `tube_full.obj`.

Standard library only; numbers have 6 decimals, so that every machine writes the same bytes.
"""

from __future__ import annotations

import argparse
import math
import struct
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

SCENES = Path(__file__).resolve().parents[1] / "tests" / "scenes"
Point = tuple[float, float, float]

NEEDLES = 5
"""Needles along each side of the bed."""
BODY_SAMPLES = 19
"""Samples of the body's cache, from frame 1 on."""
BODY_RATE = 2.0
"""Frames from one to the next."""


@dataclass
class Mesh:
    """Vertices (m) and faces, whose corners count from 0."""

    vertices: list[Point] = field(default_factory=list)
    faces: list[tuple[int, ...]] = field(default_factory=list)

    def ring(
        self, sides: int, radius: float, z: float, middle: tuple[float, float] = (0, 0)
    ) -> int:
        """Add a circle of vertices and return the number of the first."""
        first = len(self.vertices)
        for side in range(sides):
            angle = 2.0 * math.pi * side / sides
            x, y = middle[0] + radius * math.cos(angle), middle[1] + radius * math.sin(angle)
            self.vertices.append((x, y, z))
        return first

    def band(self, sides: int, below: int, above: int) -> None:
        """Join two circles by quads that are seen from outside."""
        pairs = zip(sides_of(below, sides), sides_of(above, sides), strict=True)
        self.faces += [(a, b, d, c) for (a, b), (c, d) in pairs]

    def fan(self, sides: int, first: int, tip: int) -> None:
        """Join a circle to a tip above it by triangles that are seen from outside."""
        self.faces += [(a, b, tip) for a, b in sides_of(first, sides)]

    def text(self) -> str:
        """The mesh as OBJ."""
        lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in map(rounded, self.vertices)]
        lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in self.faces]
        return "\n".join(lines) + "\n"


def sides_of(first: int, sides: int) -> list[tuple[int, int]]:
    """The sides of a circle of vertices: both ends of each."""
    return [(first + side, first + (side + 1) % sides) for side in range(sides)]


def rounded(point: Point) -> Point:
    """A point with 6 decimals and no negative zero."""
    x, y, z = (round(number, 6) + 0.0 for number in point)
    return (x, y, z)


def needles(height: float = 0.3, radius: float = 0.015, spacing: float = 0.2) -> Mesh:
    """A bed of closed cones with 6 sides each."""
    mesh, sides = Mesh(), 6
    for needle in range(NEEDLES**2):
        x, y = (spacing * (part - (NEEDLES - 1) / 2) for part in divmod(needle, NEEDLES))
        base = mesh.ring(sides, radius, 0.0, (x, y))
        mesh.vertices.append((x, y, height))
        mesh.fan(sides, base, len(mesh.vertices) - 1)
        mesh.faces.append(tuple(reversed(range(base, base + sides))))
    return mesh


def lathe(sides: int, profile: list[tuple[float, float]]) -> Mesh:
    """A profile of radii and heights (m), from below, turned about the z axis; open at both ends."""
    mesh = Mesh()
    rings = [mesh.ring(sides, radius, z) for radius, z in profile]
    for below, above in pairwise(rings):
        mesh.band(sides, below, above)
    return mesh


def tube(sides: int, rows: int, radius: float = 0.05, length: float = 2.0) -> Mesh:
    """A cylinder about the z axis, its middle at the origin."""
    return lathe(sides, [(radius, length * (row / rows - 0.5)) for row in range(rows + 1)])


def funnel(sides: int = 32) -> Mesh:
    """A pipe of radius 0.12 m below z = 0, a cone of radius 0.6 m above."""
    return lathe(sides, [(0.12, -0.4), (0.12, -0.2), (0.12, 0.0), (0.36, 0.25), (0.6, 0.5)])


def ball(sides: int = 16, rings: int = 9, radius: float = 0.4) -> Mesh:
    """A closed ball about the origin."""
    mesh = Mesh()
    angles = [math.pi * (ring / (rings + 1) - 0.5) for ring in range(1, rings + 1)]
    circles = [mesh.ring(sides, radius * math.cos(a), radius * math.sin(a)) for a in angles]
    for below, above in pairwise(circles):
        mesh.band(sides, below, above)
    mesh.vertices += [(0.0, 0.0, radius), (0.0, 0.0, -radius)]
    top = len(mesh.vertices) - 2
    mesh.fan(sides, circles[-1], top)
    mesh.faces += [tuple(reversed((a, b, top + 1))) for a, b in sides_of(circles[0], sides)]
    return mesh


def roll(columns: int = 40, rows: int = 20, radius: float = 0.2, turn: float = 6.9) -> Mesh:
    """A sheet about the y axis, rolled by more than a full turn (rad): it leans, so that its end crosses its beginning."""
    mesh = Mesh()
    for row in range(rows):
        y = radius * turn * (row / (rows - 1) - 0.5) * rows / columns
        for column in range(columns):
            share = column / (columns - 1)
            x, z = radius * math.cos(turn * share), radius * math.sin(turn * share)
            mesh.vertices.append((x, y, z + 0.001 * y + 0.02 * (share - 0.5)))
    quads = [(row * columns + column) for row in range(rows - 1) for column in range(columns - 1)]
    mesh.faces = [(a, a + 1, a + columns + 1, a + columns) for a in quads]
    return mesh


def fold(columns: int = 49, rows: int = 25, length: float = 1.2, bend: float = 0.03) -> Mesh:
    """A sheet in the plane z = 0, folded over about the y axis with a bend of a radius."""
    mesh = Mesh()
    half = 0.5 * (length - math.pi * bend)
    for row in range(rows):
        y = length * (row / (rows - 1) - 0.5) * (rows - 1) / (columns - 1)
        for column in range(columns):
            way = length * column / (columns - 1) - half
            angle = min(max(way / bend, 0.0), math.pi)
            x = min(way, 0.0) + bend * math.sin(angle) - max(way - math.pi * bend, 0.0)
            z = bend * (1.0 - math.cos(angle))
            if angle == math.pi:
                z -= 0.1 * math.exp(-((x + 0.5 * half) ** 2 + y**2) / 0.01)
            mesh.vertices.append((x, y, z))
    quads = [(row * columns + column) for row in range(rows - 1) for column in range(columns - 1)]
    mesh.faces = [(a, a + 1, a + columns + 1, a + columns) for a in quads]
    return mesh


def swaying(seconds: float) -> Callable[[Point], Point]:
    """Where a point of the body is at a time: it breathes 1 time, and leans 0.5 times, a second."""
    breath = 1.0 + 0.15 * math.sin(2.0 * math.pi * seconds)
    lean = 0.5 * math.sin(math.pi * seconds)

    def moved(point: Point) -> Point:
        x, y, z = point
        return (x * breath + lean * z, y * breath, z)

    return moved


def cache(mesh: Mesh) -> bytes:
    """The body's motion as POINTCACHE2, at 24 frames a second."""
    data = struct.pack(
        "<12siiffi", b"POINTCACHE2\0", 1, len(mesh.vertices), 1.0, BODY_RATE, BODY_SAMPLES
    )
    for sample in range(BODY_SAMPLES):
        move = swaying(BODY_RATE * sample / 24.0)
        for vertex in mesh.vertices:
            data += struct.pack("<3f", *rounded(move(rounded(vertex))))
    return data


def files(full: bool) -> dict[str, bytes]:
    """Every file by its name."""
    if full:
        return {"tube_full.obj": tube(64, 256).text().encode()}
    body = ball()
    return {
        "needles.obj": needles().text().encode(),
        "tube.obj": tube(16, 48).text().encode(),
        "funnel.obj": funnel().text().encode(),
        "fold.obj": fold().text().encode(),
        "roll.obj": roll().text().encode(),
        "body.obj": body.text().encode(),
        "body.pc2": cache(body),
    }


def main() -> None:
    """Write the files."""
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    parser.add_argument("--full", action="store_true", help="the files of benchmarks")
    parser.add_argument("--out", type=Path, default=SCENES, metavar="DIR")
    words = parser.parse_args()
    words.out.mkdir(parents=True, exist_ok=True)
    for name, content in files(words.full).items():
        (words.out / name).write_bytes(content)


if __name__ == "__main__":
    main()
