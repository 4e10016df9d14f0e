"""What the runs of a sweep set: grids, and Latin hypercubes.

A Latin hypercube of n samples cuts every parameter's range into n strata of equal width (on a logarithmic scale, if it
has one) and puts exactly one sample into each: n runs see n values of every parameter. Source: McKay, Beckman & Conover
1979; the strata are shuffled by `scipy.stats.qmc`, the same way for the same seed.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol


class Parameter(Protocol):
    """The values that a sweep gives to a key."""

    def values(self) -> list[Any]:
        """Its values in a grid."""

    def at(self, place: float) -> Any:
        """Its value at a place from 0 to below 1."""


@dataclass(frozen=True)
class Choice:
    """Values one by one."""

    choices: Sequence[Any]

    def values(self) -> list[Any]:
        """All of them."""
        return list(self.choices)

    def at(self, place: float) -> Any:
        """The one whose part of 0 to 1 holds the place; all parts are as wide."""
        return self.choices[min(int(place * len(self.choices)), len(self.choices) - 1)]


@dataclass(frozen=True)
class Range:
    """Numbers between two ends."""

    first: float
    last: float
    count: int | None = None
    is_log: bool = False
    is_integer: bool = False

    def values(self) -> list[Any]:
        """`count` numbers, both ends included, evenly spaced on the scale."""
        if self.count == 1:
            return [self._rounded(self.first)]
        steps = self.count - 1
        inner = [self._rounded(self._between(step / steps)) for step in range(1, steps)]
        values = [self._rounded(self.first), *inner, self._rounded(self.last)]
        return list(dict.fromkeys(values))  # whole numbers may meet

    def at(self, place: float) -> Any:
        """The number at a place from 0 to below 1; whole numbers are all as likely on an even scale."""
        if self.is_integer and not self.is_log:
            return math.floor(self.first + place * (self.last - self.first + 1))
        return self._rounded(self._between(place))

    def _between(self, place: float) -> float:
        if self.is_log:
            value = self.first * (self.last / self.first) ** place
        else:
            value = self.first + place * (self.last - self.first)
        return min(max(value, self.first), self.last)

    def _rounded(self, value: float) -> float | int:
        return round(value) if self.is_integer else float(value)


def grid(parameters: Mapping[str, Parameter]) -> list[dict[str, Any]]:
    """Every combination; the last parameter changes fastest."""
    values = [parameter.values() for parameter in parameters.values()]
    return [dict(zip(parameters, row, strict=True)) for row in itertools.product(*values)]


def grid_size(parameters: Mapping[str, Parameter]) -> int:
    """How many combinations there are."""
    return math.prod(len(parameter.values()) for parameter in parameters.values())


def latin_hypercube(
    parameters: Mapping[str, Parameter], samples: int, seed: int
) -> list[dict[str, Any]]:
    """A Latin hypercube of `samples` rows, the same for the same seed."""
    from scipy.stats import qmc

    places = qmc.LatinHypercube(d=len(parameters), rng=seed).random(samples)
    return [
        {
            name: parameter.at(float(place))
            for (name, parameter), place in zip(parameters.items(), row, strict=True)
        }
        for row in places
    ]
