"""What changes a cloth's shape: shrink, pressure and seams as keys of a scene, and their values at a frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from .points import Points

Numbers = Sequence[float]


class ShapeGroups(NamedTuple):
    """What the mesh and its vertex groups say of the shape."""

    shrink_weights: Numbers = ()
    """For every vertex, 0 to 1; none for a shrink that is the same everywhere."""
    pressure_weights: Numbers = ()
    """For every vertex, 0 to 1; none for a pressure that is the same everywhere."""
    seams: Sequence[Sequence[int]] | None = None
    """Both vertices of each loose edge; None where they were not asked for."""


class Simulation(Protocol):
    """What a shape needs of the solver."""

    def set_rest(
        self, cloth: int, shape: Points | None, shrink: tuple[float, float] | None
    ) -> None: ...
    def set_pressure(
        self, cloth: int, uniform: float, factor: float, target_volume: float | None
    ) -> None: ...


class Shape(NamedTuple):
    """The shape that a frame asks for."""

    rest: Points | None = None
    """Rest positions (m, world space) of all vertices; None for those of the start."""
    shrink: tuple[float, float] | None = None
    """By which fraction rest lengths are less at vertices of weight 0 and 1; None for that of the start."""
    pressure: tuple[float, float, float | None] | None = None
    """Uniform pressure and factor (N/m²) and target volume (m³); None for that of the start."""

    def aim(self, simulation: Simulation, cloth: int) -> None:
        """Tell a simulation what the shape of a cloth is to be at the end of the next frame."""
        if self.rest is not None or self.shrink is not None:
            simulation.set_rest(cloth, self.rest, self.shrink)
        if self.pressure is not None:
            simulation.set_pressure(cloth, *self.pressure)


def decimal(value: float) -> float:
    """A float32 property as the decimal that the user typed: 0.1, not 0.10000000149011612."""
    return float(f"{value:.7g}")


def shrink(values: Mapping[str, Any]) -> tuple[float, float]:
    """The shrink of vertices of weight 0 and 1."""
    return decimal(values.get("shrink_min", 0.0)), decimal(values.get("shrink_max", 0.0))


def pressure(values: Mapping[str, Any]) -> tuple[float, float, float | None]:
    """Uniform pressure and factor (N/m²) and target volume (m³), None for that at rest."""
    target = decimal(values["target_volume"]) if values["use_pressure_volume"] else None
    return decimal(values["uniform_pressure_force"]), decimal(values["pressure_factor"]), target


def describe(values: Mapping[str, Any], groups: ShapeGroups) -> dict[str, Any]:
    """The keys of one cloth; none where its shape is left alone."""
    out: dict[str, Any] = {}
    least, most = shrink(values)
    if least or values.get("shrink_group"):
        out["shrink"] = {"min": least, "max": most}
        if groups.shrink_weights:
            out["shrink"]["weights"] = list(groups.shrink_weights)
    if values.get("use_pressure"):
        uniform, factor, target = pressure(values)
        out["pressure"] = {"uniform": uniform, "factor": factor}
        if target is not None:
            out["pressure"]["target_volume"] = target
        if groups.pressure_weights:
            out["pressure"]["weights"] = list(groups.pressure_weights)
    if values.get("use_sewing_springs"):
        out["sewing"] = {
            "force_max": decimal(values["sewing_force_max"]),
            "weld_distance": decimal(values["weld_distance"]),
        }
        if groups.seams is not None:
            out["sewing"]["seams"] = [list(seam) for seam in groups.seams]
    return out


def steady(scene: Mapping[str, Any], rest: str, moving: Sequence[str]) -> dict[str, Any]:
    """The scene as a bake remembers it: what moves in time is the same at every frame, and the rest shape has its name.

    Args:
        scene: The description of one cloth.
        rest: What the rest shape is; empty for that of the start.
        moving: Which of "shrink" and "pressure" are animated.
    """
    cloth = dict(scene["cloth"][0])
    for key in moving:
        numbers = dict(cloth.get(key, {}))
        weights = {"weights": numbers["weights"]} if "weights" in numbers else {}
        cloth[key] = {**weights, "animated": True}
    if rest:
        cloth["rest_shape"] = rest
    return {**scene, "cloth": [cloth]}
