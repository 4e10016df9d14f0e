"""The fabrics that a cloth can look like: their names, colours and yarns.

Colours are linear RGB. The yarn's size is the distance from one thread, stitch or loop to the next.
"""

from __future__ import annotations

from typing import NamedTuple

Color = tuple[float, float, float]


class Fabric(NamedTuple):
    """What one of them looks like unless the user says otherwise."""

    key: str
    label: str
    description: str
    color: Color
    """Of the yarn; of the warp where there are two."""
    second: Color
    """Of the weft, of the other loops or of the specks."""
    yarn: float
    """(m)"""
    relief: float
    """Height of the threads (m)."""
    roughness: float
    sheen: float
    """Fibres that catch the light at the edge, 0 to 1."""
    translucency: float
    """Part of the light that goes through."""


WEAVE = Fabric(
    "weave", "Linen", "Plain weave of uneven yarns, one over and one under",
    (0.62, 0.52, 0.38), (0.70, 0.61, 0.47), 1.1e-3, 0.5e-3, 0.85, 0.15, 0.15,
)  # fmt: skip
DENIM = Fabric(
    "denim", "Denim", "Twill of a dyed warp and a white weft, three over and one under",
    (0.030, 0.062, 0.165), (0.52, 0.52, 0.48), 0.8e-3, 0.45e-3, 0.85, 0.10, 0.0,
)  # fmt: skip
SATIN = Fabric(
    "satin", "Satin", "Smooth threads that float over seven others, shining across them",
    (0.30, 0.020, 0.055), (0.42, 0.035, 0.080), 0.35e-3, 0.03e-3, 0.34, 0.05, 0.05,
)  # fmt: skip
KNIT = Fabric(
    "knit", "Knit", "Columns of stitches of a plied wool yarn",
    (0.60, 0.34, 0.085), (0.52, 0.27, 0.060), 5.0e-3, 2.4e-3, 0.9, 0.35, 0.05,
)  # fmt: skip
BOUCLE = Fabric(
    "boucle", "Bouclé", "Rows of loops and curls of a thick, fuzzy yarn",
    (0.80, 0.70, 0.56), (0.66, 0.54, 0.40), 6.5e-3, 4.5e-3, 0.95, 0.25, 0.05,
)  # fmt: skip
FELT = Fabric(
    "felt", "Felt", "Matted fibres in all directions",
    (0.16, 0.25, 0.20), (0.36, 0.45, 0.38), 2.2e-3, 0.4e-3, 0.95, 0.5, 0.0,
)  # fmt: skip
ALL = (WEAVE, DENIM, SATIN, KNIT, BOUCLE, FELT)
BY_KEY = {fabric.key: fabric for fabric in ALL}
