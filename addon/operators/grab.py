"""Grab: drag a cloth with the mouse while it moves, without a timeline."""

from __future__ import annotations

import time
from contextlib import suppress

from bpy.types import Area, Context, Event, Operator, Region
from bpy_extras import view3d_utils
from mathutils import Vector

from .. import native
from .._identifiers import Operators
from ..bridge import picture, settings
from ..bridge.grab import Grab
from ..bridge.worker import Worker
from ..core.bake import Step
from ..core.refusal import Refusal, sentence_of
from .polling import can_simulate

_KEYS = "Drag to grab the cloth   |   P picture   |   O wireframe   |   Esc or right mouse ends"

_LEFT_TO_BLENDER = (
    "MIDDLEMOUSE",
    "WHEEL",
    "TRACKPAD",
    "MOUSEROTATE",
    "MOUSESMARTZOOM",
    "NDOF",
    "NUMPAD",
    "TIMER",
)
"""Beginnings of the names of events that look around, in the viewport too."""
_WALK = "ACCENT_GRAVE"
"""The key of walk navigation and of the view pie."""


class _Grabbing:
    """What Grab does, without Blender's part of an operator."""

    def invoke(self, context: Context, _event: Event) -> set[str]:
        """Let the cloth move on and listen to the mouse."""
        found = _viewport(context)
        if found is None:
            self.report({"ERROR"}, "Grab needs a 3D viewport: open one in this window")
            return {"CANCELLED"}
        self._area, self._region = found
        try:
            self._grab = Grab(context.object, context.scene, context.evaluated_depsgraph_get())
        except native.FAILURES as error:
            self.report({"ERROR"}, sentence_of(error))
            return {"CANCELLED"}
        self._begin(context)
        return {"RUNNING_MODAL"}

    def execute(self, _context: Context) -> set[str]:
        """A script has no mouse."""
        self.report(
            {"ERROR"}, "Grab needs a mouse: call it with 'INVOKE_DEFAULT', or use bridge.grab.Grab"
        )
        return {"CANCELLED"}

    def _begin(self, context: Context) -> None:
        self._worker = Worker()
        self._step: Step | None = None
        self._seconds = 1.0 / settings.world(context.scene).fps
        self._next = time.monotonic()
        manager = context.window_manager
        self._timer = manager.event_timer_add(0.5 * self._seconds, window=context.window)
        self._area.header_text_set(_KEYS)
        manager.modal_handler_add(self)

    def modal(self, context: Context, event: Event) -> set[str]:
        """Timer: simulate. Left mouse: grab. Navigation and what is outside of the viewport: Blender's own."""
        try:
            return self._answer(context, event)
        except native.FAILURES as error:
            self.report({"ERROR"}, sentence_of(error))
            return self._end(context, {"CANCELLED"})
        except Exception:
            self._end(context, {"CANCELLED"})
            raise

    def _answer(self, context: Context, event: Event) -> set[str]:
        if self._area.type != "VIEW_3D":
            return self._end(context, {"FINISHED"})
        if event.type == "TIMER":
            self._move_on(context)
            return {"PASS_THROUGH"}
        is_inside = self._is_inside(event)
        ends = event.type == "ESC" or (event.type == "RIGHTMOUSE" and is_inside)
        if ends and event.value == "PRESS":
            return self._end(context, {"FINISHED"})
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            self._grab.let_go()
            return {"RUNNING_MODAL"}
        if event.type == "MOUSEMOVE" and self._grab.grip is not None:
            origin, direction, normal = self._ray(event)
            self._grab.drag(origin, direction, normal)
            return {"RUNNING_MODAL"}
        if not is_inside or self._is_left_to_blender(event):
            return {"PASS_THROUGH"}
        if event.value == "PRESS":
            self._press(context, event)
        return {"RUNNING_MODAL"}

    def _press(self, context: Context, event: Event) -> None:
        if event.type == "LEFTMOUSE":
            origin, direction, _ = self._ray(event)
            self._grab.pick(origin, direction, context.evaluated_depsgraph_get())
        elif event.type == "O":
            overlay = self._area.spaces.active.overlay
            overlay.show_wireframes = not overlay.show_wireframes
        elif event.type == "P":
            self._take_picture(context)

    def _take_picture(self, context: Context) -> None:
        try:
            path = picture.path_for(self._grab.name)
            with context.temp_override(area=self._area, region=self._region):
                picture.take(context.scene, path)
        except Refusal as refusal:
            self.report({"WARNING"}, str(refusal))
            return
        self.report({"INFO"}, f"Picture saved: {path}")

    def _move_on(self, context: Context) -> None:
        """Show the step that is done and begin the next, at the scene's rate at the most."""
        if not self._worker.is_done(0.0):
            return
        if self._step is not None:
            step, self._step = self._step, None
            self._grab.show(step)
            self._area.tag_redraw()
        now = time.monotonic()
        if now >= self._next:
            self._next = max(self._next + self._seconds, now)
            self._step = self._grab.step(context.evaluated_depsgraph_get())
            self._worker.begin(self._step)

    def _ray(self, event: Event) -> tuple[Vector, Vector, Vector]:
        """The mouse's ray and the direction of the view, in the world."""
        at = (event.mouse_x - self._region.x, event.mouse_y - self._region.y)
        view = self._area.spaces.active.region_3d
        origin = view3d_utils.region_2d_to_origin_3d(self._region, view, at)
        direction = view3d_utils.region_2d_to_vector_3d(self._region, view, at)
        return origin, direction, view.view_rotation @ Vector((0.0, 0.0, -1.0))

    def _is_inside(self, event: Event) -> bool:
        """Whether the mouse is over the view itself, not over its header, toolbar or sidebar."""

        def holds(region: Region) -> bool:
            x, y = event.mouse_x - region.x, event.mouse_y - region.y
            return 0 <= x < region.width and 0 <= y < region.height

        others = (region for region in self._area.regions if region.type != "WINDOW")
        return holds(self._region) and not any(holds(r) for r in others if r.width > 1)

    def _is_left_to_blender(self, event: Event) -> bool:
        return event.type.startswith(_LEFT_TO_BLENDER) or event.type == _WALK or event.alt

    def cancel(self, context: Context) -> None:
        """Blender ends the operator: a file is loaded, or the window closes."""
        self._end(context, {"CANCELLED"})

    def _end(self, context: Context, outcome: set[str]) -> set[str]:
        self._worker.end()
        context.window_manager.event_timer_remove(self._timer)
        self._grab.end()
        with suppress(ReferenceError):  # the area may be gone
            self._area.header_text_set(None)
            self._area.tag_redraw()
        return outcome


def _viewport(context: Context) -> tuple[Area, Region] | None:
    """The 3D viewport of the context, or the largest of the window: the button stands in another editor."""
    if context.window is None:
        return None
    areas = [area for area in context.window.screen.areas if area.type == "VIEW_3D"]
    if context.area is not None and context.area.type == "VIEW_3D":
        areas = [context.area]
    if not areas:
        return None
    area = max(areas, key=lambda one: one.width * one.height)
    return area, next(region for region in area.regions if region.type == "WINDOW")


class BOUCLE_OT_grab(_Grabbing, Operator):
    """Drag the cloth with the mouse while it is simulated at the present frame, without playing"""

    bl_idname = Operators.GRAB
    bl_label = "Grab Cloth"
    bl_options = {"REGISTER"}  # without UNDO: the shape is live state, as after play

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file, while no bake runs."""
        return can_simulate(cls, context)


CLASSES = (BOUCLE_OT_grab,)
