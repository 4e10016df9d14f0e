"""The check before a bake: every problem in one sentence, with the vertices that have it."""

from __future__ import annotations

from collections.abc import Iterator

import bmesh
import bpy

from .. import native
from ..core import mesh_check, points, scene_json
from ..core.mesh_check import Problem, Severity
from ..core.refusal import Refusal
from . import animation, cache, mesh_arrays, rest, sampling, settings, slot

SAMPLED_ONCE = (
    "stretch", "shear", "bend", "damping", "damping_stretch", "damping_shear", "damping_bend",
    "air_damping", "deformation_rate", "density", "mass_per_vertex", "wind_velocity",
    "wind_coefficient", "wind_air_density", "thickness", "friction", "pin_damping",
)  # fmt: skip
"""Settings that may be animated in the file, of which the solver takes the first frame's value."""


def problems(obj: bpy.types.Object, scene: bpy.types.Scene) -> list[Problem]:
    """Everything that is wrong with a cloth, errors first."""
    found = [*_errors(obj, scene), *_warnings(obj, scene)]
    return sorted(found, key=lambda problem: problem.severity is Severity.WARNING)


def refuse_errors(obj: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Refuse a cloth that cannot be simulated, with the first reason."""
    for problem in _errors(obj, scene):
        if problem.severity is Severity.ERROR:
            raise Refusal(problem.sentence)


def select(obj: bpy.types.Object, vertices: set[int]) -> None:
    """Select these vertices of a mesh and no others."""
    mesh = obj.data
    if mesh.is_editmode:
        edited = bmesh.from_edit_mesh(mesh)
        for vertex in edited.verts:
            vertex.select_set(vertex.index in vertices)
        edited.select_flush_mode()
        bmesh.update_edit_mesh(mesh)
        return
    # In Blender 5.0 the flags of a fresh mesh may be stored as one value for all, and its own `select` then writes beyond
    # it: they are made anew.
    for name, domain, flags in (
        (".select_vert", "POINT", [v.index in vertices for v in mesh.vertices]),
        (".select_edge", "EDGE", [vertices.issuperset(edge.vertices) for edge in mesh.edges]),
        (".select_poly", "FACE", [vertices.issuperset(face.vertices) for face in mesh.polygons]),
    ):
        if mesh.attributes.get(name) is not None:
            mesh.attributes.remove(mesh.attributes[name])
        mesh.attributes.new(name, "BOOLEAN", domain).data.foreach_set("value", flags)
    mesh.update()


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
        mesh_arrays.edges(mesh),
    ):
        yield problem._replace(sentence=f'"{obj.name}": {problem.sentence}')
    try:
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
    group = obj.boucle.pin_group
    if not group:
        yield _warning(f'"{obj.name}": no Pin Group is set, so the cloth falls freely')
    animated = [name for name in SAMPLED_ONCE if animation.moves(obj, f"boucle.{name}")]
    if animated:
        yield _warning(
            f'"{obj.name}": {", ".join(animated)} is animated: only its value at the start frame '
            "counts yet"
        )
    yield from _unsupported(obj, scene)
    if cache.problem(obj):
        yield _warning(cache.problem(obj))
    changed = cache.drift_of(obj, scene, in_full=True)
    if changed:
        yield _warning(
            f'"{obj.name}": the bake is outdated, changed since: {", ".join(changed)}: bake again'
        )


def _unsupported(obj: bpy.types.Object, scene: bpy.types.Scene) -> Iterator[Problem]:
    """What a scene may hold and this version leaves out: said, never silently ignored."""
    if any(modifier.type == "CLOTH" for modifier in obj.modifiers):
        yield _warning(f'"{obj.name}" has a Cloth modifier, too: remove one of the two')
    fields = [o.name for o in scene.objects if o.field is not None and o.field.type != "NONE"]
    if fields:
        yield _warning(
            f'"{obj.name}": force fields are not supported yet, so "{fields[0]}" has no effect on it'
        )


def _error(sentence: str) -> Problem:
    return Problem(Severity.ERROR, sentence)


def _warning(sentence: str) -> Problem:
    return Problem(Severity.WARNING, sentence)
