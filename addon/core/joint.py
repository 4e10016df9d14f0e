"""Several cloths in one scene description, so that they collide with each other."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from .scene_json import settling

WATER = "water"
"""The kind of force of which cloths that are simulated together have the same one."""

Scene = Mapping[str, Any]
"""The description of one cloth among its colliders, or of several."""


class Groups(NamedTuple):
    """Which cloths are baked together."""

    together: list[list[str]]
    """Their names; each cloth stands once."""
    apart: list[str]
    """Why cloths that could meet are not baked together, a sentence each."""


def join(scenes: Sequence[Scene], meets: Callable[[str, str], bool]) -> dict[str, Any]:
    """One description of cloths that begin at the same frame.

    It goes on to the latest end, with the finest of their tolerances. Each cloth keeps its own colliders and forces.

    Args:
        scenes: The descriptions, one cloth each.
        meets: Whether two cloths, by their names, collide with each other.
    """
    names = [scene["cloth"][0]["name"] for scene in scenes]
    colliders = {thing["name"]: thing for scene in scenes for thing in scene.get("collider", [])}
    cloths, forces = [], []
    for name, scene in zip(names, scenes, strict=True):
        met = [other for other in names if other != name and meets(name, other)]
        own = [thing["name"] for thing in scene.get("collider", [])]
        cloth = dict(scene["cloth"][0])
        cloth["collision"] = {**cloth["collision"], "colliders": own, "cloths": met}
        cloths.append(cloth)
        winds = (force for force in scene.get("force", []) if force["kind"] != WATER)
        forces += [_on(name, force) for force in winds]
    start = scenes[0]["scene"]["frames"][0]
    end = max(scene["scene"]["frames"][1] for scene in scenes)
    solver = dict(scenes[0]["solver"])
    if "tolerance" in solver:
        solver["tolerance"] = min(scene["solver"]["tolerance"] for scene in scenes)
    joined = {
        **scenes[0],
        "scene": {**scenes[0]["scene"], "frames": [start, end]},
        "cloth": cloths,
        "solver": solver,
    }
    forces += [water for water in [water_of(scenes[0])] if water]
    parts = {"force": forces, "collider": [colliders[name] for name in sorted(colliders)]}
    rest = {key: joined[key] for key in joined if key not in parts}
    return {**rest, **{key: part for key, part in parts.items() if part}}


def groups(
    scenes: Sequence[Scene], meets: Callable[[str, str], bool], pushed: Mapping[str, str]
) -> Groups:
    """Sort cloths into groups: those that meet, directly or by way of others, and whose settings fit each other.

    Args:
        scenes: The descriptions, one cloth each.
        meets: Whether two cloths, by their names, collide with each other.
        pushed: What pushes each, by its name: the same for cloths that can be simulated together.
    """
    names = [scene["cloth"][0]["name"] for scene in scenes]
    by_name = dict(zip(names, scenes, strict=True))
    group_of = {name: [name] for name in names}
    apart = []
    for index, one in enumerate(names):
        for other in names[index + 1 :]:
            if not meets(one, other):
                continue
            difference = _difference(by_name[one], by_name[other])
            if not difference and pushed[one] != pushed[other]:
                difference = "force fields or field weights"
            if difference:
                apart.append(
                    f'"{one}" and "{other}" are baked one after the other and do not collide: '
                    f"their {difference} differ"
                )
            elif group_of[one] is not group_of[other]:
                joined = [name for name in names if name in group_of[one] + group_of[other]]
                group_of.update(dict.fromkeys(joined, joined))
    together = []
    for name in names:
        if group_of[name] not in together:
            together.append(group_of[name])
    return Groups(together, apart)


def _difference(one: Scene, other: Scene) -> str:
    """What keeps two cloths from being simulated together, in words; empty if nothing does."""
    if one["scene"]["frames"][0] != other["scene"]["frames"][0]:
        return "start frames"
    if one["scene"].get("speed") != other["scene"].get("speed"):
        return "speed multipliers"
    if settling(one) != settling(other):
        return "settings of settling"
    for key, words in (
        ("integrator", "integrators"),
        ("linear_solver", "linear solvers"),
        ("substeps", "substeps"),
        ("time_step", "time steps"),
    ):
        if one["solver"].get(key) != other["solver"].get(key):
            return words
    if water_of(one) != water_of(other):
        return "waters"
    if _rules(one) != _rules(other):
        return "solver settings"
    return ""


def water_of(scene: Scene) -> Mapping[str, Any] | None:
    """The water of a description, if it has one."""
    return next((force for force in scene.get("force", []) if force["kind"] == WATER), None)


def _rules(scene: Scene) -> dict[str, Any]:
    return {key: value for key, value in scene["solver"].items() if key != "tolerance"}


def _on(name: str, force: Mapping[str, Any]) -> dict[str, Any]:
    return {**force, "region": {**force.get("region", {}), "cloth": name}}
