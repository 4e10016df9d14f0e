"""Live settling: at once as long as a window can wait for it, then in slices of time between which the window lives.

Without a window it is done at once. What comes of it is the same.
"""

from __future__ import annotations

import math
import time
from typing import Any

import bpy

from ..core.points import Affine
from ..core.settle import Settle, Settling
from . import runtime

PATIENCE = 0.5
"""Seconds for which a window waits."""
SLICE = 0.05
"""Seconds that one slice takes, or one frame of the cloth if that is longer."""


def patience() -> float:
    """Seconds for which settling may go on at once: a render waits until it is done."""
    return math.inf if bpy.app.background or runtime.rendering else PATIENCE


class LiveSettle:
    """The settling of one cloth."""

    def __init__(
        self, solver: Any, settling: Settling, vertex_count: int, to_object: Affine
    ) -> None:
        """Nothing moves before `go_on`. Where the object stands at the start frame is kept: the scene may go on meanwhile."""
        self.to_object = to_object
        self._settle = Settle(solver, settling, [vertex_count])
        self._total = settling.frames

    @property
    def is_done(self) -> bool:
        """Whether the start frame is reached."""
        return self._settle.is_done

    @property
    def words(self) -> str:
        """How far it is."""
        done = self._total - self._settle.left
        return f"settling ({done} of {self._total} frames; Reset stops it)"

    def go_on(self, seconds: float) -> None:
        """Simulate frames for about so long; at least one, if it is any time.

        Raises:
            native.BoucleError: What the solver said.
        """
        until = time.monotonic() + seconds
        while not self.is_done and seconds > 0.0:
            self._settle.advance()
            if time.monotonic() >= until:
                return
