"""The stages of the demo that run inside Blender, each in a process of its own: `demo_scene.py STAGE FOLDER`.

- bake: adds the cloth with the add-on's operator, bakes it with the add-on, saves curtain.blend
- still, video: open curtain.blend without the add-on, as a render farm would, and render it
"""

from __future__ import annotations

import json
import os
import shutil
import sys
import time
import traceback
from pathlib import Path
from typing import Any

FRAMES = 60
GATHER = (3, 28)
"""Frames between which the curtain is drawn together."""
WIDTH = 1.7
HEIGHT = 1.8
VERTICES = 96
ROD = 1.36
"""Length (m) of what is seen of the rod when the curtain is drawn together."""
RINGS = 11
GATHERED = 0.54
"""Distance of the rings when drawn together, as a fraction of what it was."""
PLEAT = 0.04
"""m; every other ring's point goes forward by this, the rest back."""
STILL = {"frame": 58, "width": 560, "height": 700, "samples": 14}
VIDEO = {"width": 256, "height": 320, "samples": 3}


def bake(folder: Path) -> None:
    """Build the scene around a cloth of the add-on, bake it, and leave what plays without the add-on."""
    import embedded

    bpy = embedded.start(folder / ".blender")
    import demo_look

    bpy.context.preferences.filepaths.save_version = 0  # no curtain.blend1
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.render.fps = 1, FRAMES, 24
    top = demo_look.TOP - 2.0 * demo_look.RING + 0.012
    bpy.ops.boucle.add_cloth(
        vertices_x=VERTICES,
        vertices_y=VERTICES,
        size_x=WIDTH,
        size_y=HEIGHT,
        plane="xz",
        pins={"top_left", "top_right"},
        location=(0.0, 0.0, top - 0.5 * HEIGHT),
    )
    cloth = bpy.context.object
    cloth.name = "Curtain"
    settings = cloth.boucle
    settings.frame_start, settings.frame_end = 1, FRAMES
    settings.density = 0.3
    settings.stretch, settings.shear, settings.bend = 600.0, 60.0, 1.0
    settings.damping = 0.008
    settings.deformation_rate = 0.10
    pins = hang(cloth)
    demo_look.dress(cloth, ROD)
    draw_together(cloth, pins, demo_look.build_rings([cloth.data.vertices[p].co.x for p in pins]))
    bpy.context.view_layer.objects.active = cloth
    scene.frame_set(1)
    blend = folder / "curtain.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    started = time.monotonic()
    if bpy.ops.boucle.bake() != {"FINISHED"}:
        raise RuntimeError("the bake did not finish")
    print(f"   {FRAMES} frames baked: {time.monotonic() - started:.1f} s")
    put_beside(cloth, bpy, folder)
    bpy.ops.wm.save_mainfile()
    shutil.rmtree(folder / ".blender")


def hang(cloth: Any) -> list[int]:
    """Pin the cloth at RINGS points of its top edge, the two corners among them, and return them."""
    row = VERTICES * (VERTICES - 1)
    pins = [row + round(i * (VERTICES - 1) / (RINGS - 1)) for i in range(RINGS)]
    cloth.vertex_groups[cloth.boucle.pin_group].add(pins, 1.0, "REPLACE")
    return pins


def draw_together(cloth: Any, pins: list[int], rings: list[Any]) -> None:
    """Animate pins and rings towards the middle: pins by a shape key, which the simulation samples."""
    cloth.shape_key_add(name="Basis")
    drawn = cloth.shape_key_add(name="Drawn")
    for number, (pin, ring) in enumerate(zip(pins, rings, strict=True)):
        place = cloth.data.vertices[pin].co
        forward = PLEAT if number % 2 else -PLEAT
        drawn.data[pin].co = (place.x * GATHERED, place.y + forward, place.z)
        for frame, x in zip(GATHER, (place.x, place.x * GATHERED), strict=True):
            ring.location.x = x
            ring.keyframe_insert("location", index=0, frame=frame)
    for frame, value in zip(GATHER, (0.0, 1.0), strict=True):
        drawn.value = value
        drawn.keyframe_insert("value", frame=frame)


def put_beside(cloth: Any, bpy: Any, folder: Path) -> None:
    """Move the cache and its report beside curtain.blend and let the Mesh Cache play it from there."""
    player = next(m for m in cloth.modifiers if m.type == "MESH_CACHE")
    cache = Path(bpy.path.abspath(player.filepath))
    shutil.move(cache, folder / "curtain.pc2")
    shutil.move(cache.with_suffix(".json"), folder / "report.json")
    player.filepath = "//curtain.pc2"
    shutil.rmtree(folder / "boucle_cache")
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    rows = report["frames"]
    worst = max(rows, key=lambda row: row["max_strain"])
    print(f"   largest strain {worst['max_strain']:.4f} at frame {worst['frame']}")
    if len(rows) != FRAMES:
        raise RuntimeError(f"the report has {len(rows)} frames, {FRAMES} were asked for")


def open_without_addon(folder: Path) -> Any:
    """Open curtain.blend in a Blender that has no add-on, and check that the cloth moves there."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(folder / "curtain.blend"))
    heights = []
    for frame in (1, FRAMES):
        bpy.context.scene.frame_set(frame)
        curtain = bpy.data.objects["Curtain"].evaluated_get(bpy.context.evaluated_depsgraph_get())
        heights.append(min(vertex.co.x for vertex in curtain.data.vertices))
    if abs(heights[1] - heights[0]) < 0.1:
        raise RuntimeError(f"the curtain does not move without the add-on: {heights}")
    return bpy


def still(folder: Path) -> None:
    """Render curtain.png."""
    bpy = open_without_addon(folder)
    import demo_look

    demo_look.prepare_render(STILL["width"], STILL["height"], STILL["samples"])
    scene = bpy.context.scene
    scene.frame_set(STILL["frame"])
    scene.render.filepath = str(folder / "curtain.png")
    bpy.ops.render.render(write_still=True)


def video(folder: Path) -> None:
    """Render curtain.mp4."""
    bpy = open_without_addon(folder)
    import demo_look

    demo_look.flatten(bpy.data.objects["Curtain"])
    demo_look.prepare_render(VIDEO["width"], VIDEO["height"], VIDEO["samples"])
    render = bpy.context.scene.render
    render.image_settings.file_format = "FFMPEG"
    render.ffmpeg.format, render.ffmpeg.codec = "MPEG4", "H264"
    render.ffmpeg.constant_rate_factor = "HIGH"
    render.use_file_extension = False
    render.filepath = str(folder / "curtain.mp4")
    bpy.ops.render.render(animation=True)


if __name__ == "__main__":
    stage = {"bake": bake, "still": still, "video": video}[sys.argv[1]]
    try:
        stage(Path(sys.argv[2]).resolve())
    except BaseException:  # noqa: BLE001 (told in full; the exit code says it too)
        traceback.print_exc()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(1)
    # Some renders hang when Blender ends; everything is written by now.
    sys.stdout.flush()
    os._exit(0)
