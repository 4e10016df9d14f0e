"""What is told beside positions: one number a frame at every vertex, or at every corner of the faces where a cloth may tear."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from .._identifiers import (
    CONTACT_ATTRIBUTE,
    FORCE_ATTRIBUTE,
    INTERSECTION_ATTRIBUTE,
    STRAIN_ATTRIBUTE,
    TENSION_ATTRIBUTE,
)
from . import points
from .points import Points

Numbers = Mapping[str, Points]
"""Values, float32, by the key of their quantity: at the vertices (n,), or at the corners of faces (c,)."""


class Quantity(NamedTuple):
    """One of them."""

    key: str
    """Ending of the file in which a bake keeps it, and of the setting that asks for it: `use_<key>`."""
    attribute: str
    """The mesh's attribute."""
    reader: str
    """The method of a simulation that tells it of vertices; empty where it is of edges and told at corners alone."""
    label: str
    unit: str
    """In which the legend tells it; empty where it is counted."""
    factor: float
    """What makes that unit of a value."""


STRAIN = Quantity("strain", STRAIN_ATTRIBUTE, "read_strain", "Strain", "%", 100.0)
TENSION = Quantity("tension", TENSION_ATTRIBUTE, "read_tension", "Tension", "N", 1.0)
CONTACT = Quantity("contact", CONTACT_ATTRIBUTE, "read_contacts", "Contact", "N", 1.0)
INTERSECTION = Quantity(
    "intersection", INTERSECTION_ATTRIBUTE, "read_intersections", "Intersections", "", 1.0
)
FORCE = Quantity("force", FORCE_ATTRIBUTE, "", "Force in Edges", "N", 1.0)
"""At each corner, of the edge from there to the next corner of the face."""
ALL = (STRAIN, TENSION, CONTACT, INTERSECTION, FORCE)
BY_KEY = {quantity.key: quantity for quantity in ALL}


class Sizes(NamedTuple):
    """How many numbers a cloth has."""

    vertices: int
    corners: int
    is_torn: bool = False
    """Whether it may tear: then each side of a tear has its own numbers."""

    def at_corners(self, key: str) -> bool:
        """Whether a quantity is told at the corners of faces."""
        return self.is_torn or not BY_KEY[key].reader

    def count(self, key: str) -> int:
        """How many numbers of a quantity there are."""
        return self.corners if self.at_corners(key) else self.vertices


def empty(keys: tuple[str, ...], sizes: Sizes) -> dict[str, Points]:
    """A buffer for each quantity that is asked for."""
    return {key: points.empty("f", sizes.count(key)) for key in keys}


def read(simulation: Any, cloth: int, out: Numbers, sizes: Sizes) -> None:
    """Fill the buffers with the numbers of a cloth of a simulation."""
    for quantity in ALL:
        if quantity.key not in out:
            continue
        if sizes.at_corners(quantity.key):
            simulation.read_corner_numbers(cloth, quantity.key, out[quantity.key])
        else:
            getattr(simulation, quantity.reader)(cloth, out[quantity.key])
