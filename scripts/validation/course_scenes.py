"""The scenes of a course's cloth assignment (Berkeley CS184, 2018), and a demo in plain numpy."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from versus.full_size import settings

from .baked import SCENES, Baked, bake, read
from .plain_cloth import Demo
from .row import EXACTLY, Curve, Finding, Range, Row, Tolerance
from .specimen import STILL, Setting, Shape, Specimen, grid

CHAPTER = "course_scenes"

RATE = Range(0.0, 0.101)
"""The assignment's tenth, which frames keep to a tenth of a percentage point."""
DEMO = Tolerance(1e-9, is_relative=False)
"""m: rounding of 1e-16 grows with two seconds of motion."""
FALLS = 1e-3
"""m: by how much a sag must fall at the least where springs are ten times as stiff."""
STIFFNESSES = (50.0, 500.0, 5000.0, 50_000.0)

NAMES = {
    "pinned2": ("sheet on two corners", 120),
    "pinned4": ("sheet on four corners", 120),
    "cs184_plane": ("sheet on a plane", 25),
    "cs184_sphere": ("sheet on a ball", 45),
    "cs184_self_collision": ("sheet on a plane and on itself", 33),
}
"""Scene files, what they show, and how many frames are simulated here."""


@cache
def baked(name: str, overrides: tuple[str, ...] = ()) -> Baked:
    """A scene of 50 x 50 points, baked with two threads."""
    full = [
        each for each in settings(SCENES / f"{name}.toml") if not each.startswith("scene.frames")
    ]
    frames = f"scene.frames=[1,{NAMES[name][1]}]"
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        return read(name, out, bake(name, out, 2, [*full, frames, *overrides]))


def wires(scene: Baked, axes: Any) -> None:
    """The last frame from the front, every second row and column."""
    side = round(scene.frames.shape[1] ** 0.5)
    x = scene.frames[-1].reshape(side, side, 3)
    view = np.array([[0.94, 0.34, 0.0], [0.12, -0.32, 0.94]]).T
    flat = x @ view
    for lines in (flat[::2], flat.transpose(1, 0, 2)[::2]):
        for line in lines:
            axes.plot(line[:, 0], line[:, 1], color="C1", lw=0.5)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("seen from the front (m)")


def elongation(name: str) -> Finding:
    """The largest elongation of an edge in the last frame."""
    scene = baked(name)
    note = (
        f"{len(scene.frames)} frames, the worst {max(row['max_strain'] for row in scene.rows):.4f}"
    )
    return Finding(scene.rows[-1]["max_strain"], RATE, partial(wires, scene), note)


def untangled(name: str) -> Finding:
    """Frames with an intersection, by our count, by ipctk, or of cloth inside a plane or ball."""
    scene = baked(name)
    found = {
        "our exact count": list(scene.counted()),
        "ipctk": scene.crossed(),
        "depth": scene.sunk(),
    }
    told = ", ".join(f"{oracle}: {len(frames)}" for oracle, frames in found.items())
    note = f"frames with intersections of {len(scene.frames)}: {told}"
    return Finding(len(set().union(*found.values())), 0.0, partial(wires, scene), note)


@cache
def sag(name: str, stiffness: float) -> float:
    """How far (m) the lowest point hangs below the pins after two seconds."""
    springs = "cloth.sheet.springs"
    overrides = (
        f"{springs}.stretch={stiffness}",
        f"{springs}.shear={stiffness}",
        f"{springs}.bend={0.2 * stiffness}",
        "scene.frames=[1,61]",
    )
    last = baked(name, overrides).frames[-1]
    return float(baked(name, overrides).frames[0][:, 2].max() - last[:, 2].min())


def sags(name: str) -> Finding:
    """The least fall of the sag from one stiffness to ten times it."""
    found = [sag(name, stiffness) for stiffness in STIFFNESSES]

    def draw(axes: Any) -> None:
        axes.plot(STIFFNESSES, found, "o-", color="C1", mfc="none")
        axes.set_xscale("log")
        axes.set_xlabel("ks (N/m)")
        axes.set_ylabel("sag (m)")

    note = "sags " + ", ".join(f"{value:.4f}" for value in found)
    return Finding(float(-np.diff(found).max()), Range(low=FALLS), draw, note)


@cache
def demonstrated() -> tuple[np.ndarray, np.ndarray]:
    """Positions (m) of the demo every tenth of a second for two seconds: by the module, by plain numpy."""
    demo = Demo()
    flat = demo.rest().reshape(-1, 3)
    faces = grid(np.arange(demo.side), np.arange(demo.side)).faces
    pins = [row * demo.side + column for row, column in demo.pins()]
    k = demo.stiffness
    springs = {**STILL, "stretch": k, "shear": k, "bend": k, "air_damping": demo.air_damping}
    wind = {
        "kind": "wind",
        "velocity": list(demo.wind),
        "coefficient": demo.wind_coefficient,
        "region": {"vertices": np.flatnonzero(demo.blown()).tolist()},
    }
    cloth = {"mass_per_vertex": demo.mass, "springs": springs}
    setting = Setting(step=demo.step, gravity=demo.gravity, forces=[wind])
    sheet = Specimen(Shape(flat, faces), cloth, setting, pins=pins)
    seen = [sheet.positions()]
    for _ in range(20):
        sheet.advance(10)
        seen.append(sheet.positions())
    return np.array(seen), demo.run(200)[::10]


def demo_error() -> Finding:
    """The farthest that a particle of the demo is from where plain numpy has it."""
    ours, plain = demonstrated()
    corner, times = 13, 0.1 * np.arange(21)
    plot = Curve(times, ours[:, corner, 2], plain[:, corner, 2], "t (s)", "blown corner z (m)")
    return Finding(float(np.abs(ours - plain).max()), 0.0, plot)


def collided(names: Sequence[str]) -> list[Row]:
    """Rows of intersections."""
    test = "test_no_frame_has_an_intersection_by_our_count_by_ipctk_or_by_distance"
    source = "exact predicates, and the package ipctk"
    return [
        Row(CHAPTER, f"{NAMES[name][0]}: frames with an intersection", "frames", "", source, test,
            partial(untangled, name), EXACTLY)
        for name in names
    ]  # fmt: skip


def rows() -> list[Row]:
    """All rows of the chapter."""
    hung = {
        "pinned2": "the_courses_curtain_on_two_corners_ends_within_its_deformation_rate",
        "pinned4": "the_courses_sheet_on_four_corners_ends_within_its_deformation_rate",
    }
    collides = "test_every_frame_is_finite_and_within_the_deformation_rate"
    assignment = "CS184's cloth assignment: no edge longer than by a tenth"
    found = [
        Row(CHAPTER, f"{words}: elongation at the end", "L/L0 - 1", "", assignment, hung.get(name, collides),
            partial(elongation, name))
        for name, (words, _) in NAMES.items()
    ]  # fmt: skip
    found += collided([name for name in NAMES if name not in hung])
    tests = {
        "pinned2": "sag_from_two_corners_falls_as_the_springs_stiffen_from_50_to_50000",
        "pinned4": "sag_from_four_corners_falls_as_the_springs_stiffen_from_50_to_50000",
    }
    for name, test in tests.items():
        found.append(
            Row(CHAPTER, f"{NAMES[name][0]}: the sag falls as ks rises from 50 to 50 000", "least fall", "m",
                "CS184's cloth assignment: stiffer springs sag less", test, partial(sags, name))
        )  # fmt: skip
    found.append(
        Row(CHAPTER, "numpy demo, 14 x 14, after two seconds", "farthest particle", "m",
            "the same method in plain numpy, written apart (plain_cloth.py)",
            "the_numpy_demonstration_moves_as_the_plain_method_does", demo_error, DEMO)
    )  # fmt: skip
    return found
