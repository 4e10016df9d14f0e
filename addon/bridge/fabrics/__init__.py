"""Materials that look like cloth: a node group for each fabric, procedural, in real size.

A group takes colours, the yarn's size (m) and how many metres the UV map stands for, and gives a shader for Cycles and EEVEE.
Every material has its own values; the group is shared.
"""

from __future__ import annotations

from collections.abc import Callable

import bpy

from ..._identifiers import FABRIC_MARK
from ...core import fabric
from ...core.fabric import Fabric
from . import boucle, felt, interlaced, knit
from .graph import Graph
from .shader import GROUP_INPUTS, finish, read_place
from .surface import Place, Surface

_SURFACES: dict[str, Callable[[Graph, Place], Surface]] = {
    "weave": lambda graph, place: interlaced.surface(graph, place, interlaced.PLAIN),
    "denim": lambda graph, place: interlaced.surface(graph, place, interlaced.TWILL),
    "satin": lambda graph, place: interlaced.surface(graph, place, interlaced.SATIN),
    "knit": knit.surface,
    "boucle": boucle.surface,
    "felt": felt.surface,
}


def make(key: str, metres: tuple[float, float]) -> bpy.types.Material:
    """A new material of a fabric, for a cloth on which one unit of the UV map is so many metres along u and v."""
    chosen = fabric.BY_KEY[key]
    made = bpy.data.materials.new(f"Boucle {chosen.label}")
    made.use_nodes = True
    made.diffuse_color = (*chosen.color, 1.0)
    tree = made.node_tree
    tree.nodes.clear()
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = _group(chosen)
    node.name = node.label = chosen.label
    node.width = 220.0
    for name, value in defaults(chosen, metres).items():
        node.inputs[name].default_value = value
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    output.location = (320.0, 0.0)
    tree.links.new(node.outputs["Shader"], output.inputs["Surface"])
    return made


def group_node(material: bpy.types.Material) -> bpy.types.Node:
    """The node that holds a fabric's values."""
    return next(node for node in material.node_tree.nodes if node.type == "GROUP")


def defaults(chosen: Fabric, metres: tuple[float, float]) -> dict[str, object]:
    """The values of a fabric's group."""
    return {
        "Color": (*chosen.color, 1.0),
        "Second Color": (*chosen.second, 1.0),
        "Yarn Size": chosen.yarn,
        "Width": metres[0],
        "Height": metres[1],
        "Relief": chosen.relief,
        "Roughness": chosen.roughness,
        "Sheen": chosen.sheen,
        "Translucency": chosen.translucency,
    }


def _group(chosen: Fabric) -> bpy.types.NodeTree:
    """The file's group of a fabric, made if it is not there."""
    for group in bpy.data.node_groups:
        if group.library is None and group.get(FABRIC_MARK) == chosen.key:
            return group
    group = bpy.data.node_groups.new(f"Boucle {chosen.label}", "ShaderNodeTree")
    group[FABRIC_MARK] = chosen.key
    for row in GROUP_INPUTS:
        row.add_to(group)
    group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    graph = Graph(group)
    source = group.nodes.new("NodeGroupInput")
    surface = _SURFACES[chosen.key](graph, read_place(graph, source))
    finish(graph, source, surface, is_shiny=chosen.key == "satin")
    return group
