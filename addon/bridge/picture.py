"""Pictures of the viewport."""

from __future__ import annotations

import os

import bpy

from .._identifiers import PICTURE_FOLDER
from ..core.refusal import Refusal


def path_for(name: str) -> str:
    """The first free file name for a picture of an object: beside the saved file, else in the add-on's own user folder.

    Raises:
        Refusal: The folder cannot be made.
    """
    if bpy.data.filepath:
        folder = bpy.path.abspath(f"//{PICTURE_FOLDER}")
    else:
        package = __package__.rpartition(".")[0]
        folder = bpy.utils.extension_path_user(package, path=PICTURE_FOLDER)
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise Refusal(
            f'the folder "{folder}" for pictures cannot be made: {error.strerror}'
        ) from error
    name = bpy.path.clean_name(name)
    number = 1
    while os.path.exists(path := os.path.join(folder, f"{name}_{number:04d}.png")):
        number += 1
    return path


def take(scene: bpy.types.Scene, path: str) -> None:
    """Save what the 3D viewport of the context shows as a PNG; the scene's output settings stay as they are.

    Raises:
        Refusal: Blender cannot draw or write it.
    """
    render = scene.render
    kept: list[tuple[object, str, object]] = []

    def set_for_now(owner: object, name: str, value: object) -> None:
        if hasattr(owner, name):
            kept.append((owner, name, getattr(owner, name)))
            setattr(owner, name, value)

    try:
        set_for_now(render, "filepath", path)
        set_for_now(render.image_settings, "media_type", "IMAGE")  # since Blender 5.0
        set_for_now(render.image_settings, "file_format", "PNG")
        bpy.ops.render.opengl(write_still=True, view_context=True)
    except RuntimeError as error:
        raise Refusal(f"the viewport cannot be drawn into a picture: {error}") from error
    finally:
        for owner, name, value in reversed(kept):
            setattr(owner, name, value)
    if not os.path.isfile(path):
        raise Refusal(
            f"the picture was not written to {path}: check that the folder can be written"
        )
