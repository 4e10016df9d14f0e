"""What is unusual about a cloth's object and scene: units, scale, thickness, support, frames, users of its mesh."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
from mathutils import Vector

from ..core import mesh_check, points
from ..core.mesh_check import Problem, Severity
from ..core.points import Points
from . import colliders, mesh_arrays, rest, slot, vertex_groups

UNEVEN = 1e-3
"""Relative difference of an object's scales from which on it is told."""


def problems(obj: bpy.types.Object, scene: bpy.types.Scene) -> Iterator[Problem]:
    """Warnings and hints, each with its cure."""
    yield from _units(scene)
    yield from _scale(obj)
    if not obj.data.is_editmode:
        world = points.transform(rest.positions(obj.data), mesh_arrays.world_matrix(obj), "d")
        yield from _thickness(obj, world)
        yield from _support(obj, scene, world)
    yield from _fabric(obj)
    yield from _frames(obj, scene)
    yield from _users(obj)
    yield from _stack(obj)


def _units(scene: bpy.types.Scene) -> Iterator[Problem]:
    scale = scene.unit_settings.scale_length
    if abs(scale - 1.0) > 1e-6:
        yield _warning(
            f"Unit Scale of the scene is {scale:.4g}: Boucle takes a Blender unit for 1 m all the same, "
            f"so cloth falls and bends as if it were {1.0 / scale:.4g} times as large as it says: set "
            f"Unit Scale to 1 and scale the scene by {scale:.4g}"
        )


def _scale(obj: bpy.types.Object) -> Iterator[Problem]:
    sizes = [abs(value) for value in obj.matrix_world.to_scale()]
    if max(sizes) - min(sizes) > UNEVEN * max(sizes):
        text = ", ".join(f"{value:.4g}" for value in sizes)
        yield _warning(
            f'"{obj.name}": its scale is uneven ({text}): cloth has the scaled shape, but modifiers below '
            "Boucle's and texture coordinates the unscaled one: apply the scale (Ctrl A)"
        )


def _thickness(obj: bpy.types.Object, world: Points) -> Iterator[Problem]:
    if not obj.boucle.self_collision:
        return
    ends = mesh_arrays.edges(obj.data)
    for problem in mesh_check.thick_for_edges(world, ends, obj.boucle.thickness):
        yield problem._replace(sentence=f'"{obj.name}": {problem.sentence}')


def _fabric(obj: bpy.types.Object) -> Iterator[Problem]:
    settings = obj.boucle
    if settings.model != "fabric":
        return
    if not settings.is_implicit:
        yield _warning(
            f'"{obj.name}" is of fabric, which is stiff, and its integrator is explicit: it takes many '
            "steps: choose BDF2 or Implicit Euler under Solver"
        )
    large = [face for face in obj.data.polygons if face.loop_total > 4]
    if large:
        sentence = (
            f'"{obj.name}": {len(large)} faces have more than four corners: fabric cuts each into triangles '
            "from one corner, so that it bends unevenly there: triangulate them (Edit Mode, Ctrl T)"
        )
        vertices = sorted({vertex for face in large for vertex in face.vertices})
        yield Problem(Severity.HINT, sentence, vertices)


def _support(obj: bpy.types.Object, scene: bpy.types.Scene, world: Points) -> Iterator[Problem]:
    group = obj.boucle.pin_group
    if group and obj.vertex_groups.get(group) is None:
        return  # said as an error of its own
    if group and vertex_groups.vertices(obj, group):
        return
    why = f'no vertex is in the Pin Group "{group}"' if group else "no Pin Group is set"
    if not scene.use_gravity or scene.gravity.length == 0.0:
        return
    if not any(_is_below(other, world) for other in colliders.find(obj, scene)):
        yield _warning(
            f'"{obj.name}": {why} and no object with Collision physics is below, so the cloth falls '
            "freely: pin some of it, or give what shall catch it Collision physics"
        )


def _is_below(other: bpy.types.Object, world: Points) -> bool:
    """Whether a part of the object is lower than the cloth's highest point and under or over its outline."""
    corners = [other.matrix_world @ corner for corner in map(Vector, other.bound_box)]
    for axis in (0, 1):
        if max(corner[axis] for corner in corners) < min(world[axis::3]):
            return False
        if min(corner[axis] for corner in corners) > max(world[axis::3]):
            return False
    return min(corner.z for corner in corners) < max(world[2::3])


def _frames(obj: bpy.types.Object, scene: bpy.types.Scene) -> Iterator[Problem]:
    first, last = obj.boucle.frame_start, obj.boucle.frame_end
    if first > last:
        return  # said as an error of its own
    if first + 1 < scene.frame_start:
        yield _warning(
            f'"{obj.name}" begins at frame {first} and the scene plays from {scene.frame_start} on, so '
            f"it never moves live: set the cloth's Start to {scene.frame_start}, or bake"
        )
    if first > scene.frame_end:
        yield _warning(
            f'"{obj.name}" begins at frame {first}, after the scene\'s last frame {scene.frame_end}: '
            "lower the cloth's Start"
        )
    elif last < scene.frame_end:
        yield _hint(
            f'"{obj.name}" stops at frame {last} and the scene plays to {scene.frame_end}: raise the '
            "cloth's End if it shall move on"
        )


def _users(obj: bpy.types.Object) -> Iterator[Problem]:
    mesh = obj.data
    if mesh.users - mesh.use_fake_user > 1:
        yield _hint(
            f'"{obj.name}" shares its mesh "{mesh.name}" with others: its strain and contacts are not '
            "shown on it: make the mesh single-user (Object > Relations)"
        )


def _stack(obj: bpy.types.Object) -> Iterator[Problem]:
    if slot.find(obj) is None:
        return  # said as an error of its own
    hiding = slot.COUNT_CHANGING - slot.KEEPING_FIRST - {"NODES"}
    for modifier in slot.below(obj):
        if modifier.type in hiding and modifier.show_viewport:
            yield _hint(
                f'"{obj.name}": the modifier "{modifier.name}" below Boucle\'s hides the cloth\'s own '
                "vertices, so pins cannot follow it live: switch it off in the viewport to play, or bake"
            )


def _warning(sentence: str) -> Problem:
    return Problem(Severity.WARNING, sentence)


def _hint(sentence: str) -> Problem:
    return Problem(Severity.HINT, sentence)
