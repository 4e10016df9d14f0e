"""The check before a bake: every problem in one sentence, with the vertices that have it."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from .. import native
from ..core import mesh_check, points, scene_json
from ..core.mesh_check import Problem, Severity
from ..core.refusal import Refusal
from . import (
    animation,
    cache,
    crossing,
    fields,
    mesh_arrays,
    rest,
    sampling,
    settings,
    setup_check,
    shape,
    slot,
    warp,
)

SAMPLED_ONCE = (
    "stretch", "shear", "bend", "damping", "damping_stretch", "damping_shear", "damping_bend",
    "stretch_warp", "stretch_weft", "compression_warp", "compression_weft", "bend_warp", "bend_weft",
    "damping_ratio", "damping_ratio_stretch", "damping_ratio_shear", "damping_ratio_bend",
    "yield_curvature", "hardening", "bend_hysteresis",
    "air_damping", "deformation_rate", "density", "mass_per_vertex", "wind_coefficient",
    "wind_air_density", "wind_drag", "wind_lift", "wind_gusts", "wind_gust_period", "wind_turbulence",
    "wind_turbulence_size", "water_density", "water_drag", "water_friction", "wave_amplitude", "wave_length", "wave_angle",
    "bulk_density", "absorbency", "soak_time", "dry_time", "thickness", "friction", "pin_damping",
)  # fmt: skip
"""Settings that may be animated in the file, of which the solver takes the first frame's value."""


def problems(obj: bpy.types.Object, scene: bpy.types.Scene) -> list[Problem]:
    """Everything that is wrong with a cloth, errors first."""
    found = [*_errors(obj, scene), *_warnings(obj, scene)]
    if not any(problem.severity is Severity.ERROR for problem in found):
        found += [*crossing.at_start(obj, scene), *crossing.strangers(obj, scene)]
    order = list(Severity)
    return sorted(found, key=lambda problem: order.index(problem.severity))


def refuse_errors(obj: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Refuse a cloth that cannot be simulated, with the first reason."""
    for problem in _errors(obj, scene):
        if problem.severity is Severity.ERROR:
            raise Refusal(problem.sentence)


def _errors(obj: bpy.types.Object, scene: bpy.types.Scene) -> Iterator[Problem]:
    mesh = obj.data
    if native.problem():
        yield _error(native.problem())
    if mesh.is_editmode:
        yield _error(f'"{obj.name}" is in Edit Mode: leave it first')
        return
    matrix = mesh_arrays.world_matrix(obj)
    try:
        sampling.inverse(obj, matrix)
    except Refusal as refusal:
        yield _error(str(refusal))
    faces = mesh_arrays.topology(mesh)
    for problem in mesh_check.check(
        points.transform(rest.positions(mesh), matrix, "d"),
        faces.starts,
        faces.corners,
        shape.face_edges(mesh),
    ):
        yield problem._replace(sentence=f'"{obj.name}": {problem.sentence}')
    try:
        warp.uvs(obj)
        scene_json.describe(
            obj.name, settings.values(obj), settings.world(scene), settings.groups(obj)
        )
    except Refusal as refusal:
        yield _error(str(refusal))
    yield from _stack_errors(obj)


def _stack_errors(obj: bpy.types.Object) -> Iterator[Problem]:
    if slot.find(obj) is None:
        yield _error(f'"{obj.name}": Boucle\'s modifiers are missing: press Disable and Enable')
        return
    if not slot.find(obj).target.show_viewport:
        yield _error(
            f'"{obj.name}": the modifier "{slot.find(obj).target.name}" is off in the viewport: '
            "switch it on"
        )
    for modifier in slot.above(obj):
        if modifier.type in slot.COUNT_CHANGING - {"NODES"} and modifier.show_viewport:
            yield _error(
                f'"{obj.name}": the modifier "{modifier.name}" stands above Boucle\'s and changes '
                "the vertices: move it below"
            )
    if obj.hide_viewport or not obj.visible_get():
        yield _error(
            f'"{obj.name}" is hidden, so Blender does not evaluate it: show it and its collection '
            "in the viewport"
        )


def _warnings(obj: bpy.types.Object, scene: bpy.types.Scene) -> Iterator[Problem]:
    yield from _loose_edges(obj)
    animated = [name for name in SAMPLED_ONCE if animation.moves(obj, f"boucle.{name}")]
    if animated:
        yield _warning(
            f'"{obj.name}": {", ".join(animated)} is animated: only its value at the start frame '
            "counts"
        )
    yield from _unsupported(obj, scene)
    yield from setup_check.problems(obj, scene)
    if cache.problem(obj):
        yield _warning(cache.problem(obj))
    changed = cache.drift_of(obj, scene, in_full=True)
    if changed:
        yield _warning(
            f'"{obj.name}": the bake is outdated, changed since: {", ".join(changed)}: bake again'
        )


def _loose_edges(obj: bpy.types.Object) -> Iterator[Problem]:
    seams = shape.loose_edges(obj.data)
    is_sewn = obj.boucle.use_sewing_springs
    if seams and not is_sewn:
        yield Problem(
            Severity.WARNING,
            f'"{obj.name}": {len(seams)} loose edges have no effect: switch on Sewing to draw their '
            "ends together, or delete them",
            sorted({vertex for seam in seams for vertex in seam}),
        )
    if is_sewn and not seams:
        yield _warning(
            f'"{obj.name}": Sewing is on, but the mesh has no loose edges: add edges without faces '
            "between the vertices that are to meet"
        )


def _unsupported(obj: bpy.types.Object, scene: bpy.types.Scene) -> Iterator[Problem]:
    """What a scene may hold and this version leaves out: said, never silently ignored."""
    if any(m.type == "CLOTH" and (m.show_viewport or m.show_render) for m in obj.modifiers):
        yield _warning(f'"{obj.name}" has a Cloth modifier, too: remove one of the two')
    yield from (_warning(sentence) for sentence in fields.unsupported(obj, scene))


def _error(sentence: str) -> Problem:
    return Problem(Severity.ERROR, sentence)


def _warning(sentence: str) -> Problem:
    return Problem(Severity.WARNING, sentence)
