"""Takes of a cloth: its bake copied under a name, brought back, compared.

Blender does not know the paths in our settings: when the file is saved elsewhere they are written anew.
"""

from __future__ import annotations

import os
import shutil
import time

import bpy

from ..core import bake_record, cache_paths, report, store, takes
from ..core.cache_paths import CacheFiles
from ..core.refusal import Refusal, cannot_write
from . import cache, live, registry, runtime, take_settings

_comparisons: dict[int, list[str]] = {}
"""What was last compared, by `session_uid`."""
_places: list[tuple[int, int, str]] = []
"""While the file is saved: a cloth's `session_uid`, the number of its take, and the file's absolute path."""


def add(obj: bpy.types.Object, name: str) -> bpy.types.PropertyGroup:
    """Keep the bake that the object plays as a new take.

    Raises:
        Refusal: There is no bake that can be played, or it cannot be copied.
    """
    played = cache.played_path(obj)
    trouble = cache.problem(obj)
    if not played or trouble:
        raise Refusal(trouble or f'"{obj.name}" plays no bake that could be kept: bake it first')
    files = takes.files_of(cache.own_files(obj), name)
    _copy(cache_paths.files_of(played), files)
    take = obj.boucle.takes.add()
    take.name = name
    take.date = time.strftime("%Y-%m-%d %H:%M")
    take.note = takes.note(cache.record_of(obj))
    take.path = cache_paths.relative_to_blend(files.pc2, bpy.data.filepath)
    take.settings = take_settings.keep(obj.boucle)
    obj.boucle.take_index = len(obj.boucle.takes) - 1
    return take


def free_name(obj: bpy.types.Object) -> str:
    """A name that no take has yet."""
    taken = {take.name for take in obj.boucle.takes}
    number = len(taken) + 1
    while f"Take {number}" in taken:
        number += 1
    return f"Take {number}"


def restore(obj: bpy.types.Object, number: int, with_settings: bool) -> str:
    """Play a take as the object's own bake; the bake that was there is kept as the one before. What was done, in words.

    Raises:
        Refusal: There is no such take, or its files are missing or of another mesh.
    """
    take = chosen(obj, number)
    files = files_of(obj, take)
    trouble = cache.trouble(obj, files)
    if trouble:
        raise Refusal(f'"{obj.name}", take "{take.name}": {trouble}')
    record = bake_record.of_report(report.read(files.report))
    if not record:
        raise Refusal(f'"{files.report}" is missing or damaged: bake again')
    before = take_settings.keep(obj.boucle)
    gone = take_settings.give(obj.boucle, take.settings, take.name) if with_settings else []
    live.drop(obj)
    own = cache.own_files(obj)
    try:
        _put(files, own)
    except Refusal:
        take_settings.give(obj.boucle, before, take.name)
        raise
    cache.attach(obj, own.pc2, record)
    said = f'"{obj.name}" plays "{take.name}"' + (" with its settings" if with_settings else "")
    if gone:
        names = ", ".join(f'"{name}"' for name in gone)
        said += f", but for collections that are gone: {names}"
    return said


def remove(obj: bpy.types.Object, number: int) -> None:
    """Remove a take and its files, unless another cloth, as a duplicate, has the same.

    Raises:
        Refusal: There is no such take, or its files cannot be removed.
    """
    take = chosen(obj, number)
    linked = obj.override_library.reference if obj.override_library else None
    if linked is not None and number < len(linked.boucle.takes):
        raise Refusal(
            f'"{obj.name}": the take "{take.name}" comes from the linked file '
            f'"{linked.library.filepath}": remove it there'
        )
    files = files_of(obj, take)
    users = [
        other
        for other in registry.local_cloths()
        for one in other.boucle.takes
        if is_same_file(files_of(other, one).pc2, files.pc2)
    ]
    if len(users) == 1 and not cache_paths.is_ours(files.pc2):
        runtime.warn(f'"{obj.name}": "{files.pc2}" lies in no cache folder and is not removed')
    elif len(users) == 1:
        for path in files.existing():
            try:
                os.remove(path)
            except OSError as error:
                raise cannot_write(path, error) from error
    obj.boucle.takes.remove(number)
    obj.boucle.take_index = max(0, min(obj.boucle.take_index, len(obj.boucle.takes) - 1))
    _comparisons.pop(obj.session_uid, None)


def compare(obj: bpy.types.Object, number: int) -> list[str]:
    """What tells a take from the bake that is played, in words; kept for the panel.

    Raises:
        Refusal: There is no such take, no bake, or no report of either.
    """
    take = chosen(obj, number)
    played = cache.played_path(obj)
    if not played:
        raise Refusal(f'"{obj.name}" plays no bake to compare with: bake it, or restore a take')
    reports = []
    for path in (files_of(obj, take).report, cache_paths.files_of(played).report):
        content = report.read(path)
        if not content.get("frames"):
            raise Refusal(f'"{path}" is missing or damaged: bake again')
        reports.append(content)
    lines = takes.compare(*reports, (f'"{take.name}"', "the bake"))
    _comparisons[obj.session_uid] = lines
    return lines


def comparison(obj: bpy.types.Object) -> str:
    """What was last compared, one fact a line."""
    return "\n".join(_comparisons.get(obj.session_uid, ()))


def chosen(obj: bpy.types.Object, number: int) -> bpy.types.PropertyGroup:
    """One of the takes.

    Raises:
        Refusal: There is no such take.
    """
    count = len(obj.boucle.takes)
    if not 0 <= number < count:
        noun = "take" if count == 1 else "takes"
        raise Refusal(f'"{obj.name}" has {count} {noun}, so there is none of number {number}')
    return obj.boucle.takes[number]


def files_of(obj: bpy.types.Object, take: bpy.types.PropertyGroup) -> CacheFiles:
    """The files of a take. An override has those of the linked file, too, named from there."""
    path = cache.absolute(obj, take.path)
    linked = obj.override_library.reference if obj.override_library else None
    if linked is not None and take.path.startswith("//") and not os.path.isfile(path):
        theirs = cache.absolute(linked, take.path)
        path = theirs if os.path.isfile(theirs) else path
    return cache_paths.files_of(path)


def is_same_file(one: str, other: str) -> bool:
    """Whether two paths name the same file."""
    return os.path.normcase(one) == os.path.normcase(other)


def before_save(blend_path: str) -> None:
    """Name every take from where the file will lie; those of the unsaved session are moved beside it."""
    _places.clear()
    session_folder = cache_paths.own_folder("", runtime.session_folder())
    folder = cache_paths.own_folder(blend_path, "")
    for obj in registry.local_cloths():
        for number, take in enumerate(obj.boucle.takes):
            files = files_of(obj, take)
            if cache_paths.is_within(files.pc2, session_folder):
                target = cache_paths.files_of(os.path.join(folder, os.path.basename(files.pc2)))
                try:
                    _carry(files, target, shutil.move)
                except Refusal as refusal:
                    runtime.warn(str(refusal))
                    continue
                files = target
            _places.append((obj.session_uid, number, files.pc2))
            take.path = cache_paths.relative_to_blend(files.pc2, blend_path)


def after_save() -> None:
    """Name every take from where the open file lies: a copy that was saved elsewhere is not open."""
    for uid, number, path in _places:
        obj = registry.by_uid(uid)
        if obj is not None and number < len(obj.boucle.takes):
            here = cache_paths.relative_to_blend(path, bpy.data.filepath)
            if obj.boucle.takes[number].path != here:
                obj.boucle.takes[number].path = here
    _places.clear()


def forget() -> None:
    """Another file is loaded."""
    _comparisons.clear()
    _places.clear()


def _put(files: CacheFiles, own: CacheFiles) -> None:
    """Copy a take's files to a cloth's own place; the bake that was there becomes the one before."""
    try:
        store.set_aside(own)
    except OSError as error:
        raise cannot_write(own.pc2, error) from error
    _copy(files, own)


def _copy(source: CacheFiles, target: CacheFiles) -> None:
    _carry(source, target, shutil.copyfile)


def _carry(source: CacheFiles, target: CacheFiles, act: object) -> None:
    try:
        os.makedirs(os.path.dirname(target.pc2), exist_ok=True)
        for here, there in zip(source, target, strict=True):
            if os.path.isfile(here):
                act(here, there)
    except OSError as error:
        raise cannot_write(target.pc2, error) from error
