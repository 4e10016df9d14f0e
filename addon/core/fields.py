"""Blender's force fields as the scene description takes them: the keys and words of `[[force]]`."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from .refusal import Refusal

PRESSURE = 0.48
"""What Blender's cloth feels of a unit of strength at 24 frames a second (N/m²); here it feels that at every frame rate."""

KINDS = {
    "FORCE": "point",
    "WIND": "wind_field",
    "VORTEX": "vortex",
    "MAGNET": "magnetic",
    "HARMONIC": "harmonic",
    "TURBULENCE": "turbulence",
    "DRAG": "drag",
}
"""Kinds of fields that push the cloth, and the words of the scene description for them."""

WEIGHTS = {
    "FORCE": "force",
    "WIND": "wind",
    "VORTEX": "vortex",
    "MAGNET": "magnetic",
    "HARMONIC": "harmonic",
    "TURBULENCE": "turbulence",
    "DRAG": "drag",
}
"""The field weight of each kind."""

NUMBERS = (
    "strength", "harmonic_damping", "flow", "noise", "seed", "wind_factor", "size", "falloff_power", "distance_min",
    "distance_max", "radial_falloff", "radial_min", "radial_max",
)  # fmt: skip
"""The numbers of a field. Drag and rest length are two of these by other names: `strength` and `harmonic_damping` are drag
by the square of the speed and by the speed, whatever their labels say, and `size` is the rest length."""

CHOICES = (
    "type", "shape", "falloff_type", "z_direction", "use_min_distance", "use_max_distance", "use_radial_min",
    "use_radial_max", "use_gravity_falloff", "use_global_coords",
)  # fmt: skip
"""The words and switches of a field."""

MOST = 1e9
"""The largest number that a field may have."""

_MOST_DRAG = 2.0
"""Blender takes no more than this of either drag."""


class Field(NamedTuple):
    """A field at a frame, in Blender's words."""

    name: str
    values: Mapping[str, Any]
    """Its numbers and choices by their names."""
    location: Sequence[float]
    """(m), world space."""
    axis: Sequence[float]
    """Its own z axis in the world."""


class Forces(NamedTuple):
    """What a simulation is told of forces before a frame."""

    gravity: tuple[float, float, float]
    """(m/s²)"""
    fields: str
    """A JSON list of force tables."""


def weight_of(weights: Mapping[str, float], kind: str) -> float:
    """How much of a kind of field a cloth feels."""
    return weights["all"] * weights[WEIGHTS[kind]]


def encode(fields: Sequence[Field], weights: Mapping[str, float]) -> str:
    """Fields as a JSON list of force tables, under these field weights.

    Raises:
        Refusal: A number is not finite, or far too large.
    """
    tables = [describe(field, weight_of(weights, field.values["type"])) for field in fields]
    return json.dumps(tables, allow_nan=False)


def describe(field: Field, weight: float) -> dict[str, Any]:
    """One field as a force table."""
    values = field.values
    numbers = {key: values[key] for key in NUMBERS}
    numbers |= {f"location {axis}": x for axis, x in zip("xyz", field.location, strict=True)}
    for key, value in {**numbers, "field weight": weight}.items():
        if not math.isfinite(value) or abs(value) > MOST:
            raise Refusal(
                f'the force field "{field.name}" has a {key.replace("_", " ")} of {value:g}: '
                f"accepted are numbers up to {MOST:g}"
            )
    kind = values["type"]
    length = math.hypot(*field.axis)
    table: dict[str, Any] = {
        "kind": KINDS[kind],
        "strength": values["strength"],
        "pressure": PRESSURE,
        "weight": weight,
        "noise": values["noise"],
        "seed": values["seed"],
        "wind_factor": values["wind_factor"],
        "location": list(field.location),
        "axis": list(field.axis) if 1e-6 < length < math.inf else [0.0, 0.0, 1.0],
        "shape": values["shape"].lower(),
        "falloff": _falloff(values),
    }
    return table | _keys_of_kind(kind, values)


def _keys_of_kind(kind: str, values: Mapping[str, Any]) -> dict[str, Any]:
    if kind == "DRAG":
        return {
            "strength": min(values["strength"], _MOST_DRAG),
            "damping": max(0.0, min(values["harmonic_damping"], _MOST_DRAG)),
        }
    if kind == "HARMONIC":
        return {"damping": max(0.0, values["harmonic_damping"]), "rest_length": values["size"]}
    keys: dict[str, Any] = {"flow": values["flow"]}
    if kind == "FORCE":
        keys["inverse_square"] = bool(values["use_gravity_falloff"])
    if kind == "TURBULENCE":
        keys |= {"size": values["size"], "global": bool(values["use_global_coords"])}
    return keys


def _falloff(values: Mapping[str, Any]) -> dict[str, Any]:
    falloff = {
        "shape": values["falloff_type"].lower(),
        "side": values["z_direction"].lower(),
        "power": values["falloff_power"],
        "radial_power": values["radial_falloff"],
    }
    for key, switch, name in (
        ("min", "use_min_distance", "distance_min"),
        ("max", "use_max_distance", "distance_max"),
        ("radial_min", "use_radial_min", "radial_min"),
        ("radial_max", "use_radial_max", "radial_max"),
    ):
        if values[switch]:
            falloff[key] = values[name]
    return falloff
