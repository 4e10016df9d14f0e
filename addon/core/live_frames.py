"""Which frame live mode simulates, shows or leaves alone, and the frames that it keeps in memory.

A cloth moves on only when the scene stands exactly one frame after the last simulated one: never backwards, never twice,
never over a gap. Everything else shows what is kept.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from types import MappingProxyType
from typing import Any, NamedTuple

from .points import Points
from .quantity import Numbers


class Action(Enum):
    """What to do at a frame."""

    STEP = "simulate this frame"
    SHOW = "show a kept frame"
    WAIT = "frames were skipped: show the last kept frame"
    FULL = "the memory is full: show the last kept frame"
    IGNORE = "a sub-frame: leave everything as it is"


class Frame(NamedTuple):
    """What is kept of a frame."""

    positions: Points
    """(m), object space, float32, flat."""
    certificate: Mapping[str, Any]
    numbers: Numbers = MappingProxyType({})
    """Quantities at the vertices, as far as they were asked for."""

    @property
    def size_bytes(self) -> int:
        """Memory of its arrays."""
        return sum(memoryview(part).nbytes for part in (self.positions, *self.numbers.values()))


class LiveFrames:
    """Simulated frames from first on, without a gap."""

    def __init__(self, first: int, rest: Frame, limit_bytes: int) -> None:
        """Begin with the rest pose at frame first; beyond limit_bytes no frame is added."""
        self.first = first
        self._frames: list[Frame] = [rest]
        self._limit_bytes = limit_bytes
        self.size_bytes = rest.size_bytes
        """Memory that the frames take."""

    @property
    def last(self) -> int:
        """The last simulated frame."""
        return self.first + len(self._frames) - 1

    def action(self, frame: int, subframe: float, end: int) -> Action:
        """What to do when the scene comes to a frame; end is the last frame to simulate."""
        if subframe != 0.0:
            return Action.IGNORE
        if frame <= self.last or frame > end:
            return Action.SHOW
        if self.size_bytes + self._frames[-1].size_bytes > self._limit_bytes:
            return Action.FULL
        return Action.STEP if frame == self.last + 1 else Action.WAIT

    def add(self, frame: Frame) -> None:
        """Keep the frame after the last."""
        self._frames.append(frame)
        self.size_bytes += frame.size_bytes

    def tell(self, numbers: Numbers) -> None:
        """Add what is known now of the last simulated frame."""
        last = self._frames[-1]
        more = last._replace(numbers={**last.numbers, **numbers})
        self._frames[-1] = more
        self.size_bytes += more.size_bytes - last.size_bytes

    def nearest(self, frame: int) -> Frame:
        """The kept frame, or the first or last one beyond the ends."""
        return self._frames[min(max(frame, self.first), self.last) - self.first]

    def certificate(self, frame: int) -> Mapping[str, Any]:
        """The certificate of a kept frame; empty beyond the ends."""
        return self.nearest(frame).certificate if self.first <= frame <= self.last else {}

    def positions_from(self, index: int) -> list[Points]:
        """Positions of the kept frames from a number on, in order; the first frame is number 0."""
        return [frame.positions for frame in self._frames[index:]]
