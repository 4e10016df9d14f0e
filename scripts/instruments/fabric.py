"""The fabric on the bench: a preset of the module, or one with some numbers changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import boucle_core

GRAVITY = 9.81
"""m/s²."""


@dataclass(frozen=True)
class Fabric:
    """A named fabric; `changes` are numbers by their keys in `[cloth.fabric]`, or `density`."""

    preset: str
    changes: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.preset not in boucle_core.fabric_presets():
            names = ", ".join(boucle_core.fabric_presets())
            raise ValueError(f"there is no fabric {self.preset!r}; accepted: {names}")

    def number(self, key: str) -> float:
        """One of its numbers, in SI units."""
        return float(self.changes.get(key, boucle_core.fabric_presets()[self.preset][key]))

    @property
    def band(self) -> tuple[float, float] | None:
        """Between what its drape coefficient (%) is said to lie, where anybody says so."""
        said = boucle_core.fabric_presets()[self.preset].get("drape_coefficient")
        return None if said is None else (float(said[0]), float(said[1]))

    @property
    def weight(self) -> float:
        """Weight of an area (N/m²)."""
        return self.number("density") * GRAVITY

    def pressed(self) -> Fabric:
        """The same between two panes, where no yarn can buckle: compression is resisted as tension is."""
        ways = ("warp", "weft")
        stiff = {f"compression_{way}": self.number(f"stretch_{way}") for way in ways}
        return replace(self, changes={**self.changes, **stiff})

    def keys(self) -> dict[str, object]:
        """What `[cloth.fabric]` says of it. Without a limiter: instruments measure the law, not the limit to it."""
        own = {key: value for key, value in self.changes.items() if key != "density"}
        return {"preset": self.preset, **own, "limiter": "none"}
