"""The picture of tearing: a ball goes through a sheet, in a Blender without the add-on, beside the forces in the sheet before.

Usage: .venv/bin/python scripts/torn.py [--readme]: out/torn/ with torn.blend, its cache and torn.png.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import embedded
from environment import OUT, SCRIPTS

SMALL = SCRIPTS / "pictures" / "torn.jpg"
COLUMNS, ROWS = 65, 61
WIDTH, HEIGHT = 1.5, 1.4
"""Of the sheet (m)."""
STRETCHED, TORN = 16, 40
"""Frames of the pictures: just before it tears, and when the ball is through."""
SIZE = (560, 620)
SAMPLES = 32


def main() -> None:
    """Make the picture, or one of a file that is opened without the add-on."""
    if sys.argv[1:2] == ["--alone"]:
        path, picture = sys.argv[2:4]
        photograph_alone(path, picture)
    parser = argparse.ArgumentParser(description=__doc__)
    embedded.make_picture(parser, make, SMALL)


def make(bpy: Any, _options: argparse.Namespace) -> Path:
    """Bake, save, and put both pictures side by side."""
    folder = OUT / "torn"
    folder.mkdir(parents=True, exist_ok=True)
    sheet = build(bpy)
    blend = folder / "torn.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    bpy.context.view_layer.objects.active = sheet
    bpy.ops.boucle.bake()
    print(sheet.boucle.status)
    bpy.ops.wm.save_mainfile()
    alone, forces = folder / "alone.png", folder / "forces.png"
    subprocess.run([sys.executable, __file__, "--alone", blend, alone], check=True)
    photograph_forces(bpy, sheet, forces)
    return side_by_side([forces, alone], folder / "torn.png")


def build(bpy: Any) -> Any:
    """The room, the ball and the sheet, which is held at its upper and lower edge."""
    import demo_look

    demo_look.build_room()
    demo_look.light_room()
    demo_look.place_camera()
    scene = bpy.context.scene
    scene.camera.location = (1.5, -3.6, 1.5)
    scene.camera.rotation_euler = demo_look.look(scene.camera.location, (0.05, 0.1, 1.08))
    scene.camera.data.lens = 62.0
    demo_look.prepare_render(*SIZE, SAMPLES)
    scene.frame_end = TORN
    bpy.ops.mesh.primitive_uv_sphere_add(
        segments=48, ring_count=24, radius=0.17, location=(0.0, -1.0, 1.15)
    )
    ball = bpy.context.object
    ball.data.materials.append(demo_look.material("Ball", (0.05, 0.09, 0.16), roughness=0.35))
    for polygon in ball.data.polygons:
        polygon.use_smooth = True
    for frame, y in ((1, -0.35), (24, 0.62), (TORN, 0.72)):
        ball.location.y = y
        ball.keyframe_insert("location", frame=frame)
    ball.modifiers.new("Collision", "COLLISION")
    bpy.ops.boucle.add_cloth(
        vertices_x=COLUMNS, vertices_y=ROWS, size_x=WIDTH, size_y=HEIGHT, plane="xz",
        pins={"top", "bottom"}, location=(0.0, 0.0, 1.12),
    )  # fmt: skip
    sheet = bpy.context.object
    values = {
        "frame_end": TORN, "use_tear": True, "tear_stress": 220.0, "tear_noise": 0.15, "tear_seed": 4, "density": 0.15,
        "thickness": 0.004, "stretch": 900.0, "shear": 250.0, "bend": 2.0, "limiter": "none", "stiffness_from": "continuum",
        "use_force": True,
    }  # fmt: skip
    for name, value in values.items():
        setattr(sheet.boucle, name, value)
    sheet.data.materials.append(demo_look.material("Cloth", (0.72, 0.13, 0.07), roughness=0.8))
    for polygon in sheet.data.polygons:
        polygon.use_smooth = True
    thicken = sheet.modifiers.new("Thickness", "SOLIDIFY")
    thicken.thickness = 0.003
    return sheet


def photograph_alone(path: str, picture: str) -> None:
    """Render a frame of a file as a Blender shows it that has no add-on, and end the process."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    if hasattr(bpy.types.Object, "boucle"):
        raise RuntimeError("the add-on is there")
    photograph(bpy, TORN, picture)
    sys.stdout.flush()
    os._exit(0)


def photograph_forces(bpy: Any, sheet: Any, picture: Path) -> None:
    """The colours of the force in each edge, up to what an edge bears."""
    sheet.boucle.overlay, sheet.boucle.overlay_range = "force", "tear"
    bpy.context.scene.frame_set(STRETCHED)
    bpy.context.view_layer.objects.active = sheet
    bpy.ops.boucle.add_heat_map_material()
    photograph(bpy, STRETCHED, str(picture))


def photograph(bpy: Any, frame: int, picture: str) -> None:
    """Render a frame."""
    bpy.context.scene.frame_set(frame)
    bpy.context.scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)


def side_by_side(pictures: list[Path], path: Path) -> Path:
    """Pictures in a row."""
    from PIL import Image

    images = [Image.open(picture).convert("RGB") for picture in pictures]
    row = Image.new("RGB", (sum(image.width for image in images), images[0].height))
    x = 0
    for image in images:
        row.paste(image, (x, 0))
        x += image.width
    row.save(path)
    return path


if __name__ == "__main__":
    main()
