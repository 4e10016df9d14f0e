"""A new user's way in Blender's window, from the zip to a rendered picture, in the scene that Blender starts with.

Every click is one of the mouse, made by the script outside. Only the drop of the zip on the window is the operator that
Blender calls for it, since no file manager runs here; it counts as a click. Runs inside Blender, pulled by gui_inside.py.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy

from gui_scenario import MODULE, area, draw, on_screen, window

MOST_CLICKS, MOST_SECONDS = 10, 120
"""The second, on a machine that has nothing else to do."""
PLAYED = 16
"""Frames that the new user watches before the bake."""
FRAMES = 250
"""Blender's own range, which the bake goes through."""
PICTURE = (640, 430)
RENDERED = (640, 360)
RENDERED_AT = (208, 240)
"""Where the picture is seen, about."""
ADD, PLAY = (283, 13), (551, 13)
PHYSICS, BAKE = (15, 334), (124, 334)
RENDER, RENDER_IMAGE = (129, 14), (170, 38)
"""Where the buttons stand, in pixels from the corners of the regions that hold them, in Blender 4.3 at this window's size."""
WAIT = 240.0

Step = Iterator[Any]
Place = tuple[int, int]


class Way:
    """What the way has taken so far."""

    clicks = 0
    began = 0.0
    photographing = 0.0
    """Seconds that taking pictures took, which no user spends."""

    @classmethod
    def seconds(cls) -> float:
        """Since the first click, without the time for pictures."""
        return time.monotonic() - cls.began - cls.photographing


def click(place: Place) -> Step:
    """Move the mouse there and click."""
    Way.clicks += 1
    yield {"do": "move", "to": place}
    yield 0.15
    yield {"do": "press", "button": 1}
    yield {"do": "release", "button": 1}
    yield 0.5


def hover(*places: Place) -> Step:
    """Move the mouse, which opens menus without a click."""
    for place in places:
        yield {"do": "move", "to": place}
        yield 0.6


def picture(
    name: str, corner: Place, mark: Place | None = None, size: tuple[int, int] = PICTURE
) -> Step:
    """Photograph a part of the window; the mark is where the next click goes."""
    began = time.monotonic()
    yield from draw()
    yield {"do": "photo", "name": f"path_{name}", "part": (*corner, *size), "mark": mark}
    Way.photographing += time.monotonic() - began


def corner_of(kind: str, region: str = "WINDOW") -> Place:
    """The upper left corner of a region of the window's area of a kind."""
    part = next(one for one in area(kind).regions if one.type == region)
    return on_screen(part.x, part.y + part.height)


def beside(place: Place, x: int, y: int) -> Place:
    """A place so many pixels to the right of and below another."""
    return place[0] + x, place[1] + y


def wait_for(done: Callable[[], bool], what: str) -> Step:
    """Wait until it is so."""
    until = time.monotonic() + WAIT
    while not done():
        assert time.monotonic() < until, f"{what} not within {WAIT:.0f} s"
        yield 0.1


def drop_the_zip_on_the_window() -> Step:
    """The zip dropped, and OK."""
    yield from draw(seconds=120.0)  # software compiles the shaders first
    assert MODULE not in bpy.context.preferences.addons
    names = sorted(obj.name for obj in bpy.data.objects)
    assert names == ["Camera", "Cube", "Light"], f"a fresh Blender holds {names}"
    use_the_processor()
    zip_file = next(Path(bpy.utils.resource_path("USER")).parent.glob("*.zip"))
    dropped = beside(corner_of("VIEW_3D"), 539, 392)
    yield from hover(dropped)
    Way.began = time.monotonic()
    Way.clicks += 1
    with bpy.context.temp_override(window=window(), area=area("VIEW_3D")):
        bpy.ops.extensions.package_install_files("INVOKE_DEFAULT", url=str(zip_file))
    yield 0.5
    okay = beside(dropped, -61, 93)
    yield from picture("1_install", beside(dropped, -390, -150), okay)
    yield from click(okay)
    yield from wait_for(lambda: MODULE in bpy.context.preferences.addons, "installed")
    return told()


def use_the_processor() -> None:
    """Render by what this machine has, and where it is seen: EEVEE wants a graphics card, a new window a window manager."""
    render = bpy.context.scene.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = RENDERED
    bpy.context.scene.cycles.samples = 32
    bpy.context.scene.cycles.use_denoising = False  # Debian's Blender cannot
    bpy.context.preferences.view.render_display_type = "AREA"


def add_a_cloth_from_the_menu() -> Step:
    """Add > Mesh > Boucle Cloth > Drape over Selected, over the cube that Blender starts with."""
    add = beside(corner_of("VIEW_3D", "HEADER"), *ADD)
    yield from click(add)
    yield from hover(beside(add, 20, 24), beside(add, 177, 25), beside(add, 227, 240))
    drape = beside(add, 423, 352)
    yield from hover(beside(add, 377, 240), drape)
    yield from picture("2_add", (beside(add, -40, 0)[0], 0), drape)
    yield from click(drape)
    yield from wait_for(lambda: "Drape" in bpy.data.objects, "added")
    assert bpy.data.objects["Drape"].boucle.enabled
    assert bpy.data.objects["Cube"].collision.use
    return told()


def play() -> Step:
    """The timeline's button."""
    button = beside(corner_of("DOPESHEET_EDITOR", "HEADER"), *PLAY)
    yield from click(button)
    yield from wait_for(lambda: bpy.context.scene.frame_current >= PLAYED, f"frame {PLAYED}")
    seen = beside(button, -320, -530)
    yield from picture("3_play", seen, button, (PICTURE[0], 560))
    return told()


def bake() -> Step:
    """The Physics tab, and Bake, while it still plays."""
    tabs = corner_of("PROPERTIES", "NAVIGATION_BAR")
    yield from click(beside(tabs, *PHYSICS))
    button = beside(tabs, *BAKE)
    yield from click(button)
    yield from wait_for(lambda: not bpy.ops.boucle.bake.poll(), "the bake begun")
    corner = beside(button, -300, -300)
    yield from picture("4_bake", corner, button, (window().width - corner[0], PICTURE[1]))
    yield from wait_for(bpy.ops.boucle.bake.poll, "baked")
    status = bpy.data.objects["Drape"].boucle.status
    assert status.startswith(f"Baked: frames 1 to {FRAMES}"), status
    return told()


def render() -> Step:
    """Render > Render Image."""
    done: list[bool] = []
    for ends in (bpy.app.handlers.render_complete, bpy.app.handlers.render_cancel):
        ends.append(lambda *_, good=ends is bpy.app.handlers.render_complete: done.append(good))
    yield from click(RENDER)
    yield from picture("5_render", (0, 0), RENDER_IMAGE)
    yield from click(RENDER_IMAGE)
    yield from wait_for(lambda: bool(done), "rendered")
    assert done[0], "the render was not completed"
    said, seconds = told(), Way.seconds()
    yield 2.0
    yield {"do": "photo", "name": "path_6_rendered", "part": (*RENDERED_AT, *PICTURE), "mark": None}
    assert Way.clicks <= MOST_CLICKS, said
    shared = max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))
    assert seconds <= MOST_SECONDS * shared, said
    return f"{said}; {shared:.1f} processes for each core"


def told() -> str:
    """What the way has taken so far."""
    return f"{Way.clicks} clicks, {Way.seconds():.0f} s"


PHASES = ((drop_the_zip_on_the_window, add_a_cloth_from_the_menu, play, bake, render),)
