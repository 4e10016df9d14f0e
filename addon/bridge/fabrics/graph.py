"""Shader nodes written as formulas: `Number` and `Vector` stand for sockets, their operators for nodes.

    graph = Graph(tree)
    ring = (1.0 - (radius / width) ** 2).at_least(0.0).root()

The names of nodes and sockets are the same from Blender 4.2 to 5.2; every socket is asked for by name and must be there.
"""

from __future__ import annotations

from typing import Any

import bpy

_MATH = {
    "+": "ADD", "-": "SUBTRACT", "*": "MULTIPLY", "/": "DIVIDE", "**": "POWER", "max": "MAXIMUM",
    "min": "MINIMUM", "mod": "FLOORED_MODULO", ">": "GREATER_THAN", "smooth max": "SMOOTH_MAX",
}  # fmt: skip


class Graph:
    """A node tree that is being written."""

    def __init__(self, tree: bpy.types.NodeTree) -> None:
        self.tree = tree

    def node(self, kind: str, **properties: object) -> bpy.types.Node:
        """A new node; its properties are set."""
        made = self.tree.nodes.new(kind)
        for name, value in properties.items():
            setattr(made, name, value)
        return made

    def feed(self, socket: bpy.types.NodeSocket, value: Any) -> None:
        """Link a socket to a number, vector or colour of the graph, or give it a constant."""
        if isinstance(value, Socket):
            self.tree.links.new(value.socket, socket)
        else:
            socket.default_value = value

    def math(self, operation: str, *values: Any) -> Number:
        """A math node."""
        node = self.node("ShaderNodeMath", operation=operation)
        for socket, value in zip(node.inputs, values, strict=False):
            self.feed(socket, value)
        return Number(self, node.outputs[0])

    def vector(self, x: Any, y: Any, z: Any = 0.0) -> Socket:
        """A vector of three numbers."""
        node = self.node("ShaderNodeCombineXYZ")
        for name, value in zip("XYZ", (x, y, z), strict=True):
            self.feed(node.inputs[name], value)
        return Socket(self, node.outputs["Vector"])

    def parts(self, vector: Socket) -> tuple[Number, Number]:
        """Its x and y."""
        node = self.node("ShaderNodeSeparateXYZ")
        self.feed(node.inputs["Vector"], vector)
        return Number(self, node.outputs["X"]), Number(self, node.outputs["Y"])

    def noise(self, at: Socket, detail: float = 2.0) -> Number:
        """A smooth noise of one unit, -0.5 to 0.5 about."""
        node = self.node("ShaderNodeTexNoise", noise_dimensions="2D")
        self.feed(node.inputs["Vector"], at)
        node.inputs["Scale"].default_value = 1.0
        node.inputs["Detail"].default_value = detail
        return Number(self, _output(node, "Fac", "Factor")) - 0.5

    def white(self, at: Any) -> Number:
        """A random number, 0 to 1, for each value of a number."""
        node = self.node("ShaderNodeTexWhiteNoise", noise_dimensions="1D")
        self.feed(node.inputs["W"], at)
        return Number(self, node.outputs["Value"])

    def mixed(self, factor: Any, one: Any, other: Any) -> Socket:
        """A colour between two."""
        node = self.node("ShaderNodeMix", data_type="RGBA", clamp_factor=True)
        self.feed(_of_type(node.inputs, "Factor", "VALUE"), factor)
        self.feed(_of_type(node.inputs, "A", "RGBA"), one)
        self.feed(_of_type(node.inputs, "B", "RGBA"), other)
        return Socket(self, _of_type(node.outputs, "Result", "RGBA"))

    def shaded(self, color: Any, factor: Any) -> Socket:
        """A colour times a number."""
        node = self.node("ShaderNodeVectorMath", operation="SCALE")
        self.feed(node.inputs[0], color)
        self.feed(node.inputs["Scale"], factor)
        return Socket(self, node.outputs["Vector"])


class Socket:
    """What comes out of a node."""

    def __init__(self, graph: Graph, socket: bpy.types.NodeSocket) -> None:
        self.graph = graph
        self.socket = socket


class Number(Socket):
    """A number that comes out of a node."""

    def _math(self, word: str, *others: Any) -> Number:
        return self.graph.math(_MATH.get(word, word), self, *others)

    def __add__(self, other: Any) -> Number:
        return self._math("+", other)

    def __sub__(self, other: Any) -> Number:
        return self._math("-", other)

    def __mul__(self, other: Any) -> Number:
        return self._math("*", other)

    def __truediv__(self, other: Any) -> Number:
        return self._math("/", other)

    def __mod__(self, other: Any) -> Number:
        return self._math("mod", other)

    def __pow__(self, other: Any) -> Number:
        return self._math("**", other)

    def __rsub__(self, other: Any) -> Number:
        return self.graph.math("SUBTRACT", other, self)

    def __neg__(self) -> Number:
        return self * -1.0

    __radd__ = __add__
    __rmul__ = __mul__

    def floor(self) -> Number:
        """The next whole number below."""
        return self._math("FLOOR")

    def size(self) -> Number:
        """Without its sign."""
        return self._math("ABSOLUTE")

    def sine(self) -> Number:
        """Of an angle (rad)."""
        return self._math("SINE")

    def root(self) -> Number:
        """The square root of what is at least 0."""
        return self.at_least(0.0)._math("SQRT")

    def at_least(self, other: Any) -> Number:
        """The larger of both."""
        return self._math("max", other)

    def at_most(self, other: Any) -> Number:
        """The smaller of both."""
        return self._math("min", other)

    def above(self, other: Any) -> Number:
        """1 where it is larger, else 0."""
        return self._math(">", other)

    def smooth(self) -> Number:
        """From 0 to 1 as it goes from 0 to 1, without a kink."""
        part = self.at_least(0.0).at_most(1.0)
        return part * part * (3.0 - 2.0 * part)


def _output(node: bpy.types.Node, *names: str) -> bpy.types.NodeSocket:
    """The first output that has one of the names: some were renamed."""
    return next(node.outputs[name] for name in names if name in node.outputs)


def _of_type(sockets: bpy.types.bpy_prop_collection, name: str, kind: str) -> bpy.types.NodeSocket:
    """The socket of a name that a node has for several kinds of values."""
    return next(socket for socket in sockets if socket.name == name and socket.type == kind)
