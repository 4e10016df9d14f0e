"""One row of the report: what is claimed, what came out, and whether that is near enough."""

from __future__ import annotations

import math
import time
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

Plot = Callable[[Any], None]
"""Draws into matplotlib axes."""


@dataclass(frozen=True)
class Tolerance:
    """How far a result may be from its reference, in the reference's unit or as a part of it."""

    amount: float
    is_relative: bool = True

    def error(self, result: float, reference: float) -> float:
        """How far the result is off."""
        off = abs(result - reference)
        return off / abs(reference) if self.is_relative else off

    def allows(self, error: float) -> bool:
        """Whether it is near enough; what is not a number never is."""
        return error <= self.amount

    def words(self, amount: float) -> str:
        """An error or the tolerance itself, as it is printed."""
        if not self.is_relative:
            return number(amount)
        return f"{100.0 * amount:.2g} %" if amount >= 1e-4 else f"{amount:.0e}"


EXACTLY = Tolerance(0.0, is_relative=False)


@dataclass(frozen=True)
class Range:
    """Where a result must lie; an error is how far it is outside."""

    low: float = -math.inf
    high: float = math.inf

    def error(self, result: float) -> float:
        """How far the result is outside; not a number if it is none."""
        if math.isnan(result):
            return result
        return max(self.low - result, result - self.high, 0.0)

    def words(self) -> str:
        """As it is printed."""
        if self.low == -math.inf:
            return f"≤ {number(self.high)}"
        if self.high == math.inf:
            return f"≥ {number(self.low)}"
        return f"{number(self.low)} to {number(self.high)}"


@dataclass(frozen=True)
class Finding:
    """What came out, and beside what it stands."""

    result: float
    reference: float | Range
    plot: Plot | None = None
    note: str = ""
    """What else the reader should know of this run."""


@dataclass(frozen=True)
class Row:
    """A claim that can be measured."""

    chapter: str
    name: str
    quantity: str
    unit: str
    """Of result and reference; empty for a plain number."""
    source: str
    """Where the reference comes from."""
    test: str
    """The test of the test suite that holds the same; several with commas between."""
    measure: Callable[[], Finding]
    tolerance: Tolerance | None = None
    """None where the reference is a range."""

    def run(self) -> Result:
        """Measure it. An exception is a failed row."""
        started = time.monotonic()
        finding, message = None, ""
        try:
            finding = self.measure()
        except Exception as fault:  # noqa: BLE001 - whatever goes wrong in a row, the others still run
            place = traceback.extract_tb(fault.__traceback__)[-1]
            where = f"{place.filename.rpartition('/')[2]}:{place.lineno}"
            message = f"{type(fault).__name__}: {fault} ({where})"
        return Result(self, finding, message, time.monotonic() - started)


@dataclass(frozen=True)
class Result:
    """A row that was run."""

    row: Row
    finding: Finding | None
    """None if it broke down."""
    message: str
    """Why it broke down."""
    seconds: float

    @property
    def error(self) -> float:
        """How far the result is off; not a number if there is none."""
        if self.finding is None:
            return math.nan
        reference = self.finding.reference
        if isinstance(reference, Range):
            return reference.error(self.finding.result)
        if self.row.tolerance is None:
            raise TypeError(f"row {self.row.name!r} has neither a tolerance nor a range")
        return self.row.tolerance.error(self.finding.result, reference)

    @property
    def has_passed(self) -> bool:
        """Whether the row holds."""
        if self.finding is None:
            return False
        if isinstance(self.finding.reference, Range):
            return self.error == 0.0
        return self.row.tolerance.allows(self.error)

    def cells(self) -> list[str]:
        """Result, reference, error and tolerance, as they are printed."""
        if self.finding is None:
            return ["-", "-", "-", "-"]
        reference = self.finding.reference
        result = number(self.finding.result)
        if isinstance(reference, Range):
            return [result, reference.words(), number(self.error), "in range"]
        words = self.row.tolerance.words
        return [result, number(reference), words(self.error), words(self.row.tolerance.amount)]


def number(value: float) -> str:
    """A number with as many digits as it is worth reading."""
    if value == int(value) if math.isfinite(value) else False:
        return f"{int(value)}" if abs(value) < 1e7 else f"{value:.3g}"
    return f"{value:.6g}" if 1e-3 <= abs(value) < 1e6 else f"{value:.3g}"


@dataclass(frozen=True)
class Curve:
    """Results at several places beside their references; a plot of both."""

    x: Sequence[float]
    results: Sequence[float]
    references: Sequence[float]
    x_label: str
    y_label: str
    line: tuple[Sequence[float], Sequence[float]] | None = None
    """The reference between those places, if it is known there."""
    logarithmic: str = ""
    """The axes that are: "x", "y" or both."""

    def worst(self, tolerance: Tolerance) -> Finding:
        """The place whose error is largest, with the plot of all; one that is not a number is the worst of all."""
        errors = [
            tolerance.error(result, reference)
            for result, reference in zip(self.results, self.references, strict=True)
        ]
        at = int(np.argmax(np.nan_to_num(errors, nan=math.inf)))
        note = f"worst at {self.x_label} = {number(float(self.x[at]))}, of {len(self.x)} places"
        return Finding(float(self.results[at]), float(self.references[at]), self, note)

    def __call__(self, axes: Any) -> None:
        """Draw the reference as a line, the results as rings."""
        x, y = self.line or (self.x, self.references)
        axes.plot(x, y, color="C0", lw=2.2, label="reference")
        axes.plot(self.x, self.results, "o", color="C1", mfc="none", mew=1.6, ms=6, label="result")
        for name, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
            if name in self.logarithmic:
                axes.set(**{f"{name}scale": "log"})
                axis.set_minor_formatter(lambda _value, _place: "")
        axes.set_xlabel(self.x_label)
        axes.set_ylabel(self.y_label)
