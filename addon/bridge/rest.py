"""The rest shape, never lost.

While a live frame stands in a mesh's `position`, the rest shape stands in the attribute `boucle_rest`. The attribute's
presence is the sign: where it is, `position` is a frame and not the artist's mesh.

Blender carries the attribute along when it changes the mesh. Vertices that were joined to the mesh meanwhile have zeros in
it: the vertex count at the time the rest shape was kept, a custom property, tells that, and they stay where they are.
"""

from __future__ import annotations

import bmesh
import bpy

from .._identifiers import REST_ATTRIBUTE, REST_COUNT
from ..core import points
from ..core.points import Affine, Points
from . import mesh_arrays


def is_displaced(mesh: bpy.types.Mesh) -> bool:
    """Whether the mesh shows a frame in place of its rest shape."""
    attribute = mesh.attributes.get(REST_ATTRIBUTE)
    return (
        attribute is not None
        and attribute.domain == "POINT"
        and attribute.data_type == "FLOAT_VECTOR"
    )


def positions(mesh: bpy.types.Mesh) -> Points:
    """The rest shape (m, object space), wherever it stands now."""
    if is_displaced(mesh) and not mesh.is_editmode:
        return mesh_arrays.read_vectors(mesh.attributes[REST_ATTRIBUTE])
    return mesh_arrays.read_positions(mesh)


def transform(mesh: bpy.types.Mesh, matrix: Affine) -> None:
    """Move the kept rest shape by a matrix."""
    attribute = mesh.attributes[REST_ATTRIBUTE]
    moved = points.transform(mesh_arrays.read_vectors(attribute), matrix, "f")
    attribute.data.foreach_set("vector", moved)


def keep(mesh: bpy.types.Mesh) -> None:
    """Store the rest shape, before the first frame is written into the mesh."""
    if is_displaced(mesh):
        return
    rest = mesh_arrays.read_positions(mesh)
    attribute = mesh.attributes.new(REST_ATTRIBUTE, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", rest)
    mesh[REST_COUNT] = len(mesh.vertices)


def put_back(mesh: bpy.types.Mesh) -> None:
    """Give the mesh its rest shape again."""
    if mesh.library is not None or mesh.attributes.get(REST_ATTRIBUTE) is None:
        return
    if mesh.is_editmode:
        _put_back_in_edit_mode(mesh)
        return
    if is_displaced(mesh):
        kept = positions(mesh)
        if mesh.get(REST_COUNT) != len(mesh.vertices):
            _fill_in(kept, mesh_arrays.read_positions(mesh))
        mesh_arrays.write_positions(mesh, kept)
    mesh.attributes.remove(mesh.attributes[REST_ATTRIBUTE])
    _forget_count(mesh)


def _fill_in(kept: Points, shown: Points) -> None:
    """Take the shown place of vertices that have no rest shape."""
    for k in range(0, len(kept), 3):
        if not any(kept[k : k + 3]):
            kept[k : k + 3] = shown[k : k + 3]


def _forget_count(mesh: bpy.types.Mesh) -> None:
    if REST_COUNT in mesh:
        del mesh[REST_COUNT]


def _put_back_in_edit_mode(mesh: bpy.types.Mesh) -> None:
    edited = bmesh.from_edit_mesh(mesh)
    layer = edited.verts.layers.float_vector.get(REST_ATTRIBUTE)
    if layer is None:
        return
    for vertex in edited.verts:
        vertex.co = vertex[layer]
    edited.verts.layers.float_vector.remove(layer)
    _forget_count(mesh)
    bmesh.update_edit_mesh(mesh)
