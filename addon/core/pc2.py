"""PC2 point caches: written so that the file on disk is always a valid prefix of the whole.

Layout, little-endian: "POINTCACHE2" and a zero byte, int32 version (1), int32 vertex count, float32 first frame, float32
sample rate (1), int32 sample count; then one sample a frame, float32 (n, 3), metres.
"""

from __future__ import annotations

import hashlib
import math
import os
import struct
from array import array
from collections.abc import Sequence
from typing import BinaryIO, NamedTuple

from .points import Points
from .refusal import CacheRefusal, cannot_write

_HEADER = struct.Struct("<12siiffi")
_SIGNATURE = b"POINTCACHE2\0"
_COUNT_OFFSET = _HEADER.size - 4


class Header(NamedTuple):
    """What stands at the head of a PC2 file."""

    vertex_count: int
    first_frame: float
    sample_count: int

    @property
    def sample_bytes(self) -> int:
        """Bytes of one sample."""
        return 12 * self.vertex_count


def read_header(path: str) -> Header:
    """The header of a PC2 file.

    Raises:
        CacheRefusal: The file is missing or is no PC2 file.
    """
    try:
        with open(path, "rb") as file:
            head = file.read(_HEADER.size)
    except OSError as error:
        raise _unreadable(path, error) from error
    if len(head) < _HEADER.size or not head.startswith(_SIGNATURE):
        raise CacheRefusal(f'the cache "{path}" is not a PC2 file: bake again')
    _, _, vertex_count, first_frame, _, sample_count = _HEADER.unpack(head)
    if vertex_count < 0 or sample_count < 0 or not math.isfinite(first_frame):
        raise CacheRefusal(f'the cache "{path}" is damaged: bake again')
    return Header(vertex_count, first_frame, sample_count)


def check(path: str, vertex_count: int) -> str:
    """Why Blender would not play this file on a mesh of vertex_count vertices; empty if it would."""
    if not os.path.isfile(path):
        return f'the cache "{path}" is missing: bring the file back or bake again'
    try:
        header = read_header(path)
    except CacheRefusal as refusal:
        return str(refusal)
    if header.vertex_count != vertex_count:
        return (
            f'the cache "{path}" holds {header.vertex_count} vertices and the mesh has '
            f"{vertex_count}: it belongs to another mesh, bake again"
        )
    if header.sample_count == 0:
        return f'the cache "{path}" holds no frame: bake again'
    present = (os.path.getsize(path) - _HEADER.size) // max(1, header.sample_bytes)
    if present < header.sample_count:
        return (
            f'the cache "{path}" is truncated: {present} of {header.sample_count} frames are '
            "there, bake again"
        )
    return ""


def read_sample(path: str, index: int) -> array:
    """Positions (m) of one sample, float32, flat; index counts from 0."""
    header = read_header(path)
    if not 0 <= index < header.sample_count:
        raise CacheRefusal(
            f'the cache "{path}" has no sample {index}: it holds {header.sample_count}'
        )
    start = _HEADER.size + index * header.sample_bytes
    try:
        with open(path, "rb") as file:
            # To read what the header claims would take the memory for it first.
            is_there = os.fstat(file.fileno()).st_size >= start + header.sample_bytes
            file.seek(start)
            data = file.read(header.sample_bytes if is_there else 0)
    except OSError as error:
        raise _unreadable(path, error) from error
    if len(data) < header.sample_bytes:
        raise CacheRefusal(f'the cache "{path}" is truncated: bake again')
    return array("f", data)


def digest(sample: Points) -> str:
    """What a report tells of numbers in a file (float32, flat), so that some that have changed are noticed."""
    return "blake2b-64:" + hashlib.blake2b(memoryview(sample).cast("B"), digest_size=8).hexdigest()


def _unreadable(path: str, error: OSError) -> CacheRefusal:
    return CacheRefusal(f'the cache "{path}" cannot be read ({error.strerror}): bake again')


class Writer:
    """Appends samples to a PC2 file: first the data, then the header's count."""

    def __init__(self, path: str, file: BinaryIO, header: Header) -> None:
        """Use `create` or `reopen`."""
        self.path = path
        self._file = file
        self._header = header

    @classmethod
    def create(cls, path: str, vertex_count: int, first_frame: int) -> Writer:
        """Start an empty file; its folder is made if missing."""
        header = Header(vertex_count, float(first_frame), 0)
        try:
            os.makedirs(os.path.dirname(path), exist_ok=True)
            file = open(path, "w+b", buffering=0)  # noqa: SIM115 (closed by `close`)
        except OSError as error:
            raise cannot_write(path, error) from error
        writer = cls(path, file, header)
        writer._write_header()
        return writer

    @classmethod
    def reopen(
        cls, path: str, vertex_count: int, first_frame: int, digests: Sequence[str]
    ) -> Writer:
        """Go on after the first samples, whose digests are told; later ones are dropped.

        Raises:
            CacheRefusal: The file does not hold them, or cannot be written.
        """
        found = read_header(path)
        header = Header(vertex_count, float(first_frame), len(digests))
        if found[:2] != header[:2] or found.sample_count < len(digests):
            raise CacheRefusal(
                f'the cache "{path}" does not hold the {len(digests)} frames of '
                f"{vertex_count} vertices that the checkpoint goes on from: bake from the start"
            )
        for index, known in enumerate(digests):
            if digest(read_sample(path, index)) != known:
                raise CacheRefusal(
                    f'the cache "{path}" is damaged: frame {first_frame + index} is not as it was baked: '
                    "bring the file back or bake from the start"
                )
        try:
            file = open(path, "r+b", buffering=0)  # noqa: SIM115 (closed by `close`)
            writer = cls(path, file, header)
            writer._write_header(in_full=True)
            file.truncate(_HEADER.size + len(digests) * header.sample_bytes)
        except OSError as error:
            raise cannot_write(path, error) from error
        return writer

    @property
    def sample_count(self) -> int:
        """Samples written so far."""
        return self._header.sample_count

    def append(self, positions: Points) -> None:
        """Write one sample: positions (m), float32, flat.

        Raises:
            CacheRefusal: The system did not take it all; the file keeps the samples before it.
        """
        data = memoryview(positions).cast("B")
        header = self._header
        if len(data) != header.sample_bytes:
            raise ValueError(f"a sample has {header.sample_bytes} bytes, not {len(data)}")
        start = _HEADER.size + header.sample_count * header.sample_bytes
        try:
            self._file.seek(start)
            self._write_all(data)
        except OSError as error:
            self._cut(start)
            raise cannot_write(self.path, error) from error
        self._header = header._replace(sample_count=header.sample_count + 1)
        self._write_header()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _write_all(self, data: memoryview) -> None:
        while len(data):
            written = self._file.write(data)
            data = data[written:]

    def _write_header(self, in_full: bool = False) -> None:
        header = self._header
        head = _HEADER.pack(
            _SIGNATURE, 1, header.vertex_count, header.first_frame, 1.0, header.sample_count
        )
        try:
            if header.sample_count and not in_full:
                self._file.seek(_COUNT_OFFSET)
                self._write_all(memoryview(head)[_COUNT_OFFSET:])
            else:
                self._file.seek(0)
                self._write_all(memoryview(head))
        except OSError as error:
            raise cannot_write(self.path, error) from error

    def _cut(self, length: int) -> None:
        """Drop a half-written sample; the header does not count it, so a failure here is harmless."""
        try:
            self._file.truncate(length)
        except OSError as error:
            print(f'Boucle: "{self.path}" keeps a half-written frame at its end ({error})')
