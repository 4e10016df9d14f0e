"""The largest time step that a cloth's springs and its limiter bear, in words; computed once per state of its settings."""

from __future__ import annotations

from array import array
from typing import Any

import bpy

from .. import native
from ..core import drift, points, ranges, scene_json
from ..core.refusal import Refusal, sentence_of
from . import certificate, live, mesh_arrays, rest, runtime, settings, simulation

LARGEST = 20_000
"""Vertices up to which a panel may build a solver while it draws (about 50 ms)."""

_known: dict[int, tuple[str, str]] = {}


def describe(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """The safe time step of an explicit integrator and what it means for a frame; what a frame took with the others."""
    session = live.session_of(obj)
    fps = settings.world(scene).fps
    if settings.is_implicit(obj.boucle.integrator):
        return _taken(obj, scene)
    if session is not None and session.solver is not None and not runtime.busy:
        return _words(session.solver, fps)
    try:
        description = settings.describe(obj, scene, with_groups=False)
    except Refusal as refusal:
        return str(refusal)
    key = _key(obj, description)
    known = _known.get(obj.session_uid)
    if known is None or known[0] != key:
        known = (key, _compute(obj, description, fps))
        _known[obj.session_uid] = known
    return known[1]


def forget() -> None:
    """Compute anew at the next question."""
    _known.clear()


def _compute(obj: bpy.types.Object, description: dict, fps: float) -> str:
    if len(obj.data.vertices) > LARGEST or obj.data.is_editmode:
        return "Safe time step: shown after the first simulated frame"
    matrix = mesh_arrays.world_matrix(obj)
    description = scene_json.without_contact(description)
    # A step beyond the bound is refused by the solver, and here the bound is what is asked for.
    description["solver"]["allow_unstable"] = True
    try:
        world = points.transform(rest.positions(obj.data), matrix, "d")
        given = simulation.given(obj, world, matrix)
        solver = simulation.maker(description, [given])()
        advice = _advice(description, given, solver, fps)
        return ". ".join(filter(None, [_words(solver, fps), advice]))
    except native.FAILURES as error:
        return sentence_of(error)


def _advice(description: dict[str, Any], given: simulation.Given, solver: Any, fps: float) -> str:
    """What speaks against the damping of springs, or nothing."""
    cloth = description["cloth"][0]
    if cloth["model"] != "springs":
        return ""
    _, _, _, stiffness, damping = solver.read_springs(0)
    numbers = [array("d", values) for values in (stiffness, damping)]
    bare = {**cloth["springs"], "limiter": "none", "air_damping": 0.0}
    bare = {key: 0.0 if key.startswith("damping") else bare[key] for key in bare}
    bare["damping_law"] = cloth["springs"]["damping_law"]
    undamped = {
        "scene": description["scene"],
        "cloth": [{**cloth, "springs": bare}],
        "solver": {"integrator": "verlet", "allow_unstable": True},
    }
    step = simulation.maker(undamped, [given])().safe_time_step
    if step >= 1.0 / fps:  # so slow that every step of a frame is short
        return ""
    integrator = description["solver"]["integrator"]
    return ranges.advice(integrator, ranges.damping_ratio(*numbers, step))


def _taken(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """For an implicit integrator, to which every step is safe."""
    count = certificate.row_of(obj, scene).get("substeps")
    if not count:
        return "Any time step is stable with this integrator"
    return f"This frame took {count} step{'s' if count > 1 else ''}; any step is stable"


def _words(solver: object, fps: float) -> str:
    step = solver.safe_time_step
    if step <= 0.0:
        return "Safe time step: none with this integrator and damping"
    return (
        f"Safe time step: {1000.0 * step:.3g} ms, {solver.substeps} substeps a frame at {fps:g} fps"
    )


def _key(obj: bpy.types.Object, description: dict) -> str:
    mesh = obj.data
    text = scene_json.encode(description) + repr(tuple(map(tuple, obj.matrix_world)))
    return f"{drift.digest(text.encode())} {len(mesh.vertices)} {len(mesh.loops)}"
