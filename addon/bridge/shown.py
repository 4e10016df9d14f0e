"""The shape of a cloth in the frame that is shown, without the modifiers below the slot."""

from __future__ import annotations

import bpy

from ..core import pc2
from ..core.points import Points
from ..core.refusal import Refusal
from . import cache, live, registry, rest, sampling


def is_moved(obj: bpy.types.Object) -> bool:
    """Whether there is a result: a bake that can be played, or a live session."""
    if cache.is_baked(obj):
        return not cache.problem(obj)
    return live.session_of(obj) is not None


def positions(obj: bpy.types.Object, scene: bpy.types.Scene) -> Points:
    """Positions (m, object space), float32, flat: of the bake, of the live frames, or at rest."""
    found = at_frame(obj, scene.frame_current)
    if found is not None:
        return found
    try:
        return sampling.targets(obj, registry.depsgraph_of(obj, scene))
    except Refusal:
        return rest.positions(obj.data)


def at_frame(obj: bpy.types.Object, frame: int) -> Points | None:
    """Positions (m, object space) of a frame of the result, of its first or last one beyond the ends; None without a result."""
    path = cache.played_path(obj)
    if path:
        if cache.problem(obj):
            return None
        first, last = cache.frame_range(obj)
        return pc2.read_sample(path, min(max(frame, first), last) - first)
    session = live.session_of(obj)
    return session.frames.nearest(frame).positions if session is not None else None
