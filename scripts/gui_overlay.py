"""The heat maps in Blender's window, each photographed with its legend, and the same in Material Preview.

Runs inside Blender, pulled by gui_inside.py.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import bpy

from gui_scenario import Skipped, area, draw, in_view, photo

FRAMES = 16
"""Until the sheet lies on the ball and still moves."""
PREVIEW_SECONDS = 120.0
"""Software that has not drawn Material Preview by then will not do so in time."""

Step = Iterator[Any]


def look_at(make: Any) -> None:
    """An empty scene with what `make` adds, seen from a little above."""
    for obj in [*bpy.data.objects]:
        bpy.data.objects.remove(obj)
    bpy.context.scene.frame_set(1)
    with in_view():
        make()
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=0.5, type="ORBITUP")
        bpy.ops.view3d.view_all(center=True)


def sheet_on_a_ball() -> None:
    """A ball that is a collider, and above it a sheet that is held by a side."""
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, segments=48, ring_count=24)
    bpy.context.object.modifiers.new("Collision", "COLLISION")
    bpy.ops.boucle.add_cloth(
        vertices_x=48, vertices_y=48, plane="xy", pins={"left"}, location=(0.0, 0.0, 0.6)
    )


def sheet_through_a_box() -> None:
    """A sheet that begins inside a collider: every edge on its rim passes through faces."""
    bpy.ops.mesh.primitive_cube_add(size=0.8)
    bpy.context.object.modifiers.new("Collision", "COLLISION")
    bpy.ops.boucle.add_cloth(vertices_x=32, vertices_y=32, plane="xy")


def the_cloth() -> bpy.types.Object:
    """The only cloth."""
    return next(obj for obj in bpy.context.scene.objects if obj.boucle.enabled)


def play_to(last: int) -> None:
    """Live, without drawing between the frames."""
    for frame in range(1, last + 1):
        bpy.context.scene.frame_set(frame)


def show(quantity: str) -> Step:
    """One heat map, photographed in the viewport."""
    obj = the_cloth()
    obj.boucle.overlay = quantity
    yield from photo(f"overlay_{quantity}", area("VIEW_3D"))
    return legend_of(obj)


def legend_of(obj: bpy.types.Object) -> str:
    """What the legend says, from the drawing's own state."""
    import importlib

    view = importlib.import_module("bl_ext.user_default.boucle.bridge.overlay_view")
    batch, _, legend = view._shown[obj.session_uid]
    assert batch is not None, legend.title
    return f"{legend.title} {legend.ticks[0].text} to {legend.ticks[-1].text}"


def heat_maps_of_forces() -> Step:
    """Strain, tension and contact of a sheet on a ball."""
    look_at(sheet_on_a_ball)
    the_cloth().boucle.overlay = "strain"
    play_to(FRAMES)
    told = []
    for quantity in ("strain", "tension", "contact"):
        told.append((yield from show(quantity)))
    return "; ".join(told)


def thickness_as_wires() -> Step:
    """Both sides of the cloth."""
    obj = the_cloth()
    obj.boucle.overlay = "none"
    obj.boucle.thickness = 0.01  # it begins anew
    obj.boucle.show_thickness = True
    play_to(FRAMES)
    yield from photo("overlay_thickness", area("VIEW_3D"))
    obj.boucle.show_thickness = False
    return "1 cm"


def heat_map_of_intersections() -> Step:
    """What passes through what, in the first frames of a tangled start."""
    look_at(sheet_through_a_box)
    the_cloth().boucle.overlay = "intersection"
    play_to(2)
    return (yield from show("intersection"))


def material_preview() -> Step:
    """The heat map over EEVEE's shading, if software can draw that in time."""
    look_at(sheet_on_a_ball)
    the_cloth().boucle.overlay = "strain"
    play_to(FRAMES)
    shading = area("VIEW_3D").spaces.active.shading
    before = shading.type
    shading.type = "MATERIAL"
    began = time.monotonic()
    try:
        yield from draw(seconds=PREVIEW_SECONDS)
        yield from photo("overlay_preview", area("VIEW_3D"))
    except AssertionError as late:
        raise Skipped(f"software does not draw EEVEE: {late}") from late
    finally:
        shading.type = before
        the_cloth().boucle.overlay = "none"
    return f"drawn in {time.monotonic() - began:.0f} s"


STEPS = (
    heat_maps_of_forces,
    thickness_as_wires,
    heat_map_of_intersections,
    material_preview,
)
