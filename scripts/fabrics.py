"""A picture of six fabrics: the same square of cloth on a stand, in a row of named fabrics. `--readme` renews scripts/pictures.

Leaves out/fabrics.png. Simulates and renders in the Blender of .venv, with the add-on of this checkout.
"""

from __future__ import annotations

import argparse
import math
import time
from pathlib import Path
from typing import Any, NamedTuple

from embedded import make_picture
from environment import OUT, SCRIPTS


class Piece(NamedTuple):
    """One of the cloths."""

    preset: str
    """What it is made of."""
    look: str
    """What it looks like: a material of the Look panel."""
    color: tuple[float, float, float]
    """Linear."""


PIECES = (
    Piece("silk_chiffon", "satin", (0.62, 0.34, 0.30)),
    Piece("jersey_knit", "knit", (0.20, 0.30, 0.42)),
    Piece("linen", "weave", (0.62, 0.52, 0.38)),
    Piece("tweed_boucle", "boucle", (0.80, 0.70, 0.56)),
    Piece("denim", "denim", (0.030, 0.062, 0.165)),
    Piece("felt", "felt", (0.16, 0.25, 0.20)),
)
"""From the one that folds most finely to the one that hardly folds."""
SIDE = 0.9
"""Of a cloth (m)."""
STAND = 0.2
"""Radius (m) of the round plates that they lie on."""
HEIGHT = 0.5
COLUMNS = 3
STEP = (1.15, 2.0)
"""From one cloth to the next, across and back (m)."""
CELLS = 47
FRAMES = 60
PIXELS = (1260, 800)
SAMPLES = 32
TILT = math.radians(55.0)
"""How far the camera, which sees in parallel, is turned up from looking straight down."""
VIEW = 3.4
"""What it sees from left to right (m)."""
README = SCRIPTS / "pictures" / "fabrics.jpg"


def place_of(number: int) -> tuple[float, float]:
    """Where a cloth stands (m), in rows from the back left."""
    row, column = divmod(number, COLUMNS)
    across, back = STEP
    return (column - 0.5 * (COLUMNS - 1)) * across, (0.5 - row) * back


def build_stand(bpy: Any, x: float, y: float, material: Any) -> Any:
    """A plate on a rod; the plate is a collider."""
    bpy.ops.mesh.primitive_cylinder_add(
        vertices=96, radius=STAND, depth=0.03, location=(x, y, HEIGHT - 0.015)
    )
    plate = bpy.context.object
    plate.modifiers.new("Collision", "COLLISION")
    plate.collision.thickness_outer, plate.collision.cloth_friction = 0.003, 50.0
    bpy.ops.mesh.primitive_cylinder_add(
        vertices=32, radius=0.02, depth=HEIGHT - 0.03, location=(x, y, 0.5 * (HEIGHT - 0.03))
    )
    for part in (plate, bpy.context.object):
        part.data.materials.append(material)
    return plate


def drape(bpy: Any, piece: Piece, x: float, y: float, cells: int, frames: int) -> Any:
    """A square of a fabric, just above its plate, baked until it hangs."""
    bpy.ops.boucle.add_cloth(
        vertices_x=cells + 1, vertices_y=cells + 1, size_x=SIDE, size_y=SIDE, plane="xy",
        pins=set(), location=(x, y, HEIGHT + 0.007),
    )  # fmt: skip
    cloth, settings = bpy.context.object, bpy.context.object.boucle
    settings.thickness = 0.125 * SIDE / cells
    bpy.ops.boucle.apply_preset(preset=piece.preset)
    settings.model = "fabric"
    settings.use_live = False
    settings.frame_start, settings.frame_end = 1, frames
    # Air that stops a vertex within about a third of a second.
    settings.air_damping = 3.0 * settings.density * SIDE**2 / (cells + 1) ** 2
    began = time.monotonic()
    bpy.ops.boucle.bake()
    print(
        f"{settings.preset_title}: {time.monotonic() - began:.0f} s, {settings.status}", flush=True
    )
    bpy.ops.boucle.add_material(fabric=piece.look, color=piece.color)
    return cloth


def write_name(bpy: Any, text: str, x: float, y: float, material: Any) -> None:
    """The name of a fabric in front of it, turned to the camera."""
    curve = bpy.data.curves.new("Name", "FONT")
    curve.body, curve.size, curve.align_x = text, 0.105, "CENTER"
    curve.materials.append(material)
    name = bpy.data.objects.new("Name", curve)
    name.location, name.rotation_euler = (x, y - 0.62, 0.05), (TILT, 0.0, 0.0)
    bpy.context.scene.collection.objects.link(name)


def light(bpy: Any) -> None:
    """A floor, a lamp from the left that grazes the folds, a pale sky, and the camera."""
    import demo_look

    bpy.ops.mesh.primitive_plane_add(size=60.0)
    plaster = demo_look.material("Plaster", demo_look.WARM_WHITE, roughness=0.9)
    bpy.context.object.data.materials.append(plaster)
    middle = (0.0, 0.0, 0.3)
    demo_look.area_light("Key", (-4.5, -2.5, 4.2), middle, 1.6, 460.0, (1.0, 0.95, 0.88))
    demo_look.area_light("Fill", (4.5, -3.5, 2.5), middle, 3.0, 90.0, (0.78, 0.87, 1.0))
    world = bpy.data.worlds.new("Sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.86, 0.91, 1.0, 1.0)
    background.inputs["Strength"].default_value = 0.25
    bpy.context.scene.world = world
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", VIEW
    away, up = 12.0, 0.1
    camera.location = (
        0.0, up * math.cos(TILT) - away * math.sin(TILT), up * math.sin(TILT) + away * math.cos(TILT)
    )  # fmt: skip
    camera.rotation_euler = (TILT, 0.0, 0.0)
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def render(bpy: Any, options: argparse.Namespace) -> Path:
    """Simulate, and write the picture."""
    import demo_look

    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, options.frames
    brass = demo_look.material("Brass", demo_look.BRASS, metallic=1.0, roughness=0.35)
    ink = demo_look.material("Ink", (0.02, 0.02, 0.02), roughness=0.9)
    for number, piece in enumerate(PIECES):
        x, y = place_of(number)
        build_stand(bpy, x, y, brass)
        cloth = drape(bpy, piece, x, y, options.cells, options.frames)
        write_name(bpy, cloth.boucle.preset_title, x, y, ink)
        demo_look.refine(cloth)
        cloth.modifiers["Thickness"].thickness = 0.002
        for polygon in cloth.data.polygons:
            polygon.use_smooth = True
    light(bpy)
    scene.frame_set(options.frames)
    demo_look.prepare_render(*PIXELS, options.samples)
    picture = OUT / "fabrics.png"
    scene.render.filepath = str(picture)
    bpy.ops.render.render(write_still=True)
    print(picture)
    return picture


def main() -> None:
    """Simulate and render, and shrink for the README if asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=CELLS, help="along a side of a cloth")
    parser.add_argument("--frames", type=int, default=FRAMES, help="to simulate")
    parser.add_argument("--samples", type=int, default=SAMPLES, help="a pixel")
    make_picture(parser, render, README)


if __name__ == "__main__":
    main()
