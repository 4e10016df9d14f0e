"""What the add-on knows of the running Blender and no file holds."""

from __future__ import annotations

import os
import sys

import bpy

messages: dict[int, str] = {}
"""The last sentence about a cloth, by `session_uid`; shown in its panel."""

busy: set[str] = set()
"""What keeps live mode from acting: "bake", "grab", "check" or "export" while one runs."""

rendering: set[str] = set()
"""Names of the scenes that are being rendered."""


def session_folder() -> str:
    """The folder of this Blender session, removed by Blender when it ends."""
    return os.path.join(bpy.app.tempdir, "boucle")


def warn(text: str) -> None:
    """Say something where no operator can: on the console."""
    print(f"Boucle: {text}", file=sys.stderr, flush=True)


def may_write_in_render() -> bool:
    """Whether a handler may change data now: a window draws while it renders, unless it is locked."""
    if not rendering or bpy.app.background:
        return True
    scenes = [bpy.data.scenes.get(name) for name in rendering]
    return all(scene is not None and scene.render.use_lock_interface for scene in scenes)
