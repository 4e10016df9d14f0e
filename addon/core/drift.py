"""Drift: whether a cache still belongs to the cloth it was baked from, in words."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from .points import Points

_WORDS = {
    "start": "start frame",
    "speed": "speed multiplier",
    "stretch": "stretch stiffness",
    "shear": "shear stiffness",
    "bend": "bend stiffness",
    "stretch_warp": "stretch stiffness along the warp",
    "stretch_weft": "stretch stiffness along the weft",
    "bend_warp": "bend stiffness along the warp",
    "bend_weft": "bend stiffness along the weft",
    "yield_curvature": "curvature beyond which it creases",
    "hardening": "crease hardening",
    "mass_per_vertex": "mass per vertex",
    "name": "",
    "self": "self collision",
    "enabled": "collisions",
    "tear.enabled": "tearing",
    "tear.force": "tear force",
    "tear.strain": "tear strain",
    "tear.stress": "tear stress",
    "tear.noise": "tear noise",
    "tear.seed": "tear seed",
    "tear.start": "settling",
    "openings.frame": "opening frame",
    "thickness": "collision thickness",
    "friction": "collision friction",
    "shrink": "shrinking",
    "min": "shrinking factor",
    "max": "max shrinking",
    "uniform": "pressure",
    "factor": "pressure scale",
    "force_max": "max sewing force",
}

_VERTICES = {
    "pins.vertices": "pinned vertices",
    "pins.weights": "weights of pins",
    "vertices": "vertices in the wind",
    "excluded_from_self": "vertices left out of self collision",
    "shrink.weights": "weights of the shrink group",
    "pressure.weights": "weights of the pressure group",
    "sewing.seams": "loose edges",
    "tear.strength": "weights of the strength group",
    "openings.pairs": "edges that open",
    "fabric.uv": "UV map",
    "excluded_from_colliders": "vertices left out of collision with objects",
}
"""Lists of vertices by the end of their key."""


_NAMED = ("water ", "collider ", "force field ", "field weights", "keys of ", "cloths met")
"""Beginnings of the keys that are words as they stand."""


def digest(*parts: Points | bytes) -> str:
    """A 64-bit digest of buffers, as 16 hexadecimal digits."""
    state = hashlib.blake2b(digest_size=8)
    for part in parts:
        data = memoryview(part).cast("B")
        state.update(len(data).to_bytes(8, "little"))
        state.update(data)
    return state.hexdigest()


def record(
    scene: Mapping[str, Any],
    vertices: int,
    topology: str,
    fields: Mapping[str, Any] = MappingProxyType({}),
) -> dict[str, Any]:
    """What a bake remembers of its cloth: settings one by one, long lists as a digest, and force fields by their names."""
    settings: dict[str, Any] = dict(fields)
    steady = {key: scene[key] for key in scene if key not in ("collider", "force")}
    for force in scene.get("force", []):
        if force["kind"] == "water":
            settings.update(
                {f"water {key.replace('_', ' ')}": value for key, value in force.items()}
            )
        else:
            steady["force"] = [force]
    _flatten(steady, "", settings)
    for thing in scene.get("collider", []):
        settings[f'collider "{thing["name"]}"'] = [thing["thickness"], thing["friction"]]
    settings.pop("cloth.name", None)
    frames = settings.pop("scene.frames", None)
    if frames:  # a bake may go on beyond its end: the end is no part of what it was made from
        settings["scene.start"] = frames[0]
    return {"settings": settings, "vertices": vertices, "topology": topology}


def whole_digest(of: Mapping[str, Any]) -> str:
    """A digest of a record, by which a checkpoint is bound to its cloth."""
    return digest(json.dumps(of, sort_keys=True).encode())


def differences(baked: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """What changed since the bake, in words; lists that `now` leaves out are not compared."""
    words = []
    if baked.get("vertices") != now["vertices"]:
        words.append(f"vertex count ({baked.get('vertices')} baked, {now['vertices']} now)")
    elif now["topology"] and baked.get("topology") != now["topology"]:
        words.append("topology")
    then = baked.get("settings", {})
    for key in sorted(set(then) | set(now["settings"])):
        if then.get(key) != now["settings"].get(key) and not _is_left_out(key, now["settings"]):
            words.append(_words(key))
    return list(dict.fromkeys(words))


def words_of(key: str) -> str:
    """What a setting of a record is called."""
    return _words(key)


def is_list(key: str) -> bool:
    """Whether a record keeps a digest in place of a setting, because it is a long list."""
    return bool(_list_words(key))


def _is_left_out(key: str, settings: Mapping[str, Any]) -> bool:
    """A list of vertices takes long to gather: the panel leaves it out, the check does not."""
    return bool(_list_words(key)) and not any(_list_words(name) for name in settings)


def _words(key: str) -> str:
    if key.startswith(_NAMED):
        return key
    if _list_words(key):
        return _list_words(key)
    parts = [part for part in key.split(".") if not part.isdigit()]
    return _WORDS.get(".".join(parts[-2:])) or _WORDS.get(parts[-1]) or parts[-1].replace("_", " ")


def _list_words(key: str) -> str:
    """What a list of vertices is called; empty for other keys."""
    return next((words for end, words in _VERTICES.items() if key.endswith(end)), "")


def _flatten(value: Any, path: str, out: dict[str, Any]) -> None:
    if isinstance(value, Mapping):
        for key, inner in value.items():
            _flatten(inner, f"{path}.{key}" if path else str(key), out)
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for inner in value:
            _flatten(inner, path, out)
    elif isinstance(value, list) and _list_words(path):
        out[path] = digest(json.dumps(value).encode())
    else:
        out[path] = value
