"""`bench bridge`: the time that the add-on's frame handler takes to show a frame of 100 000 vertices.

A cloth is played live for some frames inside the embedded Blender; then its frames in memory are shown again, and
the handler is timed: what Blender itself does at a frame change is not ours and is printed apart. Measured for
both ways of showing: into the mesh, and through a temporary PC2 where the mesh must not be written.

Then cloths of 128² vertices are baked, and what is not the solver's time is told as a share of the whole: sampling of
pins and of colliders, writing of frames and checkpoints. Blender's own change of the frame is told apart.
"""

from __future__ import annotations

import importlib
import time
from typing import Any

import embedded
from bench import median, table, verdict
from environment import OUT

SIDE = 316
"""316² = 99 856 vertices."""
FRAMES = 6
ROUNDS = 5
TARGET_MILLISECONDS = 3.0
BAKE_SIDE = 128
BAKE_FRAMES = 24
TARGET_SHARE = 0.1


def bench() -> dict[str, Any]:
    """Time both ways, print the table and return the numbers."""
    bpy = embedded.start(OUT / "bench" / "blender")
    handler = Stopwatch(bpy)
    rows = [measure(bpy, handler, way) for way in ("mesh", "temporary PC2")]
    headings = [
        "way",
        "handler, shown again (ms)",
        "whole frame change (ms)",
        "handler, simulated (ms)",
    ]
    keys = ("way", "shown_ms", "frame_change_ms", "simulated_ms")
    print(f"{SIDE**2} vertices")
    print(table(headings, [[row[key] for key in keys] for row in rows]))
    slowest = max(row["shown_ms"] for row in rows)
    print(verdict(f"below {TARGET_MILLISECONDS} ms in our handler", slowest < TARGET_MILLISECONDS))
    bakes = [measure_bake(bpy, scene) for scene in ("held", "held, moving collider", "two cloths")]
    headings = ["bake", "whole (ms/frame)", "Blender (ms/frame)", "ours (ms/frame)", "our share"]
    keys = ("scene", "whole_ms", "blender_ms", "ours_ms", "share")
    print(f"{BAKE_SIDE}² vertices a cloth, {BAKE_FRAMES} frames")
    print(table(headings, [[row[key] for key in keys] for row in bakes]))
    largest = max(row["share"] for row in bakes)
    print(verdict(f"below {TARGET_SHARE:.0%} in our bridge", largest < TARGET_SHARE))
    return {"vertices": SIDE**2, "ways": rows, "bakes": bakes}


def measure_bake(bpy: Any, scene: str) -> dict[str, Any]:
    """Bake in this Blender and split the time by what it was spent on."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    cloths = []
    for number in range(2 if scene == "two cloths" else 1):
        bpy.ops.boucle.add_cloth(
            vertices_x=BAKE_SIDE, vertices_y=BAKE_SIDE, size_x=2.0, size_y=2.0, plane="xy"
        )
        cloth = bpy.context.object
        cloth.location.z = 4.0 * number
        cloth.boucle.frame_start, cloth.boucle.frame_end = 1, BAKE_FRAMES
        cloth.boucle.self_collision = False  # where little touches, the bridge weighs most
        cloth.boucle.use_strain = True
        cloths.append(cloth)
    if scene == "held, moving collider":
        bpy.ops.mesh.primitive_grid_add(
            x_subdivisions=BAKE_SIDE, y_subdivisions=BAKE_SIDE, location=(0.0, 0.0, -6.0)
        )
        ground = bpy.context.object
        ground.modifiers.new("Collision", "COLLISION")
        ground.keyframe_insert("location", frame=1)
        ground.location.z = -5.0
        ground.keyframe_insert("location", frame=BAKE_FRAMES)
    bpy.context.view_layer.update()
    blender = 0.0

    class Timed(importlib.import_module(f"{embedded.MODULE}.bridge.bake").Bake):
        def _go_to(self, frame: int) -> None:
            nonlocal blender
            started = time.perf_counter()
            super()._go_to(frame)
            blender += time.perf_counter() - started

    inside, begun = 0.0, 0.0
    for step in Timed(cloths, bpy.context.scene).steps():
        if not begun:
            step.run()  # the solver is built: once, whatever the number of frames
            begun, blender = time.perf_counter(), 0.0
            continue
        step.run()
        inside += step.seconds
    whole = time.perf_counter() - begun
    per_frame = 1e3 / BAKE_FRAMES
    ours = whole - inside - blender
    return {
        "scene": scene,
        "whole_ms": whole * per_frame,
        "blender_ms": blender * per_frame,
        "ours_ms": ours * per_frame,
        "share": ours / whole,
    }


class Stopwatch:
    """Stands in for the add-on's frame handler and times it."""

    def __init__(self, bpy: Any) -> None:
        handlers = importlib.import_module(f"{embedded.MODULE}.handlers")
        self._handler = handlers.frame_change_post
        self.milliseconds = 0.0
        listeners = bpy.app.handlers.frame_change_post
        listeners.remove(self._handler)
        listeners.append(self)

    def __call__(self, *arguments: Any) -> None:
        """Call the add-on's handler."""
        started = time.perf_counter()
        self._handler(*arguments)
        self.milliseconds = 1e3 * (time.perf_counter() - started)


def measure(bpy: Any, handler: Stopwatch, way: str) -> dict[str, Any]:
    """Play a cloth, then show its frames again in changing order."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    bpy.ops.boucle.add_cloth(vertices_x=SIDE, vertices_y=SIDE)
    cloth = bpy.context.object
    cloth.boucle.frame_start, cloth.boucle.frame_end = 1, FRAMES
    cloth.boucle.self_collision = False  # the bridge is measured, not the solver
    cloth.boucle.stretch, cloth.boucle.shear, cloth.boucle.bend = 50.0, 10.0, 1.0
    if way != "mesh":
        cloth.shape_key_add(name="Basis")  # a mesh with shape keys is not written to
    simulated = [go_to(bpy, handler, frame)[0] for frame in range(1, FRAMES + 1)][1:]
    check_it_moves(bpy, cloth)
    shown = [go_to(bpy, handler, frame) for _ in range(ROUNDS) for frame in (2, 5, 3, FRAMES, 4)]
    return {
        "way": way,
        "shown_ms": median([ours for ours, _whole in shown]),
        "frame_change_ms": median([whole for _ours, whole in shown]),
        "simulated_ms": median(simulated),
    }


def go_to(bpy: Any, handler: Stopwatch, frame: int) -> tuple[float, float]:
    """Milliseconds of our handler, and of the whole change to `frame`."""
    started = time.perf_counter()
    bpy.context.scene.frame_set(frame)
    return handler.milliseconds, 1e3 * (time.perf_counter() - started)


def check_it_moves(bpy: Any, cloth: Any) -> None:
    """Check that two frames look different, or the times are those of doing nothing.

    Raises:
        SystemExit: They look alike.
    """
    heights = []
    for frame in (2, FRAMES):
        bpy.context.scene.frame_set(frame)
        evaluated = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get())
        heights.append(evaluated.data.vertices[0].co.z)
    if abs(heights[0] - heights[1]) < 1e-6:
        raise SystemExit(f"the cloth does not move between frames: {heights} m")
