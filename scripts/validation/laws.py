"""What every law keeps: momentum, the slope of its energy, and the motion of a scene that is turned, moved or mirrored."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache, partial
from typing import Any

import numpy as np

from integrator_words import WORDS

from .row import Finding, Row, Tolerance
from .specimen import STILL, Setting, Shape, Specimen, even_grid

CHAPTER = "laws"

DRIFT = Tolerance(1e-10, is_relative=False)
"""Relative, a second: what is wanted."""
SLOPE = Tolerance(1e-6, is_relative=False)
"""Of the largest force: what is wanted. A central difference over 1e-5 m is off by 1e-9 of it."""
SAME = Tolerance(1e-9, is_relative=False)
"""Relative, over 24 frames: what is wanted."""

SPRINGS = {**STILL, "stretch": 500.0, "shear": 100.0, "bend": 5.0}
DAMPING = {"damping_stretch": 0.05, "damping_shear": 0.02, "damping_bend": 0.01}
FABRIC = {
    "stretch_warp": 800.0,
    "stretch_weft": 500.0,
    "compression_warp": 200.0,
    "compression_weft": 200.0,
    "shear": 40.0,
    "bend_warp": 1e-4,
    "bend_weft": 5e-5,
    "damping_ratio": 0.0,
    "limiter": "none",
}
RULES = {
    "forward_euler": 1e-4,
    "symplectic_euler": 1e-3,
    "verlet": 1e-3,
    "leapfrog": 1e-3,
    "midpoint": 1e-4,
    "rk4": 1e-3,
    "implicit_euler": 1e-2,
    "bdf2": 1e-2,
}
"""Steps (s) in which rules that no undamped step keeps still gain little."""
SECONDS = {"forward_euler": 0.2, "midpoint": 0.5}
"""For how long they are followed; the others for a second."""


def kept(rule: str, cloth: Mapping[str, Any]) -> tuple[float, float]:
    """Relative drift a second of momentum and of angular momentum, of a crumpled, turning, drifting free sheet."""
    n, dice = 12, np.random.default_rng(2)
    shape = even_grid(n, n, 0.1)
    spin = np.cross([0.7, -0.4, 2.0], shape.positions) + np.array([0.5, 0.2, -0.1])
    velocities = spin + dice.uniform(-0.3, 0.3, shape.positions.shape)
    step, seconds = RULES[rule], SECONDS.get(rule, 1.0)
    keys = {"mass_per_vertex": 0.02, **cloth}
    sheet = Specimen(shape, keys, Setting(rule, step=step), velocities=velocities)

    def parts() -> tuple[np.ndarray, np.ndarray]:
        x, v = sheet.positions(), sheet.velocities()
        return 0.02 * v, 0.02 * np.cross(x, v)

    before = parts()
    sheet.advance(round(seconds / step))
    after = parts()
    drifts = [
        float(np.linalg.norm((b - a).sum(axis=0)) / np.linalg.norm(a, axis=1).sum() / seconds)
        for a, b in zip(before, after, strict=True)
    ]
    return drifts[0], drifts[1]


def bars(values: Mapping[str, float], limit: float, label: str) -> Any:
    """A plot of errors beside what is allowed."""

    def draw(axes: Any) -> None:
        sizes = [max(value, 1e-18) for value in values.values()]
        axes.barh(range(len(values)), sizes, left=1e-18, color="C1", alpha=0.45)
        axes.axvline(limit, color="C0", lw=2.0)
        axes.set_xscale("log")
        axes.set_xlim(1e-18, 10.0 * limit)
        axes.set_yticks([])
        axes.invert_yaxis()
        for place, name in enumerate(values):
            axes.text(2e-18, place, name, va="center", fontsize=6.5)
        axes.set_xlabel(label)

    return draw


def worst_of(values: Mapping[str, float], tolerance: Tolerance, label: str) -> Finding:
    """The worst of some errors, which are held to 0."""
    worst = max(values, key=lambda name: (math.isnan(values[name]), values[name]))
    return Finding(values[worst], 0.0, bars(values, tolerance.amount, label), f"worst: {worst}")


def momentum() -> Finding:
    """Momentum under every rule, with and without damping, and of fabric."""
    drifts = {WORDS[rule]: kept(rule, {"springs": SPRINGS})[0] for rule in RULES}
    for law in ("relative", "axial"):
        damped = {"springs": {**SPRINGS, **DAMPING, "damping_law": law}}
        drifts[f"Verlet, {law} damping"] = kept("verlet", damped)[0]
    for rule in ("verlet", "bdf2"):
        drifts[f"fabric, {WORDS[rule]}"] = kept(rule, {"model": "fabric", "fabric": FABRIC})[0]
    return worst_of(drifts, DRIFT, "drift a second")


def angular_momentum() -> Finding:
    """Angular momentum under symplectic rules, with axial damping, and of fabric."""
    symplectic = ("symplectic_euler", "verlet", "leapfrog")
    drifts = {WORDS[rule]: kept(rule, {"springs": SPRINGS})[1] for rule in symplectic}
    damped = {"springs": {**SPRINGS, **DAMPING, "damping_law": "axial"}}
    drifts["axial damping"] = kept("symplectic_euler", damped)[1]
    drifts["fabric, Verlet"] = kept("verlet", {"model": "fabric", "fabric": FABRIC})[1]
    return worst_of(drifts, DRIFT, "drift a second")


PULL = [1.0, -2.0, -9.81]
LAWS = {
    "stretch": ({"springs": {**STILL, "stretch": 500.0}}, [0.0] * 3),
    "shear": ({"springs": {**STILL, "shear": 100.0}}, [0.0] * 3),
    "bend": ({"springs": {**STILL, "bend": 20.0}}, [0.0] * 3),
    "gravity": ({"springs": STILL}, PULL),
    "equation 6": ({"springs": {**SPRINGS, "limiter": "stiffen", "deformation_rate": 0.1}}, PULL),
    "fabric, membrane": (
        {"model": "fabric", "fabric": {**FABRIC, "bend_warp": 0.0, "bend_weft": 0.0}},
        [0.0] * 3,
    ),
    "fabric, all": (
        {"model": "fabric", "fabric": {**FABRIC, "bend_warp": 0.1, "bend_weft": 0.05}},
        PULL,
    ),
}
"""Cloth and gravity (m/s²)."""


def slope_error(cloth: Mapping[str, Any], gravity: list[float]) -> float:
    """How far forces on a crumpled sheet are from the slope of its energy, as a part of the largest force.

    A step from rest changes velocities by h F/m; the certificate tells the energy.
    """
    h, mass, e = 1e-3, 0.05, 1e-5
    shape = even_grid(5, 4, 0.3)
    crumpled = shape.positions + np.random.default_rng(3).uniform(
        -0.06, 0.06, shape.positions.shape
    )
    setting = Setting("symplectic_euler", step=h, gravity=gravity)
    sheet = Specimen(shape, {"mass_per_vertex": mass, **cloth}, setting)

    def energy(vertex: int, axis: int, shift: float) -> float:
        moved = crumpled.copy()
        moved[vertex, axis] += shift
        sheet.simulation.set_positions(0, moved)
        return sheet.simulation.certificate()["potential_energy"]

    slopes = np.array(
        [
            [(energy(vertex, axis, -e) - energy(vertex, axis, e)) / (2.0 * e) for axis in range(3)]
            for vertex in range(len(crumpled))
        ]
    )
    sheet.simulation.set_positions(0, crumpled)
    sheet.advance()
    forces = sheet.velocities() * mass / h
    largest = np.linalg.norm(forces, axis=1).max()
    if largest < 1e-2:
        raise RuntimeError(f"the largest force is {largest} N: there is nothing to compare")
    return float(np.linalg.norm(forces - slopes, axis=1).max() / largest)


def slopes() -> Finding:
    """The worst law."""
    errors = {name: slope_error(*law) for name, law in LAWS.items()}
    return worst_of(errors, SLOPE, "error / largest force")


def turn(axis: list[float], angle: float) -> np.ndarray:
    """A rotation matrix about an axis by an angle (rad), by Rodrigues' formula."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross


CHANGES = {
    "turned": (turn([0.3, -0.8, 0.5], 1.1), np.zeros(3)),
    "moved": (np.eye(3), np.array([1.3, -2.1, 0.7])),
    "mirrored": (np.diag([-1.0, 1.0, 1.0]), np.zeros(3)),
}
"""A matrix, and a displacement (m)."""
SAIL = {**STILL, "stretch": 200.0, "shear": 50.0, "bend": 5.0}
SAIL |= {"damping_stretch": 0.02, "damping_shear": 0.01, "damping_bend": 0.005}
FIRM = {**FABRIC, "bend_warp": 1e-3, "bend_weft": 1e-3, "damping_ratio": 0.05}
"""So stiff that no wrinkle grows out of rounding."""
SCENES = {
    "symplectic Euler": ("symplectic_euler", {"springs": SAIL}),
    "RK4, axial damping": ("rk4", {"springs": {**SAIL, "damping_law": "axial"}}),
    "Verlet, equation 6": (
        "verlet",
        {"springs": {**SAIL, "limiter": "stiffen", "deformation_rate": 0.02}},
    ),
    "Euler, provot": (
        "symplectic_euler",
        {"springs": {**SAIL, "limiter": "provot", "deformation_rate": 0.02}},
    ),
    "Euler, project": (
        "symplectic_euler",
        {"springs": {**SAIL, "limiter": "project", "deformation_rate": 0.02}},
    ),
    "fabric, Verlet": ("verlet", {"model": "fabric", "fabric": FIRM}),
}
"""Integrator and cloth."""
IMPLICIT = {
    "BDF2": ("bdf2", {"springs": SAIL}),
    "fabric, BDF2": ("bdf2", {"model": "fabric", "fabric": FIRM}),
}
"""Implicit rules solve their linear systems in single precision: they are told in a note, and not held to 1e-9."""


def final_positions(
    rule: str, cloth: Mapping[str, Any], matrix: np.ndarray, shift: np.ndarray
) -> np.ndarray:
    """Where a crumpled sheet of 1 m in wind, hung by two corners, is after 24 frames, in a changed scene."""
    n = 13
    flat = even_grid(n, n, 1.0 / (n - 1))
    rest = flat.positions + np.random.default_rng(4).uniform(-0.01, 0.01, flat.positions.shape)
    shape = Shape(rest @ matrix.T + shift, flat.faces)
    keys = {"density": 0.2, **cloth}
    if "fabric" in cloth:
        keys["fabric"] = {**cloth["fabric"], "warp": list(matrix @ [0.0, 1.0, 0.0])}
    wind = {"kind": "wind", "velocity": list(matrix @ [0.5, 1.0, 2.0]), "air_density": 1.2}
    setting = Setting(rule, gravity=list(matrix @ [0.0, -9.81, 0.0]), forces=[wind])
    sheet = Specimen(shape, keys, setting, pins=[n * (n - 1), n * n - 1])
    sheet.advance(24)
    return sheet.positions()


@cache
def difference(scene: str, change: str) -> float:
    """How far (m, of a sheet of 1 m) a changed scene's motion is from the motion changed."""
    rule, cloth = (SCENES | IMPLICIT)[scene]
    matrix, shift = CHANGES[change]
    plain = final_positions(rule, cloth, np.eye(3), np.zeros(3))
    changed = final_positions(rule, cloth, matrix, shift)
    return float(np.abs(changed - (plain @ matrix.T + shift)).max())


def invariance(change: str) -> Finding:
    """The scene that differs most."""
    errors = {scene: difference(scene, change) for scene in SCENES}
    finding = worst_of(errors, SAME, "difference / size")
    told = ", ".join(f"{scene} {difference(scene, change):.0e}" for scene in IMPLICIT)
    return replace(
        finding, note=f"{finding.note}; not held to it, solved in single precision: {told}"
    )


def rows() -> list[Row]:
    """All rows of the chapter."""
    law = "law: "
    found = [
        Row(CHAPTER, "momentum of a free sheet", "relative drift a second", "", law + "no outer force, no change",
            "a_free_sheet_keeps_its_momentum_under_every_rule_and_damping, a_free_sheet_of_fabric_keeps_its_momentum",
            momentum, DRIFT),
        Row(CHAPTER, "angular momentum of a free sheet", "relative drift a second", "",
            law + "no outer moment, no change", "a_free_sheet_keeps_its_angular_momentum_under_symplectic_rules, "
            "test_a_free_sheet_of_fabric_keeps_its_angular_momentum_under_verlet",
            angular_momentum, DRIFT),
        Row(CHAPTER, "force = -gradient of the energy", "error / largest force", "",
            "central differences of the energy that certificates tell",
            "every_law_pushes_down_the_slope_of_its_energy, forces_are_the_slope_of_the_energy", slopes, SLOPE),
    ]  # fmt: skip
    test = "a_turned_moved_or_mirrored_scene_moves_the_same, "
    test += "test_a_scene_of_fabric_that_is_turned_moved_or_mirrored_moves_the_same"
    for change in CHANGES:
        found.append(
            Row(CHAPTER, f"the scene {change}: the same motion after 24 frames", "difference / size", "",
                law + "space has no direction, no middle and no hand", test, partial(invariance, change), SAME)
        )  # fmt: skip
    return found
