"""What happens to caches when the blend file is saved, loaded or saved under another name."""

from __future__ import annotations

import os
import shutil

import bpy

from ..core import cache_paths
from ..core.cache_paths import CacheFiles
from ..core.refusal import Refusal, cannot_write
from . import cache, display, live, registry, rest, runtime, slot, takes, tearing, vertex_attributes


def before_save(path: str) -> None:
    """Put rest shapes in place, and bring caches of the unsaved session beside the file."""
    live.hide_all()
    for obj in registry.local_cloths():
        tearing.tidy(obj.data)
    cache.ensure_identity()
    if path:
        _bring_along(path)
        takes.before_save(path)


def after_save(scene: bpy.types.Scene) -> None:
    """Show live frames again. A file saved as a copy leaves the session unsaved: name its caches in full."""
    for obj in registry.local_cloths():
        found = slot.find(obj)
        if found is None:
            continue
        if not slot.played(found.cache):
            slot.silence(found.cache)
        elif found.cache.filepath.startswith("//"):
            _name_in_full_if_lost(obj, found.cache)
    takes.after_save()
    live.show_all(scene)


def after_load() -> None:
    """Tidy up what a crash or an automatic save left: frames in meshes, temporary files, shared identities."""
    registry.forget()
    silent = []
    for obj in registry.local_cloths():
        rest.put_back(obj.data)
        vertex_attributes.hide(obj.data)
        tearing.tidy(obj.data)
        found = slot.find(obj)
        if found is None:
            continue
        path = slot.played(found.cache)
        display.silence_leftover(obj)
        if not path or cache_paths.is_live(path):
            slot.silence(found.cache)
            silent.append(obj)
    _find_again(silent)
    cache.ensure_identity()
    cache.follow_files()
    for obj in registry.cloths_of(bpy.context.scene):
        live.show_attributes(obj, bpy.context.scene)


def _find_again(cloths: list[bpy.types.Object]) -> None:
    """A file that was saved before its bake, or killed in it, plays what is there, if it is of these very settings."""
    found = [obj for obj in cloths if obj.override_library is None and cache.reattach(obj)]
    changed = [obj for obj in found if cache.drift_of(obj, bpy.context.scene, in_full=True)]
    for obj in changed:
        cache.detach(obj)


def adopt(obj: bpy.types.Object) -> None:
    """Copy the bake that the object plays to its own place, and play that.

    Raises:
        Refusal: There is nothing to copy, or it cannot be written.
    """
    played = cache.played_path(obj)
    if not played:
        raise Refusal(f'"{obj.name}" plays no bake that could be copied')
    trouble = cache.trouble(obj, cache_paths.files_of(played))
    if trouble:
        raise Refusal(f'"{obj.name}": {trouble}')
    files = cache.own_files(obj)
    record = cache.record_of(obj)
    if not record:
        raise Refusal(f'"{obj.name}": nothing is known of its bake: bake again')
    if cache.is_foreign(obj):
        _copy(cache_paths.files_of(played), files)
    cache.attach(obj, files.pc2, record)


def warn_of_missing() -> None:
    """Before a render: say which caches Blender will not play."""
    for obj in registry.all_cloths():
        trouble = cache.problem(obj)
        if trouble:
            runtime.warn(f"{trouble} (its rest shape is rendered)")


def warn_of_live(scene: bpy.types.Scene) -> None:
    """When a render begins: say what live frames cannot do."""
    unbaked = [obj for obj in registry.cloths_of(scene) if not cache.is_baked(obj)]
    if not unbaked:
        return
    names = ", ".join(f'"{obj.name}"' for obj in unbaked)
    if not runtime.may_write_in_render():
        runtime.warn(
            f"{names} is not baked and does not move in this render: bake, or switch on Render > "
            "Lock Interface"
        )
    elif scene.render.use_motion_blur:
        runtime.warn(f"{names} is not baked and has no deformation blur in this render: bake")


def _bring_along(blend_path: str) -> None:
    session_folder = cache_paths.own_folder("", runtime.session_folder())
    folder = cache_paths.own_folder(blend_path, "")
    for obj in registry.local_cloths():
        played = cache.played_path(obj)
        if not played or not cache_paths.is_within(played, session_folder):
            continue
        source = cache_paths.files_of(played)
        target = cache_paths.files_of(os.path.join(folder, os.path.basename(played)))
        try:
            _move(source, target)
            _move(source.previous, target.previous)
        except Refusal as refusal:
            runtime.warn(str(refusal))
            continue
        slot.find(obj).cache.filepath = cache_paths.relative_to_blend(target.pc2, blend_path)


def _name_in_full_if_lost(obj: bpy.types.Object, modifier: bpy.types.MeshCacheModifier) -> None:
    if bpy.data.filepath or obj.override_library is not None:
        return
    for folder in _saved_folders:
        path = os.path.normpath(os.path.join(folder, modifier.filepath[2:]))
        if os.path.isfile(path):
            modifier.filepath = path
            return


_saved_folders: list[str] = []
"""Folders of the last saves: there `//` pointed while the file was written."""


def remember_folder(path: str) -> None:
    """Note where a file is being saved."""
    if path:
        _saved_folders[:] = [os.path.dirname(path), *_saved_folders[:3]]


def _move(source: CacheFiles, target: CacheFiles) -> None:
    _each(source, target, shutil.move)


def _copy(source: CacheFiles, target: CacheFiles) -> None:
    _each(source, target, shutil.copyfile)


def _each(source: CacheFiles, target: CacheFiles, act: object) -> None:
    try:
        os.makedirs(os.path.dirname(target.pc2), exist_ok=True)
        replaces = os.path.isfile(source.pc2)
        for here, there in zip(source, target, strict=True):
            if os.path.isfile(here):
                act(here, there)
            elif replaces and os.path.isfile(there):  # it belongs to the bake that was here
                os.remove(there)
    except OSError as error:
        raise cannot_write(target.pc2, error) from error
