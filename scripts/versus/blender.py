"""Blender's own cloth on the sheet, with its default settings: `python -m versus.blender '{"side": 64, "frames": 24}'`.

Both kinds of collision are off. Its vertex mass is set so that the sheets weigh the same; such light vertices hardly fall
there, with or without damping, so that it is measured with its default mass (0.3 kg a vertex) as well.
"""

from __future__ import annotations

import json
import os
import sys
import time
from typing import Any

import numpy as np

from .child import follow, tell
from .sheet import FPS, Sheet


def cloth_object(bpy: Any, sheet: Sheet, frames: int) -> Any:
    """A mesh object with Blender's cloth modifier."""
    mesh = bpy.data.meshes.new("sheet")
    mesh.from_pydata(sheet.rest.tolist(), [], sheet.faces.tolist())
    cloth = bpy.data.objects.new("sheet", mesh)
    bpy.context.scene.collection.objects.link(cloth)
    group = cloth.vertex_groups.new(name="pins")
    group.add(sheet.pins, 1.0, "REPLACE")
    modifier = cloth.modifiers.new("cloth", "CLOTH")
    modifier.settings.vertex_group_mass = group.name
    modifier.collision_settings.use_collision = False
    modifier.collision_settings.use_self_collision = False
    modifier.point_cache.frame_start = 1
    modifier.point_cache.frame_end = frames + 1
    return cloth


def main(side: int, frames: int, seconds: float, default_mass: bool) -> None:
    """Measure as many frames as begin within some seconds, with our mass or Blender's default."""
    import bpy

    sheet = Sheet(side)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.fps = FPS
    started = time.perf_counter()
    cloth = cloth_object(bpy, sheet, frames)
    if not default_mass:
        cloth.modifiers["cloth"].settings.mass = sheet.mass_per_vertex
    scene.frame_set(1)
    set_up = time.perf_counter() - started
    positions = np.empty(3 * side * side, dtype=np.float32)

    def step() -> np.ndarray:
        scene.frame_set(scene.frame_current + 1)
        evaluated = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get())
        evaluated.data.vertices.foreach_get("co", positions)
        return positions

    result = follow(sheet, frames, step, seconds=seconds)
    quality = cloth.modifiers["cloth"].settings.quality
    tell({**result, "set_up_ms": 1e3 * set_up, "substeps": [quality] * len(result["ms"])})


if __name__ == "__main__":
    main(**json.loads(sys.argv[1]))
    os._exit(0)  # Blender may hang at its own end
