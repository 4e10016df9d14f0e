"""The shape of a cloth in the frame that is shown, without the modifiers below the slot."""

from __future__ import annotations

import bpy

from ..core import pc2, torn
from ..core.points import Points
from ..core.refusal import Refusal
from ..core.torn import Layout
from . import cache, live, mesh_arrays, registry, rest, sampling


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
    """Positions (m, object space) of the vertices in a frame of the result, of its first or last one beyond the ends.

    None without a result. Of what is torn, those of the pieces that keep the vertices' numbers.
    """
    found = points_at_frame(obj, frame)
    return found if found is None else found[: 3 * len(obj.data.vertices)]


def layout(obj: bpy.types.Object) -> Layout | None:
    """How the points of the result belong to a cloth that may tear; None for others, and without a result."""
    if cache.is_baked(obj):
        return None if cache.problem(obj) else cache.layout(obj)
    session = live.session_of(obj)
    return session.layout if session is not None else None


def is_torn(obj: bpy.types.Object, frame: int) -> bool:
    """Whether the cloth is in pieces in a frame of the result."""
    known, found = layout(obj), points_at_frame(obj, frame)
    if known is None or found is None:
        return False
    return torn.is_apart(found, known, mesh_arrays.topology(obj.data).corners)


def points_at_frame(obj: bpy.types.Object, frame: int) -> Points | None:
    """The same of all points of the result, which are more than the vertices if the cloth may tear."""
    path = cache.played_path(obj)
    if path:
        if cache.problem(obj):
            return None
        first, last = cache.frame_range(obj)
        return pc2.read_sample(path, min(max(frame, first), last) - first)
    session = live.session_of(obj)
    return session.frames.nearest(frame).positions if session is not None else None
