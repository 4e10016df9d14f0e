"""The attributes of a cloth's mesh that tell numbers at its vertices in the frame that is shown: `boucle_strain` and its like.

They are there only while they are true: no attribute where nothing is known of a frame, none in a saved file. Only a local
mesh of a single user gets them.
"""

from __future__ import annotations

import bmesh
import bpy

from ..core import cache_paths, points, quantity, vertex_file
from ..core.points import Points
from ..core.quantity import Numbers, Quantity
from . import cache, runtime


def wanted(obj: bpy.types.Object) -> tuple[str, ...]:
    """The keys of the quantities that the user wants to know, the heat map's among them."""
    settings = obj.boucle
    return tuple(
        one.key
        for one in quantity.ALL
        if settings.overlay == one.key or getattr(settings, f"use_{one.key}")
    )


def of_bake(obj: bpy.types.Object, frame: int) -> Numbers:
    """What the bake keeps of a frame; beyond its ends, of the first or last one, as the bake is played."""
    path = cache.played_path(obj)
    keys = wanted(obj)
    if not path or not keys or cache.problem(obj):
        return {}
    count, first = len(obj.data.vertices), cache.frame_range(obj)[0]
    files = cache_paths.files_of(path)
    out: dict[str, Points] = {}
    for key in keys:
        file = getattr(files, key)
        last = vertex_file.row_count(file, count) - 1
        row = vertex_file.read(file, min(max(frame - first, 0), last), count)
        if row is not None:
            out[key] = row
    return out


def show(obj: bpy.types.Object, numbers: Numbers) -> None:
    """Write the numbers of the frame that is shown; what is not among them goes. A render only gets other numbers."""
    mesh = obj.data
    if mesh.library is not None or mesh.override_library is not None or mesh.is_editmode:
        return
    written = [_show(mesh, one, numbers.get(one.key)) for one in quantity.ALL]
    if any(written):
        mesh.update()


def _show(mesh: bpy.types.Mesh, one: Quantity, values: Points | None) -> bool:
    """Write one attribute or take it away; whether it was written."""
    attribute = _find(mesh, one)
    if values is None or mesh.users != 1 or len(values) != len(mesh.vertices):
        if attribute is None:
            return False
        if not runtime.rendering:
            mesh.attributes.remove(attribute)
            return False
        values = points.empty("f", len(mesh.vertices))
    if attribute is None:
        if runtime.rendering:
            return False
        attribute = mesh.attributes.new(one.attribute, "FLOAT", "POINT")
    attribute.data.foreach_set("value", values)
    return True


def hide(mesh: bpy.types.Mesh) -> None:
    """Take the attributes away."""
    if mesh.library is not None or mesh.override_library is not None:
        return
    if mesh.is_editmode:
        _hide_in_edit_mode(mesh)
        return
    for one in quantity.ALL:
        attribute = _find(mesh, one)
        if attribute is not None:
            mesh.attributes.remove(attribute)


def _hide_in_edit_mode(mesh: bpy.types.Mesh) -> None:
    edited = bmesh.from_edit_mesh(mesh)
    names = {one.attribute for one in quantity.ALL} & set(edited.verts.layers.float.keys())
    for name in names:
        edited.verts.layers.float.remove(edited.verts.layers.float[name])
    if names:
        bmesh.update_edit_mesh(mesh)


def _find(mesh: bpy.types.Mesh, one: Quantity) -> bpy.types.Attribute | None:
    """The attribute, if it is ours and not a stranger's of the same name."""
    attribute = mesh.attributes.get(one.attribute)
    is_ours = attribute is not None and attribute.domain == "POINT"
    return attribute if is_ours and attribute.data_type == "FLOAT" else None
