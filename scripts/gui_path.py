"""A new user's way in Blender's window, from the zip to a rendered picture, in the scene that Blender starts with.

Every click is one of the mouse, made by the script outside. Only the drop of the zip on the window is the operator that
Blender calls for it, since no file manager runs here; it counts as a click. Runs inside Blender, pulled by gui_inside.py.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
from gui_scenario import MODULE, area, draw, on_screen, window

MOST_CLICKS, MOST_SECONDS = 10, 120
PLAYED = 30
"""Frames that the new user watches before the bake."""
FRAMES = 250
"""Blender's own range, which the bake goes through."""
PICTURE = (640, 430)
WAIT = 60.0

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


def picture(name: str, corner: Place, mark: Place | None = None) -> Step:
    """Photograph a part of the window; the mark is where the next click goes."""
    began = time.monotonic()
    yield from draw()
    yield {"do": "photo", "name": f"path_{name}", "part": (*corner, *PICTURE), "mark": mark}
    Way.photographing += time.monotonic() - began


def corner_of(kind: str, region: str = "WINDOW") -> Place:
    """The upper left corner of a region of the window's area of a kind."""
    part = next(one for one in area(kind).regions if one.type == region)
    return on_screen(part.x, part.y + part.height)


def beside(place: Place, x: int, y: int) -> Place:
    """A place so many pixels to the right of and below another."""
    return place[0] + x, place[1] + y


def wait_for(done: Any, what: str) -> Step:
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
    zip_file = next(Path(bpy.utils.resource_path("USER")).parent.glob("*.zip"))
    Way.began = time.monotonic()
    middle = (540, 420)
    yield from hover(middle)
    Way.clicks += 1
    with bpy.context.temp_override(window=window(), area=area("VIEW_3D")):
        bpy.ops.extensions.package_install_files("INVOKE_DEFAULT", url=str(zip_file))
    yield 1.0
    yield from picture("1_install", (middle[0] - 320, middle[1] - 215))
    return "dropped"


STEPS = (drop_the_zip_on_the_window,)
