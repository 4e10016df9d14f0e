"""A torn cloth in Blender: its mesh split by a node group, moved by the slot's Mesh Cache, and mended where it holds together.

The artist's mesh keeps its vertices. It bears one more attribute as long as it plays a bake, which tells the torn edges; a mesh
that cannot bear it, because it is linked or others use it, is split along all of its edges, and so is every mesh live and in an
unfinished bake.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence

import bmesh
import bpy

from .._identifiers import ORIGIN_ATTRIBUTE, TARGET_ATTRIBUTE, TEAR_ATTRIBUTE, TEAR_MODIFIER
from ..core import points
from ..core.points import Points
from ..core.refusal import Refusal
from ..core.torn import Layout
from . import mesh_arrays, slot, tear_fit, tear_groups

_CORNER = "boucle_corner"
"""Attribute of a mesh that is split to learn where its corners go."""


def layout(mesh: bpy.types.Mesh, torn: Sequence[tuple[int, int]] | None) -> Layout:
    """How Blender splits a mesh along edges, or along all if None: a copy of it is split, in a scene of its own."""
    copy = mesh.copy()
    obj = bpy.data.objects.new(copy.name, copy)
    scene = bpy.data.scenes.new(copy.name)
    try:
        edges = None if torn is None else array("i", (end for edge in torn for end in edge))
        count = len(copy.loops)
        attribute = copy.attributes.new(_CORNER, "INT", "CORNER")
        attribute.data.foreach_set("value", array("i", range(count)))
        if edges is not None:
            _mark(copy, edges)
        obj.modifiers.new(TEAR_MODIFIER, "NODES").node_group = tear_groups.ensure(_kind(edges))
        scene.collection.objects.link(obj)
        scene.view_layers[0].update()
        split = obj.evaluated_get(scene.view_layers[0].depsgraph).data
        numbers, at = points.empty("i", count), points.empty("i", count)
        split.attributes[_CORNER].data.foreach_get("value", numbers)
        split.attributes[".corner_vert"].data.foreach_get("value", at)
        placed = array("i", bytes(4 * count))
        for number, point in zip(numbers, at, strict=True):
            placed[number] = point
        shape = tear_fit.digest(copy)  # the mesh itself may be in edit mode
        return Layout(len(mesh.vertices), len(split.vertices), placed, edges, shape)
    finally:
        bpy.data.scenes.remove(scene)
        bpy.data.objects.remove(obj)
        bpy.data.meshes.remove(copy)
        tear_groups.remove_unused()


def _kind(edges: Points | None) -> str:
    return tear_groups.ALL if edges is None else tear_groups.TORN


def may_mark(obj: bpy.types.Object) -> bool:
    """Whether the mesh can tell which of its edges are torn: it is this file's, and nobody else's."""
    mesh = obj.data
    is_own = mesh.library is None and mesh.override_library is None
    return is_own and mesh.users - mesh.use_fake_user == 1 and not mesh.is_editmode


def show(obj: bpy.types.Object, shown: Layout | None) -> None:
    """Split and mend the object as a cache wants it; None, or a cloth that stayed whole, takes all of that away.

    Raises:
        Refusal: The mesh cannot tell which of its edges are torn.
    """
    if shown is None or shown.is_whole:
        _take_away(obj)
        return
    if shown.edges is not None and not may_mark(obj):
        _refuse_unmarked(obj, shown)
    elif shown.edges is not None:
        _mark(obj.data, shown.edges)
    elif may_mark(obj):
        _unmark(obj.data)
    found = slot.find(obj) if slot.is_in_order(obj) else slot.add_tear(obj)
    for modifier, kind in ((found.tear, _kind(shown.edges)), (found.mend, tear_groups.MEND)):
        group = tear_groups.ensure(kind)
        if modifier.node_group != group:
            modifier.node_group = group
        modifier.show_viewport = modifier.show_render = True


def _refuse_unmarked(obj: bpy.types.Object, shown: Layout) -> None:
    """A mesh of others may bear the marks already, as that of a linked cloth does."""
    if obj.data.is_editmode or not tear_fit.bears_marks(obj.data, shown):
        raise Refusal(
            f'"{obj.name}" cannot play this bake: its mesh is linked or has several users, so that it cannot tell '
            "which edges are torn: make it local and single-user, or bake again"
        )


def _take_away(obj: bpy.types.Object) -> None:
    if slot.splits(obj):
        slot.remove_tear(obj)
        tear_groups.remove_unused()
    tidy(obj.data)


def tidy(mesh: bpy.types.Mesh) -> None:
    """Remove the attributes that modifiers leave in a mesh when they are applied by hand, and marks that nothing needs."""
    if mesh.library is not None or mesh.override_library is not None:
        return
    is_marked = TEAR_ATTRIBUTE in mesh.attributes or ORIGIN_ATTRIBUTE in mesh.attributes
    if is_marked and not any(o.data == mesh and slot.splits(o) for o in bpy.data.objects):
        _unmark(mesh)
        _remove(mesh, ORIGIN_ATTRIBUTE)
    _remove(mesh, TARGET_ATTRIBUTE)


def _remove(mesh: bpy.types.Mesh, name: str) -> None:
    attribute = None if mesh.is_editmode else mesh.attributes.get(name)
    if attribute is not None:
        mesh.attributes.remove(attribute)


def _mark(mesh: bpy.types.Mesh, edges: Points) -> None:
    """Store which edges are torn, given both ends of each."""
    torn = tear_fit.pairs(edges)
    attribute = mesh.attributes.get(TEAR_ATTRIBUTE)
    if attribute is not None and (attribute.domain, attribute.data_type) != ("EDGE", "BOOLEAN"):
        mesh.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.attributes.new(TEAR_ATTRIBUTE, "BOOLEAN", "EDGE")
    ends = mesh_arrays.edges(mesh).tolist()
    pairs = zip(ends[::2], ends[1::2], strict=True)
    attribute.data.foreach_set("value", [(min(pair), max(pair)) in torn for pair in pairs])
    mesh.update()
    tear_fit.forget()


def _unmark(mesh: bpy.types.Mesh) -> None:
    tear_fit.forget()
    if mesh.is_editmode:
        edited = bmesh.from_edit_mesh(mesh)
        layer = edited.edges.layers.bool.get(TEAR_ATTRIBUTE)
        if layer is not None:
            edited.edges.layers.bool.remove(layer)
            bmesh.update_edit_mesh(mesh)
        return
    _remove(mesh, TEAR_ATTRIBUTE)


def sides(mesh: bpy.types.Mesh, shown: Layout) -> Points:
    """The two points of each side of each face, from its corners in turn, int32, flat."""
    ends = zip(range(len(mesh.loops)), mesh_arrays.next_corners(mesh), strict=True)
    return array("i", (shown.points[corner] for side in ends for corner in side))


def edge_points(mesh: bpy.types.Mesh, shown: Layout) -> Points:
    """The two points of each edge, int32, flat: those of a face beside it; of a loose edge, its vertices."""
    out, of_sides = mesh_arrays.edges(mesh), sides(mesh, shown)
    edges = points.empty("i", len(mesh.loops))
    mesh.loops.foreach_get("edge_index", edges)
    for corner, edge in enumerate(edges):
        out[2 * edge : 2 * edge + 2] = of_sides[2 * corner : 2 * corner + 2]
    return out
