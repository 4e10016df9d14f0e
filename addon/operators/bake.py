"""Bake: in a window with a worker thread and a status bar, in a script to the end at once."""

from __future__ import annotations

import time
from collections.abc import Iterator

import bpy
from bpy.props import BoolProperty
from bpy.types import Context, Event, Operator, Timer

from .. import native
from .._identifiers import Operators
from ..bridge import runtime
from ..bridge.bake import Bake, Options, outcome
from ..bridge.worker import Worker
from ..core.bake import Step
from .polling import can_simulate, cloths_of, is_free

_TICK = 0.02
"""Seconds between two looks at the worker."""
_PATIENCE = 0.03
"""Seconds that one look may take, in which the window cannot answer: short frames are baked several at a look."""


class _Baking:
    """What Bake and Bake All share: pulling the steps of one cloth after another."""

    resume: BoolProperty(
        name="Resume",
        description="Go on where a bake was stopped; without one, begin",
        default=False,
        options={"SKIP_SAVE"},
    )

    def cloths(self, context: Context) -> list[bpy.types.Object]:
        """What to bake."""
        raise NotImplementedError

    def invoke(self, context: Context, _event: Event) -> set[str]:
        """Bake beside a living window."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self._begin(context)
        return {"RUNNING_MODAL"}

    def _begin(self, context: Context) -> None:
        self._bakes = self._make_bakes(context)
        self._current: Bake | None = None
        self._steps: Iterator[Step] | None = None
        self._step: Step | None = None
        self._worker = Worker()
        self._messages: list[tuple[str, str]] = []
        self._timer: Timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)

    def execute(self, context: Context) -> set[str]:
        """Bake to the end without interaction, for scripts and background Blender."""
        failed = False
        for bake in self._make_bakes(context):
            error = None
            try:
                for step in bake.steps():
                    step.run()
            except native.FAILURES as caught:
                error = caught
            failed = failed or error is not None
            self.report({"INFO" if error is None else "ERROR"}, _keep(bake, error))
        return {"CANCELLED"} if failed else {"FINISHED"}

    def modal(self, context: Context, event: Event) -> set[str]:
        """Pull steps at every tick; Esc stops and keeps. Everything else waits."""
        if event.type == "ESC" and event.value == "PRESS":
            self._stop()
            return self._end(context)
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        if self._pull(context):
            return {"RUNNING_MODAL"}
        return self._end(context)

    def cancel(self, context: Context) -> None:
        """Blender ends the operator: a file is loaded, or the window closes."""
        self._stop()
        self._end(context)

    def _make_bakes(self, context: Context) -> list[Bake]:
        options = Options(resume=self.resume)
        return [Bake(obj, context.scene, options) for obj in self.cloths(context)]

    def _pull(self, context: Context) -> bool:
        """Do what can be done in a moment; False at the end of the last bake."""
        until = time.monotonic() + _PATIENCE
        while True:
            if not self._worker.is_done(max(0.0, until - time.monotonic())):
                return True
            if not self._next_step():
                return False
            context.workspace.status_text_set(self._current.progress(self._step))
            self._worker.begin(self._step)
            if time.monotonic() > until:
                return True

    def _next_step(self) -> bool:
        """Ask for the next step, of the next cloth if this one is done."""
        while True:
            if self._steps is None:
                if not self._bakes:
                    return False
                self._current = self._bakes.pop(0)
                self._steps = self._current.steps()
            error = None
            try:
                self._step = next(self._steps, None)
            except native.FAILURES as caught:
                error, self._step = caught, None
            if self._step is not None:
                return True
            self._messages.append(
                ("INFO" if error is None else "ERROR", _keep(self._current, error))
            )
            self._steps = None

    def _stop(self) -> None:
        """Let the running step end, keep what is done and bake nothing more."""
        self._worker.end()
        self._bakes = []
        if self._steps is None:
            return
        error: BaseException = GeneratorExit()
        try:
            self._steps.close()
        except native.FAILURES as caught:
            error = caught
        self._steps = None
        self._messages.append(("WARNING", _keep(self._current, error)))

    def _end(self, context: Context) -> set[str]:
        self._worker.end()
        context.window_manager.event_timer_remove(self._timer)
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        kinds = {kind for kind, _ in self._messages}
        for kind, text in self._messages:
            self.report({kind}, text)
        return {"FINISHED"} if kinds <= {"INFO", "WARNING"} else {"CANCELLED"}


def _keep(bake: Bake, error: BaseException | None) -> str:
    """The outcome as a sentence; a failure stays in the cloth's panel."""
    text = outcome(bake, error)
    if error is not None and not isinstance(error, GeneratorExit):
        runtime.messages[bake.uid] = text
    else:
        runtime.messages.pop(bake.uid, None)
    return text


class BOUCLE_OT_bake(_Baking, Operator):
    """Simulate the cloth over its frame range and keep the result on disk"""

    bl_idname = Operators.BAKE
    bl_label = "Bake"
    bl_options = {"UNDO"}  # without REGISTER: the redo panel would bake again

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file, and one bake at a time."""
        return can_simulate(cls, context)

    def cloths(self, context: Context) -> list[bpy.types.Object]:
        """The active cloth."""
        return [context.object]


class BOUCLE_OT_bake_all(_Baking, Operator):
    """Bake every Boucle cloth of the scene, one after another"""

    bl_idname = Operators.BAKE_ALL
    bl_label = "Bake All"
    bl_options = {"UNDO"}  # without REGISTER: the redo panel would bake again

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only with a cloth in the scene."""
        if not cloths_of(context):
            cls.poll_message_set("The scene has no Boucle cloth")
            return False
        return is_free(cls)

    def cloths(self, context: Context) -> list[bpy.types.Object]:
        """Every cloth of the scene."""
        return cloths_of(context)


CLASSES = (BOUCLE_OT_bake, BOUCLE_OT_bake_all)
