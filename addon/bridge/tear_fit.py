"""Whether an object splits its mesh as the torn bake needs it that it plays: if not, its rest shape or a scramble is shown."""

from __future__ import annotations

from array import array

import bpy

from .._identifiers import MEND_MODIFIER, TEAR_ATTRIBUTE, TEAR_MODIFIER
from ..core import drift, points
from ..core.points import Points
from ..core.torn import Layout
from . import mesh_arrays, slot, tear_groups

_digests: dict[int, str] = {}
"""What is known of meshes, by `session_uid`, until something changes: panels ask at every redraw."""
_marks: dict[int, set[tuple[int, int]] | None] = {}


def forget() -> None:
    """Look at all meshes again."""
    _digests.clear()
    _marks.clear()


def digest(mesh: bpy.types.Mesh) -> str:
    """A digest of the faces and edges of a mesh as they are numbered, upon which depends how Blender splits it."""
    starts = points.empty("i", len(mesh.polygons))
    corners, ends = points.empty("i", len(mesh.loops)), points.empty("i", 2 * len(mesh.edges))
    mesh.polygons.foreach_get("loop_start", starts)
    # Two hundred times as fast as by loops and edges.
    mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
    mesh.attributes[".edge_verts"].data.foreach_get("value", ends)
    return drift.digest(starts, corners, ends)


def pairs(edges: Points) -> set[tuple[int, int]]:
    """Edges, given both ends of each, as pairs with the lower vertex first."""
    ends = [int(end) for end in edges]
    return {(min(pair), max(pair)) for pair in zip(ends[::2], ends[1::2], strict=True)}


def mesh_trouble(mesh: bpy.types.Mesh, layout: Layout | None) -> str:
    """Why a torn bake does not fit the faces and edges of a mesh; empty if it does, or if nobody can tell now."""
    if layout is None or layout.is_whole or not layout.mesh or mesh.is_editmode:
        return ""
    uid = mesh.session_uid
    if uid not in _digests:
        _digests[uid] = digest(mesh)
    if _digests[uid] == layout.mesh:
        return ""
    return (
        "its faces or edges are not numbered as when it was baked torn (some were added, removed or sorted): "
        "restore the mesh, or bake again"
    )


def bears_marks(mesh: bpy.types.Mesh, layout: Layout) -> bool:
    """Whether the torn edges of a layout, and no others, are marked on a mesh that is not being edited."""
    uid = mesh.session_uid
    if uid not in _marks:
        _marks[uid] = _marked(mesh)
    return _marks[uid] == pairs(layout.edges)


def _marked(mesh: bpy.types.Mesh) -> set[tuple[int, int]] | None:
    attribute = mesh.attributes.get(TEAR_ATTRIBUTE)
    if attribute is None or (attribute.domain, attribute.data_type) != ("EDGE", "BOOLEAN"):
        return None
    marks = array("b", bytes(len(mesh.edges)))
    attribute.data.foreach_get("value", marks)
    ends, torn, known = mesh_arrays.edges(mesh), [], marks.tobytes()
    number = known.find(1)
    while number >= 0:
        torn.extend(ends[2 * number : 2 * number + 2])
        number = known.find(1, number + 1)
    return pairs(torn)


def object_trouble(obj: bpy.types.Object, layout: Layout | None) -> str:
    """Why an object's marks and modifiers do not play a bake in this layout, which fits its mesh; empty if they do."""
    if layout is None or layout.is_whole:
        if not slot.splits(obj):
            return ""
        return f"its bake is whole, and it still has the modifiers of a torn one: {_remedy(obj)}"
    kind = tear_groups.ALL if layout.edges is None else tear_groups.TORN
    if not _splits(obj, kind):
        return (
            f'the modifiers that split and mend it ("{TEAR_MODIFIER}", "{MEND_MODIFIER}") are not those of its bake, '
            f"or were moved, changed or switched off: {_remedy(obj)}"
        )
    if kind == tear_groups.TORN and not obj.data.is_editmode and not bears_marks(obj.data, layout):
        return f"the edges that its mesh marks as torn are not those of its bake: {_remedy(obj)}"
    return ""


def _splits(obj: bpy.types.Object, kind: str) -> bool:
    """Whether an object has what splits by this kind, and what mends, as they were made."""
    if not slot.is_in_order(obj):
        return False
    found = slot.find(obj)
    groups = found.tear.node_group, found.mend.node_group
    is_right = tear_groups.kind_of(groups[0]) == kind and all(map(tear_groups.is_intact, groups))
    return is_right and _are_on(found)


def _are_on(found: slot.Slot) -> bool:
    """Whether they are shown where the cache is."""
    cache, others = found.cache, (found.tear, found.mend)
    in_view = all(one.show_viewport or not cache.show_viewport for one in others)
    return in_view and all(one.show_render or not cache.show_render for one in others)


def _remedy(obj: bpy.types.Object) -> str:
    if obj.library is not None:
        return "save the file that it comes from after its bake, and reload the library"
    if obj.data.library is not None or obj.data.users - obj.data.use_fake_user > 1:
        return "make its mesh local and single-user, and bake again"
    return "bake again"
