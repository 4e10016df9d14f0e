"""The checkpoint beside a PC2: from it a stopped bake goes on, bit-equal to one that never stopped.

Layout: a magic line, one line of JSON (frame, sample count, digest of the scene, length, the bake, its cloths and the rows of
their reports), then the solver's own bytes, and a digest of everything before. Of several cloths that are baked together the
first one's file holds the state and the rows of all, and the others' hold none.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from . import whole_file
from .refusal import Refusal

_MAGIC = b"BOUCLE CHECKPOINT 2\n"
_DIGEST_BYTES = 16


class Checkpoint(NamedTuple):
    """Where a bake stopped."""

    frame: int
    sample_count: int
    digest: str
    state: bytes
    bake: str = ""
    """Identity of the bake."""
    cloths: tuple[str, ...] = ()
    """Names of its cloths."""
    rows: Sequence[Sequence[Mapping[str, Any]]] = ()
    """Of each cloth's report, one for every sample."""


def write(path: str, checkpoint: Checkpoint) -> None:
    """Replace the checkpoint file."""
    head = {
        "frame": checkpoint.frame,
        "samples": checkpoint.sample_count,
        "digest": checkpoint.digest,
        "length": len(checkpoint.state),
        "bake": checkpoint.bake,
        "cloths": checkpoint.cloths,
        "rows": checkpoint.rows,
    }
    content = _MAGIC + json.dumps(head).encode() + b"\n" + checkpoint.state
    whole_file.replace(path, content + _digest(content))


def _digest(content: bytes) -> bytes:
    return hashlib.blake2b(content, digest_size=_DIGEST_BYTES).digest()


def read(path: str) -> Checkpoint | None:
    """The checkpoint; None if there is none.

    Raises:
        Refusal: The file is damaged, or of another version.
    """
    try:
        with open(path, "rb") as file:
            content = file.read()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise Refusal(f'the checkpoint "{path}" cannot be read ({error.strerror})') from error
    version = re.match(rb"BOUCLE CHECKPOINT \d+\n", content)
    if version and version[0] != _MAGIC:
        raise Refusal(
            f'the checkpoint "{path}" is of another version of Boucle: go on with that one, or bake from the start'
        )
    try:
        return _parse(content)
    except (ValueError, KeyError, TypeError, OverflowError, RecursionError) as error:
        raise Refusal(f'the checkpoint "{path}" is damaged: bake from the start') from error


def _parse(content: bytes) -> Checkpoint:
    body, digest = content[:-_DIGEST_BYTES], content[-_DIGEST_BYTES:]
    if not body.startswith(_MAGIC) or _digest(body) != digest:
        raise ValueError(digest)
    line, _, state = body[len(_MAGIC) :].partition(b"\n")
    head = json.loads(line)
    if head["length"] != len(state):
        raise ValueError(head["length"])
    numbers = int(head["frame"]), int(head["samples"])
    cloths = tuple(map(str, head["cloths"]))
    rows = tuple([dict(row) for row in each] for each in head["rows"])
    return Checkpoint(*numbers, str(head["digest"]), state, str(head["bake"]), cloths, rows)
