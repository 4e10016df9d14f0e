"""How the points of a cache belong to a torn cloth, in a file `NAME.tear` beside `NAME.pc2`.

While a cloth is baked it is not known where it will tear: the cache holds a point for each corner of each face, as Blender's
Split Edges makes them of all edges. At the end the same file holds the points of a mesh that is split along torn edges alone.
Which corner is at which point is asked of Blender, and kept here: in whatever order it splits, nothing is guessed.

Layout, little-endian: a magic line, one line of JSON (the counts, and since version 2 a digest of the mesh's faces and edges),
then int32 of the point of each corner, and int32 of both ends of each edge that is split, and a digest of all that. While the
cache is replaced by one in another layout the file holds both, one after the other: that counts which has as many points as the
cache, so that a kill at any moment leaves two files that fit.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from contextlib import suppress
from functools import lru_cache
from io import BytesIO
from typing import Any, NamedTuple

from . import pc2, points, whole_file
from .points import Points
from .refusal import CacheRefusal, Refusal, cannot_write

_MAGIC = b"BOUCLE TEAR 2\n"
_READABLE = (b"BOUCLE TEAR 1\n", _MAGIC)
_DIGEST_BYTES = 16


class Layout(NamedTuple):
    """Which corner of the faces is at which point."""

    vertex_count: int
    """Of the mesh, which are the first of the points."""
    point_count: int
    points: Points
    """The point of each corner, int32."""
    edges: Points | None
    """Both ends of each edge that is split, int32, flat; None where all are."""
    mesh: str = ""
    """A digest of the faces and edges that are numbered so; empty if the file is of version 1 and does not tell."""

    @property
    def is_whole(self) -> bool:
        """Whether no edge is split."""
        return self.edges is not None and not len(self.edges)

    def gather(self, corners: Points) -> Points:
        """What the points have of what the corners have (x, y, z of each, float32, flat)."""
        return points.scatter(corners, self.points, self.point_count)

    def spread(self, gathered: Points) -> Points:
        """What the corners have of what the points have (x, y, z of each, float32, flat)."""
        return points.take(gathered, self.points)


def write(path: str, *layouts: Layout) -> None:
    """Replace the file: one layout, or two of different numbers of points."""
    whole_file.replace(path, b"".join(map(_block, layouts)))


def _block(layout: Layout) -> bytes:
    head = {
        "vertices": layout.vertex_count,
        "points": layout.point_count,
        "corners": len(layout.points),
        "edges": None if layout.edges is None else len(layout.edges) // 2,
        "mesh": layout.mesh,
    }
    parts = [layout.points] if layout.edges is None else [layout.points, layout.edges]
    data = b"".join(memoryview(part).cast("B").tobytes() for part in parts if len(part))
    block = _MAGIC + json.dumps(head).encode() + b"\n" + data
    return block + _digest(block)


def _digest(block: bytes | memoryview) -> bytes:
    return hashlib.blake2b(block, digest_size=_DIGEST_BYTES).digest()


def read(path: str) -> Layout | None:
    """What the file says of the cache beside it; None if there is none.

    Raises:
        CacheRefusal: It is damaged or of a later version, or holds several layouts and the cache cannot be read.
    """
    try:
        found = os.stat(path)
    except OSError:
        return None
    layouts = _read(path, found.st_mtime_ns, found.st_size, found.st_ino)
    if len(layouts) == 1:
        return layouts[0]
    count = pc2.read_header(f"{os.path.splitext(path)[0]}.pc2").vertex_count
    return next((layout for layout in layouts if layout.point_count == count), layouts[0])


@lru_cache(maxsize=16)
def _read(path: str, _written: int, _size: int, _file: int) -> tuple[Layout, ...]:
    """It is asked for at every frame, and read once as long as it stays the same."""
    try:
        with open(path, "rb") as file:
            content = file.read()
    except OSError as error:
        raise CacheRefusal(f'"{path}" cannot be read ({error.strerror}): bake again') from error
    source, layouts = BytesIO(content), []
    version = re.match(rb"BOUCLE TEAR \d+\n", content)
    if version and version[0] not in _READABLE:
        raise CacheRefusal(f'"{path}" is of a later version of Boucle: use that one, or bake again')
    try:
        while not layouts or source.tell() < len(content):
            layouts.append(_read_block(source))
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise CacheRefusal(f'"{path}" is damaged: bake again') from error
    return tuple(layouts)


def _read_block(source: BytesIO) -> Layout:
    start = source.tell()
    magic, head = source.readline(len(_MAGIC)), json.loads(source.readline(1 << 16))
    corners, edges = int(head["corners"]), head["edges"]
    placed, split = (source.read(max(0, size)) for size in (4 * corners, 8 * int(edges or 0)))
    block = source.getbuffer()[start : source.tell()]
    if magic not in _READABLE or source.read(_DIGEST_BYTES) != _digest(block):
        raise ValueError(head)
    ends = None if edges is None else points.integers(split)
    counts = int(head["vertices"]), int(head["points"])
    return Layout(*counts, points.integers(placed), ends, str(head.get("mesh", "")))


def check(pc2_path: str, tear_path: str, vertices: int, corners: int) -> str:
    """Why Blender would not play a cache on a mesh of so many vertices and corners of faces; empty if it would."""
    try:
        layout = read(tear_path)
    except CacheRefusal as refusal:
        return str(refusal)
    if layout is None:
        return pc2.check(pc2_path, vertices)
    if (layout.vertex_count, len(layout.points)) != (vertices, corners):
        return (
            f'the cache "{pc2_path}" is of a torn cloth of {layout.vertex_count} vertices and '
            f"{len(layout.points)} corners of faces, and the mesh has {vertices} and {corners}: it belongs to "
            "another mesh, bake again"
        )
    return pc2.check(pc2_path, layout.point_count)


def arrange(pc2_path: str, tear_path: str, old: Layout, new: Layout) -> bool:
    """Write a cache's points in another layout; False, and nothing changes, if that would join what is apart or gain nothing.

    A kill at any moment leaves the cache in one of the two, and a file that fits it.

    Raises:
        CacheRefusal: A file cannot be read or written.
    """
    if new.point_count == old.point_count:
        return False
    header = pc2.read_header(pc2_path)
    part = f"{pc2_path}.part"
    writer = pc2.Writer.create(part, new.point_count, int(header.first_frame))
    try:
        for index in range(header.sample_count):
            corners = old.spread(pc2.read_sample(pc2_path, index))
            gathered = new.gather(corners)
            if bytes(memoryview(new.spread(gathered)).cast("B")) != bytes(
                memoryview(corners).cast("B")
            ):
                return False
            writer.append(gathered)
        writer.close()
        write(tear_path, old, new)
        os.replace(part, pc2_path)
        write(tear_path, new)
    except OSError as error:
        raise cannot_write(pc2_path, error) from error
    finally:
        writer.close()
        with suppress(OSError):  # it has become the cache, or the disk is gone
            os.remove(part)
    return True


def restore_corners(pc2_path: str, tear_path: str, full: Layout) -> None:
    """Give a cache that is to go on a point for each corner again.

    Raises:
        Refusal: The files are damaged or do not fit.
    """
    if pc2.read_header(pc2_path).vertex_count == full.point_count:
        write(tear_path, full)
        return
    old = read(tear_path)
    if old is None or pc2.read_header(pc2_path).vertex_count != old.point_count:
        raise Refusal(f'"{tear_path}" is missing or of another bake: bake from the start')
    arrange(pc2_path, tear_path, old, full)


def of_vertices(vertices: Points, layout: Layout, corner_vertices: Points) -> Points:
    """Positions of the vertices of a cloth that is whole as those of the points (x, y, z of each, float32, flat)."""
    return layout.gather(points.take(vertices, corner_vertices))


def is_apart(gathered: Points, layout: Layout, corner_vertices: Points) -> bool:
    """Whether the corners of some vertex are in several places."""
    corners = layout.spread(gathered)
    vertices = points.scatter(corners, corner_vertices, layout.vertex_count)
    joined: Any = points.take(vertices, corner_vertices)
    return bytes(memoryview(joined).cast("B")) != bytes(memoryview(corners).cast("B"))
