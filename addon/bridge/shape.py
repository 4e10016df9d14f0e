"""What an object says of its cloth's shape: rest shape, shrink, pressure and seams."""

from __future__ import annotations

from typing import Any

import bpy

from ..core import mesh_check, points, shape
from ..core.points import Affine, Points
from ..core.refusal import Refusal
from ..core.shape import Shape, ShapeGroups
from . import animation, mesh_arrays, vertex_groups
from . import rest as kept_rest

SHRINK = ("shrink_min", "shrink_max")
PRESSURE = ("uniform_pressure_force", "pressure_factor", "target_volume")


def groups(obj: bpy.types.Object) -> ShapeGroups:
    """The weights of shrink and pressure, and the loose edges.

    Raises:
        Refusal: A vertex group or a shape key is named that the object does not have.
    """
    settings = obj.boucle
    rest_key(obj)
    shrink = weights(obj, "Shrink Group", settings.shrink_group)
    pressure = (
        weights(obj, "Pressure Group", settings.pressure_group) if settings.use_pressure else []
    )
    seams = loose_edges(obj.data) if settings.use_sewing_springs else None
    return ShapeGroups(shrink, pressure, seams)


def weights(obj: bpy.types.Object, label: str, name: str) -> list[float]:
    """The weight of every vertex in a group; none for no name."""
    if not name:
        return []
    vertex_groups.require(obj, label, name)
    found = [0.0] * len(obj.data.vertices)
    for vertex, weight in vertex_groups.weights(obj, name, 0.0).items():
        found[vertex] = min(1.0, shape.decimal(weight))
    return found


def loose_edges(mesh: bpy.types.Mesh) -> list[tuple[int, int]]:
    """Both vertices of every edge that no face has."""
    has_face = _edges_with_faces(mesh)
    if all(has_face):
        return []
    ends = mesh_arrays.edges(mesh)
    loose = (k for k in range(len(has_face)) if not has_face[k])
    return [(int(ends[2 * k]), int(ends[2 * k + 1])) for k in loose]


def face_edges(mesh: bpy.types.Mesh) -> Points:
    """The two vertices of each edge that has a face, flat."""
    has_face = _edges_with_faces(mesh)
    ends = mesh_arrays.edges(mesh)
    if all(has_face):
        return ends
    return [end for k in range(len(has_face)) if has_face[k] for end in ends[2 * k : 2 * k + 2]]


def _edges_with_faces(mesh: bpy.types.Mesh) -> bytearray:
    of_corners = points.empty("i", len(mesh.loops))
    mesh.loops.foreach_get("edge_index", of_corners)
    has_face = bytearray(len(mesh.edges))
    for edge in of_corners:
        has_face[edge] = 1
    return has_face


def rest_key(obj: bpy.types.Object) -> bpy.types.ShapeKey | None:
    """The shape key whose lengths hold, unless the rest shape follows the evaluated mesh."""
    name = obj.boucle.rest_shape_key
    if not name or obj.boucle.use_dynamic_mesh:
        return None
    keys = obj.data.shape_keys
    found = keys.key_blocks.get(name) if keys else None
    if found is None:
        known = ", ".join(f'"{key.name}"' for key in keys.key_blocks) if keys else "none"
        raise Refusal(
            f'"{obj.name}": Rest Shape Key "{name}" is not a shape key of the mesh '
            f"(it has {known}): choose one of them or clear the field"
        )
    return found


def rest(obj: bpy.types.Object, matrix: Affine) -> Points | None:
    """The rest shape (m, world space) where it is not that of the start."""
    key = rest_key(obj)
    if key is None:
        return None
    local = points.empty("f", 3 * len(key.data))
    key.data.foreach_get("co", local)
    return points.transform(local, matrix, "d")


def mean_edge(obj: bpy.types.Object) -> float:
    """The mean length (m, world space) of the edges of faces at rest.

    Raises:
        Refusal: The mesh has no such edges, or they have no length; or its rest shape key is not there.
    """
    matrix = mesh_arrays.world_matrix(obj)
    world = rest(obj, matrix)
    if world is None:
        world = points.transform(kept_rest.positions(obj.data), matrix, "d")
    lengths = mesh_check.edge_lengths([float(value) for value in world], face_edges(obj.data))
    total = sum(lengths)
    if not total > 0.0:
        raise Refusal(f'"{obj.name}" has edges of {total:g} m: a cloth with faces is needed')
    return total / len(lengths)


def at_frame(obj: bpy.types.Object, evaluated: Any, targets: Points | None) -> Shape:
    """The shape at the frame of an evaluated object, whose modifiers above the slot put its vertices there (m, world)."""
    settings = obj.boucle
    if not is_moving(obj):
        return Shape()
    names = (*SHRINK, *PRESSURE, "use_pressure_volume")
    now = {name: getattr(evaluated.boucle, name) for name in names}
    shrinks = bool(settings.shrink_group) or any(shape.shrink(now)) or _moves(obj, SHRINK)
    return Shape(
        targets if settings.use_dynamic_mesh else None,
        shape.shrink(now) if shrinks or settings.use_dynamic_mesh else None,
        shape.pressure(now) if settings.use_pressure else None,
    )


def is_moving(obj: bpy.types.Object) -> bool:
    """Whether the shape may change from frame to frame."""
    settings = obj.boucle
    return bool(
        settings.use_dynamic_mesh
        or settings.use_pressure
        or settings.shrink_group
        or settings.shrink_min
        or _moves(obj, SHRINK)
    )


def steady(obj: bpy.types.Object, description: dict[str, Any]) -> dict[str, Any]:
    """The description as a bake remembers it, whatever the frame."""
    settings = obj.boucle
    rest_shape = "dynamic" if settings.use_dynamic_mesh else settings.rest_shape_key
    parts = (("shrink", SHRINK, True), ("pressure", PRESSURE, settings.use_pressure))
    moving = [key for key, names, is_used in parts if is_used and _moves(obj, names)]
    return shape.steady(description, rest_shape, moving)


def _moves(obj: bpy.types.Object, names: tuple[str, ...]) -> bool:
    return any(animation.moves(obj, f"boucle.{name}") for name in names)
