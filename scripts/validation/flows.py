"""Cloth in wind and water: terminal speeds, pressure, drag and lift, buoyancy depth, currents, wet cloth."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np

from .row import Curve, Finding, Row, Tolerance
from .specimen import STILL, G, Setting, Shape, Specimen, even_grid

CHAPTER = "flows"
DOWN = (0.0, 0.0, -G)
WANTED = Tolerance(0.02)
"""What is wanted of terminal speeds, buoyancy depth and wind pressure."""

AIR, WATER = 1.2, 1000.0
"""Densities (kg/m³)."""
SOFT = {"springs": {**STILL, "stretch": 50.0, "shear": 10.0, "bend": 1.0}}
STIFF = {"springs": {**STILL, "stretch": 2000.0, "shear": 500.0, "bend": 50.0}}


def by_default(forces: list[dict[str, Any]]) -> Setting:
    """The settings of a user who has changed none: BDF2 with automatic steps at 24 frames a second."""
    return Setting("bdf2", gravity=DOWN, forces=forces)


def falling(drag: float, lift: float | None) -> Finding:
    """A flat sheet of 0.2 kg/m² that falls face-on through air for three seconds."""
    still: dict[str, Any] = {
        "kind": "wind",
        "velocity": [0.0] * 3,
        "air_density": AIR,
        "drag_coefficient": drag,
    }
    if lift is not None:
        still["lift_coefficient"] = lift
    sheet = Specimen(even_grid(6, 6, 0.1), {"density": 0.2, **SOFT}, by_default([still]))
    sheet.advance(72)
    speed = -float(sheet.velocities()[:, 2].mean())
    return Finding(speed, math.sqrt(2.0 * 0.2 * G / (AIR * drag)))


def inclined(part: str) -> Finding:
    """Drag or lift of a sheet of 1 m² that leans against a wind of 7 m/s, from its first short step; at five angles."""
    drag, lift, speed, step = 1.17, 0.9, 7.0, 1e-4
    angles = np.array([15.0, 30.0, 45.0, 60.0, 90.0])
    wind = {
        "kind": "wind", "velocity": [speed, 0.0, 0.0], "air_density": AIR, "drag_coefficient": drag,
        "lift_coefficient": lift,
    }  # fmt: skip
    found = []
    for degrees in angles:
        flat = even_grid(6, 6, 0.2)
        sin, cos = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
        x, y = flat.positions[:, 0], flat.positions[:, 1]
        leaning = Shape(np.stack([x * cos, y, -x * sin], axis=-1), flat.faces)
        setting = Setting("symplectic_euler", step=step, forces=[wind])
        sheet = Specimen(leaning, {"mass_per_vertex": 0.01, **SOFT}, setting)
        sheet.advance(1)
        force = 0.01 / step * sheet.velocities().sum(axis=0)
        found.append(float(force[0] if part == "drag" else force[2]))
    sin, cos = np.sin(np.radians(angles)), np.cos(np.radians(angles))
    pressure = 0.5 * AIR * speed**2
    expected = pressure * (drag * sin if part == "drag" else lift * sin * cos)
    shown = slice(None) if part == "drag" else slice(0, 4)  # face-on there is no lift
    return Curve(
        angles[shown], found[shown], expected[shown], "angle of attack (°)", "force (N)"
    ).worst(WANTED)


def face_on() -> Finding:
    """The force of winds of 1 to 30 m/s on a sheet of 1 m² face-on, by pressure along the normal."""
    speeds, step, found = np.array([1.0, 3.0, 10.0, 30.0]), 1e-5, []
    for speed in speeds:
        wind = {
            "kind": "wind",
            "velocity": [0.0, 0.0, speed],
            "air_density": AIR,
            "drag_coefficient": 1.17,
        }
        setting = Setting("symplectic_euler", step=step, forces=[wind])
        sheet = Specimen(even_grid(6, 6, 0.2), {"mass_per_vertex": 0.01, **SOFT}, setting)
        sheet.advance(1)
        found.append(float(0.01 / step * sheet.velocities()[:, 2].sum()))
    curve = Curve(
        speeds, found, 0.5 * AIR * 1.17 * speeds**2, "speed (m/s)", "force (N)", logarithmic="both"
    )
    return curve.worst(WANTED)


def water(**keys: Any) -> dict[str, Any]:
    """Water up to z = 0."""
    return {"kind": "water", **keys}


def floating(bulk: float) -> Finding:
    """How deep the lower side of a mat of 10 cm lies after 20 s."""
    cloth = {"density": 0.1 * bulk, "water": {"bulk_density": bulk}, **STIFF}
    mat = Specimen(even_grid(6, 6, 0.1), cloth, by_default([water()]))
    mat.advance(480)
    return Finding(0.05 - float(mat.positions()[:, 2].mean()), 0.1 * bulk / WATER)


def sinking() -> Finding:
    """A sheet of 0.4 kg/m² and 1500 kg/m³ that sinks face-on for two seconds."""
    cloth = {"density": 0.4, "water": {"bulk_density": 1500.0}, **SOFT}
    sheet = Specimen(even_grid(6, 6, 0.1), cloth, by_default([water(level=10.0)]))
    sheet.advance(48)
    speed = -float(sheet.velocities()[:, 2].mean())
    return Finding(speed, math.sqrt(2.0 * 0.4 * G * (1.0 - WATER / 1500.0) / WATER))


def drifting() -> Finding:
    """A floating sheet in a current of 0.6 m/s after 20 s."""
    cloth = {"density": 0.2, "water": {"bulk_density": 500.0}, **STIFF}
    current = water(velocity=[0.6, 0.0, 0.0], friction_coefficient=0.05)
    sheet = Specimen(even_grid(6, 6, 0.1), cloth, by_default([current]))
    sheet.advance(480)
    return Finding(float(sheet.velocities()[:, 0].mean()), 0.6)


def soaked() -> Finding:
    """The speed at which a sheet falls through air that has soaked up twice its mass, which counts as weight and inertia."""
    cotton = {"bulk_density": 400.0, "absorbency": 2.0, "soak_time": 0.5}
    air = {"kind": "wind", "velocity": [0.0] * 3, "air_density": AIR}
    cloth = {"density": 0.3, "water": cotton, **SOFT}
    sheet = Specimen(even_grid(6, 6, 0.1), cloth, by_default([air, water(level=10.0)]))
    sheet.advance(24)
    sheet.simulation.set_water(-1e5, (0.0, 0.0, 0.0))
    sheet.advance(120)
    speed = -float(sheet.velocities()[:, 2].mean())
    return Finding(speed, math.sqrt(2.0 * 3.0 * 0.3 * G / AIR))


def rows() -> list[Row]:
    """The rows of this chapter."""
    closed = "closed form, "
    carries = "a_falling_sheet_reaches_the_speed_at_which_drag_carries_it"
    leans = "an_inclined_sheet_feels_the_drag_and_lift_of_the_closed_forms"
    terminal = closed + "sqrt(2 m g/(rho Cd A))"
    found = [
        Row(CHAPTER, "terminal speed in air, by pressure", "speed", "m/s", terminal, carries,
            partial(falling, 1.3, None), WANTED),
        Row(CHAPTER, "terminal speed in air, by drag and lift", "speed", "m/s", terminal, carries,
            partial(falling, 1.3, 1.5), WANTED),
        Row(CHAPTER, "wind pressure face-on", "force", "N", closed + "1/2 rho Cd A v²",
            "pressure_pushes_each_face_and_its_corners_share_it", face_on, WANTED),
        Row(CHAPTER, "drag of an inclined sheet", "force", "N", closed + "1/2 rho Cd A v² sin a", leans,
            partial(inclined, "drag"), WANTED),
        Row(CHAPTER, "lift of an inclined sheet", "force", "N", closed + "1/2 rho Cl A v² sin a cos a", leans,
            partial(inclined, "lift"), WANTED),
    ]  # fmt: skip
    floats = "a_mat_floats_as_deep_as_its_density_says"
    for bulk in (200.0, 600.0):
        found.append(
            Row(CHAPTER, f"buoyancy depth of a mat of {bulk:g} kg/m³", "depth", "m",
                closed + "thickness times density over that of water", floats, partial(floating, bulk), WANTED)
        )  # fmt: skip
    found += [
        Row(CHAPTER, "terminal speed of a sheet that sinks", "speed", "m/s",
            closed + "sqrt(2 sigma g (1 - rho/rho_b)/(rho Cd))",
            "a_sheet_that_is_denser_than_water_sinks_at_the_speed_of_the_closed_form", sinking, WANTED),
        Row(CHAPTER, "drift of a floating sheet", "speed", "m/s", "the current's", "a_current_carries_a_floating_sheet_along",
            drifting, WANTED),
        Row(CHAPTER, "terminal speed in air of a soaked sheet", "speed", "m/s",
            closed + "sqrt(2 (1 + a) sigma g/(rho Cd))", "soaked_cloth_falls_as_fast_as_its_weight_says", soaked, WANTED),
    ]  # fmt: skip
    return found
