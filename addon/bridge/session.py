"""One live cloth: its solver, the frames that are kept, and what both stand on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy

from ..core import drift, points, quantity, scene_json, torn
from ..core.bake import Moment
from ..core.live_frames import Frame, LiveFrames
from ..core.points import Points
from ..core.quantity import Numbers, Sizes
from ..core.refusal import Refusal
from ..core.torn import Layout
from . import (
    colliders,
    display,
    fields,
    mesh_arrays,
    record,
    rest,
    runtime,
    sampling,
    settings,
    settling,
    simulation,
    slot,
    tearing,
    vertex_attributes,
)
from .colliders import Colliders
from .fields import Fields
from .pins import Pins
from .settling import LiveSettle
from .winds import Water, Winds


@dataclass
class Session:
    """One cloth in motion."""

    uid: int
    solver: Any
    """None after a fault: the kept frames can still be shown."""
    frames: LiveFrames
    pins: Pins
    colliders: Colliders
    fields: Fields
    winds: Winds
    water: Water
    display: display.Display
    basis: tuple[object, ...]
    """What must not change while the session lives; looked at at every frame."""
    settings: str
    """A digest of settings, groups and rest shape; looked at after undo, which changes them without a word."""
    place: points.Affine
    """The object in its parent's space, when the last frame was shown."""
    layout: Layout | None = None
    """How the points of the frames belong to a cloth that may tear."""
    settle: LiveSettle | None = None
    """While the cloth is not yet settled: the first frame is not what it will be, and no other is simulated."""
    waits: str = ""
    """Why the cloth does not move on at the present frame; empty if it does."""
    refusal: str = ""
    """Why the frame after the last could not be simulated when the scene stood there."""


def build(obj: bpy.types.Object, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> Session:
    """Make a session with the present pose as the rest pose.

    Raises:
        Refusal, native.BoucleError: The cloth cannot be simulated.
    """
    if not runtime.rendering:
        slot.ensure(obj)
    layout = _layout(obj)
    description = settings.describe(obj, scene, with_groups=True)
    is_direct = display.may_write(obj) and (not runtime.rendering or rest.is_displaced(obj.data))
    local = rest.positions(obj.data) if is_direct else sampling.targets(obj, depsgraph)
    matrix = sampling.object_matrix(obj, depsgraph)
    to_object = sampling.inverse(obj, matrix)
    met = Colliders([obj], scene, depsgraph)
    world = points.transform(local, matrix, "d")
    given = simulation.given(obj, world, matrix)
    make = simulation.maker(description, [given], colliders=met.arrays)
    solver = make()
    pushing, held = Fields(obj, scene), Pins(description, 0, len(obj.data.vertices))
    blowing, water = Winds([obj], description), Water(obj, description)
    pose = sampling.pose(obj, depsgraph, held)
    forces = pushing.sample(depsgraph)
    winds, waters = blowing.sample(depsgraph), water.sample(depsgraph)
    Moment([pose], met.targets(depsgraph), forces, winds, waters).aim(solver)
    how = scene_json.settling(description)
    settle = LiveSettle(solver, how, len(obj.data.vertices), to_object) if how.frames else None
    if layout is not None:
        local = torn.of_vertices(local, layout, mesh_arrays.topology(obj.data).corners)
    first = Frame(local, solver.certificate(), read_numbers(solver, obj))
    shown = display.Direct() if is_direct else display.TemporaryFile(obj.session_uid, layout)
    session = Session(
        uid=obj.session_uid,
        solver=solver,
        frames=LiveFrames(obj.boucle.frame_start, first, memory_limit()),
        pins=held,
        colliders=met,
        fields=pushing,
        winds=blowing,
        water=water,
        display=shown,
        basis=basis_of(obj, scene),
        settings=settings_digest(obj, scene),
        place=points.affine(obj.matrix_local),
        layout=layout,
        settle=settle,
    )
    go_on_settling(session, obj, settling.patience())
    return session


def _layout(obj: bpy.types.Object) -> Layout | None:
    """How Blender splits a cloth that may tear.

    Raises:
        Refusal: A render has begun, in which no data may be added.
    """
    if not obj.boucle.use_tear:
        return None
    if runtime.rendering:
        raise Refusal(f'"{obj.name}" may tear: bake before you render, or play it first')
    return tearing.layout(obj.data, None)


def go_on_settling(session: Session, obj: bpy.types.Object, seconds: float) -> bool:
    """Let the cloth settle for about so long; whether its first frame has become another, because it is settled.

    Raises:
        native.BoucleError: What the solver said.
    """
    settle = session.settle
    if settle is None:
        return False
    settle.go_on(seconds)
    if not settle.is_done:
        return False
    session.settle = None
    positions = read_positions(session, settle.to_object, len(obj.data.vertices))
    numbers = read_numbers(session.solver, obj)
    frame = Frame(positions, session.solver.certificate(), numbers)
    session.frames = LiveFrames(session.frames.first, frame, memory_limit())
    session.display.begin_again(obj)
    return True


def memory_limit() -> int:
    """Bytes that one cloth's live frames may take."""
    addon = bpy.context.preferences.addons.get(__package__.rpartition(".")[0])
    return addon.preferences.live_memory * 1_000_000 if addon else 4_000_000_000


def basis_of(obj: bpy.types.Object, scene: bpy.types.Scene) -> tuple[object, ...]:
    """What must not change while a session lives."""
    mesh = obj.data
    return (
        mesh.session_uid,
        len(mesh.vertices),
        len(mesh.loops),
        obj.boucle.frame_start,
        settings.steady_world(scene),
        display.may_write(obj),
        colliders.signature(obj, scene),
        fields.signature(obj, scene),
    )


def settings_digest(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """A digest of the settings, the groups and the rest shape; empty if they contradict each other."""
    try:
        known = drift.whole_digest(record.of(obj, scene))
        return known + drift.digest(rest.positions(obj.data))
    except Refusal:
        return ""


def moment_of(session: Session, obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Moment:
    """Where pins and colliders go now, and what pushes."""
    targets, forces = session.colliders.targets(depsgraph), session.fields.sample(depsgraph)
    pose = sampling.pose(obj, depsgraph, session.pins)  # last: what pins tell is told once
    winds, water = session.winds.sample(depsgraph), session.water.sample(depsgraph)
    return Moment([pose], targets, forces, winds, water)


def read_positions(session: Session, to_object: points.Affine, vertex_count: int) -> Points:
    """Where the vertices are, or the points of a cloth that may tear (m, object space), float32, flat."""
    layout = session.layout
    count = vertex_count if layout is None else len(layout.points)
    read = session.solver.read_positions if layout is None else session.solver.read_corners
    if to_object == points.IDENTITY:
        out = points.empty("f", 3 * count)
        read(0, out)
    else:
        world = points.empty("d", 3 * count)
        read(0, world)
        out = points.transform(world, to_object, "f")
    return out if layout is None else layout.gather(out)


def read_numbers(solver: Any, obj: bpy.types.Object) -> Numbers:
    """The quantities that the user wants to see, at vertices or corners."""
    mesh = obj.data
    sizes = Sizes(len(mesh.vertices), len(mesh.loops), obj.boucle.use_tear)
    out = quantity.empty(vertex_attributes.wanted(obj), sizes)
    quantity.read(solver, 0, out, sizes)
    return out
