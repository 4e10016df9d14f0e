"""Settling: frames before the first, in which the cloth comes to rest while pins and colliders stand as at the start.

Damped, it loses its velocity whenever its kinetic energy has passed a peak: there most of the potential energy of a swing has
become motion, so that few swings are needed (kinetic damping, after Cundall 1976 and Barnes 1999). At the end it is at rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from . import points


class Settling(NamedTuple):
    """How long and in which way."""

    frames: int = 0
    damped: bool = True


class Settle:
    """A simulation that begins so many frames before the start frame, on its way there."""

    def __init__(self, simulation: Any, settling: Settling, vertex_counts: Sequence[int]) -> None:
        """Nothing moves before `advance`; the counts are those of the cloths."""
        self._simulation = simulation
        self.left = settling.frames
        """Frames that are still to be simulated."""
        self._energy = 0.0
        self._damped = settling.damped
        self._positions = [points.empty("d", 3 * count) for count in vertex_counts]

    @property
    def is_done(self) -> bool:
        """Whether the start frame is reached."""
        return self.left == 0

    def advance(self) -> None:
        """Simulate one frame; pins and colliders stay where they are."""
        energy = self._simulation.advance()["kinetic_energy"]
        self.left -= 1
        if not self._damped:
            return
        if energy < self._energy or self.is_done:
            for cloth, positions in enumerate(self._positions):
                self._simulation.read_positions(cloth, positions)
                self._simulation.set_positions(cloth, positions)
            energy = 0.0
        self._energy = energy
