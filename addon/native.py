"""The one door to the compiled module `boucle_core`.

The module's name is global to Blender and stays loaded until Blender ends: after an update of the extension in a running
Blender the old one may still be there. `problem` says so.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from .core.refusal import Refusal, sentence_of

try:
    import boucle_core as _core
except ImportError as _error:
    _core = None
    _import_error = sentence_of(_error)
else:
    _import_error = ""


class _NeverRaised(Exception):
    """Stands for the module's errors where the module is missing."""


BoucleError: type[Exception] = getattr(_core, "BoucleError", _NeverRaised)
"""Anything that the module refuses or reports."""
DivergedError: type[Exception] = getattr(_core, "DivergedError", _NeverRaised)
"""A position left the finite numbers; the state is that of the last good frame."""
UnstableError: type[Exception] = getattr(_core, "UnstableError", _NeverRaised)
"""From a frame on the settings would not stay stable; the state is that of the last good frame."""
InterruptionError: type[Exception] = getattr(_core, "InterruptionError", _NeverRaised)
"""A frame was stopped from outside; the state is that of the frame before it."""
InternalError: type[Exception] = getattr(_core, "InternalError", _NeverRaised)
"""A caught panic: the simulation must be thrown away."""

FAILURES: tuple[type[Exception], ...] = (BoucleError, Refusal, OSError)
"""Everything whose message is meant for the user."""


@cache
def manifest_version() -> str:
    """The version in the extension's manifest."""
    text = Path(__file__).with_name("blender_manifest.toml").read_text(encoding="utf-8")
    return str(tomllib.loads(text)["version"])


@cache
def problem() -> str:
    """Why the compiled module cannot be used; empty if it can."""
    if _core is None:
        return (
            f"the compiled module boucle_core cannot be loaded ({_import_error}): install the "
            "extension's zip for this platform"
        )
    version = str(getattr(_core, "__version__", "unknown"))
    if version != manifest_version():
        return (
            f"the compiled module is version {version} and the add-on {manifest_version()}: "
            "restart Blender"
        )
    return ""


@cache
def fabric_presets() -> Mapping[str, Mapping[str, Any]]:
    """All named fabrics, see `boucle_core.fabric_presets`; none where the module cannot be used."""
    return {} if problem() else _core.fabric_presets()


def fabric_springs(preset: str, edge: float) -> Mapping[str, Any]:
    """The springs of a named fabric on a mesh of such edges (m), see `boucle_core.fabric_springs`.

    Raises:
        BoucleError: There is no such fabric, or the length is not accepted.
    """
    return _core.fabric_springs(preset, edge)


def simulation(
    scene: str,
    meshes: Sequence[tuple[Any, Any, Any]],
    threads: int = 0,
    colliders: Sequence[tuple[Any, Any, Any]] = (),
    rests: Sequence[Any] = (),
    uvs: Sequence[Any] = (),
) -> Any:
    """A new simulation; see `boucle_core.Simulation`.

    Raises:
        Refusal: The module cannot be used.
        BoucleError: The scene, a mesh or a collider is not accepted.
    """
    if problem():
        raise Refusal(problem())
    make: Callable[..., Any] = _core.Simulation
    return make(scene, meshes, threads, colliders, rests, uvs)
