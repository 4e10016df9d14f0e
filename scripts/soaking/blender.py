"""A cloth in embedded Blender that is baked, freed and played live, over and over."""

from __future__ import annotations

import gc
import importlib
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import embedded

from .watch import Watch, gauge, resident_bytes

SIDE = 16
FRAMES = 12
TELL_ROUNDS = 20


def soak(watch: Watch, folder: Path, rounds: int) -> None:
    """Bake, look, free, play live and let go, so many times."""
    bpy = embedded.start(folder / "blender")
    set_up(bpy, folder)
    for number in range(1, rounds + 1):
        for name, work in (("bake, free", bake), ("play live", play)):
            before = gauge()
            begin = time.process_time()
            rows = work(bpy)
            seconds = time.process_time() - begin
            watch.add(name, rows, seconds, (before + gauge()) / 2.0)
        gc.collect()
        watch.memory.append(resident_bytes())
        if number % TELL_ROUNDS == 0:
            memory = watch.memory[-1] / 1e6
            print(f"round {number}: {watch.frames} frames, {memory:.1f} MB", flush=True)


def set_up(bpy: Any, folder: Path) -> None:
    """A sheet over a cube that is a collider, in a saved file."""
    bpy.ops.mesh.primitive_cube_add(size=0.5)
    bpy.context.object.modifiers.new("Collision", "COLLISION")
    bpy.ops.boucle.add_cloth(vertices_x=SIDE, vertices_y=SIDE, size_x=1.0, size_y=1.0, plane="xy")
    cloth = bpy.context.object
    cloth.name, cloth.location.z = "Cloth", 0.4
    cloth.boucle.frame_start, cloth.boucle.frame_end = 1, FRAMES
    cloth.boucle.thickness = 0.01
    cloth.boucle.use_strain = True
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "soak.blend"))


def bake(bpy: Any) -> Sequence[Mapping[str, Any]]:
    """Bake, play what is baked, and free it; the rows of its report."""
    bpy.context.view_layer.objects.active = cloth = bpy.data.objects["Cloth"]
    bpy.ops.boucle.bake()
    path = addon("bridge.cache").own_files(cloth).report
    rows = addon("core.report").read(path)["frames"]
    for frame in range(1, FRAMES + 1):
        bpy.context.scene.frame_set(frame)
    bpy.ops.boucle.free_bake()
    return rows


def play(bpy: Any) -> Sequence[Mapping[str, Any]]:
    """Play live from the start; a row for each frame simulated."""
    bpy.context.scene.frame_set(1)
    bpy.ops.boucle.reset()
    cloth = bpy.data.objects["Cloth"]
    rows = []
    for frame in range(1, FRAMES + 1):
        bpy.context.scene.frame_set(frame)
        rows.append(dict(addon("bridge.certificate").row_of(cloth, bpy.context.scene)))
    bpy.context.scene.frame_set(1)
    bpy.ops.boucle.reset()
    return rows


def addon(name: str) -> Any:
    """A module of the add-on."""
    return importlib.import_module(f"{embedded.MODULE}.{name}")
