"""Grabbing: a cloth that moves on by itself while the scene's frame stands still, and a hand that takes it along.

Nothing here needs a window. What a window adds (mouse rays, a timer, a worker thread) is in `operators/grab.py`; a script
does the same by hand:

    grab = Grab(obj, scene, depsgraph)
    if grab.pick(origin, direction, depsgraph):
        grab.drag(origin, direction, normal)
    step = grab.step(depsgraph)
    step.run()
    grab.show(step)
    grab.end()

The shape stays as the cloth's live state: play goes on from it, until Reset.
"""

from __future__ import annotations

from typing import Any

import bpy
from mathutils import Vector

from .. import native
from ..core import grip, points
from ..core.bake import Step
from ..core.grip import Grip
from ..core.live_frames import Frame, LiveFrames
from ..core.refusal import Refusal
from . import cache, live, registry, runtime, sampling, vertex_attributes
from . import session as sessions
from .session import Session

REACH = 0.1
"""Part of the cloth's size that a hand holds around the vertex: the falloff's radius."""


class Grab:
    """One cloth in motion without a timeline. Only its `session_uid` is held between two calls, never the object."""

    def __init__(
        self, obj: bpy.types.Object, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph
    ) -> None:
        """Take up the live state, or begin with the present pose.

        Raises:
            Refusal: The cloth cannot be simulated now.
        """
        if cache.is_baked(obj):
            raise Refusal(f'"{obj.name}" plays its bake: free it to grab the cloth')
        if obj.mode != "OBJECT":
            raise Refusal(f'"{obj.name}" is in {obj.mode.title()} Mode: grab it in Object Mode')
        if not sampling.is_evaluated(obj, depsgraph):
            raise Refusal(f'"{obj.name}" is hidden in the view layer: show it to grab it')
        self.uid = obj.session_uid
        self.name = obj.name
        self.frame = scene.frame_current
        self.grip: Grip | None = None
        self._target: points.Points | None = None
        self._session = _begin_or_go_on(obj, scene, depsgraph)
        self._keep(self._session.frames.nearest(self._session.frames.last), obj)
        runtime.busy.add("grab")

    def pick(self, origin: Vector, direction: Vector, depsgraph: bpy.types.Depsgraph) -> bool:
        """Close the hand on the cloth where a ray in the world first meets what is shown of it; False if it misses."""
        obj = self._object()
        evaluated = obj.evaluated_get(depsgraph)
        matrix = evaluated.matrix_world
        back = matrix.inverted_safe()
        begin = back @ Vector(origin)
        way = back.to_3x3() @ Vector(direction)
        hit, place, _, _ = evaluated.ray_cast(begin, way)
        if not hit:
            return False
        to_world = sampling.object_matrix(obj, depsgraph)
        positions = self._session.frames.nearest(self.frame).positions
        vertices = positions[
            : 3 * len(obj.data.vertices)
        ]  # of a torn cloth, pieces come after them
        shown = points.transform(vertices, to_world, "d")
        self.grip = grip.close(shown, tuple(matrix @ place), REACH * grip.size(shown))
        self._target = self.grip.targets((0.0, 0.0, 0.0))
        return True

    def drag(self, origin: Vector, direction: Vector, normal: Vector) -> None:
        """Take what is held along, to a ray in the world, in the plane of the view."""
        if self.grip is None:
            return
        offset = grip.offset(tuple(origin), tuple(direction), self.grip, tuple(normal))
        if offset is not None:
            self._target = self.grip.targets(offset)

    def let_go(self) -> None:
        """Open the hand."""
        self.grip = self._target = None

    def step(self, depsgraph: bpy.types.Depsgraph) -> Step:
        """The work of one frame, for any thread.

        Raises:
            Refusal: Blender does not tell where pins or colliders go, or the session has ended.
        """
        obj = self._object()
        is_there = live.session_of(obj) is self._session and self._session.solver is not None
        if not is_there or obj.mode != "OBJECT":
            raise Refusal(
                f'"{self.name}": its live state has ended, by a changed setting or mode: grab anew'
            )
        moment = sessions.moment_of(self._session, obj, depsgraph)
        to_object = moment.poses[0].to_object
        session, solver = self._session, self._session.solver
        held, target = self.grip, self._target
        count = len(obj.data.vertices)

        def work() -> tuple[points.Points, dict[str, Any]]:
            moment.aim(solver)
            if held is None:
                solver.let_go()
            else:
                solver.grab(0, held.vertices, target, held.weights)
            certificate = solver.advance()
            return sessions.read_positions(session, to_object, count), certificate

        return Step(self.frame, work)

    def show(self, step: Step) -> None:
        """Show what a step led to.

        Raises:
            BoucleError: What the solver said; the last good shape stays.
        """
        obj = self._object()
        if live.session_of(obj) is not self._session or obj.mode != "OBJECT":
            return
        try:
            positions, certificate = step.result()
        except native.InternalError:
            self._session.solver = None
            raise
        self._keep(
            Frame(positions, certificate, sessions.read_numbers(self._session.solver, obj)), obj
        )

    def end(self) -> None:
        """Open the hand and give the cloth back to the timeline."""
        runtime.busy.discard("grab")
        if self._session.solver is not None:
            self._session.solver.let_go()

    def _keep(self, frame: Frame, obj: bpy.types.Object) -> None:
        """Make a frame the only one that the session knows: the state of the frame at which the scene stands."""
        self._session.frames = LiveFrames(self.frame, frame, sessions.memory_limit())
        self._session.display.begin_again(obj)
        self._session.display.show(obj, self._session.frames, self.frame)
        vertex_attributes.show(obj, frame.numbers)

    def _object(self) -> bpy.types.Object:
        obj = registry.by_uid(self.uid)
        if obj is None or not registry.is_cloth(obj):
            raise Refusal(f'"{self.name}" is no Boucle cloth any more')
        return obj


def _begin_or_go_on(
    obj: bpy.types.Object, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph
) -> Session:
    """The session that there is, or a new one with the present pose as the rest pose.

    Raises:
        Refusal: The cloth cannot be simulated.
    """
    session = live.valid_session(obj, scene)
    if session is None or session.solver is None:
        live.drop(obj)
        session = live.begin(obj, scene, depsgraph)
    if session is None:
        raise Refusal(runtime.messages[obj.session_uid])
    if session.settle is not None:
        raise Refusal(f'"{obj.name}" is {session.settle.words}: grab it when it is settled')
    return session
