"""What the last check found of each cloth, for its panel.

It is of this session and in no file: kept by `session_uid`, it outlasts undo, and it goes when another file is loaded.
"""

from __future__ import annotations

import json
from collections.abc import Sequence

import bpy

from ..core.mesh_check import Problem
from ..core.refusal import Refusal

_found: dict[int, list[Problem]] = {}


def keep(obj: bpy.types.Object, problems: Sequence[Problem]) -> None:
    """Remember what a check found, in place of what was found before."""
    _found[obj.session_uid] = list(problems)


def forget() -> None:
    """Another file is loaded."""
    _found.clear()


def as_text(obj: bpy.types.Object) -> str:
    """The problems as a JSON list; empty if nobody has checked."""
    if obj.session_uid not in _found:
        return ""
    rows = [
        {
            "severity": problem.severity.name,
            "sentence": problem.sentence,
            "selects": bool(problem.vertices),
            "passes_through": problem.passes_through,
        }
        for problem in _found[obj.session_uid]
    ]
    return json.dumps(rows)


def problem(obj: bpy.types.Object, number: int) -> Problem:
    """One of the problems that were found, counted from 0.

    Raises:
        Refusal: There is no such problem, or the mesh has changed since.
    """
    found = _found.get(obj.session_uid, [])
    if not 0 <= number < len(found):
        raise Refusal(
            f'"{obj.name}": the check found {len(found)} problems, so there is no number {number}: '
            "check again"
        )
    if max(found[number].vertices, default=-1) >= len(obj.data.vertices):
        raise Refusal(f'"{obj.name}": the mesh has changed since the check: check again')
    return found[number]


def drop_passing(obj: bpy.types.Object, name: str) -> None:
    """The cloth no longer passes through this object unhindered: name the problem no longer."""
    found = _found.get(obj.session_uid, [])
    found[:] = [problem for problem in found if problem.passes_through != name]
