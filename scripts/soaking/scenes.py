"""The scenes of a long run: those of contact in tests/scenes, and many cloths that fall into a heap."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

SCENES = Path(__file__).resolve().parents[2] / "tests" / "scenes"
NAMES = (
    "sphere",
    "box_corner",
    "needles",
    "folding_strip",
    "two_sheets",
    "twist",
    "funnel",
    "tablecloth",
    "closing_plates",
    "fast_sphere",
    "moving_body",
    "incline",
    "cs184_plane",
    "cs184_sphere",
    "cs184_self_collision",
)
SELDOM = ("layers",)
"""A frame of it takes as long as thirty of others."""
EVERY = 20
"""In one round out of so many."""
CLOTHS = 24


@dataclass(frozen=True)
class Subject:
    """A scene file, and in which rounds it is run."""

    name: str
    path: Path
    every: int = 1


def subjects(folder: Path) -> list[Subject]:
    """All scenes; the one that is made goes into a folder."""
    heap = folder / "heap.toml"
    heap.write_text(heap_of(CLOTHS), encoding="utf-8")
    often = [Subject(name, SCENES / f"{name}.toml") for name in NAMES]
    seldom = [Subject(name, SCENES / f"{name}.toml", EVERY) for name in SELDOM]
    return [*often, Subject(f"{CLOTHS} cloths", heap), *seldom]


def heap_of(count: int) -> str:
    """A scene of cloths, each turned further than the one below, that fall on a ball and on each other."""
    cloths = [
        f"""
[[cloth]]
name = "sheet{number:02}"
grid = {{ size = [0.5, 0.5], vertices = [9, 9], plane = "xy" }}
transform = {{ location = [0.0, 0.0, {0.27 + 0.035 * number:.3f}], rotation_deg = [0.0, 0.0, {37 * number}] }}
density = 0.2
springs = {{ stretch = 500, shear = 100, bend = 5 }}
"""
        for number in range(count)
    ]
    return f"""[scene]
frames = [1, 25]
{"".join(cloths)}
[collision]
thickness = 0.012
friction = 0.3

[[collider]]
name = "ball"
sphere = {{ center = [0.0, 0.0, 0.0], radius = 0.2 }}

[[collider]]
name = "floor"
plane = {{ point = [0.0, 0.0, -0.2], normal = [0.0, 0.0, 1.0] }}
"""
