"""The geometry-nodes group that stores, at its place in the stack, where every vertex is."""

from __future__ import annotations

import bpy

from .._identifiers import TARGET_ATTRIBUTE, TARGET_GROUP, TARGET_GROUP_MARK


def is_ours(group: bpy.types.NodeTree | None) -> bool:
    """Whether a node group is this one, in this file or linked."""
    return group is not None and bool(group.get(TARGET_GROUP_MARK))


def ensure() -> bpy.types.NodeTree:
    """The file's group, made if it is not there."""
    for group in bpy.data.node_groups:
        if group.library is None and is_ours(group):
            return group
    return _make()


def remove_if_unused() -> None:
    """Remove the group when no modifier uses it any more."""
    for group in list(bpy.data.node_groups):
        if group.library is None and is_ours(group) and group.users == 0:
            bpy.data.node_groups.remove(group)


def _make() -> bpy.types.NodeTree:
    group = bpy.data.node_groups.new(TARGET_GROUP, "GeometryNodeTree")
    group[TARGET_GROUP_MARK] = True
    group.is_modifier = True
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    source = group.nodes.new("NodeGroupInput")
    position = group.nodes.new("GeometryNodeInputPosition")
    store = group.nodes.new("GeometryNodeStoreNamedAttribute")
    sink = group.nodes.new("NodeGroupOutput")
    store.data_type = "FLOAT_VECTOR"
    store.domain = "POINT"
    store.inputs["Name"].default_value = TARGET_ATTRIBUTE
    value = next(
        socket for socket in store.inputs if socket.name == "Value" and socket.type == "VECTOR"
    )
    group.links.new(source.outputs["Geometry"], store.inputs["Geometry"])
    group.links.new(position.outputs["Position"], value)
    group.links.new(store.outputs["Geometry"], sink.inputs["Geometry"])
    for column, node in enumerate((source, position, store, sink)):
        node.location = (200.0 * column, 0.0 if node is not position else -120.0)
    return group
