"""The legend of a heat map: a bar of its colours with numbers and unit, and the object's name."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy

from ..core import heat_map
from ..core.heat_map import Tick
from ..core.quantity import Quantity

_WIDTH, _HEIGHT = 180.0, 12.0
"""Of the bar; lengths here are pixels at a resolution scale of 1."""
_MARGIN = 24.0
_TEXT = 11.0
_LINE = 58.0
"""From one legend to the next."""
_STRIPS = 32


class Legend(NamedTuple):
    """What one says."""

    title: str
    ticks: tuple[Tick, ...]
    """Empty where nothing is known."""


def of(name: str, one: Quantity, low: float, high: float) -> Legend:
    """The legend of an object whose colours span a range."""
    if not one.unit:
        return Legend(f"{name}: {one.label}", tuple(heat_map.whole_ticks(low, high)))
    ticks = heat_map.ticks(low, high, one.factor)
    return Legend(f"{name}: {one.label} ({one.unit})", tuple(ticks))


def unknown(name: str, one: Quantity) -> Legend:
    """What stands in its place where nothing is known of the frame."""
    return Legend(
        f"{name}: {one.label} of this frame is not known: play from the start or bake", ()
    )


def draw(legends: list[Legend], context: bpy.types.Context) -> None:
    """Draw the legends in the lower left corner of the view, one above the other."""
    if not legends or context.region is None:
        return
    scale = context.preferences.system.ui_scale or 1.0
    left = _MARGIN * scale + _toolbar_width(context)
    for number, one in enumerate(legends):
        _draw_one(one, left, (_MARGIN + number * _LINE) * scale, scale)


def _toolbar_width(context: bpy.types.Context) -> float:
    """Pixels that the toolbar covers of the view."""
    regions = context.area.regions if context.area else ()
    return float(max((r.width for r in regions if r.type == "TOOLS" and r.width > 1), default=0))


def strip(left: float, bottom: float, scale: float) -> tuple[list[Any], list[Any]]:
    """Corners and colours of the bar, from its lower to its upper end as a strip of triangles."""
    corners, colors = [], []
    for k in range(_STRIPS + 1):
        part = k / _STRIPS
        x = left + part * _WIDTH * scale
        for y in (bottom, bottom + _HEIGHT * scale):
            corners.append((x, y, 0.0))
            colors.append((*heat_map.color(part), 1.0))
    return corners, colors


def _draw_one(one: Legend, left: float, bottom: float, scale: float) -> None:
    import gpu

    if one.ticks:
        corners, colors = strip(left, bottom + 14.0 * scale, scale)
        shader = gpu.shader.from_builtin("SMOOTH_COLOR")
        buffer = gpu.types.GPUVertBuf(shader.format_calc(), len(corners))
        buffer.attr_fill("pos", corners)
        buffer.attr_fill("color", colors)
        gpu.types.GPUBatch(type="TRI_STRIP", buf=buffer).draw(shader)
    _write(one.title, left, bottom + 31.0 * scale, scale, 0.0)
    for tick in one.ticks:
        _write(tick.text, left + tick.place * _WIDTH * scale, bottom, scale, 0.5)


def _write(text: str, x: float, y: float, scale: float, middle: float) -> None:
    """A text with its left end, or its middle, at a place."""
    import blf

    blf.size(0, _TEXT * scale)
    blf.color(0, 1.0, 1.0, 1.0, 1.0)
    blf.enable(0, blf.SHADOW)
    blf.shadow(0, 3, 0.0, 0.0, 0.0, 0.9)
    width = blf.dimensions(0, text)[0] if middle else 0.0
    blf.position(0, x - middle * width, y, 0.0)
    blf.draw(0, text)
    blf.disable(0, blf.SHADOW)
