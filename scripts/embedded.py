"""Start the embedded Blender of .venv with this checkout's add-on as an installed extension, and make pictures in it."""

from __future__ import annotations

import argparse
import importlib
import os
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

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


def make_picture(
    parser: argparse.ArgumentParser,
    render: Callable[[Any, argparse.Namespace], Path],
    small: Path,
) -> NoReturn:
    """Render what the command line asks for, and end the process.

    Args:
        parser: What the script accepts, but for `--readme`.
        render: Writes the picture, given `bpy` and the command line, and says where it is.
        small: The small copy that `--readme` renews.
    """
    parser.add_argument("--readme", action="store_true", help=f"also write {small.name}")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        picture = render(start(Path(folder) / "blender"), options)
    if options.readme:
        keep(picture, small)
    # Some renders hang when Blender ends; everything is written by now.
    sys.stdout.flush()
    os._exit(0)


def keep(picture: Path, small: Path) -> None:
    """Keep a picture as a small file beside the README."""
    from PIL import Image

    with Image.open(picture) as image:
        image.convert("RGB").save(small, quality=82, optimize=True)
