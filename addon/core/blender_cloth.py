"""What the settings of Blender's own Cloth modifier are in ours, row by row.

Blender scales gravity by 0.001 and nothing else: its forces are kilonewtons (all of this measured in Blender: hanging strips
to five digits, at any frame rate; sheets under pressure to four). With tension T and mean edge length e (m) a spring is as
stiff as

```text
k = 1000 T / e        (N/m)
```

so that cloth hangs as far under its own weight. Its unit of time is a frame; that in which kilonewtons, kilograms and
metres agree is `1/sqrt(1000)` s, so that a damping c is `1000 c / sqrt(1000)` (N s/m): the same part of the critical one.

A bent edge of width w between faces that reach h has the moment `50 B w h` (N m/rad). Our bend springs join vertices over two
edges and grow stiff only as they bend; they are made to ask the same work for a fold of 90 degrees:

```text
1/2 50 B e² (pi/2)² = 1/2 k ((2 - sqrt 2) e)²
```
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

FORCE = 1000.0
"""Newtons in Blender's unit of force."""
TIME = 1.0 / math.sqrt(FORCE)
"""Seconds in the unit of time that goes with it."""
_FOLD = ((math.pi / 2.0) / (2.0 - math.sqrt(2.0))) ** 2
"""Stiffness of a bend spring times e², for each unit of a hinge's: equal work at 90 degrees."""
_HINGE = 50.0
"""Moment (N m/rad) of Blender's hinge for each unit of its bending stiffness, of its width and of its faces' reach (m)."""
_PERCENT = 0.01


class Reading(NamedTuple):
    """A Cloth modifier and the mesh that it moves."""

    values: Mapping[str, Any]
    """Its settings by Blender's names; those of effector weights begin with `weight_`."""
    vertex_count: int
    area: float
    """Of the cloth (m²)."""
    edge: float
    """Mean length of its edges (m)."""
    soft_pins: int = 0
    """Vertices of its pin group whose weight is below 1."""


class Row(NamedTuple):
    """One setting of ours and what it gets."""

    target: str
    """The property of `object.boucle`, or of a group in it; empty where we have no such thing."""
    value: Callable[[Reading], Any]
    """None leaves the property as it is."""
    label: str
    """What Blender's panels call it."""
    is_used: Callable[[Reading], bool] = lambda _: False
    """Whether it is a loss where we have no such property."""


def density(reading: Reading) -> float:
    """Areal density (kg/m²): Blender gives every vertex the same mass."""
    return reading.values["mass"] * reading.vertex_count / reading.area


def spring(name: str) -> Callable[[Reading], float]:
    """The stiffness (N/m) of springs that Blender divides by the mean edge length."""
    return lambda reading: FORCE * reading.values[name] / reading.edge


def damper(name: str) -> Callable[[Reading], float]:
    """The damping (N·s/m) of a spring."""
    return lambda reading: FORCE * TIME * reading.values[name]


def bend(reading: Reading) -> float:
    """The stiffness (N/m) of bend springs."""
    stiffness = reading.values["bending_stiffness"]
    if reading.values["bending_model"] == "LINEAR":  # a spring over two edges, like ours
        return FORCE * stiffness / (20.0 * reading.edge)
    return _HINGE * stiffness * _FOLD


def bend_damping(reading: Reading) -> float:
    """The damping (N·s/m) of bend springs: in the ratio to the stiffness that Blender's has."""
    damping = reading.values["bending_damping"]
    if reading.values["bending_model"] == "LINEAR":
        return bend(reading) * damping * TIME
    return FORCE * TIME * damping / 4.0 * _FOLD  # a hinge's is 1/4 c e² (N m s/rad)


def pressure(reading: Reading) -> float:
    """The pressure (N/m²) besides that of the volume: Blender's is in units of its scale, which is in kilopascals."""
    return FORCE * reading.values["uniform_pressure_force"] * reading.values["pressure_factor"]


def pin_stiffness(reading: Reading) -> float | None:
    """The stiffness (N/m) of a patch of soft pins together: Blender's is that of each vertex at weight 1."""
    stiffness = spring("pin_stiffness")(reading)
    return stiffness * reading.soft_pins if reading.soft_pins else None


def thickness(reading: Reading) -> float:
    """How far the cloth reaches (m): two layers keep twice of it, an object once and its own thickness."""
    if reading.values["use_self_collision"]:
        return reading.values["self_distance_min"] / 2.0
    return reading.values["distance_min"]


def quality(reading: Reading) -> str:
    """Our quality by Blender's steps a frame: its default is 5, its presets for stiff cloth take 12 and 15."""
    steps = reading.values["quality"]
    return "draft" if steps < 5 else "normal" if steps < 10 else "final"


def _as_it_is(name: str) -> Callable[[Reading], Any]:
    return lambda reading: reading.values[name]


def _always(value: Any) -> Callable[[Reading], Any]:
    return lambda _: value


def _used(name: str, unused: Any = False) -> Callable[[Reading], bool]:
    return lambda reading: reading.values.get(name, unused) not in {unused, "", None}


def _group_differs(group: str) -> Callable[[Reading], bool]:
    return lambda reading: bool(reading.values[group])


ROWS = (
    Row("model", _always("springs"), "Model"),
    Row("mass_mode", _always("density"), "Mass"),
    Row("density", density, "Vertex Mass"),
    Row("mass_per_vertex", _as_it_is("mass"), "Vertex Mass"),  # for whoever switches to it
    Row("stiffness_from", _always("springs"), "Stiffness"),
    Row("stretch", spring("tension_stiffness"), "Tension"),
    Row("shear", spring("shear_stiffness"), "Shear"),
    Row("bend", bend, "Bending"),
    Row("damping_per_kind", _always(True), "Damping"),
    Row("damping_stretch", damper("tension_damping"), "Tension Damping"),
    Row("damping_shear", damper("shear_damping"), "Shear Damping"),
    Row("damping_bend", bend_damping, "Bending Damping"),
    Row("damping_law", _always("axial"), "Damping"),
    Row("air_damping", lambda r: _PERCENT * FORCE * TIME * r.values["air_damping"], "Air Viscosity"),
    Row("quality", quality, "Quality Steps"),
    Row("speed", _as_it_is("time_scale"), "Speed Multiplier", _used("time_scale", 1.0)),
    Row("pin_group", _as_it_is("vertex_group_mass"), "Pin Group"),
    Row("pin_stiffness", pin_stiffness, "Pin Stiffness"),
    Row("use_sewing_springs", _as_it_is("use_sewing_springs"), "Sewing", _used("use_sewing_springs")),
    Row("sewing_force_max", lambda r: FORCE * r.values["sewing_force_max"], "Max Sewing Force"),
    Row("shrink_min", _as_it_is("shrink_min"), "Shrinking Factor", _used("shrink_min", 0.0)),
    Row("shrink_max", _as_it_is("shrink_max"), "Max Shrinking"),
    Row("shrink_group", _as_it_is("vertex_group_shrink"), "Shrinking Group", _group_differs("vertex_group_shrink")),
    Row("rest_shape_key", _as_it_is("rest_shape_key"), "Rest Shape Key", _used("rest_shape_key")),
    Row("use_dynamic_mesh", _as_it_is("use_dynamic_mesh"), "Dynamic Mesh", _used("use_dynamic_mesh")),
    Row("use_pressure", _as_it_is("use_pressure"), "Pressure", _used("use_pressure")),
    Row("uniform_pressure_force", pressure, "Pressure"),
    Row("pressure_factor", lambda r: FORCE * r.values["pressure_factor"], "Pressure Scale"),
    Row("use_pressure_volume", _as_it_is("use_pressure_volume"), "Custom Volume"),
    Row("target_volume", _as_it_is("target_volume"), "Target Volume"),
    Row("pressure_group", _as_it_is("vertex_group_pressure"), "Pressure Vertex Group"),
    Row("object_collision", _as_it_is("use_collision"), "Object Collisions"),
    Row("collision_group", _as_it_is("vertex_group_object_collisions"), "Vertex Group"),
    Row("collision_collection", _as_it_is("collection"), "Collision Collection"),
    Row("self_collision", _as_it_is("use_self_collision"), "Self Collisions"),
    Row("self_collision_group", _as_it_is("vertex_group_self_collisions"), "Vertex Group"),
    Row("thickness", thickness, "Distance"),
    Row("friction", lambda r: _PERCENT * r.values["self_friction"], "Friction"),
    Row("frame_start", _as_it_is("frame_start"), "Simulation Start"),
    Row("frame_end", _as_it_is("frame_end"), "End"),
    # what has no counterpart
    Row("", _always(None), "Compression", lambda r: r.values["compression_stiffness"] != r.values["tension_stiffness"]),
    Row("", _always(None), "Internal Springs", _used("use_internal_springs")),
    Row("", _always(None), "Fluid Density", lambda r: r.values["use_pressure"] and r.values["fluid_density"] != 0.0),
    Row("", _always(None), "Structural Group", _group_differs("vertex_group_structural_stiffness")),
    Row("", _always(None), "Shear Group", _group_differs("vertex_group_shear_stiffness")),
    Row("", _always(None), "Bending Group", _group_differs("vertex_group_bending")),
    Row("", _always(None), "Impulse Clamping", _used("impulse_clamp", 0.0)),
    Row("", _always(None), "Self Impulse Clamping", _used("self_impulse_clamp", 0.0)),
)  # fmt: skip
"""Every setting that is carried over, in the order in which it is set."""

WEIGHTS = (
    "gravity", "all", "force", "vortex", "magnetic", "harmonic", "charge", "lennardjones", "wind",
    "curve_guide", "texture", "smokeflow", "turbulence", "drag", "boid",
)  # fmt: skip
"""Blender's field weights."""


def rows() -> tuple[Row, ...]:
    """All rows, those of the field weights last."""
    weights = (
        Row(
            f"field_weights.{name}",
            _as_it_is(f"weight_{name}"),
            f"Field Weight {name.title()}",
            _used(f"weight_{name}", 1.0),
        )
        for name in WEIGHTS
    )
    return (*ROWS, *weights, Row("field_weights.collection", _as_it_is("weight_collection"), "Effector Collection",
                                 _used("weight_collection", None)))  # fmt: skip


def sentence(name: str, modifier: str, reading: Reading, lost: list[str]) -> str:
    """What was done, with the numbers, and what could not be carried over."""
    said = (
        f'"{name}": {reading.vertex_count} vertices of {reading.values["mass"]:.3g} kg on '
        f"{reading.area:.3g} m² are {density(reading):.3g} kg/m²; a tension of "
        f"{reading.values['tension_stiffness']:.3g} on edges of {reading.edge:.3g} m is "
        f'{spring("tension_stiffness")(reading):.6g} N/m; the modifier "{modifier}" is off now'
    )
    return f"{said}. Not carried over: {', '.join(lost)}" if lost else said
