"""The named fabrics of the compiled module as settings of a cloth, for either model."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

Fabric = Mapping[str, Any]
"""A fabric as the module tells it: the keys of rust/scene/presets/fabrics.toml."""

_OF_FABRIC = (
    "density", "friction", "deformation_rate", "stretch_warp", "stretch_weft", "shear", "bend_warp",
    "bend_weft", "damping_ratio", "tear_stress",
)  # fmt: skip
_OF_SPRINGS = (
    "stretch", "bend", "damping_stretch", "damping_shear", "damping_bend", "damping_law",
    "stiffness_from",
)  # fmt: skip
_SWITCHES = {
    "mass_mode": "density",
    "damping_ratio_per_kind": False,
    "damping_per_kind": True,
    "tear_force": 0.0,
    "tear_strain": 0.0,
}
"""Which of the numbers hold."""

_COMPRESSION = {"compression_warp": "stretch_warp", "compression_weft": "stretch_weft"}
"""Numbers that some fabrics have of their own, and what stands for them in the others."""

SETTINGS = (*_SWITCHES, "use_compression", *_COMPRESSION, *_OF_FABRIC, *_OF_SPRINGS)
"""What a fabric sets, besides the thickness; also what tells whether a cloth still is as its preset left it."""


class Row(NamedTuple):
    """A preset in a menu."""

    name: str
    """By which scenes and scripts call it."""
    group: str
    title: str


def rows(fabrics: Mapping[str, Fabric]) -> list[Row]:
    """All fabrics, group by group, in alphabetical order."""
    found = (Row(name, one["group"], one["title"]) for name, one in fabrics.items())
    return sorted(found, key=lambda row: (row.group, row.title))


def settings(fabric: Fabric, springs: Mapping[str, Any]) -> dict[str, Any]:
    """The settings of both models, by name.

    Args:
        fabric: The fabric.
        springs: What the module makes of it on the cloth's mesh: keys of `[cloth.springs]`.
    """
    of_fabric = {name: fabric[name] for name in _OF_FABRIC}
    of_fabric["use_compression"] = any(name in fabric for name in _COMPRESSION)
    for name, other in _COMPRESSION.items():
        of_fabric[name] = fabric.get(name, fabric[other])
    return {**_SWITCHES, **of_fabric, **{name: _typed(springs[name]) for name in _OF_SPRINGS}}


def _typed(value: Any) -> Any:
    """A computed number with the digits of one that is typed: those outlive a file and Blender's float32."""
    return float(f"{value:.5g}") if isinstance(value, float) else value


def thickness(fabric: Fabric) -> float:
    """How far a cloth of it reaches around its middle (m)."""
    return 0.5 * fabric["thickness"]


def sentence(fabric: Fabric) -> str:
    """The numbers of a fabric, for a tooltip."""
    both = [
        " and ".join(f"{factor * fabric[f'{key}_{yarn}']:.3g}" for yarn in ("warp", "weft"))
        for key, factor in (("stretch", 1e-3), ("bend", 1e6))
    ]
    return (
        f"{1e3 * fabric['density']:.0f} g/m², {1e3 * fabric['thickness']:.2g} mm thick; along warp and weft it "
        f"stretches by {both[0]} kN/m and bends by {both[1]} µN·m; shear {fabric['shear']:.0f} N/m; "
        f"it tears at {1e-3 * fabric['tear_stress']:.2g} kN/m"
    )
