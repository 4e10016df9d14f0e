"""The thickness of cloths in the viewports: both sides of the surface as wires.

Blender calls `_draw` only while some cloth has Show Thickness on; without a window there is nothing to draw on. What was
computed of a cloth is kept until something changes in the scene: turning the view costs no more than drawing.
"""

from __future__ import annotations

from typing import Any

import bpy

from ..core import points, shell
from ..core.points import Points
from . import mesh_arrays, registry

_COLOR = (0.25, 0.65, 1.0, 0.35)

_rows = points.rows

_handle: Any = None
_batches: dict[int, Any] = {}
"""What is drawn of each cloth, by `session_uid`."""


def follow() -> None:
    """Draw if a cloth wants it, else stop."""
    global _handle
    forget()
    if not _has_window() or not any(obj.boucle.show_thickness for obj in registry.all_cloths()):
        end()
    elif _handle is None:
        _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")


def _has_window() -> bool:
    return not bpy.app.background


def end() -> None:
    """Draw no more."""
    global _handle
    forget()
    if _handle is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
        _handle = None


def forget() -> None:
    """Something has changed in the scene: compute anew at the next drawing."""
    _batches.clear()


def wires(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph
) -> tuple[tuple[Points, Points], Points] | None:
    """Both sides of a cloth as it is shown (m, world space, float32, flat) and the vertices of its edges, if it has any."""
    evaluated = obj.evaluated_get(depsgraph)
    mesh = evaluated.data
    to_world = mesh_arrays.world_matrix(evaluated)
    to_object = points.inverse(to_world)
    if to_object is None or mesh is None or not mesh.edges:
        return None
    positions = points.transform(mesh_arrays.read_positions(mesh), to_world, "f")
    normals = points.empty("f", len(positions))
    mesh.vertex_normals.foreach_get("vector", normals)
    normals = shell.normals_to_world(normals, to_object)
    return shell.sides(positions, normals, obj.boucle.thickness), mesh_arrays.edges(mesh)


def _draw() -> None:
    import gpu

    context = bpy.context
    space = context.space_data
    shown = [
        obj
        for obj in registry.cloths_of(context.scene)
        if obj.boucle.show_thickness and obj.visible_get() and obj.mode == "OBJECT"
    ]
    if not shown or (space is not None and not space.overlay.show_overlays):
        return
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.uniform_float("color", _COLOR)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("LESS_EQUAL")
    for obj in shown:
        if obj.session_uid not in _batches:
            _batches[obj.session_uid] = _batches_of(obj, context.evaluated_depsgraph_get(), shader)
        for batch in _batches[obj.session_uid]:
            batch.draw(shader)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def _batches_of(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, shader: Any) -> list[Any]:
    import gpu

    found = wires(obj, depsgraph)
    if found is None:
        return []
    both, ends = found
    pairs = _rows(ends, 2)
    order = gpu.types.GPUIndexBuf(type="LINES", seq=pairs)
    out = []
    for side in both:
        vertices = gpu.types.GPUVertBuf(shader.format_calc(), len(side) // 3)
        vertices.attr_fill("pos", _rows(side, 3))
        out.append(gpu.types.GPUBatch(type="LINES", buf=vertices, elem=order))
    return out
