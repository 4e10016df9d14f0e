"""Scenes that are only asked what passes through what: a cloth against itself, or against colliders alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Scene = Mapping[str, Any]


def against_itself(scene: Scene) -> dict[str, Any] | None:
    """The scene of a cloth without its colliders; None if it does not meet itself."""
    collision = scene["cloth"][0]["collision"]
    if not collision.get("self"):
        return None
    without = {key: collision[key] for key in collision if key != "excluded_from_colliders"}
    return _with(scene, without, [])


def against_colliders(scene: Scene) -> dict[str, Any] | None:
    """The scene of a cloth that meets its colliders and not itself; None without colliders."""
    colliders = scene.get("collider", [])
    if not colliders:
        return None
    collision = scene["cloth"][0]["collision"]
    without = {key: collision[key] for key in collision if key != "excluded_from_self"}
    return _with(scene, {**without, "self": False}, list(colliders))


def against(scene: Scene, name: str) -> dict[str, Any]:
    """The scene of a cloth and one object, which need not be a collider of it."""
    collision = {"self": False, "thickness": 1e-3, "friction": 0.0}
    return _with(scene, collision, [{"name": name, "thickness": 0.0, "friction": 0.0}])


def _with(
    scene: Scene, collision: Mapping[str, Any], colliders: list[Mapping[str, Any]]
) -> dict[str, Any]:
    """Nothing is simulated: neither pins nor forces nor steps matter."""
    out: dict[str, Any] = {
        "scene": {"frames": [0, 1]},
        "cloth": [
            {"name": scene["cloth"][0]["name"], "model": "springs", "collision": dict(collision)}
        ],
    }
    if colliders:
        out["collider"] = colliders
    return out
