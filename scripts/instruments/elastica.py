"""The heavy elastica: what an inextensible strip does that is clamped level at one end and bends under its own weight.

With the length s = 0 at the clamp and 1 at the tip, and the angle t below the level,

    t'' = -Gamma (1 - s) cos t        t(0) = 0        t'(1) = 0        Gamma = weight L³/B

for a weight (N/m²), a length L (m) and a bending stiffness B (N·m). Seen from the tip it is an initial value problem with
one unknown, the angle there. It is solved here by itself, so that what the solver does is held against something else.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

FLAT_TIP = 41.5
"""The angle (degrees) of the line from the edge to the tip at which ASTM D1388 reads the overhang."""
MOST = 140.0
"""The largest `gamma` that is solved."""


class Hanging:
    """The middle line of a strip that is clamped at one end."""

    out: np.ndarray
    """How far from the clamp."""
    down: np.ndarray
    """How far below it."""

    @property
    def droop(self) -> float:
        """H/W: how far the tip is below the clamp over how far out."""
        return float(self.down[-1] / self.out[-1])

    @property
    def chord(self) -> float:
        """The angle (degrees) below the level of the line from the clamp to the tip."""
        return float(np.degrees(np.arctan2(self.down[-1], self.out[-1])))


@dataclass(frozen=True)
class Profile(Hanging):
    """The shape of a strip, by length from the clamp."""

    along: np.ndarray
    """(n,), 0 to 1."""
    out: np.ndarray
    """How far from the clamp, as a part of the length."""
    down: np.ndarray
    """How far below it, as a part of the length."""


def profile(gamma: float, count: int = 101) -> Profile:
    """The shape at a weight over stiffness `gamma`, above 0 and up to MOST.

    Raises:
        ValueError: It is beyond MOST, where a tip angle says too little of the shape.
    """
    if not 0.0 < gamma <= MOST:
        raise ValueError(f"gamma = {gamma:g}; accepted: above 0, up to {MOST:g}")

    def rates(u: float, state: np.ndarray) -> list[float]:
        angle, turn = state[0], state[1]
        return [turn, -gamma * u * np.cos(angle), np.cos(angle), np.sin(angle)]

    def from_tip(tip: float, places: np.ndarray | None = None) -> np.ndarray:
        start = [tip, 0.0, 0.0, 0.0]
        done = solve_ivp(rates, (0.0, 1.0), start, "DOP853", places, rtol=1e-10, atol=1e-12)
        return done.y

    tip = brentq(lambda angle: from_tip(angle)[0, -1], 0.0, 0.5 * np.pi, xtol=1e-14)
    along = np.linspace(0.0, 1.0, count)
    _, _, out, down = from_tip(tip, along)
    return Profile(along, (out[-1] - out)[::-1], (down[-1] - down)[::-1])


def gamma_of_chord(degrees: float) -> float:
    """At which `gamma` the line from the clamp to the tip is so far below the level."""
    return float(brentq(lambda gamma: profile(gamma).chord - degrees, 1e-6, MOST, rtol=1e-8))
