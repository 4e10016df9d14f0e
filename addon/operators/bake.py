"""Bake: in a window with a worker thread and a status bar, in a script to the end at once."""

from __future__ import annotations

import time
from collections.abc import Iterator

import bpy
from bpy.app.translations import pgettext_tip
from bpy.props import BoolProperty
from bpy.types import Context, Event, Operator, Timer

from .. import native
from .._identifiers import Operators
from ..bridge import runtime, together
from ..bridge.bake import Bake, Options, outcome
from ..bridge.worker import Worker
from ..core.bake import Step
from ..core.refusal import Refusal
from .polling import can_simulate, cloths_of, is_free

_TICK = 0.02
"""Seconds between two looks at the worker."""
_PATIENCE, _MOST_PATIENCE = 0.03, 0.2
"""Seconds that one look may take, in which the window cannot answer: short frames are baked several at a look. Where drawing
takes longer, a look may take half as long as drawing, up to the second number: else slow drawing would slow the bake."""


class _Baking:
    """What Bake and Bake All share: pulling the steps of one bake after another."""

    resume: BoolProperty(
        name="Resume",
        description="Go on where a bake was stopped; without one, begin",
        default=False,
        options={"SKIP_SAVE"},
    )

    def groups(self, context: Context) -> tuple[list[list[bpy.types.Object]], list[str]]:
        """What to bake: cloths that are baked together, and what there is to say about it.

        Raises:
            Refusal: A cloth that belongs to it is gone.
        """
        raise NotImplementedError

    def invoke(self, context: Context, _event: Event) -> set[str]:
        """Bake beside a living window."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        try:
            self._begin(context)
        except Refusal as refusal:
            self.report({"ERROR"}, str(refusal))
            return {"CANCELLED"}
        return {"RUNNING_MODAL"}

    def _begin(self, context: Context) -> None:
        self._bakes, notes = self._make_bakes(context)
        self._count = len(self._bakes)
        self._is_stopping = False
        self._looked = time.monotonic()
        self._current: Bake | None = None
        self._steps: Iterator[Step] | None = None
        self._step: Step | None = None
        self._worker = Worker()
        self._messages = [("WARNING", note) for note in notes]
        if context.screen is not None and context.screen.is_animation_playing:
            # Both would set the scene's frame.
            bpy.ops.screen.animation_cancel(restore_frame=False)
        context.window_manager.progress_begin(0.0, 1.0)
        self._timer: Timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)

    def execute(self, context: Context) -> set[str]:
        """Bake to the end without interaction, for scripts and background Blender."""
        failed = False
        try:
            bakes, notes = self._make_bakes(context)
        except Refusal as refusal:
            self.report({"ERROR"}, str(refusal))
            return {"CANCELLED"}
        for note in notes:
            self.report({"WARNING"}, note)
        for bake in bakes:
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
            self._ask_to_stop(context)
        elif event.type != "TIMER":
            return {"RUNNING_MODAL"}
        if self._is_stopping:
            if not self._worker.is_done(_PATIENCE):
                return {"RUNNING_MODAL"}
            self._stop()
        elif self._pull(context):
            return {"RUNNING_MODAL"}
        return self._end(context)

    def cancel(self, context: Context) -> None:
        """Blender ends the operator: a file is loaded, or the window closes."""
        self._ask_to_stop(context)
        self._stop()
        self._end(context)

    def _make_bakes(self, context: Context) -> tuple[list[Bake], list[str]]:
        options = Options(resume=self.resume)
        groups, notes = self.groups(context)
        if self.resume:
            groups = [together.in_order(cloths) for cloths in groups]
        return [Bake(cloths, context.scene, options) for cloths in groups], notes

    def _pull(self, context: Context) -> bool:
        """Do what can be done in a moment; False at the end of the last bake."""
        began = time.monotonic()
        until = began + min(max(0.5 * (began - self._looked), _PATIENCE), _MOST_PATIENCE)
        try:
            while True:
                if not self._worker.is_done(max(0.0, until - time.monotonic())):
                    return True
                if not self._next_step():
                    return False
                self._tell(context)
                self._worker.begin(self._step)
                if time.monotonic() > until:
                    return True
        finally:
            self._looked = time.monotonic()

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

    def _tell(self, context: Context) -> None:
        """Show how far it is: in the status bar, and at the pointer."""
        context.workspace.status_text_set(self._current.progress(self._step))
        done = self._count - len(self._bakes) - 1
        part = (done + self._current.part(self._step)) / self._count
        context.window_manager.progress_update(part)

    def _ask_to_stop(self, context: Context) -> None:
        """Interrupt the running step. A frame may take seconds, of which only one of its steps is waited for."""
        self._is_stopping = True
        if self._current is not None:
            self._current.interrupt()
            if context.workspace is not None:
                context.workspace.status_text_set(f"{self._current.title}: stopping")

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
        context.window_manager.progress_end()
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
        runtime.messages.update(dict.fromkeys(bake.uids, text))
    else:
        for uid in bake.uids:
            runtime.messages.pop(uid, None)
    return text


class BOUCLE_OT_bake(_Baking, Operator):
    """Simulate the cloth over its frame range and keep the result on disk; other cloths only count as colliders"""

    bl_idname = Operators.BAKE
    bl_label = "Bake"
    bl_options = {"UNDO"}  # without REGISTER: the redo panel would bake again

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file, and one bake at a time."""
        return can_simulate(cls, context)

    def groups(self, context: Context) -> tuple[list[list[bpy.types.Object]], list[str]]:
        """The active cloth; resumed, with those that it was baked together with."""
        return [together.resumed(context.object) if self.resume else [context.object]], []


class BOUCLE_OT_bake_all(_Baking, Operator):
    """Bake every Boucle cloth of the scene: those that collide with each other together, others one after another"""

    bl_idname = Operators.BAKE_ALL
    bl_label = "Bake All"
    bl_options = {"UNDO"}  # without REGISTER: the redo panel would bake again

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only with a cloth in the scene."""
        if not cloths_of(context):
            cls.poll_message_set(pgettext_tip("The scene has no Boucle cloth"))
            return False
        return is_free(cls)

    def groups(self, context: Context) -> tuple[list[list[bpy.types.Object]], list[str]]:
        """Every cloth of the scene."""
        return together.groups(cloths_of(context), context.scene)


CLASSES = (BOUCLE_OT_bake, BOUCLE_OT_bake_all)
