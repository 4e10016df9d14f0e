"""The geometry-nodes groups that split a mesh: along the edges that a bake tears, or along all of them."""

from __future__ import annotations

import bpy

from .._identifiers import SPLIT_GROUP, TEAR_ATTRIBUTE, TEAR_GROUP, TEAR_GROUP_MARK

TORN, ALL = "torn", "all"
_NAMES = {TORN: TEAR_GROUP, ALL: SPLIT_GROUP}


def kind_of(group: bpy.types.NodeTree | None) -> str:
    """Which edges a group splits; empty for a stranger's."""
    return str(group.get(TEAR_GROUP_MARK, "")) if group is not None else ""


def ensure(kind: str) -> bpy.types.NodeTree:
    """The file's group, made if it is not there."""
    for group in bpy.data.node_groups:
        if group.library is None and kind_of(group) == kind:
            return group
    return _make(kind)


def remove_unused() -> None:
    """Remove the groups that no modifier uses any more."""
    for group in list(bpy.data.node_groups):
        if group.library is None and kind_of(group) and group.users == 0:
            bpy.data.node_groups.remove(group)


def _make(kind: str) -> bpy.types.NodeTree:
    group = bpy.data.node_groups.new(_NAMES[kind], "GeometryNodeTree")
    group[TEAR_GROUP_MARK] = kind
    group.is_modifier = True
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    source = group.nodes.new("NodeGroupInput")
    split = group.nodes.new("GeometryNodeSplitEdges")
    sink = group.nodes.new("NodeGroupOutput")
    chosen = _torn(group) if kind == TORN else _with_faces(group)
    group.links.new(chosen, split.inputs["Selection"])
    group.links.new(source.outputs["Geometry"], split.inputs["Mesh"])
    group.links.new(split.outputs["Mesh"], sink.inputs["Geometry"])
    for column, node in enumerate((source, split, sink)):
        node.location = (400.0 * column, 0.0)
    return group


def _torn(group: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    node = group.nodes.new("GeometryNodeInputNamedAttribute")
    node.data_type = "BOOLEAN"
    node.inputs["Name"].default_value = TEAR_ATTRIBUTE
    node.location = (200.0, -120.0)
    return next(
        socket for socket in node.outputs if socket.name == "Attribute" and socket.type == "BOOLEAN"
    )


def _with_faces(group: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    """Loose edges are seams, which stay where they are."""
    neighbors = group.nodes.new("GeometryNodeInputMeshEdgeNeighbors")
    compare = group.nodes.new("FunctionNodeCompare")
    compare.data_type, compare.operation = "INT", "GREATER_THAN"
    one, other = (socket for socket in compare.inputs if socket.type == "INT")
    group.links.new(neighbors.outputs[0], one)
    other.default_value = 0
    neighbors.location, compare.location = (0.0, -120.0), (200.0, -120.0)
    return compare.outputs[0]
