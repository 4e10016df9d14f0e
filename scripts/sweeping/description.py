"""A sweep's file: which scene, which parameters, which runs.

```toml
[sweep]
scene = "curtain.toml"          # or "shot.blend"; beside this file
method = "latin_hypercube"      # "grid" | "list" | "latin_hypercube"
samples = 64                    # latin_hypercube: how many runs
seed = 7                        # latin_hypercube: another one, other samples; 0 by default
frames = [1, 60]                # frames to keep; all by default
timeout = 600                   # a run that takes longer (s) has failed; none by default
set = { "solver.tolerance" = 1e-2 }     # the same in all runs

[parameters]                    # grid, latin_hypercube; keys as --set of bake.py takes them, or a Blender data path
"cloth.curtain.density" = [0.1, 0.2, 0.4]
"cloth.curtain.springs.shear" = { from = 10, to = 1000, count = 5, scale = "log" }      # count: grid
"solver.substeps" = { from = 4, to = 16, integer = true }

[[run]]                         # list: one table a run
"cloth.curtain.density" = 0.3
```
"""

from __future__ import annotations

import hashlib
import json
import math
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import sampling
from .toml_text import text_of

METHODS = ("grid", "list", "latin_hypercube")
MOST_RUNS = 100_000
LARGEST_SEED = 2**63 - 1


class Wrong(Exception):
    """The sweep's file is wrong: names the key, its value and what is accepted."""


@dataclass(frozen=True)
class Run:
    """One bake of a sweep."""

    name: str
    parameters: dict[str, Any]


@dataclass(frozen=True)
class Sweep:
    """What a sweep is to bake."""

    scene: Path
    frames: tuple[int, int] | None
    timeout: float | None
    fixed: dict[str, Any]
    runs: tuple[Run, ...]

    @property
    def parameters(self) -> list[str]:
        """The parameters of all runs, in the order in which they are first named."""
        return list(dict.fromkeys(key for run in self.runs for key in run.parameters))

    def overrides(self, run: Run) -> list[str]:
        """The words after --set that make a run."""
        return [
            f"{key}={text_of(value)}" for key, value in {**self.fixed, **run.parameters}.items()
        ]

    def digest(self) -> str:
        """What the result depends on, but for the program: the scene, the files it names, and all runs."""
        settings = [self.frames, [[run.name, self.overrides(run)] for run in self.runs]]
        digest = hashlib.sha256(json.dumps(settings).encode())
        for path in [self.scene, *_named_files(self.scene)]:
            digest.update(hashlib.sha256(path.read_bytes()).digest())
        return digest.hexdigest()


def read(path: Path) -> Sweep:
    """Read a sweep's file and make its runs.

    Raises:
        Wrong: It is not accepted.
    """
    try:
        tree = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise Wrong(
            f"{path} cannot be read ({error.strerror}); accepted: a sweep's file"
        ) from error
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Wrong(f"{path} is no TOML ({error}); accepted: a sweep's file") from error
    try:
        return _sweep(tree, path.parent)
    except Wrong as wrong:
        raise Wrong(f"{path}: {wrong}") from None


def _sweep(tree: Mapping[str, Any], folder: Path) -> Sweep:
    _only(tree, ("sweep", "parameters", "run"), "")
    head = _table(tree.get("sweep"), "sweep")
    known = ("scene", "method", "samples", "seed", "frames", "timeout", "set")
    _only(head, known, "sweep.")
    scene = head.get("scene")
    if not isinstance(scene, str) or not (folder / scene).is_file():
        raise Wrong(f"sweep.scene = {scene!r}; accepted: a scene file or a .blend that is there")
    if (folder / scene).suffix.lower() not in {".toml", ".blend"}:
        raise Wrong(f"sweep.scene = {scene!r}; accepted: a .toml or a .blend")
    fixed = _table(head.get("set", {}), "sweep.set")
    for key, value in fixed.items():
        _check_value(f"sweep.set.{key}", value)
    runs = _runs(tree, head)
    twice = [key for key in fixed if any(key in run for run in runs)]
    if twice:
        raise Wrong(f"sweep.set.{twice[0]} is a parameter, too; accepted: one of them")
    width = max(3, len(str(len(runs) - 1)))
    named = tuple(Run(f"{number:0{width}}", run) for number, run in enumerate(runs))
    return Sweep(folder / scene, _frames(head), _timeout(head), dict(fixed), named)


def _runs(tree: Mapping[str, Any], head: Mapping[str, Any]) -> list[dict[str, Any]]:
    method = head.get("method")
    if method not in METHODS:
        names = ", ".join(f'"{name}"' for name in METHODS)
        raise Wrong(f"sweep.method = {method!r}; accepted: {names}")
    if method != "latin_hypercube":
        for key in ("samples", "seed"):
            if key in head:
                raise Wrong(f'sweep.{key} = {head[key]!r}; accepted only with "latin_hypercube"')
    if method == "list":
        return _list(tree)
    if "run" in tree:
        raise Wrong(f'[[run]] is accepted only with method = "list", not with {method!r}')
    parameters = {
        key: _parameter(key, value, method)
        for key, value in _table(tree.get("parameters"), "parameters").items()
    }
    if not parameters:
        raise Wrong("[parameters] is empty; accepted: at least one parameter")
    if method == "grid":
        _check_count("the grid's size", sampling.grid_size(parameters))
        return sampling.grid(parameters)
    samples, seed = head.get("samples"), head.get("seed", 0)
    if not _is_integer(samples):
        raise Wrong(f"sweep.samples = {samples!r}; accepted: a whole number from 1 to {MOST_RUNS}")
    _check_count("sweep.samples", samples)
    if not _is_integer(seed) or not 0 <= seed <= LARGEST_SEED:
        raise Wrong(f"sweep.seed = {seed!r}; accepted: a whole number from 0 to {LARGEST_SEED}")
    return sampling.latin_hypercube(parameters, samples, seed)


def _list(tree: Mapping[str, Any]) -> list[dict[str, Any]]:
    if "parameters" in tree:
        raise Wrong('[parameters] is not accepted with method = "list", which takes [[run]]')
    runs = tree.get("run")
    if not isinstance(runs, list) or not all(isinstance(run, dict) for run in runs):
        raise Wrong('method = "list" without [[run]]; accepted: one table [[run]] for each')
    _check_count("the number of [[run]]", len(runs))
    for number, run in enumerate(runs):
        for key, value in run.items():
            _check_value(f"run {number}: {key}", value)
    return [dict(run) for run in runs]


def _parameter(key: str, value: Any, method: str) -> sampling.Parameter:
    place = f"parameters.{key}"
    if isinstance(value, list):
        if not value:
            raise Wrong(f"{place} = []; accepted: at least one value")
        _check_value(place, value)
        return sampling.Choice(value)
    if isinstance(value, dict) and {"from", "to"} & set(value):
        return _range(place, value, method)
    if isinstance(value, dict):
        raise Wrong(
            f"{place} is a table without from and to; accepted: a path in quotes, as in "
            '"cloth.0.density" = [0.1, 0.2]'
        )
    raise Wrong(f"{place} = {value!r}; accepted: a list of values, or a table with from and to")


def _range(place: str, value: Mapping[str, Any], method: str) -> sampling.Range:
    _only(value, ("from", "to", "count", "scale", "integer"), f"{place}.")
    ends = [value.get(end) for end in ("from", "to")]
    if not all(_is_number(end) for end in ends) or not ends[0] < ends[1]:
        raise Wrong(f"{place}: from {ends[0]!r} to {ends[1]!r}; accepted: two numbers, from < to")
    scale, is_integer = value.get("scale", "linear"), value.get("integer", False)
    if scale not in {"linear", "log"}:
        raise Wrong(f'{place}.scale = {scale!r}; accepted: "linear", "log"')
    if scale == "log" and ends[0] <= 0:
        raise Wrong(f"{place}.from = {ends[0]!r}; accepted with a log scale: a number above 0")
    if not isinstance(is_integer, bool):
        raise Wrong(f"{place}.integer = {is_integer!r}; accepted: true or false")
    if is_integer and not all(_is_integer(end) for end in ends):
        raise Wrong(f"{place}: from {ends[0]!r} to {ends[1]!r}; accepted here: whole numbers")
    count = value.get("count")
    if method == "grid" and (not _is_integer(count) or not 1 <= count <= MOST_RUNS):
        raise Wrong(f"{place}.count = {count!r}; accepted: a whole number from 1 to {MOST_RUNS}")
    if method != "grid" and count is not None:
        raise Wrong(f'{place}.count = {count!r}; accepted only with method = "grid"')
    return sampling.Range(*ends, count, scale == "log", is_integer)


def _frames(head: Mapping[str, Any]) -> tuple[int, int] | None:
    frames = head.get("frames")
    if frames is None:
        return None
    if not isinstance(frames, list) or len(frames) != 2 or not all(map(_is_integer, frames)):
        raise Wrong(f"sweep.frames = {frames!r}; accepted: [first, last]")
    return frames[0], frames[1]


def _timeout(head: Mapping[str, Any]) -> float | None:
    timeout = head.get("timeout")
    if timeout is not None and (not _is_number(timeout) or timeout <= 0):
        raise Wrong(f"sweep.timeout = {timeout!r}; accepted: seconds, above 0")
    return timeout


def _named_files(scene: Path) -> list[Path]:
    """The files that a scene names (meshes, caches), as far as they are there; a .blend's are not looked for."""
    if scene.suffix.lower() != ".toml":
        return []
    try:
        tree = tomllib.loads(scene.read_text(encoding="utf-8"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError):
        return []  # the bake says what is wrong with it
    names = dict.fromkeys(_texts(tree))
    return [scene.parent / name for name in names if name and (scene.parent / name).is_file()]


def _texts(value: Any) -> Iterable[str]:
    if isinstance(value, str):
        if "\x00" not in value and len(value) < 1000:
            yield value
    elif isinstance(value, list | dict):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _texts(each)


def _only(table: Mapping[str, Any], known: tuple[str, ...], place: str) -> None:
    for key in table:
        if key not in known:
            raise Wrong(f"{place}{key} is not known; accepted: {', '.join(known)}")


def _table(value: Any, place: str) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise Wrong(f"[{place}] is missing or no table; accepted: a table")
    return value


def _check_value(place: str, value: Any) -> None:
    try:
        text_of(value)
    except ValueError as error:
        raise Wrong(f"{place}: {error}; accepted: numbers, texts, true, false, lists") from error


def _check_count(place: str, count: int) -> None:
    if not 1 <= count <= MOST_RUNS:
        raise Wrong(f"{place} = {count}; accepted: 1 to {MOST_RUNS} runs")


def _is_integer(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _is_number(value: Any) -> bool:
    return (_is_integer(value) or isinstance(value, float)) and math.isfinite(value)
