"""The attribute `boucle_strain` of a cloth's mesh: the largest strain of the edges at each vertex, in the frame that is shown.

It is there only while it is true: no attribute where nothing is known of a frame, none in a saved file. Only a local mesh of
a single user gets it.
"""

from __future__ import annotations

import bmesh
import bpy

from .._identifiers import STRAIN_ATTRIBUTE
from ..core import cache_paths, points, strain_file
from ..core.points import Points
from . import cache, runtime


def of_bake(obj: bpy.types.Object, frame: int) -> Points | None:
    """The strain that the bake keeps of a frame; beyond its ends, of the first or last one, as the bake is played."""
    path = cache.played_path(obj)
    record = cache.record_of(obj)
    if not path or not record or cache.problem(obj):
        return None
    count = len(obj.data.vertices)
    file = cache_paths.files_of(path).strain
    last = strain_file.row_count(file, count) - 1
    return strain_file.read(file, min(max(frame - int(record["first"]), 0), last), count)


def show(obj: bpy.types.Object, values: Points | None) -> None:
    """Write the strain of the frame that is shown; None takes the attribute away. A render only gets other numbers."""
    mesh = obj.data
    if mesh.library is not None or mesh.override_library is not None or mesh.is_editmode:
        return
    attribute = _find(mesh)
    if values is None or mesh.users != 1 or len(values) != len(mesh.vertices):
        if attribute is None:
            return
        if not runtime.rendering:
            hide(mesh)
            return
        values = points.empty("f", len(mesh.vertices))
    if attribute is None:
        if runtime.rendering:
            return
        attribute = mesh.attributes.new(STRAIN_ATTRIBUTE, "FLOAT", "POINT")
    attribute.data.foreach_set("value", values)
    mesh.update()


def hide(mesh: bpy.types.Mesh) -> None:
    """Take the attribute away."""
    if mesh.library is not None or mesh.override_library is not None:
        return
    if mesh.is_editmode:
        edited = bmesh.from_edit_mesh(mesh)
        layer = edited.verts.layers.float.get(STRAIN_ATTRIBUTE)
        if layer is not None:
            edited.verts.layers.float.remove(layer)
            bmesh.update_edit_mesh(mesh)
        return
    attribute = _find(mesh)
    if attribute is not None:
        mesh.attributes.remove(attribute)


def _find(mesh: bpy.types.Mesh) -> bpy.types.Attribute | None:
    """The attribute, if it is ours and not a stranger's of the same name."""
    attribute = mesh.attributes.get(STRAIN_ATTRIBUTE)
    is_ours = attribute is not None and attribute.domain == "POINT"
    return attribute if is_ours and attribute.data_type == "FLOAT" else None
