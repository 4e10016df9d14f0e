"""The geometry-nodes groups of a torn cloth: two split a mesh, along the edges that a bake tears or along all, and one mends.

What splits stores at each point from which vertex it comes. What mends joins points of one vertex that lie in one place, bit
for bit, and no others: seams that close and sheets that touch stay apart. For that it moves every such point to a place that
its vertex and its position alone decide, at random in a cube of 1 m, where a search for near points finds those that are
alike. Of a million points two others come as near in fewer than one of ten million frames.
"""

from __future__ import annotations

import bpy

from .._identifiers import (
    MEND_GROUP,
    ORIGIN_ATTRIBUTE,
    SPLIT_GROUP,
    TEAR_ATTRIBUTE,
    TEAR_GROUP,
    TEAR_GROUP_DIGEST,
    TEAR_GROUP_MARK,
)
from ..core import drift

TORN, ALL, MEND = "torn", "all", "mend"
_NAMES = {TORN: TEAR_GROUP, ALL: SPLIT_GROUP, MEND: MEND_GROUP}

_APART = 2.5e-7
"""What is nearer in the cube (m) is one point: a few steps of a float32, or Blender's search would pass equal points over."""


def kind_of(group: bpy.types.NodeTree | None) -> str:
    """What a group does; empty for a stranger's."""
    return str(group.get(TEAR_GROUP_MARK, "")) if group is not None else ""


def is_intact(group: bpy.types.NodeTree) -> bool:
    """Whether a group's nodes are those with which it was made."""
    return group.get(TEAR_GROUP_DIGEST) == _digest(group)


def ensure(kind: str) -> bpy.types.NodeTree:
    """The file's group, made if it is not there."""
    for group in bpy.data.node_groups:
        if group.library is None and kind_of(group) == kind and is_intact(group):
            return group
    return _make(kind)


def remove_unused() -> None:
    """Remove the groups that no modifier uses any more."""
    for group in list(bpy.data.node_groups):
        if group.library is None and kind_of(group) and group.users == 0:
            bpy.data.node_groups.remove(group)


def _digest(group: bpy.types.NodeTree) -> str:
    """By kinds of nodes, links, names of attributes and distances: other sockets change with Blender's versions."""
    words = [node.bl_idname + (" off" if node.mute else "") for node in group.nodes]
    for link in group.links:
        words.append(f"{link.from_node.bl_idname} > {link.to_node.bl_idname}")
    told = (node.inputs.get(name) for node in group.nodes for name in ("Name", "Distance"))
    words += [str(socket.default_value) for socket in told if socket is not None]
    return drift.digest("\n".join(sorted(words)).encode())


def _make(kind: str) -> bpy.types.NodeTree:
    group = bpy.data.node_groups.new(_NAMES[kind], "GeometryNodeTree")
    group[TEAR_GROUP_MARK] = kind
    group.is_modifier = True
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    _Nodes(group).mend() if kind == MEND else _Nodes(group).split(kind)
    group[TEAR_GROUP_DIGEST] = _digest(group)
    return group


class _Nodes:
    """Puts nodes into a group, from left to right."""

    def __init__(self, group: bpy.types.NodeTree) -> None:
        self._group = group
        self._across = 0.0
        self._geometry = self._add("NodeGroupInput").outputs["Geometry"]

    def split(self, kind: str) -> None:
        """Store where points come from, and split."""
        is_torn = kind == TORN
        chosen = self._named(TEAR_ATTRIBUTE, "BOOLEAN") if is_torn else self._with_faces()
        store = self._add("GeometryNodeStoreNamedAttribute")
        store.data_type, store.domain = "INT", "POINT"
        store.inputs["Name"].default_value = ORIGIN_ATTRIBUTE
        if is_torn:
            self._link(chosen, store.inputs["Selection"])
        self._link(self._number_from_one(), _used(store.inputs, "Value"))
        self._pass(store, "Geometry")
        split = self._add("GeometryNodeSplitEdges")
        self._link(chosen, split.inputs["Selection"])
        self._pass(split, "Mesh")
        self._end()

    def mend(self) -> None:
        """Move points to where those that are to be one meet, merge them there, and move them back."""
        torn, position = self._geometry, self._add("GeometryNodeInputPosition").outputs["Position"]
        origin = self._named(ORIGIN_ATTRIBUTE, "INT")
        cube = self._add("ShaderNodeTexWhiteNoise")
        cube.noise_dimensions = "4D"
        self._link(position, cube.inputs["Vector"])
        self._link(origin, cube.inputs["W"])
        self._move(cube.outputs["Color"], origin)
        merge = self._add("GeometryNodeMergeByDistance")
        merge.inputs["Distance"].default_value = _APART
        self._link(origin, merge.inputs["Selection"])
        self._pass(merge, "Geometry")
        corners = self._add("GeometryNodeCornersOfVertex")
        sample = self._add("GeometryNodeSampleIndex")  # merging takes means, which may round
        sample.data_type, sample.domain = "FLOAT_VECTOR", "CORNER"
        self._link(torn, sample.inputs["Geometry"])
        self._link(position, _used(sample.inputs, "Value"))
        self._link(corners.outputs["Corner Index"], sample.inputs["Index"])
        self._move(_used(sample.outputs, "Value"), origin)
        for name in (ORIGIN_ATTRIBUTE, TEAR_ATTRIBUTE):
            remove = self._add("GeometryNodeRemoveAttribute")
            remove.inputs["Name"].default_value = name
            self._pass(remove, "Geometry")
        self._end()

    def _move(self, to: bpy.types.NodeSocket, chosen: bpy.types.NodeSocket) -> None:
        place = self._add("GeometryNodeSetPosition")
        self._link(to, place.inputs["Position"])
        self._link(chosen, place.inputs["Selection"])
        self._pass(place, "Geometry")

    def _named(self, name: str, kind: str) -> bpy.types.NodeSocket:
        node = self._add("GeometryNodeInputNamedAttribute")
        node.data_type = kind
        node.inputs["Name"].default_value = name
        return _used(node.outputs, "Attribute")

    def _number_from_one(self) -> bpy.types.NodeSocket:
        index, more = self._add("GeometryNodeInputIndex"), self._add("ShaderNodeMath")
        more.operation = "ADD"
        more.inputs[1].default_value = 1.0
        self._link(index.outputs["Index"], more.inputs[0])
        return more.outputs["Value"]

    def _with_faces(self) -> bpy.types.NodeSocket:
        """Loose edges are seams, which stay where they are."""
        neighbors = self._add("GeometryNodeInputMeshEdgeNeighbors")
        compare = self._add("FunctionNodeCompare")
        compare.data_type, compare.operation = "INT", "GREATER_THAN"
        one, other = (socket for socket in compare.inputs if socket.type == "INT")
        self._link(neighbors.outputs[0], one)
        other.default_value = 0
        return compare.outputs[0]

    def _add(self, kind: str) -> bpy.types.Node:
        node = self._group.nodes.new(kind)
        node.location = (self._across, 0.0)
        self._across += 200.0
        return node

    def _link(self, one: bpy.types.NodeSocket, other: bpy.types.NodeSocket) -> None:
        self._group.links.new(one, other)

    def _pass(self, node: bpy.types.Node, name: str) -> None:
        """Let the geometry go through a node."""
        self._link(self._geometry, node.inputs[name])
        self._geometry = node.outputs[name]

    def _end(self) -> None:
        self._link(self._geometry, self._add("NodeGroupOutput").inputs["Geometry"])


def _used(sockets: bpy.types.NodeInputs, name: str) -> bpy.types.NodeSocket:
    """The socket of that name for the type of data that the node has now."""
    return next(socket for socket in sockets if socket.name == name and socket.enabled)
