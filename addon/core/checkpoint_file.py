"""The checkpoint beside a PC2: from it a stopped bake goes on, bit-equal to one that never stopped.

Layout: a magic line, one line of JSON (frame, sample count, digest of the scene, length, the bake and its cloths), then the
solver's own bytes, which carry their own checksum. Of several cloths that are baked together the first one's file holds the
state of all, and the others' hold no bytes.
"""

from __future__ import annotations

import json
from typing import NamedTuple

from . import whole_file
from .refusal import Refusal

_MAGIC = b"BOUCLE CHECKPOINT 1\n"


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


def write(path: str, checkpoint: Checkpoint) -> None:
    """Replace the checkpoint file."""
    head = {
        "frame": checkpoint.frame,
        "samples": checkpoint.sample_count,
        "digest": checkpoint.digest,
        "length": len(checkpoint.state),
        "bake": checkpoint.bake,
        "cloths": checkpoint.cloths,
    }
    whole_file.replace(path, _MAGIC + json.dumps(head).encode() + b"\n" + checkpoint.state)


def read(path: str) -> Checkpoint | None:
    """The checkpoint; None if there is none.

    Raises:
        Refusal: The file is damaged.
    """
    try:
        with open(path, "rb") as file:
            magic = file.readline(len(_MAGIC))
            head_line = file.readline(1 << 20)
            state = file.read()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise Refusal(f'the checkpoint "{path}" cannot be read ({error.strerror})') from error
    try:
        if magic != _MAGIC:
            raise ValueError(magic)
        head = json.loads(head_line)
        if head["length"] != len(state):
            raise ValueError(head)
        numbers = int(head["frame"]), int(head["samples"])
        cloths = tuple(map(str, head["cloths"]))
        return Checkpoint(*numbers, str(head["digest"]), state, str(head["bake"]), cloths)
    except (ValueError, KeyError, TypeError, OverflowError, RecursionError) as error:
        raise Refusal(f'the checkpoint "{path}" is damaged: bake from the start') from error
