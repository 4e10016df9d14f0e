"""The certificate of the frame that the scene stands at, from the live session or the bake's report."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import bpy

from ..core import cache_paths, certificate, report
from . import cache, live

_reports: dict[int, tuple[tuple[object, ...], dict[int, Mapping[str, Any]]]] = {}
"""Rows of the report that each cloth was last asked about, with the state of its file."""


def line(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """The certificate in one line; empty where nothing is known of the frame."""
    row = row_of(obj, scene)
    return certificate.line(row) if row else ""


def warning(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """Which edges are longer than allowed, in one sentence; empty if none is."""
    row = row_of(obj, scene)
    return certificate.warning(row) if row else ""


def row_of(obj: bpy.types.Object, scene: bpy.types.Scene) -> Mapping[str, Any]:
    """The certificate of the present frame; empty where nothing is known of it."""
    path = cache.played_path(obj)
    if path:
        return {} if cache.problem(obj) else _rows_of(obj, path).get(scene.frame_current, {})
    session = live.session_of(obj)
    return session.frames.certificate(scene.frame_current) if session is not None else {}


def rows(obj: bpy.types.Object) -> Mapping[int, Mapping[str, Any]]:
    """The certificates of all frames of the result by their frame; empty without one."""
    path = cache.played_path(obj)
    if path:
        return {} if cache.problem(obj) else _rows_of(obj, path)
    session = live.session_of(obj)
    if session is None:
        return {}
    frames = session.frames
    return {frame: frames.certificate(frame) for frame in range(frames.first, frames.last + 1)}


def _rows_of(obj: bpy.types.Object, pc2_path: str) -> dict[int, Mapping[str, Any]]:
    path = cache_paths.files_of(pc2_path).report
    try:
        found = os.stat(path)
    except OSError:
        return {}
    state = (path, found.st_mtime_ns, found.st_size, found.st_ino)
    known = _reports.get(obj.session_uid)
    if known is None or known[0] != state:
        rows = {row["frame"]: row for row in report.read(path).get("frames", [])}
        known = (state, rows)
        _reports[obj.session_uid] = known
    return known[1]


def forget() -> None:
    """Another file is loaded."""
    _reports.clear()
