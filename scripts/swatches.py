"""Pictures of the fabric materials: a swatch of each, in rows, seen from 20 cm. `--readme` renews the one in scripts/pictures.

Leaves out/swatches.png. Runs in the Blender of .venv, with the add-on of this checkout.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from embedded import make_picture
from environment import OUT, SCRIPTS

SIDE = 0.075
"""Of a swatch (m)."""
STEP = 0.081
COLUMNS = 3
PIXELS = 260
"""A swatch, with the gap beside it."""
SAMPLES = 20
CELLS = 90
README = SCRIPTS / "pictures" / "swatches.jpg"


def lay_out(bpy: Any, keys: list[str]) -> None:
    """A cloth for each fabric, with a soft fold, in rows from the top left."""
    for number, key in enumerate(keys):
        row, column = divmod(number, COLUMNS)
        bpy.ops.boucle.add_cloth(
            vertices_x=CELLS,
            vertices_y=CELLS,
            size_x=SIDE,
            size_y=SIDE,
            plane="xy",
            pins={"top"},
            location=(column * STEP, -row * STEP, 0.0),
        )
        swatch = bpy.context.object
        swatch.boucle.use_live = False
        for vertex in swatch.data.vertices:
            vertex.co.z = height(vertex.co.x / SIDE, vertex.co.y / SIDE) * SIDE
        for polygon in swatch.data.polygons:
            polygon.use_smooth = True
        bpy.ops.boucle.add_material(fabric=key)


def height(x: float, y: float) -> float:
    """A fold that runs out across the swatch, by its width; x and y from -0.5 to 0.5."""
    along = x + 0.45 * y + 0.08 * math.sin(3.0 * y)
    fold = math.exp(-((along / 0.16) ** 2))
    return 0.11 * fold * (0.75 + 0.5 * y) + 0.025 * math.sin(4.0 * x - 3.0 * y)


def light(bpy: Any, rows: int) -> None:
    """Daylight from the left that grazes the threads, a pale sky, and a camera straight above."""
    scene = bpy.context.scene
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle, sun.color = 3.4, 0.12, (1.0, 0.96, 0.9)
    lamp = bpy.data.objects.new("Sun", sun)
    lamp.rotation_euler = (math.radians(38.0), math.radians(-38.0), 0.0)
    scene.collection.objects.link(lamp)
    world = bpy.data.worlds.new("Sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.86, 0.91, 1.0, 1.0)
    background.inputs["Strength"].default_value = 0.45
    scene.world = world
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = STEP * max(COLUMNS, rows)
    camera.location = (0.5 * STEP * (COLUMNS - 1), -0.5 * STEP * (rows - 1), 1.0)
    scene.collection.objects.link(camera)
    scene.camera = camera


def render(bpy: Any, options: argparse.Namespace) -> Path:
    """Write the picture."""
    import demo_look

    items = bpy.ops.boucle.add_material.get_rna_type().properties["fabric"].enum_items
    keys = [item.identifier for item in items]
    rows = math.ceil(len(keys) / COLUMNS)
    lay_out(bpy, keys)
    light(bpy, rows)
    demo_look.prepare_render(options.pixels * COLUMNS, options.pixels * rows, options.samples)
    picture = OUT / "swatches.png"
    bpy.context.scene.render.filepath = str(picture)
    bpy.ops.render.render(write_still=True)
    print(f"{picture}: {', '.join(item.name for item in items)}")
    return picture


def main() -> None:
    """Render, and shrink for the README if asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pixels", type=int, default=PIXELS, help="of a swatch")
    parser.add_argument("--samples", type=int, default=SAMPLES, help="a pixel")
    make_picture(parser, render, README)


if __name__ == "__main__":
    main()
