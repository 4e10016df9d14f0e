"""What the add-on does at Blender's events. Without a Boucle cloth in the file none of these does any work."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
from bpy.app.handlers import persistent

from .bridge import (
    cache,
    certificate,
    cloth,
    findings,
    live,
    overlay_view,
    registry,
    runtime,
    safe_step,
    saving,
    takes,
    tear_fit,
    thickness_view,
)


@persistent
def frame_change_post(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Step or show live cloths."""
    thickness_view.forget()
    overlay_view.forget()
    if registry.all_cloths():
        live.on_frame(scene, depsgraph)


@persistent
def depsgraph_update_post(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Give back the rest shape when the artist starts to edit, or moves the mesh within its object."""
    thickness_view.forget()
    overlay_view.forget()
    tear_fit.forget()
    if registry.all_cloths() and not runtime.busy and not runtime.rendering:
        live.follow_edits(depsgraph)


@persistent
def animation_playback_pre(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Take the rest pose at the start frame, which playing leaves without an event of its own."""
    if registry.all_cloths():
        live.on_frame(scene, depsgraph)


@persistent
def save_pre(path: str, *_: Any) -> None:
    """Rest shapes and caches in place before the file is written."""
    if registry.all_cloths():
        for obj in registry.local_cloths():
            if obj.override_library is None:
                cloth.store_groups(obj)
        saving.remember_folder(path)
        saving.before_save(path)


@persistent
def save_post(_path: str, *_: Any) -> None:
    """Live frames shown again."""
    if registry.all_cloths():
        saving.after_save(bpy.context.scene)


@persistent
def load_pre(*_: Any) -> None:
    """Forget everything about the file that is about to go."""
    live.forget_all()
    safe_step.forget()
    certificate.forget()
    findings.forget()
    takes.forget()
    tear_fit.forget()
    runtime.rendering.clear()
    runtime.busy.discard("grab")


@persistent
def load_post(*_: Any) -> None:
    """Tidy up the file that came."""
    registry.forget()
    thickness_view.follow()
    overlay_view.follow()
    if registry.all_cloths():
        saving.after_load()


@persistent
def undo_post(scene: bpy.types.Scene, *_: Any) -> None:
    """Undo and redo replace Blender's data: look at it anew."""
    registry.forget()
    safe_step.forget()
    tear_fit.forget()
    thickness_view.follow()
    overlay_view.follow()
    if live.any_session() or registry.all_cloths():
        cache.follow_files()
        live.revalidate(scene)


@persistent
def render_init(scene: bpy.types.Scene, *_: Any) -> None:
    """From here on no data is added or removed."""
    runtime.rendering.add(scene.name)
    if registry.all_cloths():
        saving.warn_of_live(scene)


@persistent
def render_pre(_scene: bpy.types.Scene, *_: Any) -> None:
    """Blender shows the rest shape without a word where a cache is missing: say it."""
    if registry.all_cloths():
        saving.warn_of_missing()


@persistent
def render_end(_scene: bpy.types.Scene, *_: Any) -> None:
    """The render is done or was stopped."""
    runtime.rendering.clear()


_HANDLERS: tuple[tuple[str, Callable[..., None]], ...] = (
    ("frame_change_post", frame_change_post),
    ("depsgraph_update_post", depsgraph_update_post),
    ("animation_playback_pre", animation_playback_pre),
    ("save_pre", save_pre),
    ("save_post", save_post),
    ("save_post_fail", save_post),
    ("load_pre", load_pre),
    ("load_post", load_post),
    ("undo_post", undo_post),
    ("redo_post", undo_post),
    ("render_init", render_init),
    ("render_pre", render_pre),
    ("render_complete", render_end),
    ("render_cancel", render_end),
)


def register() -> None:
    """Listen to Blender's events."""
    for name, function in _HANDLERS:
        getattr(bpy.app.handlers, name).append(function)


def unregister() -> None:
    """Stop listening."""
    for name, function in _HANDLERS:
        listeners = getattr(bpy.app.handlers, name)
        if function in listeners:
            listeners.remove(function)
