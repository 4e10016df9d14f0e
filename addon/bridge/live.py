"""Live mode: play steps each cloth, scrubbing shows the frames kept in memory.

A session belongs to one cloth and lives until the user resets it or changes a setting, the faces or the stack above the
slot. It holds no Blender data: the cloth is found again at every event by its `session_uid`.

Where the mesh may be written (see `display.may_write`), frames stand in its `position` and the rest shape in
`boucle_rest`. In every other case they go into a temporary PC2 that the slot's Mesh Cache plays.

The rest pose is taken when the scene comes to the start frame, or when play begins there. A script that goes to the frame
after it at once has the pose of that frame as the rest pose.
"""

from __future__ import annotations

import bpy

from .. import native
from ..core import points
from ..core.live_frames import Action, Frame
from ..core.progress import size
from ..core.quantity import Numbers
from ..core.refusal import Refusal, sentence_of
from . import cache, display, registry, rest, runtime, sampling, settling, vertex_attributes
from .session import (
    Session,
    basis_of,
    build,
    go_on_settling,
    moment_of,
    read_numbers,
    read_positions,
    settings_digest,
)

EDITING_MODES = frozenset({"EDIT", "SCULPT", "WEIGHT_PAINT"})
"""Modes in which the artist works on the rest shape or on the pins."""


_sessions: dict[int, Session] = {}


def session_of(obj: bpy.types.Object) -> Session | None:
    """The live session of a cloth."""
    return _sessions.get(obj.session_uid)


def any_session() -> bool:
    """Whether any cloth is live."""
    return bool(_sessions)


def on_frame(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Step or show every live cloth of the scene at its frame; sub-frames are left alone."""
    is_still = runtime.busy == {"export"}  # bakes go on to tell of their frames
    if runtime.busy and not is_still:
        return
    if scene.frame_subframe != 0.0 or not runtime.may_write_in_render():
        return
    _forget_gone()
    for obj in registry.cloths_of(scene):
        if _is_live(obj) and not is_still:
            _come_to_frame(obj, scene, depsgraph)
        show_attributes(obj, scene)


def show_attributes(obj: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Let the mesh's attributes tell of the frame that is shown what the user wants to know."""
    vertex_attributes.show(obj, numbers_at(obj, scene))


def numbers_at(obj: bpy.types.Object, scene: bpy.types.Scene) -> Numbers:
    """What is known of the vertices in the frame that is shown, of what the user wants to know."""
    numbers: Numbers = {}
    session = session_of(obj)
    keys = vertex_attributes.wanted(obj)
    if not keys or obj.mode in EDITING_MODES:
        pass
    elif cache.is_baked(obj):
        numbers = vertex_attributes.of_bake(obj, scene.frame_current)
    elif session is not None and _is_live(obj):
        numbers = session.frames.nearest(scene.frame_current).numbers
    return {key: numbers[key] for key in keys if key in numbers}


def read_last(obj: bpy.types.Object) -> None:
    """Ask the solver what the user wants to know now of the last simulated frame."""
    session = session_of(obj)
    if session is None or session.solver is None or runtime.busy:
        return
    try:
        session.frames.tell(read_numbers(session.solver, obj))
    except native.FAILURES as error:
        session.solver = None
        _say(obj, sentence_of(error))


def _is_live(obj: bpy.types.Object) -> bool:
    return obj.boucle.use_live and obj.mode not in EDITING_MODES and not cache.is_baked(obj)


def _come_to_frame(
    obj: bpy.types.Object, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph
) -> None:
    if not sampling.is_evaluated(obj, depsgraph):
        return
    session = valid_session(obj, scene)
    frame = scene.frame_current
    if session is None:
        if frame not in (obj.boucle.frame_start, obj.boucle.frame_start + 1):
            return
        session = begin(obj, scene, depsgraph)
        if session is None:
            return
    if session.settle is not None and runtime.rendering:
        _settle(session, obj, settling.patience())
    action = session.frames.action(frame, scene.frame_subframe, obj.boucle.frame_end)
    if session.settle is not None and action is not Action.IGNORE:
        action = Action.SHOW
    session.waits = _explain(session, action)
    if action is Action.STEP:
        _step(session, obj, depsgraph)
    if action is not Action.IGNORE:
        session.display.show(obj, session.frames, frame)
        session.place = points.affine(obj.matrix_local)


def begin(
    obj: bpy.types.Object, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph
) -> Session | None:
    """Start a session with the present pose as the rest pose; None, and a message, if it cannot be."""
    runtime.messages.pop(obj.session_uid, None)
    try:
        session = build(obj, scene, depsgraph)
    except native.FAILURES as error:
        _say(obj, sentence_of(error))
        return None
    _sessions[obj.session_uid] = session
    if session.settle is not None and not bpy.app.timers.is_registered(settle_on):
        bpy.app.timers.register(settle_on)
    return session


def settle_on() -> float | None:
    """Let cloths settle for a slice of time; a timer calls it until all are settled or reset."""
    waiting = [session for session in _sessions.values() if session.settle is not None]
    if runtime.busy or runtime.rendering:
        return 1.0
    for session in waiting:
        obj = registry.by_uid(session.uid)
        if obj is None:
            session.settle = None
        else:
            _settle(session, obj, settling.SLICE)
    _redraw()
    return 0.0 if waiting else None


def _settle(session: Session, obj: bpy.types.Object, seconds: float) -> None:
    """Let a cloth settle for about so long, and show it when it is done."""
    scene = bpy.context.scene
    try:
        is_new = go_on_settling(session, obj, seconds)
    except native.FAILURES as error:
        session.solver = session.settle = None
        _say(obj, sentence_of(error))
        return
    if is_new and _is_live(obj):
        session.display.show(obj, session.frames, scene.frame_current)
        show_attributes(obj, scene)


def _redraw() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"VIEW_3D", "PROPERTIES"}:
                area.tag_redraw()


def valid_session(obj: bpy.types.Object, scene: bpy.types.Scene) -> Session | None:
    """The session, dropped if what it stands on has changed; a left-over frame gives way to the rest shape."""
    session = session_of(obj)
    if session is not None and session.basis != basis_of(obj, scene):
        drop(obj)
        session = None
    if session is None and rest.is_displaced(obj.data) and not runtime.rendering:
        rest.put_back(obj.data)
    return session


def _step(session: Session, obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
    if session.solver is None:
        return
    try:
        moment = moment_of(session, obj, depsgraph)
    except Refusal as refusal:
        session.waits = session.refusal = str(refusal)
        return
    session.refusal = ""
    try:
        moment.aim(session.solver)
        certificate = session.solver.advance()
        positions = read_positions(session, moment.poses[0].to_object, len(obj.data.vertices))
        session.frames.add(Frame(positions, certificate, read_numbers(session.solver, obj)))
    except native.FAILURES as error:
        session.solver = None
        _say(obj, f"{sentence_of(error)}; frames up to {session.frames.last} are kept")


def _explain(session: Session, action: Action) -> str:
    last = session.frames.last
    if action is Action.FULL:
        return (
            f"the live frames fill their memory at frame {last}: bake, or raise the limit in the "
            "add-on's preferences"
        )
    if action is Action.WAIT:
        return session.refusal or (
            f"frame {last + 1} was skipped: the cloth waits at frame {last}, play on from there "
            "with Sync set to Play Every Frame"
        )
    return ""


def _say(obj: bpy.types.Object, text: str) -> None:
    runtime.messages[obj.session_uid] = text
    runtime.warn(text)


def drop(obj: bpy.types.Object) -> None:
    """End the live session of an object and give it its rest shape back."""
    session = _sessions.pop(obj.session_uid, None)
    runtime.messages.pop(obj.session_uid, None)
    if obj.library is not None or obj.type != "MESH":
        return
    if session is not None:
        session.display.end(obj)
    if not runtime.rendering:
        vertex_attributes.hide(obj.data)
        if rest.is_displaced(obj.data):
            rest.put_back(obj.data)


def drop_all() -> None:
    """End every session, when the add-on is switched off."""
    for obj in registry.local_cloths():
        drop(obj)
    forget_all()


def forget_all() -> None:
    """Forget every session without touching Blender's data, which is about to be replaced."""
    for session in _sessions.values():
        session.display.forget()
    _sessions.clear()
    runtime.messages.clear()


def show_anew(obj: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Keep the frames of a mesh that must be shown in another way from now on; its display has ended."""
    session = session_of(obj)
    if session is None:
        return
    is_direct = display.may_write(obj)
    session.display = (
        display.Direct() if is_direct else display.TemporaryFile(obj.session_uid, session.layout)
    )
    session.basis = basis_of(obj, scene)
    session.display.show(obj, session.frames, scene.frame_current)


def revalidate(scene: bpy.types.Scene) -> None:
    """After undo or redo: keep the sessions whose cloths are as they were, and show their frame again."""
    _forget_gone()
    for obj in registry.cloths_of(scene):
        session = session_of(obj)
        if session is None:
            continue
        if obj.mode in EDITING_MODES or session.settings != settings_digest(obj, scene):
            drop(obj)
    for obj in registry.cloths_of(scene):
        session = valid_session(obj, scene)
        if session is None:
            display.silence_leftover(obj)
        if session is not None and _is_live(obj):
            session.display.show(obj, session.frames, scene.frame_current)
        show_attributes(obj, scene)


def _forget_gone() -> None:
    """Let go the frames of cloths that are no longer there."""
    if not _sessions:
        return
    uids = {obj.session_uid for obj in registry.all_cloths()}
    for uid in _sessions.keys() - uids:
        _sessions.pop(uid).display.forget()


def follow_edits(depsgraph: bpy.types.Depsgraph) -> None:
    """Give back the rest shape of cloths that the artist began to edit; called after each depsgraph update."""
    if not depsgraph.id_type_updated("OBJECT") and not depsgraph.id_type_updated("MESH"):
        return
    for obj in registry.local_cloths():
        session = session_of(obj)
        if obj.mode in EDITING_MODES and (session is not None or rest.is_displaced(obj.data)):
            drop(obj)  # a copy of a live cloth shows a frame without a session
        elif session is not None:
            _follow_applied_transform(obj, session)


def _follow_applied_transform(obj: bpy.types.Object, session: Session) -> None:
    """Apply Scale, Set Origin and their like move the mesh within its object: the kept rest shape must come along."""
    place = points.affine(obj.matrix_local)
    if place == session.place:
        return
    before, session.place = session.place, place
    back = points.inverse(place)
    if back is None or not rest.is_displaced(obj.data):
        return
    if session.display.is_shown(obj, session.frames):
        return
    rest.transform(obj.data, points.product(back, before))
    drop(obj)


def hide_all() -> None:
    """Before the file is saved: rest shapes in place, no temporary file named; `show_all` undoes it."""
    for obj in registry.local_cloths():
        session = session_of(obj)
        if session is not None:
            session.display.hide(obj)
        if obj.type == "MESH" and obj.mode not in EDITING_MODES:
            rest.put_back(obj.data)
            vertex_attributes.hide(obj.data)


def show_all(scene: bpy.types.Scene) -> None:
    """After the file is saved: show the frame that was there before."""
    for obj in registry.cloths_of(scene):
        session = session_of(obj)
        if session is not None and _is_live(obj):
            session.display.show(obj, session.frames, scene.frame_current)
        show_attributes(obj, scene)


def status(obj: bpy.types.Object) -> str:
    """The state of live mode in one sentence."""
    message = runtime.messages.get(obj.session_uid)
    if message:
        return message
    session = session_of(obj)
    if session is None:
        return f"Not baked: play from frame {obj.boucle.frame_start} to see it move"
    if session.settle is not None:
        return f"Live: {session.settle.words}"
    frames = session.frames
    text = f"Live: frames {frames.first} to {frames.last} in memory, {size(frames.size_bytes)}"
    return f"{text}; {session.waits}" if session.waits else text
