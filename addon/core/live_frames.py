"""Which frame live mode simulates, shows or leaves alone, and the frames that it keeps in memory.

A cloth moves on only when the scene stands exactly one frame after the last simulated one: never backwards, never twice,
never over a gap. Everything else shows what is kept.
"""

from __future__ import annotations

from enum import Enum

from .points import Points


class Action(Enum):
    """What to do at a frame."""

    STEP = "simulate this frame"
    SHOW = "show a kept frame"
    WAIT = "frames were skipped: show the last kept frame"
    FULL = "the memory is full: show the last kept frame"
    IGNORE = "a sub-frame: leave everything as it is"


class LiveFrames:
    """Simulated frames from first on, without a gap, in object space (m), float32, flat."""

    def __init__(self, first: int, rest: Points, limit_bytes: int) -> None:
        """Begin with the rest pose at frame first; beyond limit_bytes no frame is added."""
        self.first = first
        self._frames: list[Points] = [rest]
        self._frame_bytes = memoryview(rest).nbytes
        self._limit_bytes = limit_bytes

    @property
    def last(self) -> int:
        """The last simulated frame."""
        return self.first + len(self._frames) - 1

    @property
    def size_bytes(self) -> int:
        """Memory that the frames take."""
        return self._frame_bytes * len(self._frames)

    def action(self, frame: int, subframe: float, end: int) -> Action:
        """What to do when the scene comes to a frame; end is the last frame to simulate."""
        if subframe != 0.0:
            return Action.IGNORE
        if frame <= self.last or frame > end:
            return Action.SHOW
        if self.size_bytes + self._frame_bytes > self._limit_bytes:
            return Action.FULL
        return Action.STEP if frame == self.last + 1 else Action.WAIT

    def add(self, positions: Points) -> None:
        """Keep the frame after the last."""
        self._frames.append(positions)

    def nearest(self, frame: int) -> Points:
        """The kept frame, or the first or last one beyond the ends."""
        return self._frames[min(max(frame, self.first), self.last) - self.first]

    def all(self) -> list[Points]:
        """Every kept frame, in order."""
        return self._frames
