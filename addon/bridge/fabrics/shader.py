"""The frame around every fabric's formulas: from the UV map to yarns, and from colour and height to light."""

from __future__ import annotations

from typing import NamedTuple

import bpy

from .graph import Graph, Number, Socket
from .surface import Place, Surface


class Input(NamedTuple):
    """A value of the group that the user may change."""

    name: str
    kind: str
    description: str
    least: float = 0.0
    most: float = 1.0
    subtype: str = "NONE"

    def add_to(self, group: bpy.types.NodeTree) -> None:
        """Make the socket."""
        socket = group.interface.new_socket(
            self.name, in_out="INPUT", socket_type=f"NodeSocket{self.kind}"
        )
        socket.description = self.description
        if self.kind == "Float":
            socket.min_value, socket.max_value = self.least, self.most
            socket.subtype = self.subtype


GROUP_INPUTS = (
    Input("Color", "Color", "Colour of the yarn, or of the warp"),
    Input("Second Color", "Color", "Colour of the weft, of every other loop or of specks"),
    Input(
        "Yarn Size",
        "Float",
        "From one thread, stitch or loop to the next (m)",
        1e-5,
        1.0,
        "DISTANCE",
    ),
    Input("Width", "Float", "Metres that one unit of the UV map is along u", 1e-6, 1e6, "DISTANCE"),
    Input(
        "Height", "Float", "Metres that one unit of the UV map is along v", 1e-6, 1e6, "DISTANCE"
    ),
    Input("Relief", "Float", "Height of the threads (m)", 0.0, 0.1, "DISTANCE"),
    Input("Roughness", "Float", "Of the fibres, as in Principled BSDF", subtype="FACTOR"),
    Input("Sheen", "Float", "Light that fuzz catches at the edge", subtype="FACTOR"),
    Input("Translucency", "Float", "Part of the light that goes through", subtype="FACTOR"),
)


def read_place(graph: Graph, source: bpy.types.Node) -> Place:
    """Where on the cloth, in yarns."""
    where = Socket(graph, graph.node("ShaderNodeUVMap").outputs["UV"])
    u, v = graph.parts(where)
    yarn = Number(graph, source.outputs["Yarn Size"])
    return Place(
        u * Number(graph, source.outputs["Width"]) / yarn,
        v * Number(graph, source.outputs["Height"]) / yarn,
        Socket(graph, source.outputs["Color"]),
        Socket(graph, source.outputs["Second Color"]),
    )


def finish(graph: Graph, source: bpy.types.Node, surface: Surface, is_shiny: bool) -> None:
    """Light on the surface: fibres that scatter, fuzz, and what shines through."""

    def value(name: str) -> Number:
        return Number(graph, source.outputs[name])

    bump = graph.node("ShaderNodeBump")
    bump.inputs["Strength"].default_value = 1.0
    graph.feed(bump.inputs["Distance"], value("Relief"))
    graph.feed(bump.inputs["Height"], surface.height)
    normal = Socket(graph, bump.outputs["Normal"])
    fibres = graph.node("ShaderNodeBsdfPrincipled")
    fibres.inputs["Specular IOR Level"].default_value = 0.5 if is_shiny else 0.2
    fibres.inputs["Sheen Roughness"].default_value = 0.5
    graph.feed(fibres.inputs["Base Color"], surface.color)
    graph.feed(fibres.inputs["Roughness"], value("Roughness"))
    graph.feed(fibres.inputs["Sheen Weight"], value("Sheen"))
    graph.feed(fibres.inputs["Sheen Tint"], graph.mixed(0.5, surface.color, (1.0, 1.0, 1.0, 1.0)))
    graph.feed(fibres.inputs["Normal"], normal)
    if is_shiny:
        fibres.inputs["Anisotropic"].default_value = 0.75
        tangent = graph.node("ShaderNodeTangent", direction_type="UV_MAP")
        graph.feed(fibres.inputs["Tangent"], Socket(graph, tangent.outputs["Tangent"]))
    through = graph.node("ShaderNodeBsdfTranslucent")
    graph.feed(through.inputs["Color"], surface.color)
    graph.feed(through.inputs["Normal"], normal)
    both = graph.node("ShaderNodeMixShader")
    graph.feed(both.inputs[0], value("Translucency"))
    graph.tree.links.new(fibres.outputs["BSDF"], both.inputs[1])
    graph.tree.links.new(through.outputs["BSDF"], both.inputs[2])
    sink = graph.node("NodeGroupOutput")
    graph.tree.links.new(both.outputs["Shader"], sink.inputs["Shader"])
