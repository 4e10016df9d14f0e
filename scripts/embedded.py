"""Start the embedded Blender of .venv with this checkout's add-on as an installed extension."""

from __future__ import annotations

import importlib
import os
import shutil
from pathlib import Path
from typing import Any

from environment import ROOT

MODULE = "bl_ext.user_default.boucle"


def start(folder: Path) -> Any:
    """Put the add-on into a user folder of its own, start Blender with an empty scene, and return `bpy`.

    Args:
        folder: Emptied; holds Blender's user folder. Call this before anything imports bpy.

    Raises:
        RuntimeError: The add-on could not be enabled.
    """
    shutil.rmtree(folder, ignore_errors=True)
    extensions = folder / "extensions" / "user_default"
    extensions.mkdir(parents=True)
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "addon", extensions / "boucle", ignore=ignored)
    os.environ["BLENDER_USER_RESOURCES"] = str(folder)

    import bpy

    addon_utils = importlib.import_module("addon_utils")  # bpy made it importable
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    if addon_utils.enable(MODULE, default_set=True, persistent=True) is None:
        raise RuntimeError("the add-on could not be enabled in the embedded Blender")
    return bpy
