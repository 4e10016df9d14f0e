"""Wind and water around a cloth in Blender as forces of a scene description."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from .shape import decimal

Values = Mapping[str, Any]
"""Property names of `object.boucle` and their values."""

_BULK = {"bulk_density": 500.0, "absorbency": 0.0}
"""What the solver takes of a cloth in water where a scene says nothing."""


def wind(values: Values, vertices: Sequence[int] | None) -> dict[str, Any] | None:
    """The wind on a cloth, or on some of its vertices; None if none blows. Keys at their defaults are left out."""
    if not values["use_wind"] or vertices == []:
        return None
    velocity = [decimal(value) for value in values["wind_velocity"]]
    out: dict[str, Any] = {"kind": "wind", "velocity": velocity}
    if values["wind_law"] == "vertex":
        out["coefficient"] = decimal(values["wind_coefficient"])
    else:
        out["air_density"] = decimal(values["wind_air_density"])
        if decimal(values.get("wind_drag", 1.0)) != 1.0:
            out["drag_coefficient"] = decimal(values["wind_drag"])
        if values.get("use_wind_lift"):
            out["lift_coefficient"] = decimal(values["wind_lift"])
    if values.get("wind_gusts"):
        period, seed = decimal(values["wind_gust_period"]), int(values["wind_seed"])
        out["gusts"] = {"strength": decimal(values["wind_gusts"]), "period": period, "seed": seed}
    if values.get("wind_turbulence"):
        size, seed = decimal(values["wind_turbulence_size"]), int(values["wind_seed"])
        out["turbulence"] = {
            "intensity": decimal(values["wind_turbulence"]),
            "size": size,
            "seed": seed,
        }
    if values.get("use_wind_shelter"):
        out["shelter"] = True
    if vertices is not None:
        out["region"] = {"vertices": list(vertices)}
    return out


def water(values: Values) -> dict[str, Any] | None:
    """The water around a cloth; None if there is none."""
    if not values.get("use_water"):
        return None
    out: dict[str, Any] = {
        "kind": "water",
        "level": decimal(values["water_level"]),
        "velocity": [decimal(value) for value in values["water_velocity"]],
        "density": decimal(values["water_density"]),
        "drag_coefficient": decimal(values["water_drag"]),
        "friction_coefficient": decimal(values["water_friction"]),
    }
    if values["wave_amplitude"]:
        angle = decimal(values["wave_angle"])
        out["waves"] = [
            {
                "amplitude": decimal(values["wave_amplitude"]),
                "length": decimal(values["wave_length"]),
                "direction": [math.cos(angle), math.sin(angle), 0.0],
            }
        ]
    return out


def bulk(values: Values) -> dict[str, Any]:
    """How a cloth meets water; nothing where there is none."""
    if not values.get("use_water"):
        return {}
    out: dict[str, Any] = {
        key: decimal(values[key]) for key, plain in _BULK.items() if decimal(values[key]) != plain
    }
    if values["water_hull"] != "auto":
        out["hull"] = values["water_hull"] == "dry"
    if values["absorbency"]:
        out["soak_time"] = decimal(values["soak_time"])
        if values["dry_time"]:
            out["dry_time"] = decimal(values["dry_time"])
    return out
