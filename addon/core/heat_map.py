"""Numbers as colours: the map, the range that it spans and the legend that says so.

The colours are those of viridis, which its authors (S. van der Walt, N. Smith, E. Firing) gave away under CC0: as bright
as the number is large, equal steps look equal, and every kind of eye can read it.
"""

from __future__ import annotations

import math
from array import array
from typing import NamedTuple

from . import points
from .points import Points

Color = tuple[float, float, float]

VIRIDIS: tuple[Color, ...] = (
    (0.267004, 0.004874, 0.329415), (0.282623, 0.140926, 0.457517), (0.253935, 0.265254, 0.529983),
    (0.206756, 0.371758, 0.553117), (0.163625, 0.471133, 0.558148), (0.127568, 0.566949, 0.550556),
    (0.134692, 0.658636, 0.517649), (0.266941, 0.748751, 0.440573), (0.477504, 0.821444, 0.318195),
    (0.741388, 0.873449, 0.149561), (0.993248, 0.906157, 0.143936),
)  # fmt: skip
"""At equal steps from the least number to the greatest; sRGB, as screens show it."""

_SHADES = 256
_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


class Tick(NamedTuple):
    """A number beside the legend's bar."""

    place: float
    """0 at its lower end, 1 at its upper."""
    text: str


def color(place: float) -> Color:
    """The colour at a place from 0 to 1 of the map, sRGB; outside, that of the nearer end."""
    along = min(max(place, 0.0), 1.0) * (len(VIRIDIS) - 1)
    first = min(int(along), len(VIRIDIS) - 2)
    part = along - first
    pairs = zip(VIRIDIS[first], VIRIDIS[first + 1], strict=True)
    red, green, blue = (one + part * (other - one) for one, other in pairs)
    return red, green, blue


def linear(shown: Color) -> Color:
    """A screen's sRGB as the linear light that viewports and renders compute with."""
    red, green, blue = (
        value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in shown
    )
    return red, green, blue


def colors(values: Points, low: float, high: float, alpha: float) -> Points:
    """A colour for each number: red, green, blue in sRGB and alpha, float32, flat. What is no number gets the lowest."""
    shades = _shades(alpha)
    scale = _SHADES / (high - low) if high > low else 0.0
    numpy = points.numpy_module()
    if numpy is None:
        out = array("f", bytes(16 * len(values)))
        for k, value in enumerate(values):
            place = (value - low) * scale
            shade = int(min(max(place, 0.0), _SHADES - 1)) if place == place else 0
            out[4 * k : 4 * k + 4] = array("f", shades[shade])
        return out
    places = (numpy.asarray(values, dtype=numpy.float32) - numpy.float32(low)) * numpy.float32(
        scale
    )
    # fmax and fmin take the other where one is no number.
    order = numpy.fmin(numpy.fmax(places, 0.0), _SHADES - 1).astype(numpy.uint8)
    return numpy.array(shades, dtype=numpy.float32).take(order, axis=0).reshape(-1)


def _shades(alpha: float) -> list[tuple[float, ...]]:
    return [(*color((k + 0.5) / _SHADES), alpha) for k in range(_SHADES)]


def span(values: Points) -> tuple[float, float]:
    """From 0 to a round number that none of the numbers exceeds."""
    numpy = points.numpy_module()
    if len(values) == 0:
        return 0.0, 1.0
    if numpy is not None:
        array_of = numpy.asarray(values)
        finite = array_of[numpy.isfinite(array_of)]
        most = float(finite.max()) if len(finite) else 0.0
    else:
        most = max((value for value in values if math.isfinite(value)), default=0.0)
    return 0.0, round_up(most)


def round_up(number: float) -> float:
    """The next of 1, 2, 2.5 and 5 times a power of ten; 1e-6 of less than that."""
    if not number > 1e-6:
        return 1e-6
    power = 10.0 ** math.floor(math.log10(number))
    return next(step * power for step in _STEPS if step * power >= number * (1.0 - 1e-6))


def ticks(low: float, high: float, factor: float = 1.0, count: int = 5) -> list[Tick]:
    """Numbers at equal steps of the range, each times a factor (100 for percent), with as many digits as they differ by."""
    parts = [k / (count - 1) for k in range(count)]
    numbers = [(low + part * (high - low)) * factor for part in parts]
    step = abs(numbers[1] - numbers[0])
    largest = max(abs(number) for number in numbers)
    if step > 0.0 and (largest >= 1e5 or largest < 1e-3):
        texts = [f"{number:.2e}" for number in numbers]
    else:
        digits = max(0, 2 - math.floor(math.log10(step))) if step > 0.0 else 3
        texts = [_plain(number, digits) for number in numbers]
    return [Tick(part, text) for part, text in zip(parts, texts, strict=True)]


def whole_ticks(low: float, high: float) -> list[Tick]:
    """Ticks of something that is counted: whole numbers at equal steps, where the range has such."""
    for steps in (4, 5, 3, 2, 1):
        if low.is_integer() and high > low and ((high - low) / steps).is_integer():
            return ticks(low, high, count=steps + 1)
    return ticks(low, high)


def _plain(number: float, digits: int) -> str:
    text = f"{number:.{digits}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text == "-0" else text
