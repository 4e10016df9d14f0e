"""What passes through what, exactly: the solver counts it in a scene that is built for the question alone."""

from __future__ import annotations

import json
from array import array
from collections.abc import Iterator, Sequence
from typing import Any

import bpy

from .. import native
from ..core import crossing_scene, points
from ..core.mesh_check import Problem, Severity
from ..core.points import Points
from ..core.refusal import Refusal
from . import mesh_arrays, registry, settings, shown, start_pose
from .colliders import Arrays

MOST_OBJECTS = 32
"""Objects whose boxes meet the cloth's that are looked at closely, the nearest in name first."""

Box = tuple[Sequence[float], Sequence[float]]
"""Least and greatest corner (m, world space)."""


def at_start(obj: bpy.types.Object, scene: bpy.types.Scene) -> list[Problem]:
    """What the cloth passes through at its start frame: itself and its colliders."""
    try:
        start = start_pose.sample(obj, scene)
    except Refusal:
        return []  # said as an error of its own
    found = []
    scenes = (
        (crossing_scene.against_itself(start.description), [], "itself", "part its layers"),
        (
            crossing_scene.against_colliders(start.description), start.colliders,
            "what it collides with", "move it or the objects apart",
        ),
    )  # fmt: skip
    for asked, arrays, whom, cure in scenes:
        vertices = _crossing(obj, asked, start.given.mesh[0], arrays) if asked else []
        if vertices:
            sentence = (
                f'"{obj.name}" passes through {whom} at the start frame, at {len(vertices)} vertices: '
                f"{cure}, or let it come free by itself in the first frames"
            )
            found.append(Problem(Severity.WARNING, sentence, vertices))
    return found


def strangers(obj: bpy.types.Object, scene: bpy.types.Scene) -> list[Problem]:
    """Objects that the cloth passes through in the frame that is shown, because they are no colliders."""
    matrix = mesh_arrays.world_matrix(obj)
    world = points.transform(shown.positions(obj, scene), matrix, "d")
    depsgraph = registry.depsgraph_of(obj, scene)
    try:
        description = settings.describe(obj, scene, with_groups=False)
    except Refusal:
        return []  # said as an error of its own
    near = [other for other in _candidates(obj, depsgraph) if _meet(_box(world), _box_of(other))]
    found = []
    for other in sorted(near, key=lambda other: other.name)[:MOST_OBJECTS]:
        asked = crossing_scene.against(description, other.name)
        vertices = _crossing(obj, asked, world, [_arrays(other)])
        if vertices:
            sentence = (
                f'"{obj.name}" passes through "{other.name}", which has no Collision physics: make '
                "it a collider if the cloth shall lie on it"
            )
            found.append(Problem(Severity.HINT, sentence, vertices, other.name))
    return found


def _candidates(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph
) -> Iterator[bpy.types.Object]:
    """Evaluated meshes that are seen and no colliders, but those that follow the cloth."""
    for other in depsgraph.objects:
        if other.type != "MESH" or other.original == obj or not other.data.polygons:
            continue
        if other.is_instancer or _follows(other.original, obj):
            continue
        if not any(modifier.type == "COLLISION" for modifier in other.original.modifiers):
            yield other


def _follows(other: bpy.types.Object, obj: bpy.types.Object) -> bool:
    return other.parent == obj or any(
        getattr(modifier, "target", None) == obj for modifier in other.modifiers
    )


def _crossing(
    obj: bpy.types.Object, asked: dict[str, Any], world: Points, arrays: Sequence[Arrays]
) -> list[int]:
    try:
        faces = mesh_arrays.topology(obj.data)
        mesh = (world, faces.starts, faces.corners)
        solver = native.simulation(json.dumps(asked), [mesh], colliders=arrays)
    except native.FAILURES:
        return []  # a mesh that the solver does not take: said as an error of its own, or not the cloth's
    counts = points.empty("f", len(world) // 3)
    solver.read_intersections(0, counts)
    return [vertex for vertex, count in enumerate(counts) if count > 0.0]


def _arrays(evaluated: bpy.types.Object) -> Arrays:
    faces = mesh_arrays.topology(evaluated.data)
    local = mesh_arrays.read_positions(evaluated.data)
    world = points.transform(local, mesh_arrays.world_matrix(evaluated), "d")
    return world, faces.starts, faces.corners


def _box(world: Points) -> Box:
    axes = [world[axis::3] for axis in range(3)]
    return [min(axis) for axis in axes], [max(axis) for axis in axes]


def _box_of(evaluated: bpy.types.Object) -> Box:
    flat = [value for corner in evaluated.bound_box for value in corner]
    return _box(points.transform(array("d", flat), mesh_arrays.world_matrix(evaluated), "d"))


def _meet(one: Box, other: Box) -> bool:
    return all(
        one[0][axis] <= other[1][axis] and other[0][axis] <= one[1][axis] for axis in range(3)
    )
