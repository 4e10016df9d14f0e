"""The settings of a cloth in Blender as a scene description: the keys and words of SCENE.toml."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from . import flow, shape, tear
from .points import Affine
from .refusal import Refusal
from .settle import Settling
from .shape import ShapeGroups, decimal
from .tear import TearGroups

IMPLICIT = frozenset({"bdf2", "implicit_euler"})
"""Integrators that are stable at any step."""

QUALITIES = {"draft": 2e-2, "normal": 5e-3, "final": 1e-3}
"""Tolerances of the quality presets: of a swinging sheet 5e-3 keeps the amplitude within 1 % with 4 steps a frame."""

PIN_DEFAULTS = {"pin_stiffness": 1000.0, "pin_damping": 1.0}
"""What the solver takes where a scene says nothing: bakes from before there were soft pins stay as they are."""

UV = "uv"
"""The warp of a fabric that follows a UV map."""

Values = Mapping[str, Any]
"""Property names of `object.boucle` and their values."""


class World(NamedTuple):
    """What a scene gives to its cloths: gravity (m/s²) and frames a second."""

    gravity: tuple[float, float, float]
    fps: float


class Groups(NamedTuple):
    """Vertices picked by vertex groups; wind None blows everywhere, and excluded ones do not collide."""

    pins: Sequence[int]
    wind: Sequence[int] | None
    excluded_from_self: Sequence[int] = ()
    excluded_from_colliders: Sequence[int] = ()
    shape: ShapeGroups = ShapeGroups()
    pin_weights: Sequence[float] = ()
    """One a pin; all are 1 if it is empty."""
    tear: TearGroups = TearGroups()


class CollisionObject(NamedTuple):
    """An object that cloth collides with, by the numbers of its Collision physics; its mesh goes beside the scene."""

    name: str
    thickness_outer: float
    """What is kept free around it (m), beside the cloth's own thickness."""
    cloth_friction: float
    """A hundred times the coefficient of friction, 0 to 80."""


def describe(
    name: str,
    values: Values,
    world: World,
    groups: Groups,
    colliders: Sequence[CollisionObject] = (),
    meets_cloths: bool = False,
) -> dict[str, Any]:
    """The scene of one cloth among colliders, and perhaps other cloths, without any mesh."""
    frames = [int(values["frame_start"]), int(values["frame_end"])]
    if frames[1] < frames[0]:
        raise Refusal(
            f'"{name}": the end frame is {frames[1]}, before the start frame {frames[0]}: '
            "raise Frame End"
        )
    scene: dict[str, Any] = {
        "scene": {
            "frames": frames,
            "fps": world.fps,
            "gravity": [decimal(value) for value in world.gravity],
        },
        "cloth": [_cloth(name, values, groups, bool(colliders) or meets_cloths)],
        "solver": _solver(name, values),
    }
    if decimal(values.get("speed", 1.0)) != 1.0:
        scene["scene"]["speed"] = decimal(values["speed"])
    if values.get("settle_frames"):
        scene["scene"]["settle_frames"] = int(values["settle_frames"])
        scene["scene"]["settle_damped"] = bool(values["settle_damped"])
    forces = [force for force in (flow.wind(values, groups.wind), flow.water(values)) if force]
    if forces:
        scene["force"] = forces
    if colliders:
        scene["collider"] = [collider(thing) for thing in colliders]
    return scene


def settling(scene: Mapping[str, Any]) -> Settling:
    """How the cloth settles before the start frame."""
    head = scene["scene"]
    return Settling(head.get("settle_frames", 0), head.get("settle_damped", True))


def in_world(scene: Mapping[str, Any], matrices: Sequence[Affine]) -> dict[str, Any]:
    """The same scene with directions that lie in an object's space turned to the world.

    Args:
        scene: The description of cloths.
        matrices: Object to world space of each of them.
    """
    cloths = [dict(cloth) for cloth in scene["cloth"]]
    for cloth, matrix in zip(cloths, matrices, strict=True):
        warp = cloth.get("fabric", {}).get("warp", UV)
        if warp != UV:
            rows = (matrix[4 * row : 4 * row + 3] for row in range(3))
            turned = [sum(a * b for a, b in zip(row, warp, strict=True)) for row in rows]
            cloth["fabric"] = {**cloth["fabric"], "warp": turned}
    return {**scene, "cloth": cloths}


def encode(scene: Mapping[str, Any]) -> str:
    """The scene as JSON for the solver, which begins with the frames of settling; how long a frame is the speed says."""
    ours = ("settle_frames", "settle_damped", "speed")
    head = {key: value for key, value in scene["scene"].items() if key not in ours}
    head["fps"] = head["fps"] / scene["scene"].get("speed", 1.0)
    start, end = scene["scene"]["frames"]
    head["frames"] = [start - settling(scene).frames, end]
    return json.dumps({**scene, "scene": head}, allow_nan=False)


def _cloth(name: str, values: Values, groups: Groups, meets: bool) -> dict[str, Any]:
    model = values.get("model", "springs")
    described = _fabric(name, values) if model == "fabric" else _springs(values)
    cloth: dict[str, Any] = {"name": name, "model": model, model: described}
    if values["mass_mode"] == "density":
        cloth["density"] = decimal(values["density"])
    else:
        cloth["mass_per_vertex"] = decimal(values["mass_per_vertex"])
    if groups.pins:
        cloth["pins"] = _pins(groups)
    for key, default in PIN_DEFAULTS.items():
        if decimal(values.get(key, default)) != default:
            cloth[key] = decimal(values[key])
    cloth.update(shape.describe(values, groups.shape))
    cloth["collision"] = collision(values, groups, meets)
    torn = tear.describe(name, values, groups.tear)
    if torn:
        cloth["tear"] = torn
    bulk = flow.bulk(values)
    if bulk:
        cloth["water"] = bulk
    return cloth


def _pins(groups: Groups) -> dict[str, Any]:
    pins: dict[str, Any] = {"vertices": list(groups.pins)}
    if any(weight < 1.0 for weight in groups.pin_weights):
        pins["weights"] = [decimal(weight) for weight in groups.pin_weights]
    return pins


def collision(values: Values, groups: Groups, meets: bool) -> dict[str, Any]:
    """How a cloth collides; not at all where there is nothing that it could meet."""
    with_self = bool(values.get("self_collision", False))
    if not with_self and not meets:
        return {"enabled": False}
    out = {"self": with_self, **{key: decimal(values[key]) for key in ("thickness", "friction")}}
    if with_self and groups.excluded_from_self:
        out["excluded_from_self"] = list(groups.excluded_from_self)
    if meets and groups.excluded_from_colliders:
        out["excluded_from_colliders"] = list(groups.excluded_from_colliders)
    return out


def without_contact(scene: Mapping[str, Any]) -> dict[str, Any]:
    """The same scene with nothing to touch: for what depends on springs alone."""
    cloths = [{**cloth, "collision": {"enabled": False}} for cloth in scene["cloth"]]
    return {**{key: scene[key] for key in scene if key != "collider"}, "cloth": cloths}


def collider(thing: CollisionObject) -> dict[str, Any]:
    """One collider, whose mesh is given beside the scene."""
    return {
        "name": thing.name,
        "thickness": decimal(thing.thickness_outer),
        "friction": decimal(thing.cloth_friction / 100.0),
    }


def _springs(values: Values) -> dict[str, Any]:
    springs = {
        key: decimal(values[key])
        for key in ("stretch", "shear", "bend", "air_damping", "deformation_rate")
    }
    if values["damping_per_kind"]:
        for key in ("damping_stretch", "damping_shear", "damping_bend"):
            springs[key] = decimal(values[key])
    else:
        springs["damping"] = decimal(values["damping"])
    words = {key: values[key] for key in ("damping_law", "stiffness_from", "limiter")}
    return {**springs, **words}


def _fabric(name: str, values: Values) -> dict[str, Any]:
    if values["limiter"] == "stiffen":
        raise Refusal(
            f'"{name}": the limiter Stiffen is for springs, and the model is Fabric: choose Project, '
            "Provot or None under Fabric > Deformation"
        )
    keys = ["stretch_warp", "stretch_weft", "shear", "bend_warp", "bend_weft"]
    if values["use_compression"]:
        keys += ["compression_warp", "compression_weft"]
    if values["damping_ratio_per_kind"]:
        keys += ["damping_ratio_stretch", "damping_ratio_shear", "damping_ratio_bend"]
    else:
        keys.append("damping_ratio")
    if values["yield_curvature"] > 0.0:
        keys += ["yield_curvature", "hardening"]
    if values["bend_hysteresis"] > 0.0:
        keys.append("bend_hysteresis")
    fabric = {key: decimal(values[key]) for key in (*keys, "air_damping", "deformation_rate")}
    warp = values["warp"]
    fabric["warp"] = UV if warp == UV else [float(axis == warp) for axis in "xyz"]
    return {**fabric, "limiter": values["limiter"]}


def _solver(name: str, values: Values) -> dict[str, Any]:
    solver: dict[str, Any] = {
        "integrator": values["integrator"],
        "allow_unstable": bool(values["allow_unstable"]),
    }
    substeps, time_step = int(values["substeps"]), decimal(values["time_step"])
    if substeps and time_step:
        raise Refusal(
            f'"{name}": Substeps is {substeps} and Time Step is {time_step} s: set one of them '
            "to 0, or both for automatic steps"
        )
    if time_step:
        solver["time_step"] = time_step
    else:
        solver["substeps"] = substeps or "auto"
    if values["integrator"] in IMPLICIT:
        solver["linear_solver"] = values["linear_solver"]
        if solver.get("substeps") == "auto":
            solver["tolerance"] = tolerance(values)
    return solver


def tolerance(values: Values) -> float:
    """What a step of an implicit integrator may be off, by the quality that is chosen."""
    quality = values["quality"]
    return QUALITIES[quality] if quality in QUALITIES else decimal(values["tolerance"])
