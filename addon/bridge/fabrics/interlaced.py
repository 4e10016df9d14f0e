"""Woven fabrics: warp threads along v, weft threads along u, one over the other by a repeating pattern.

The warp thread i goes below the weft thread j where `(j - step i) mod repeat = 0`; everywhere else it lies on top:

    plain weave   repeat 2, step 1        twill 3/1   repeat 4, step 1        satin   repeat 8, step 3
"""

from __future__ import annotations

import math
from typing import NamedTuple

from .graph import Graph, Number
from .surface import Place, Surface


class Pattern(NamedTuple):
    """How warp and weft interlace."""

    repeat: int
    step: int
    """From one warp thread to the next, the crossing moves on by so many."""
    back: int
    """`step back = 1 mod repeat`: the same, seen from the weft."""
    uneven: float
    """How much threads vary in shade and wander, in threads."""


PLAIN = Pattern(2, 1, 1, 0.22)
TWILL = Pattern(4, 1, 1, 0.12)
SATIN = Pattern(8, 3, 3, 0.05)


def surface(graph: Graph, place: Place, pattern: Pattern) -> Surface:
    """Threads as half cylinders that rise and sink; the higher one is seen."""
    u, v = place.u, place.v
    wander = pattern.uneven
    drift = graph.noise(graph.vector(u * 0.35, v * 0.08), 1.0) * (2.5 * wander)
    across = graph.noise(graph.vector(u * 0.08 + 50.0, v * 0.35), 1.0) * (2.5 * wander)
    u, v = u + drift, v + across
    i, j = u.floor(), v.floor()
    dive = _dive((v - i * float(pattern.step)) % float(pattern.repeat), pattern.repeat)
    rise = _dive((u - j * float(pattern.back)) % float(pattern.repeat), pattern.repeat)
    warp = _thread(graph, u - i, i, v, pattern)
    weft = _thread(graph, v - j, j + 7777.0, u, pattern)
    warp_height = warp.height + 0.55 * (1.0 - dive)
    weft_height = weft.height + 0.55 * rise
    is_weft = ((weft_height - warp_height) * 6.0 + 0.5).smooth()
    height = warp_height.at_least(weft_height) * 0.6
    color = graph.mixed(
        is_weft, graph.shaded(place.color, warp.shade), graph.shaded(place.second, weft.shade)
    )
    groove = (height * 1.4).smooth() * 0.6 + 0.4
    return Surface(graph.shaded(color, groove), height)


def _dive(phase: Number, repeat: int) -> Number:
    """1 where a thread is at the other side, in the middle of the first of `repeat` threads, 0 one thread away."""
    away = ((phase - 0.5 + 0.5 * repeat) % float(repeat) - 0.5 * repeat).size()
    return (1.0 - away).smooth()


class _Thread(NamedTuple):
    height: Number
    shade: Number


def _thread(
    graph: Graph, across: Number, number: Number, along: Number, pattern: Pattern
) -> _Thread:
    """The round top of a thread, its plies and its own shade."""
    middle = across * 2.0 - 1.0
    slub = graph.noise(graph.vector(along * 0.06, number * 13.7), 2.0) * (2.0 * pattern.uneven)
    width = slub + 0.98
    ratio = middle / width
    bow = (1.0 - ratio * ratio).root()
    twist = ((along * 1.6 + across * 0.9) * (2.0 * math.pi)).sine()
    fuzz = graph.noise(graph.vector(along * 2.0, (number + across) * 9.0), 3.0)
    height = bow * 0.5 + (twist * 0.05 + fuzz * 0.25) * (0.2 + 2.0 * pattern.uneven)
    shade = (graph.white(number) - 0.5) * (2.0 * pattern.uneven) + slub * 0.5 + fuzz * 0.35 + 1.0
    return _Thread(height, shade)
