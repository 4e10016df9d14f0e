"""Felt: fibres in all directions, as noise that is drawn out along bent lines."""

from __future__ import annotations

import math

from .graph import Graph, Number
from .surface import Place, Surface

_DIRECTIONS = 4


def surface(graph: Graph, place: Place) -> Surface:
    """The highest of some layers of fibres over a soft, lumpy ground."""
    u, v = place.u, place.v
    bend_u = graph.noise(graph.vector(u * 0.8, v * 0.8), 2.0)
    bend_v = graph.noise(graph.vector(u * 0.8 + 19.0, v * 0.8 + 43.0), 2.0)
    u, v = u + bend_u * 1.6, v + bend_v * 1.6
    fibres: Number | None = None
    for number in range(_DIRECTIONS):
        angle = math.pi * (number + 0.3) / _DIRECTIONS
        c, s = math.cos(angle), math.sin(angle)
        along = u * c + v * s
        across = v * c - u * s
        strands = graph.noise(graph.vector(along * 0.9 + 7.0 * number, across * 13.0), 1.0)
        ridge = 1.0 - (strands * 5.0).size()
        fibres = ridge if fibres is None else fibres.at_least(ridge)
    lumps = graph.noise(graph.vector(u * 0.35, v * 0.35), 3.0)
    height = fibres.at_least(0.0) * 0.55 + lumps * 0.8 + 0.3
    speck = (graph.noise(graph.vector(u * 2.5, v * 2.5), 2.0) * 4.0 - 0.35).smooth()
    color = graph.mixed(speck * fibres.at_least(0.0) * 0.6, place.color, place.second)
    return Surface(graph.shaded(color, height * 0.55 + 0.62), height)
