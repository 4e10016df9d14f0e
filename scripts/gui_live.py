"""How many frames a second Play shows of a live cloth in Blender's window, and what of a frame is whose.

Software draws here, on the cores that simulate: so the same frames are played from a bake as well, which is drawing alone, and
live without a viewport, which is our own work. Runs inside Blender, pulled by gui_inside.py.
"""

from __future__ import annotations

import importlib
import os
import time
from collections.abc import Iterator
from typing import Any

import bpy

from gui_scenario import MODULE, area, begin_bake, in_view, is_baking, window

COLUMNS = 64
FRAMES, DRAWN_FRAMES = 60, 24
"""Played without a viewport; played where every one is drawn."""
MOST_BESIDE = 0.003
"""Seconds a frame that our handler may take beside the solver's (design: 3 ms at 100k vertices)."""
WAIT = 180.0

Step = Iterator[Any]


class Clock:
    """How long our own handler takes: two more handlers, one before and one after it."""

    def __init__(self) -> None:
        """Begin to measure."""
        self.frames: list[float] = []
        self.handler: list[float] = []
        self.solver: list[float] = []
        """What of it the solver takes: from when it was told the frame's pins until its positions are read."""
        self._began = self._told = 0.0
        self._live = importlib.import_module(f"{MODULE}.bridge.live")
        self._moment = importlib.import_module(f"{MODULE}.core.bake").Moment
        self._theirs = self._moment.aim, self._live.read_positions
        self._moment.aim, self._live.read_positions = self._aim(), self._read
        ours = importlib.import_module(f"{MODULE}.handlers").frame_change_post
        self._list = bpy.app.handlers.frame_change_post
        self._both = (self._before, self._after)
        at = self._list.index(ours)
        self._list.insert(at, self._both[0])
        self._list.insert(at + 2, self._both[1])

    def _before(self, *_: Any) -> None:
        self._began = time.perf_counter()
        self.frames.append(self._began)

    def _after(self, *_: Any) -> None:
        self.handler.append(time.perf_counter() - self._began)

    def _aim(self) -> Any:
        theirs = self._theirs[0]

        def aim(moment: Any, solver: Any) -> None:
            theirs(moment, solver)
            self._told = time.perf_counter()

        return aim

    def _read(self, *arguments: Any) -> Any:
        self.solver.append(time.perf_counter() - self._told)
        return self._theirs[1](*arguments)

    def end(self) -> None:
        """Measure no more."""
        self._moment.aim, self._live.read_positions = self._theirs
        for handler in self._both:
            self._list.remove(handler)

    @property
    def rate(self) -> float:
        """Frames a second."""
        return (len(self.frames) - 1) / (self.frames[-1] - self.frames[0])

    @property
    def mean(self) -> float:
        """Seconds that the handler takes."""
        return sum(self.handler) / len(self.handler)


def played(frames: int) -> Step:
    """Play from the start by the operator of the button, and measure; the frame rate is the scene's at most."""
    bpy.context.scene.frame_set(1)
    yield 0.5
    with bpy.context.temp_override(window=window(), area=area("DOPESHEET_EDITOR")):
        bpy.ops.screen.animation_play()
    assert window().screen.is_animation_playing
    clock = Clock()
    until = time.monotonic() + WAIT
    while len(clock.frames) <= frames:
        assert time.monotonic() < until, f"{frames} frames take more than {WAIT:.0f} s"
        yield 0.1
    clock.end()
    with bpy.context.temp_override(window=window(), area=area("DOPESHEET_EDITOR")):
        bpy.ops.screen.animation_cancel(restore_frame=False)
    yield 0.5
    return clock


def sheet() -> bpy.types.Object:
    """A new scene with nothing but the sheet, which collides with itself."""
    for obj in [*bpy.data.objects]:
        bpy.data.objects.remove(obj)
    bpy.context.scene.frame_set(1)
    with in_view():
        bpy.ops.boucle.add_cloth(vertices_x=COLUMNS, vertices_y=COLUMNS)
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_all(center=True)
    obj = bpy.context.object
    assert obj.boucle.self_collision
    return obj


def play_at_24_frames_a_second() -> Step:
    """Live with and without a viewport, and baked."""
    obj = sheet()
    drawn = yield from played(DRAWN_FRAMES)
    bpy.ops.boucle.reset()
    view = area("VIEW_3D")
    view.type = "CONSOLE"
    yield 0.5
    bare = yield from played(FRAMES)
    seconds = bare.solver
    mean, most = sum(seconds) / len(seconds), max(seconds)
    beside = sorted(
        whole - part for whole, part in zip(bare.handler[-len(seconds) :], seconds, strict=True)
    )
    median = beside[len(beside) // 2]
    view.type = "VIEW_3D"
    obj.boucle.frame_end = DRAWN_FRAMES + 10
    yield from begin_bake(resume=False)
    while is_baking():
        yield 0.2
    baked = yield from played(DRAWN_FRAMES)
    load = os.getloadavg()[0]
    said = (
        f"live {drawn.rate:.1f} fps, without a viewport {bare.rate:.1f}, baked {baked.rate:.1f}; handler "
        f"{1e3 * bare.mean:.1f} ms, solver {1e3 * mean:.1f} ms (most {1e3 * most:.0f}), ours beside it "
        f"{1e3 * median:.1f} ms; load {load:.1f}"
    )
    assert median < MOST_BESIDE * max(1.0, load), said
    return said


STEPS = (play_at_24_frames_a_second,)
