"""The cache of a cloth: its files, the modifier that plays it, and what it is worth, in words."""

from __future__ import annotations

import json
import os
import uuid
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import bpy

from ..core import bake_record, cache_paths, drift, pc2, report, torn
from ..core.cache_paths import CacheFiles
from ..core.progress import size
from ..core.refusal import Refusal, cannot_write
from ..core.torn import Layout
from . import record, registry, runtime, slot, tear_fit, tearing


def absolute(obj: bpy.types.Object, path: str) -> str:
    """A path as the file system knows it; `//` starts from the file that owns the object."""
    return os.path.normpath(bpy.path.abspath(path, library=obj.library)) if path else ""


def played_path(obj: bpy.types.Object) -> str:
    """The absolute path of the bake that the object plays; empty without one."""
    found = slot.find(obj)
    path = slot.played(found.cache) if found is not None else ""
    return "" if cache_paths.is_live(path) else absolute(obj, path)


def is_baked(obj: bpy.types.Object) -> bool:
    """Whether the object plays a bake (which may be missing or outdated)."""
    return bool(played_path(obj))


def own_folder() -> str:
    """The folder for caches of this blend file."""
    return cache_paths.own_folder(bpy.data.filepath, runtime.session_folder())


def own_files(obj: bpy.types.Object) -> CacheFiles:
    """Where this object's own bake goes."""
    ensure_identity()
    return cache_paths.files_of(os.path.join(own_folder(), f"{obj.boucle.uuid}.pc2"))


def ensure_identity() -> None:
    """Give every cloth of the file an identity of its own: of two that share one, the newer is the copy.

    It names files: what is none of ours, as in a file that somebody else has made, might name others'.
    """
    taken: set[str] = set()
    for obj in sorted(registry.local_cloths(), key=lambda obj: obj.session_uid):
        if not cache_paths.is_identity(obj.boucle.uuid) or obj.boucle.uuid in taken:
            obj.boucle.uuid = uuid.uuid4().hex
        taken.add(obj.boucle.uuid)


def attach(obj: bpy.types.Object, pc2_path: str, remembered: dict[str, Any]) -> None:
    """Let the object play a bake, and keep what it remembers; others that play its files follow.

    Raises:
        Refusal: It is of a torn cloth, and damaged, or the mesh cannot bear the mark of its tears.
    """
    _play(obj, pc2_path, remembered)
    path = played_path(obj)
    others = (other for other in registry.local_cloths() if other != obj)
    follow_files([other for other in others if played_path(other) == path])


def _play(obj: bpy.types.Object, pc2_path: str, remembered: dict[str, Any]) -> None:
    slot.ensure(obj)
    tearing.show(obj, torn.read(cache_paths.files_of(pc2_path).tear))
    path = cache_paths.relative_to_blend(pc2_path, bpy.data.filepath)
    slot.play(slot.find(obj).cache, path, int(remembered["first"]))
    obj.boucle.bake_record = json.dumps(remembered)
    obj.update_tag()


def detach(obj: bpy.types.Object) -> None:
    """Let the object play no bake; files stay."""
    found = slot.find(obj)
    if found is not None:
        slot.silence(found.cache)
        tearing.show(obj, None)
    obj.boucle.bake_record = ""
    obj.update_tag()


def reattach(obj: bpy.types.Object) -> bool:
    """Play the object's own bake again if its files are there and fit; whether they do."""
    if not obj.boucle.uuid:
        return False
    files = own_files(obj)
    remembered = bake_record.of_report(report.read(files.report))
    if trouble(obj, files) or not remembered:
        return False
    try:
        _play(obj, files.pc2, remembered)
    except Refusal as refusal:
        _tell(obj, refusal)
        return False
    return True


def follow_files(cloths: Sequence[bpy.types.Object] | None = None) -> None:
    """Remember what the bakes on disk are made from, and split as they are torn; of all local cloths if none are given.

    Undo, a file that is opened again and copies know of an earlier bake only. What cannot is told, and holds up no other.
    """
    tear_fit.forget()
    for obj in registry.local_cloths() if cloths is None else cloths:
        path = played_path(obj)
        if path:
            try:
                _follow(obj, cache_paths.files_of(path))
            except Refusal as refusal:
                _tell(obj, refusal)


def _follow(obj: bpy.types.Object, files: CacheFiles) -> None:
    remembered = _bake_of(files.report)
    if remembered and remembered.get("bake") != record_of(obj).get("bake"):
        slot.find(obj).cache.frame_start = float(remembered["first"])
        obj.boucle.bake_record = json.dumps(remembered)
    known = torn.read(files.tear)
    if not tear_fit.mesh_trouble(obj.data, known) and tear_fit.object_trouble(obj, known):
        tearing.show(obj, known)


def _tell(obj: bpy.types.Object, refusal: Refusal) -> None:
    """Say it on the console: this comes of no button."""
    said = str(refusal)
    runtime.warn(said if said.startswith(f'"{obj.name}"') else f'"{obj.name}": {said}')


def _bake_of(path: str) -> dict[str, Any] | None:
    """What the bake of a report remembers; None without one."""
    try:
        found = os.stat(path)
    except OSError:
        return None
    return _read_bake(path, found.st_mtime_ns, found.st_size, found.st_ino)


@lru_cache(maxsize=256)
def _read_bake(path: str, _written: int, _size: int, _file: int) -> dict[str, Any] | None:
    """A report is long, and is read once as long as its file stays the same."""
    return bake_record.of_report(report.read(path)) or None


def free(obj: bpy.types.Object) -> None:
    """Remove the object's own bake, and the one before it, from the disk; another file's is only let go."""
    files = own_files(obj)
    for path in (*files.existing(), *files.previous.existing()):
        try:
            os.remove(path)
        except OSError as error:
            raise Refusal(
                f'the cache "{path}" cannot be removed ({error.strerror}): close what uses it'
            ) from error
    detach(obj)


def restore_previous(obj: bpy.types.Object) -> None:
    """Swap the bake with the one before it."""
    files = own_files(obj)
    previous = files.previous
    if not os.path.isfile(previous.pc2):
        raise Refusal(f'"{obj.name}": there is no earlier bake to restore')
    try:
        for path, kept in zip(files, previous, strict=True):
            _swap(path, kept)
    except OSError as error:
        raise cannot_write(files.pc2, error) from error
    remembered = bake_record.of_report(report.read(files.report))
    if not remembered:
        raise Refusal(f'"{files.report}" is missing or damaged: bake again')
    attach(obj, files.pc2, remembered)


def has_previous(obj: bpy.types.Object) -> bool:
    """Whether an earlier bake is kept."""
    if not cache_paths.is_identity(obj.boucle.uuid):
        return False
    path = os.path.join(own_folder(), f"{obj.boucle.uuid}.pc2")
    return os.path.isfile(cache_paths.files_of(path).previous.pc2)


def record_of(obj: bpy.types.Object) -> dict[str, Any]:
    """What the bake that the object plays remembers; empty without one."""
    return bake_record.of_text(obj.boucle.bake_record)


def problem(obj: bpy.types.Object) -> str:
    """Why the bake that the object plays cannot be played; empty if it can, or if there is none."""
    path = played_path(obj)
    if not path:
        return ""
    files = cache_paths.files_of(path)
    found = trouble(obj, files) or tear_fit.object_trouble(obj, torn.read(files.tear))
    return f'"{obj.name}": {found}' if found else ""


def trouble(obj: bpy.types.Object, files: CacheFiles) -> str:
    """Why Blender would not play a cache on the object; empty if it would."""
    mesh = obj.data
    found = torn.check(files.pc2, files.tear, len(mesh.vertices), len(mesh.loops))
    return found or tear_fit.mesh_trouble(mesh, torn.read(files.tear))


def layout(obj: bpy.types.Object) -> Layout | None:
    """How the points of the bake that the object plays, which must be playable, belong to a cloth that may tear; else None."""
    path = played_path(obj)
    return torn.read(cache_paths.files_of(path).tear) if path else None


def frame_range(obj: bpy.types.Object) -> tuple[int, int]:
    """The first and the last frame of the bake that the object plays, which must be there."""
    header = pc2.read_header(played_path(obj))
    first = int(record_of(obj).get("first", header.first_frame))
    return first, first + header.sample_count - 1


def drift_of(obj: bpy.types.Object, scene: bpy.types.Scene, in_full: bool) -> list[str]:
    """What changed since the bake, in words; in_full compares groups and faces too, which takes longer."""
    then = record_of(obj)
    if not then:
        return []
    return _own_drift(obj, scene, then, in_full) + _drift_of_others(obj, scene, then, in_full)


def _drift_of_others(
    obj: bpy.types.Object, scene: bpy.types.Scene, then: dict[str, Any], in_full: bool
) -> list[str]:
    """The cloths that were baked together with this one and are not as they were."""
    found = _baked_together(obj, then)
    words = []
    for key, name in then.get("together", {}).items():
        theirs = record_of(found[key]) if key in found else {}
        is_same = bool(theirs) and theirs.get("bake") == then.get("bake")
        if not is_same or _own_drift(found[key], scene, theirs, in_full):
            words.append(f'the cloth "{found[key].name if key in found else name}"')
    return words


def _baked_together(obj: bpy.types.Object, then: dict[str, Any]) -> dict[str, bpy.types.Object]:
    """The cloths that were baked together with this one and are still there, by their identity."""
    names = then.get("together", {})
    if not names:
        return {}
    cloths = (other for other in registry.all_cloths() if other.library == obj.library)
    return {other.boucle.uuid: other for other in cloths if other.boucle.uuid in names}


def _own_drift(
    obj: bpy.types.Object, scene: bpy.types.Scene, then: dict[str, Any], in_full: bool
) -> list[str]:
    try:
        now = record.of(obj, scene, list(_baked_together(obj, then).values()), in_full)
    except Refusal as refusal:
        return [str(refusal)]
    return drift.differences(then, now)


def is_foreign(obj: bpy.types.Object) -> bool:
    """Whether the object plays another file's or another object's bake."""
    path = played_path(obj)
    own = os.path.join(own_folder(), f"{obj.boucle.uuid}.pc2")
    return bool(path) and os.path.normcase(path) != os.path.normcase(os.path.normpath(own))


def status(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """The state of a bake in one sentence; empty without one."""
    path = played_path(obj)
    if not path:
        return ""
    trouble = problem(obj)
    if trouble:
        return trouble
    known = record_of(obj)
    first, last = frame_range(obj)
    text = f"Baked: frames {first} to {last}, {size(os.path.getsize(path))}"
    end = int(known.get("end", last)) if known.get("is_part") else obj.boucle.frame_end
    if last < end:
        text = f"Partly baked: frames {first} to {last} of {end}; Resume goes on"
    changed = drift_of(obj, scene, in_full=False)
    if changed:
        text += f"; outdated, changed since: {', '.join(changed)}"
    if is_foreign(obj):
        text += "; the cache belongs to another file or object, Copy makes it this one's own"
    return text


def _swap(path: str, kept: str) -> None:
    """Exchange two files, either of which may be missing."""
    aside = f"{path}.swap"
    if os.path.isfile(path):
        os.replace(path, aside)
    if os.path.isfile(kept):
        os.replace(kept, path)
    if os.path.isfile(aside):
        os.replace(aside, kept)
