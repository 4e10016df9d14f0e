"""A torn cloth in Blender: its mesh split by a node group, moved by the slot's Mesh Cache, and welded where it holds together.

The artist's mesh keeps its vertices. It bears one more attribute as long as it plays a bake, which tells the torn edges; a mesh
that cannot bear it, because it is linked or others use it, is split along all of its edges, and so is every mesh live and in an
unfinished bake.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence

import bmesh
import bpy

from .._identifiers import TEAR_ATTRIBUTE, TEAR_MODIFIER
from ..core import points
from ..core.points import Points
from ..core.refusal import Refusal
from ..core.torn import Layout
from . import mesh_arrays, slot, tear_groups

_CORNER = "boucle_corner"
"""Attribute of a mesh that is split to learn where its corners go."""

_APART = 1e-6
"""What is nearer (m) is one vertex."""
_PRECISION = 2.5e-7
"""Two steps of a float32 as a part of its value: where coordinates are so large that less is lost, the distance grows."""


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
        return Layout(len(mesh.vertices), len(split.vertices), placed, edges)
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
    """Split and weld the object as a cache wants it; None, or a cloth that stayed whole, takes all of that away.

    Raises:
        Refusal: The mesh cannot tell which of its edges are torn.
    """
    if shown is None or shown.is_whole:
        _take_away(obj)
        return
    if shown.edges is not None and not may_mark(obj):
        _refuse_unmarked(obj)
    elif shown.edges is not None:
        _mark(obj.data, shown.edges)
    elif may_mark(obj):
        _unmark(obj.data)
    found = slot.find(obj)
    if found.tear is None or found.mend is None:
        found = slot.add_tear(obj)
    group = tear_groups.ensure(_kind(shown.edges))
    if found.tear.node_group != group:
        found.tear.node_group = group
    found.mend.merge_threshold = _distance(obj)
    for modifier in (found.tear, found.mend):
        modifier.show_viewport = modifier.show_render = True


def _refuse_unmarked(obj: bpy.types.Object) -> None:
    """A mesh of others may bear the mark already, as that of a linked cloth does."""
    if obj.data.attributes.get(TEAR_ATTRIBUTE) is None:
        raise Refusal(
            f'"{obj.name}" cannot play this bake: its mesh is linked or has several users, so that it cannot tell '
            "which edges are torn: make it local and single-user, or bake again"
        )


def _take_away(obj: bpy.types.Object) -> None:
    found = slot.find(obj)
    if found is None or found.tear is None:
        return
    slot.remove_tear(obj)
    tear_groups.remove_unused()
    mesh = obj.data
    if mesh.library is None and mesh.override_library is None and not _is_needed(mesh):
        _unmark(mesh)


def _is_needed(mesh: bpy.types.Mesh) -> bool:
    """Whether another object that has the mesh is torn as well."""
    users = (other for other in bpy.data.objects if other.data == mesh)
    slots = (slot.find(other) for other in users)
    return any(found is not None and found.tear is not None for found in slots)


def _distance(obj: bpy.types.Object) -> float:
    """What is nearer (m) is welded: float32 must be able to tell it from nothing, or Blender's search passes it over."""
    farthest = max((abs(part) for corner in obj.bound_box for part in corner), default=0.0)
    return max(_APART, _PRECISION * farthest)


def _mark(mesh: bpy.types.Mesh, edges: Points) -> None:
    """Store which edges are torn, given both ends of each."""
    torn = {(min(pair), max(pair)) for pair in zip(edges[::2], edges[1::2], strict=True)}
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


def _unmark(mesh: bpy.types.Mesh) -> None:
    if mesh.is_editmode:
        edited = bmesh.from_edit_mesh(mesh)
        layer = edited.edges.layers.bool.get(TEAR_ATTRIBUTE)
        if layer is not None:
            edited.edges.layers.bool.remove(layer)
            bmesh.update_edit_mesh(mesh)
        return
    attribute = mesh.attributes.get(TEAR_ATTRIBUTE)
    if attribute is not None:
        mesh.attributes.remove(attribute)


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
