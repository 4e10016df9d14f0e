"""Blender's own cloth on the falling sheet: `python -m versus.blender_drop '{"side": 64, "frames": 36, "seconds": 60}'`.

Default settings, the vertex mass too (0.3 kg), with self-collision on; the ball has a Collision modifier with its defaults.
"""

from __future__ import annotations

import json
import os
import sys
import time
from typing import Any

import numpy as np

from .blender import cloth_object
from .boucle_drop import self_intersections
from .child import follow, peak_memory, tell
from .drop import CHECKED, RADIUS, Drop
from .sheet import FPS

SEGMENTS, RINGS = 64, 32
"""Of the ball, which is a mesh here."""


def add_ball(bpy: Any) -> None:
    """A ball that cloth collides with."""
    import bmesh

    mesh = bpy.data.meshes.new("ball")
    work = bmesh.new()
    bmesh.ops.create_uvsphere(work, u_segments=SEGMENTS, v_segments=RINGS, radius=RADIUS)
    work.to_mesh(mesh)
    work.free()
    ball = bpy.data.objects.new("ball", mesh)
    bpy.context.scene.collection.objects.link(ball)
    ball.modifiers.new("collision", "COLLISION")


def main(side: int, frames: int, seconds: float) -> None:
    """Measure as many frames as begin within some seconds."""
    import bpy

    sheet = Drop(side)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.fps = FPS
    started = time.perf_counter()
    add_ball(bpy)
    cloth = cloth_object(bpy, sheet, frames)
    collisions = cloth.modifiers["cloth"].collision_settings
    collisions.use_collision = collisions.use_self_collision = True
    scene.frame_set(1)
    set_up = time.perf_counter() - started
    shapes = []

    def step() -> np.ndarray:
        scene.frame_set(scene.frame_current + 1)
        evaluated = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get())
        positions = np.empty(3 * side * side, dtype=np.float32)
        evaluated.data.vertices.foreach_get("co", positions)
        shapes.append(positions)
        return positions

    result = follow(sheet, frames, step, seconds=seconds)
    result["peak_bytes"] = peak_memory()  # before the checks
    result["intersections"] = self_intersections(sheet, shapes)
    result["ipctk"] = sheet.crosses_itself(shapes[-CHECKED:])
    result["depth"] = max(map(sheet.depth, shapes))
    tell({**result, "set_up_ms": 1e3 * set_up})


if __name__ == "__main__":
    main(**json.loads(sys.argv[1]))
    os._exit(0)  # Blender may hang at its own end
