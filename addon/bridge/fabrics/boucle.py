"""Bouclé: a looped yarn, the fabric that gave us our name.

Loops lie in rows, each about a point of a jittered grid: a ring of yarn with its own radius, squeezed and bent by noise. Three
layers of them lie over each other; what is highest is seen. Fuzz covers all.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from .graph import Graph, Number, Socket
from .surface import Place, Surface

_LAYERS = ((0.0, 0.0, 1.0), (13.5, 57.37, 0.93), (71.21, 31.71, 0.86))
"""Shift of each layer, in loops and so far that they have nothing in common, and how high it lies."""


class _Loops(NamedTuple):
    height: Number
    own: Number
    """A random number of each loop, 0 to 1."""


def surface(graph: Graph, place: Place) -> Surface:
    """The layers, the highest of which is seen, and the fuzz on them."""
    u, v = place.u, place.v
    bend_u = graph.noise(graph.vector(u * 1.1, v * 1.1), 1.0)
    bend_v = graph.noise(graph.vector(u * 1.1 + 31.0, v * 1.1 + 17.0), 1.0)
    u, v = u + bend_u * 0.45, v + bend_v * 0.45
    height: Number | None = None
    own: Number | None = None
    for shift_u, shift_v, level in _LAYERS:
        loops = _loops(graph, u + shift_u, v + shift_v, level)
        if height is None or own is None:
            height, own = loops.height, loops.own
            continue
        is_over = loops.height.above(height)
        own = own + (loops.own - own) * is_over
        height = height.at_least(loops.height)
    fuzz = graph.noise(graph.vector(u * 11.0, v * 11.0), 2.0)
    height = height.at_least(0.22) + fuzz * 0.16
    depth = (height * 1.1).smooth() * 0.8 + 0.2
    color = graph.mixed(own, place.color, place.second)
    return Surface(graph.shaded(color, depth * (fuzz * 0.4 + 1.0)), height)


def _loops(graph: Graph, u: Number, v: Number, level: float) -> _Loops:
    """One layer: a ring about each point."""
    cells = graph.node("ShaderNodeTexVoronoi", voronoi_dimensions="2D", feature="F1")
    graph.feed(cells.inputs["Vector"], graph.vector(u, v))
    cells.inputs["Scale"].default_value = 1.0
    cells.inputs["Randomness"].default_value = 0.55
    middle_u, middle_v = graph.parts(Socket(graph, cells.outputs["Position"]))
    first, second = graph.parts(Socket(graph, cells.outputs["Color"]))
    du, dv = u - middle_u, v - middle_v
    # Rows: loops are wider than high, some the other way round.
    squeeze = first * 0.5 + 0.75
    x, y = du * squeeze, dv / squeeze
    radius = (x * x + y * y).root()
    ring = second * 0.14 + 0.17
    away = (radius - ring) / 0.14
    bow = (1.0 - away * away).root()
    angle = graph.math("ARCTAN2", y, x)
    plies = (angle * 7.0 + away * 2.2).sine()
    # Each loop leans: one side comes out of the cloth, the other sinks into it.
    lean = (angle + first * (2.0 * math.pi)).sine()
    height = bow * (lean * 0.22 + 0.72 + plies * 0.06) * level
    return _Loops(height, first)
