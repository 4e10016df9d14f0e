"""The frame that was just baked, in the viewports while a bake runs: wires beside the rest shape, which pins are sampled from.

They are drawn and nothing else: to let the object itself play the unfinished cache would move what follows the cloth, and with
it, perhaps, what the cloth collides with. Without a window there is nothing to draw on.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import bpy

from ..core import pc2, points
from ..core.points import Points
from ..core.refusal import CacheRefusal
from ..core.torn import Layout
from . import mesh_arrays, registry, tearing

_COLOR = (1.0, 0.62, 0.25, 0.6)


class Growing(NamedTuple):
    """What is drawn of a cloth."""

    path: str
    """The PC2 that grows."""
    edges: Points
    """Both points of each edge, int32, flat."""


_handle: Any = None
_growing: dict[int, Growing] = {}
"""Of each cloth that is baked, by `session_uid`."""
_batches: dict[int, tuple[int, Any]] = {}
"""What is drawn of each, and how many samples the file held."""


def growing(obj: bpy.types.Object, path: str, layout: Layout | None) -> Growing:
    """What to draw of a cloth; nothing is looked up where there is nothing to draw on."""
    if not _has_window():
        return Growing(path, points.empty("i", 0))
    mesh = obj.data
    return Growing(path, tearing.sides(mesh, layout) if layout else mesh_arrays.edges(mesh))


def begin(those: Mapping[int, Growing]) -> None:
    """Draw the last frame of these files from now on."""
    global _handle
    end()
    if _has_window():
        _growing.update(those)
        _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")


def end() -> None:
    """Draw no more."""
    global _handle
    _growing.clear()
    _batches.clear()
    if _handle is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
        _handle = None


def _has_window() -> bool:
    return not bpy.app.background


def last_frame(path: str, known: int) -> tuple[int, Points | None]:
    """How many samples a growing file holds, and the last (m, object space) if it holds others than `known`."""
    try:
        count = pc2.read_header(path).sample_count
        if count in (0, known):
            return count, None
        return count, pc2.read_sample(path, count - 1)
    except CacheRefusal:  # not begun yet
        return 0, None


def _draw() -> None:
    import gpu

    space = bpy.context.space_data
    if space is not None and not space.overlay.show_overlays:
        return
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("NONE")  # the rest shape, which is shown too, must not hide it
    for uid, (path, edges) in _growing.items():
        obj = registry.by_uid(uid)
        if obj is None or not obj.visible_get():
            continue
        known = _batches.get(uid, (0, None))
        count, positions = last_frame(path, known[0])
        if positions is not None:
            known = _batches[uid] = (count, _batch(edges, positions, shader))
        if known[1] is not None:
            with gpu.matrix.push_pop():
                gpu.matrix.multiply_matrix(obj.matrix_world)
                shader.uniform_float("color", _COLOR)
                known[1].draw(shader)
    gpu.state.blend_set("NONE")


def _batch(edges: Points, positions: Points, shader: Any) -> Any:
    import gpu

    vertices = gpu.types.GPUVertBuf(shader.format_calc(), len(positions) // 3)
    vertices.attr_fill("pos", points.rows(positions, 3))
    order = gpu.types.GPUIndexBuf(type="LINES", seq=points.rows(edges, 2))
    return gpu.types.GPUBatch(type="LINES", buf=vertices, elem=order)
