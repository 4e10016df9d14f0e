"""What is told of every vertex beside its position: one number a frame."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from .._identifiers import (
    CONTACT_ATTRIBUTE,
    INTERSECTION_ATTRIBUTE,
    STRAIN_ATTRIBUTE,
    TENSION_ATTRIBUTE,
)
from . import points
from .points import Points

Numbers = Mapping[str, Points]
"""Values at the vertices, float32 (n,), by the key of their quantity."""


class Quantity(NamedTuple):
    """One of them."""

    key: str
    """Ending of the file in which a bake keeps it, and of the setting that asks for it: `use_<key>`."""
    attribute: str
    """The mesh's attribute."""
    reader: str
    """The method of a simulation that tells it."""
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
ALL = (STRAIN, TENSION, CONTACT, INTERSECTION)
BY_KEY = {quantity.key: quantity for quantity in ALL}


def empty(keys: tuple[str, ...], vertex_count: int) -> dict[str, Points]:
    """A buffer for each quantity that is asked for."""
    return {key: points.empty("f", vertex_count) for key in keys}


def read(simulation: Any, cloth: int, out: Numbers) -> None:
    """Fill the buffers with the numbers of a cloth of a simulation."""
    for quantity in ALL:
        if quantity.key in out:
            getattr(simulation, quantity.reader)(cloth, out[quantity.key])
