"""Where a cloth's cache lies: `//boucle_cache/<blend name>/<uuid>.pc2` and the files beside it."""

from __future__ import annotations

import os
import re
from typing import NamedTuple

from .._identifiers import CACHE_FOLDER, LIVE_FOLDER


class CacheFiles(NamedTuple):
    """The files of one baked cloth; all lie in one folder."""

    pc2: str
    report: str
    checkpoint: str
    strain: str
    """There only if the bake keeps the strain; so the next four."""
    tension: str
    contact: str
    intersection: str
    force: str
    tear: str
    """Of a cloth that tears: how the points belong to it."""

    @property
    def previous(self) -> CacheFiles:
        """The files of the bake before this one, kept until the user frees the cache."""
        return self.with_middle("previous")

    def with_middle(self, word: str) -> CacheFiles:
        """The same files with a word before their endings."""
        return CacheFiles(*(_with_middle(path, word) for path in self))

    def existing(self) -> list[str]:
        """Those of the files that are there."""
        return [path for path in self if os.path.isfile(path)]


def _with_middle(path: str, word: str) -> str:
    stem, extension = os.path.splitext(path)
    return f"{stem}.{word}{extension}"


def files_of(pc2: str) -> CacheFiles:
    """The files that belong to a PC2 file."""
    stem = os.path.splitext(pc2)[0]
    endings = (
        "json",
        "checkpoint",
        "strain",
        "tension",
        "contact",
        "intersection",
        "force",
        "tear",
    )
    return CacheFiles(pc2, *(f"{stem}.{ending}" for ending in endings))


def blend_stem(blend_path: str) -> str:
    """The blend file's name without its folder and ending."""
    return os.path.splitext(os.path.basename(blend_path))[0]


def own_folder(blend_path: str, session_folder: str) -> str:
    """The absolute folder for the caches of a blend file; of an unsaved one, within session_folder."""
    if not blend_path:
        return os.path.join(session_folder, CACHE_FOLDER)
    return os.path.join(os.path.dirname(blend_path), CACHE_FOLDER, blend_stem(blend_path))


def relative_to_blend(path: str, blend_path: str) -> str:
    """The path as Blender writes it beside a blend file: `//` and forward slashes; absolute if unsaved."""
    if not blend_path:
        return path
    try:
        tail = os.path.relpath(path, os.path.dirname(blend_path))
    except ValueError:  # another drive
        return path
    return "//" + tail.replace(os.sep, "/")


def live_file(session_folder: str, uid: int) -> str:
    """The temporary PC2 in which live frames of an object are shown."""
    return os.path.join(session_folder, LIVE_FOLDER, f"{uid}.pc2")


def is_live(path: str) -> bool:
    """Whether a path is such a temporary PC2, of this session or of one that crashed."""
    return LIVE_FOLDER in re.split(r"[\\/]", path)


def is_identity(text: str) -> bool:
    """Whether a text is what we call a cloth by, and so a file."""
    return re.fullmatch("[0-9a-f]{32}", text) is not None


def is_ours(path: str) -> bool:
    """Whether a file lies in a folder for caches, of whatever blend file."""
    return CACHE_FOLDER in re.split(r"[\\/]", os.path.normpath(path))[:-1]


def is_within(path: str, folder: str) -> bool:
    """Whether a file lies directly in a folder."""
    return os.path.normcase(os.path.normpath(os.path.dirname(path))) == os.path.normcase(
        os.path.normpath(folder)
    )
