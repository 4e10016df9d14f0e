"""What a fabric's formulas get and give."""

from __future__ import annotations

from typing import NamedTuple

from .graph import Number, Socket


class Place(NamedTuple):
    """A point of the cloth, counted in yarns, and what it may be made of."""

    u: Number
    v: Number
    color: Socket
    second: Socket


class Surface(NamedTuple):
    """The cloth there."""

    color: Socket
    height: Number
    """0 in the deepest groove, 1 at the top of a thread."""
