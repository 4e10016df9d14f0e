"""Stocking stitch: columns of V, each leg a bow of plied yarn.

In a column, with x from -1 to 1 across it, the legs of one stitch after the other follow `v - slope |x|`; a leg is thick in its
middle and thin where it dips below its neighbours.
"""

from __future__ import annotations

import math

from .graph import Graph
from .surface import Place, Surface

_SLOPE = 0.75
"""Rows by which a leg climbs from the middle of its column to the border."""
_ROWS = 1.35
"""Rows of stitches on the width of a column."""


def surface(graph: Graph, place: Place) -> Surface:
    """Legs side by side; the yarn's plies turn about them."""
    u, v = place.u, place.v * _ROWS
    wobble = graph.noise(graph.vector(u * 0.7, v * 0.7), 2.0) * 0.16
    u, v = u + wobble, v + wobble * 0.8
    column = u.floor()
    x = ((u - column) * 2.0 - 1.0).size()
    climbing = v - x * _SLOPE
    stitch = climbing.floor()
    across = (climbing - stitch) * 2.0 - 1.0
    # A leg leans outwards at its top: its middle line is not the middle of its half column.
    lengthwise = (x - 0.5) * 2.0
    bow = (1.0 - across * across * 0.92).root()
    taper = (1.0 - lengthwise * lengthwise * 0.94).root()
    plies = ((lengthwise * 1.1 + across * 0.55) * (2.0 * math.pi)).sine()
    fuzz = graph.noise(graph.vector(u * 9.0, v * 9.0), 4.0)
    height = bow * taper * 0.82 + plies * 0.07 * bow + fuzz * 0.16
    own = graph.white(stitch + column * 131.7) - 0.5
    shade = own * 0.14 + fuzz * 0.5 + plies * 0.05 + 1.0
    depth = (height * 1.25).smooth() * 0.75 + 0.25
    color = graph.mixed(own + 0.5, place.color, place.second)
    return Surface(graph.shaded(color, shade * depth), height)
