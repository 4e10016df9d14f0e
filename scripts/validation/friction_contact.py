"""Friction held to Coulomb's law, and scenes of contact in which nothing may pass through anything."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping
from functools import cache, partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from .baked import Baked, bake, read
from .row import EXACTLY, Curve, Finding, Row, Tolerance
from .specimen import G, Setting, Shape, Specimen, even_grid

CHAPTER = "friction_contact"

DEAD_BAND = Tolerance(1.0, is_relative=False)
"""Degrees: what is wanted, as are the two percent."""
SLIDING = Tolerance(0.02)

THICKNESS = 0.008
STOPPING_SUBSTEPS = 24
COUNT = 8
"""Vertices along a side of the patch of 0.25 m."""


def patch(
    friction: float,
    gravity: tuple[float, float, float],
    normal: tuple[float, float, float],
    solver: Mapping[str, Any] = MappingProxyType({}),
) -> Specimen:
    """A patch that lies on a plane through the origin, turned about y, whose friction is that of both."""
    along = np.array([normal[2], 0.0, -normal[0]])
    flat = even_grid(COUNT, COUNT, 0.25 / (COUNT - 1))
    x, y, _ = (flat.positions - flat.positions.mean(axis=0)).T
    lifted = x[:, None] * along + y[:, None] * [0.0, 1.0, 0.0] + THICKNESS * np.array(normal)
    plane = {
        "name": "slope",
        "plane": {"point": [0.0] * 3, "normal": list(normal)},
        "friction": friction,
    }
    touch = {"thickness": THICKNESS, "friction": friction}
    setting = Setting("bdf2", gravity=gravity, solver=solver, collision=touch, colliders=[plane])
    return Specimen(Shape(lifted, flat.faces), {"density": 0.2, "springs": {}}, setting)


def on_slope(degrees: float, friction: float) -> Specimen:
    """A patch on a level plane under a gravity that is tilted by an angle."""
    angle = math.radians(degrees)
    return patch(friction, (G * math.sin(angle), 0.0, -G * math.cos(angle)), (0.0, 0.0, 1.0))


def gone(specimen: Specimen, along: tuple[float, float, float]) -> tuple[float, float]:
    """How far (m) and how fast (m/s) a patch has gone along a direction after a second."""
    start = specimen.positions().mean(axis=0)
    specimen.advance(24)
    way = specimen.positions().mean(axis=0) - start
    return float(way @ along), float(specimen.velocities().mean(axis=0) @ along)


def holds(degrees: float, friction: float) -> bool:
    """Whether a patch sticks: but for the creep of a smooth law and the first contact."""
    way, speed = gone(on_slope(degrees, friction), (1.0, 0.0, 0.0))
    return way < 2e-3 and speed < 1e-3


@cache
def critical_angle(friction: float) -> float:
    """The slope (degrees) from which on a patch slides, found by halving to an eighth of a degree."""
    expected = math.degrees(math.atan(friction))
    low, high = expected - 4.0, expected + 4.0
    if not holds(low, friction) or holds(high, friction):
        return math.nan
    while high - low > 0.125:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(middle, friction) else (low, middle)
    return 0.5 * (low + high)


def sticking() -> Finding:
    """The critical angles of three frictions."""
    frictions, fine = [0.2, 0.5, 1.0], np.linspace(0.05, 1.1, 50)
    expected = [math.degrees(math.atan(mu)) for mu in frictions]
    line = (fine, np.degrees(np.arctan(fine)))
    results = [critical_angle(mu) for mu in frictions]
    return Curve(frictions, results, expected, "friction", "critical angle (°)", line).worst(
        DEAD_BAND
    )


@cache
def slide(degrees: float, is_plane_tilted: bool) -> tuple[float, float]:
    """Way and speed after a second, at a friction of 0.5."""
    if not is_plane_tilted:
        return gone(on_slope(degrees, 0.5), (1.0, 0.0, 0.0))
    sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    return gone(patch(0.5, (0.0, 0.0, -G), (sine, 0.0, cosine)), (cosine, 0.0, -sine))


def coulomb(degrees: float) -> float:
    """Acceleration (m/s²) of what slides down a slope at a friction of 0.5."""
    angle = math.radians(degrees)
    return G * (math.sin(angle) - 0.5 * math.cos(angle))


def acceleration(is_plane_tilted: bool) -> Finding:
    """The acceleration at 35°, by the speed after a second; the plot has more angles."""
    angles, fine = [30.0, 35.0, 40.0, 45.0], np.linspace(27.0, 47.0, 50)
    results = [slide(angle, is_plane_tilted)[1] for angle in angles]
    expected = [coulomb(angle) for angle in angles]
    line = (fine, [coulomb(angle) for angle in fine])
    plot = Curve(angles, results, expected, "slope (°)", "acceleration (m/s²)", line)
    return Finding(results[1], expected[1], plot)


@cache
def stopping_way(friction: float) -> float:
    """How far (m) a patch slides that is pushed to 2 m/s on a level plane."""
    # BDF2 remembers that it was carried, and so begins to brake a third of a step late: steps are short.
    short = {"substeps": STOPPING_SUBSTEPS}
    settled = patch(friction, (0.0, 0.0, -G), (0.0, 0.0, 1.0), short)
    settled.advance(12)
    # Pins carry it off for a frame, and let go: it flies on with the velocity that they had.
    start = settled.positions()
    settled.simulation.set_pin_weights(0, np.ones(COUNT**2))
    settled.aim(start + np.array([2.0 / 24.0, 0.0, 0.0]))
    settled.advance()
    settled.simulation.release_pins(0)
    pushed = settled.positions().mean(axis=0)[0]
    settled.advance(60)
    if np.linalg.norm(settled.velocities().mean(axis=0)) > 1e-3:
        return math.nan
    return float(settled.positions().mean(axis=0)[0] - pushed)


def stop(friction: float) -> Finding:
    """The way of one friction; the plot has all."""
    frictions, fine = [0.2, 0.4, 0.7], np.linspace(0.15, 0.8, 50)

    def expected(mu: float) -> float:
        return 2.0**2 / (2.0 * mu * G)

    results = [stopping_way(mu) for mu in frictions]
    line = (fine, expected(fine))
    plot = Curve(
        frictions, results, [expected(mu) for mu in frictions], "friction", "way (m)", line
    )
    return Finding(stopping_way(friction), expected(friction), plot)


SCENES = {
    "sphere": "sheet dropped on a ball",
    "tablecloth": "table-cloth pulled away",
    "closing_plates": "sheet between closing plates",
    "layers": "fifty layers",
}
"""Scene files and what they show."""


@cache
def baked(name: str) -> Baked:
    """A scene as it is written, baked with two threads."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        return read(name, out, bake(name, out, 2))


def cross_section(scene: Baked, axes: Any) -> None:
    """The last frame from the side: cloth as points, meshes and planes as lines."""
    x, _, z = scene.frames[-1].T
    axes.plot(x, z, ".", ms=1.2, color="C1", rasterized=True)
    for obstacle in scene.obstacles:
        points = obstacle.at(scene.numbers[-1])
        if obstacle.triangles is not None:
            low, high = points.min(axis=0), points.max(axis=0)
            corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]])
            box = np.stack([low, high])
            axes.plot(box[corners[:, 0], 0], box[corners[:, 1], 2], color="C0", lw=1.5)
        elif "sphere" in obstacle.keys:
            angle, radius = np.linspace(0.0, math.tau, 80), obstacle.keys["sphere"]["radius"]
            center = points[0]
            axes.plot(
                center[0] + radius * np.cos(angle),
                center[2] + radius * np.sin(angle),
                color="C0",
                lw=1.5,
            )
        else:
            axes.axhline(points[0, 2], color="C0", lw=1.5)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("z (m)")


def untangled(name: str) -> Finding:
    """How many frames of a scene have an intersection: by our count, by ipctk, or of cloth inside a plane or ball."""
    scene = baked(name)
    found = {
        "our exact count": list(scene.counted()),
        "ipctk": scene.crossed(),
        "depth": scene.sunk(),
    }
    bad = set().union(*found.values())
    told = ", ".join(f"{oracle}: {len(frames)}" for oracle, frames in found.items())
    note = f"frames with intersections of {len(scene.frames)}: {told}; {sum(row['contacts'] for row in scene.rows)} contacts"
    return Finding(len(bad), 0.0, partial(cross_section, scene), note)


def rows() -> list[Row]:
    """All rows of the chapter."""
    closed, stuck = (
        "closed form: Coulomb's law, ",
        "a_patch_sticks_to_a_slope_if_its_tangent_is_below_the_friction_and_slides_above",
    )
    slides = "a_patch_on_a_slope_of_35_degrees_slides_with_coulombs_acceleration"
    tilted = "a_tilted_plane_and_a_tilted_gravity_make_the_same_slope"
    stops = "a_patch_of_2_m_per_s_slides_to_a_stop_where_friction_has_used_up_its_energy"
    found = [
        Row(CHAPTER, "patch on an incline: where it begins to slide", "critical angle", "°",
            closed + "arctan(mu)", stuck, sticking, DEAD_BAND),
        Row(CHAPTER, "patch on an incline of 35°, friction 0.5", "acceleration", "m/s²",
            closed + "g (sin a - mu cos a)", slides, partial(acceleration, False), SLIDING),
        Row(CHAPTER, "patch on a tilted plane of 35°, friction 0.5", "acceleration", "m/s²",
            closed + "g (sin a - mu cos a)", tilted, partial(acceleration, True), SLIDING),
    ]  # fmt: skip
    for friction in (0.2, 0.4, 0.7):
        found.append(
            Row(CHAPTER, f"patch of 2 m/s slides to a stop, friction {friction:g}", "way", "m",
                closed + "v²/(2 mu g)", stops, partial(stop, friction), SLIDING)
        )  # fmt: skip
    test = "test_no_frame_has_an_intersection_by_our_count_by_ipctk_or_by_distance"
    for name, words in SCENES.items():
        found.append(
            Row(CHAPTER, f"{words}: frames with an intersection", "frames", "",
                "exact predicates, and the package ipctk", test, partial(untangled, name), EXACTLY)
        )  # fmt: skip
    return found
