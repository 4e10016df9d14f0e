"""A number at each vertex of a baked cloth, or corner of its faces (see `quantity`), beside its PC2: a row for every sample.

Layout, little-endian: a magic word of 16 bytes by the quantity, which the file's ending tells, too; int32 count, int32
zero; then one row a sample, float32 (n,). Only whole rows count, so that the file is a valid prefix at any moment.
"""

from __future__ import annotations

import os
import struct
from array import array
from collections.abc import Sequence
from typing import BinaryIO

from .pc2 import digest
from .points import Points
from .refusal import CacheRefusal, cannot_write

_HEADER = struct.Struct("<16sii")
_MAGIC = {
    ".strain": b"BOUCLE STRAIN 1\n",
    ".tension": b"BOUCLE TENSION 1",
    ".contact": b"BOUCLE CONTACT 1",
    ".intersection": b"BOUCLE CROSSED 1",
    ".force": b"BOUCLE FORCE 1\n\n",
}


def _magic(path: str) -> bytes:
    return _MAGIC[os.path.splitext(path)[1]]


def row_count(path: str, vertex_count: int) -> int:
    """Whole rows in the file; 0 if it is missing or of another mesh."""
    try:
        with open(path, "rb") as file:
            head = file.read(_HEADER.size)
            length = os.fstat(file.fileno()).st_size - _HEADER.size
    except OSError:
        return 0
    if len(head) < _HEADER.size or _HEADER.unpack(head)[:2] != (_magic(path), vertex_count):
        return 0
    return length // (4 * vertex_count) if vertex_count else 0


def read(path: str, index: int, vertex_count: int) -> array | None:
    """One row, float32; None if it is not there. index counts from 0."""
    if not 0 <= index < row_count(path, vertex_count):
        return None
    try:
        with open(path, "rb") as file:
            file.seek(_HEADER.size + 4 * vertex_count * index)
            data = file.read(4 * vertex_count)
    except OSError:
        return None
    return array("f", data) if len(data) == 4 * vertex_count else None


class Writer:
    """Appends rows."""

    def __init__(self, path: str, file: BinaryIO) -> None:
        """Use `create` or `reopen`."""
        self.path = path
        self._file = file

    @classmethod
    def create(cls, path: str, vertex_count: int) -> Writer:
        """Start an empty file; its folder must be there.

        Raises:
            CacheRefusal: The system did not let us.
        """
        try:
            file = open(path, "w+b", buffering=0)  # noqa: SIM115 (closed by `close`)
            file.write(_HEADER.pack(_magic(path), vertex_count, 0))
        except OSError as error:
            raise cannot_write(path, error) from error
        return cls(path, file)

    @classmethod
    def reopen(cls, path: str, vertex_count: int, digests: Sequence[str]) -> Writer:
        """Go on after the first rows, whose digests are told; later ones are dropped.

        Raises:
            CacheRefusal: The file does not hold them, or cannot be written.
        """
        for index, known in enumerate(digests):
            row = read(path, index, vertex_count)
            if row is None or digest(row) != known:
                raise CacheRefusal(
                    f'"{path}" is missing or damaged at row {index}: bring the file back, do without its attribute '
                    "or bake from the start"
                )
        try:
            file = open(path, "r+b", buffering=0)  # noqa: SIM115 (closed by `close`)
            file.write(_HEADER.pack(_magic(path), vertex_count, 0))
            file.truncate(_HEADER.size + 4 * vertex_count * len(digests))
            file.seek(0, os.SEEK_END)
        except OSError as error:
            raise cannot_write(path, error) from error
        return cls(path, file)

    def append(self, row: Points) -> None:
        """Write one row, float32.

        Raises:
            CacheRefusal: The system did not take it all.
        """
        data = memoryview(row).cast("B")
        try:
            while len(data):
                data = data[self._file.write(data) :]
        except OSError as error:
            raise cannot_write(self.path, error) from error

    def close(self) -> None:
        """Close the file."""
        self._file.close()
