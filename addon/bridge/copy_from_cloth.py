"""Settings of Blender's own Cloth modifier for our cloth of the same object."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import bpy
from mathutils import Vector

from ..core import blender_cloth, points
from ..core.blender_cloth import Reading
from ..core.refusal import Refusal
from . import animation, mesh_arrays, rest, vertex_groups
from .vertex_groups import ANY


def find(obj: bpy.types.Object) -> bpy.types.ClothModifier | None:
    """The Cloth modifier of an object, if it has one."""
    return next((modifier for modifier in obj.modifiers if modifier.type == "CLOTH"), None)


def copy(obj: bpy.types.Object) -> tuple[str, bool]:
    """Carry the settings over and switch the modifier off.

    Returns:
        What was done in words, and whether all could be carried over.

    Raises:
        Refusal: The mesh has no area or no edges.
    """
    modifier = find(obj)
    reading = _read(obj, modifier)
    lost = [row.label for row in blender_cloth.rows() if not _carry(obj.boucle, row, reading)]
    if animation.moves(obj, f'modifiers["{modifier.name}"].'):
        lost.append("its animation")
    modifier.show_viewport = modifier.show_render = False
    return blender_cloth.sentence(obj.name, modifier.name, reading, lost), not lost


def _carry(settings: bpy.types.PropertyGroup, row: blender_cloth.Row, reading: Reading) -> bool:
    """Set one property; False if something that is used has no place here, or a number no room in its range."""
    *groups, name = row.target.split(".")
    for group in groups:
        settings = getattr(settings, group, None)
    if settings is None or name not in settings.bl_rna.properties:
        return not row.is_used(reading)
    value = row.value(reading)
    if value is None and settings.bl_rna.properties[name].type != "POINTER":
        return True
    try:
        setattr(settings, name, value)
    except (AttributeError, TypeError, ValueError):  # a property of this name, but of another kind
        return not row.is_used(reading)
    kept = getattr(settings, name)
    return not isinstance(value, float) or math.isclose(kept, value, rel_tol=1e-5, abs_tol=1e-12)


def _read(obj: bpy.types.Object, modifier: bpy.types.ClothModifier) -> Reading:
    values = {**_plain(modifier.settings), **_plain(modifier.collision_settings)}
    values |= {name: getattr(modifier.point_cache, name) for name in ("frame_start", "frame_end")}
    weights = modifier.settings.effector_weights
    values |= {f"weight_{name}": value for name, value in _plain(weights).items()}
    key = modifier.settings.rest_shape_key
    values["rest_shape_key"] = key.name if key is not None else ""
    area, edge = _measure(obj)
    if not area > 0.0 or not edge > 0.0:
        raise Refusal(
            f'"{obj.name}" has an area of {area:g} m² and edges of {edge:g} m: '
            "a cloth with faces is needed"
        )
    return Reading(values, len(obj.data.vertices), area, edge, _soft_pins(obj, modifier))


def _soft_pins(obj: bpy.types.Object, modifier: bpy.types.ClothModifier) -> int:
    group = modifier.settings.vertex_group_mass
    every, firm = (len(vertex_groups.vertices(obj, group, weight)) for weight in (ANY, 1.0))
    return every - firm


def _plain(struct: bpy.types.bpy_struct) -> dict[str, Any]:
    names = (prop.identifier for prop in struct.bl_rna.properties)
    return {name: getattr(struct, name) for name in names if name != "rna_type"}


def _measure(obj: bpy.types.Object) -> tuple[float, float]:
    """Area (m²) and mean edge length (m) of the rest shape, in world space as Blender's cloth is."""
    mesh = obj.data
    matrix = mesh_arrays.world_matrix(obj)
    flat = points.transform(rest.positions(mesh), matrix, "d")
    places = [Vector(flat[k : k + 3]) for k in range(0, len(flat), 3)]
    area = 0.0
    for polygon in mesh.polygons:
        first, *others = (places[vertex] for vertex in polygon.vertices)
        arms = [place - first for place in others]
        crosses = (a.cross(b) for a, b in pairwise(arms))
        area += 0.5 * sum(crosses, Vector((0.0, 0.0, 0.0))).length
    ends = mesh_arrays.edges(mesh)
    lengths = [(places[ends[k]] - places[ends[k + 1]]).length for k in range(0, len(ends), 2)]
    return area, sum(lengths) / len(lengths) if lengths else 0.0
