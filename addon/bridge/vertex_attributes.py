"""The attributes of a cloth's mesh that tell numbers of the frame that is shown: `boucle_strain` and its like.

They are told at its vertices, or at the corners of its faces where it may tear.

They are there only while they are true: no attribute where nothing is known of a frame, none in a saved file. Only a local
mesh of a single user gets them.
"""

from __future__ import annotations

import bmesh
import bpy

from ..core import cache_paths, points, quantity, vertex_file
from ..core.points import Points
from ..core.quantity import Numbers, Quantity, Sizes
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
    mesh, first = obj.data, cache.frame_range(obj)[0]
    sizes = Sizes(len(mesh.vertices), len(mesh.loops), cache.layout(obj) is not None)
    files = cache_paths.files_of(path)
    out: dict[str, Points] = {}
    for key in keys:
        file, count = getattr(files, key), sizes.count(key)
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
    at_corners = obj.boucle.use_tear
    written = [_show(mesh, one, numbers.get(one.key), at_corners) for one in quantity.ALL]
    if any(written):
        mesh.update()


def domain_of(mesh: bpy.types.Mesh, one: Quantity, values: Points, may_tear: bool) -> str:
    """Where values belong, by their number: vertices or corners; empty for another mesh. A mesh may have as many of both."""
    corners, vertices = len(values) == len(mesh.loops), len(values) == len(mesh.vertices)
    if corners and (not vertices or may_tear or not one.reader):
        return "CORNER"
    return "POINT" if vertices and one.reader else ""


def _show(mesh: bpy.types.Mesh, one: Quantity, values: Points | None, may_tear: bool) -> bool:
    """Write one attribute or take it away; whether it was written."""
    attribute = _find(mesh, one)
    domain = domain_of(mesh, one, values, may_tear) if values is not None else ""
    if not domain or mesh.users != 1:
        if attribute is None:
            return False
        if not runtime.rendering:
            mesh.attributes.remove(attribute)
            return False
        domain, values = attribute.domain, points.empty("f", len(attribute.data))
    if attribute is not None and attribute.domain != domain and not runtime.rendering:
        mesh.attributes.remove(attribute)
        attribute = None
    if attribute is None or attribute.domain != domain:
        if runtime.rendering:
            return False
        attribute = mesh.attributes.new(one.attribute, "FLOAT", domain)
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
    ours = {one.attribute for one in quantity.ALL}
    found = False
    for layers in (edited.verts.layers.float, edited.loops.layers.float):
        for name in ours & set(layers.keys()):
            layers.remove(layers[name])
            found = True
    if found:
        bmesh.update_edit_mesh(mesh)


def _find(mesh: bpy.types.Mesh, one: Quantity) -> bpy.types.Attribute | None:
    """The attribute, if it is ours and not a stranger's of the same name."""
    attribute = mesh.attributes.get(one.attribute)
    is_ours = attribute is not None and attribute.domain in {"POINT", "CORNER"}
    return attribute if is_ours and attribute.data_type == "FLOAT" else None
