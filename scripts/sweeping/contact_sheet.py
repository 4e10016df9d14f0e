"""The contact sheet of a sweep: every run's last frame with its parameters and largest strain beneath, on one scale."""

from __future__ import annotations

import os
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .description import Sweep
from .folder import Folder

if TYPE_CHECKING:
    from PIL import Image

COLUMNS, MOST_ROWS = 8, 8
SIDE, GAP = 200, 12
"""Pixels."""
LINE, FONT_SIZE = 15, 11
MOST_NAMED = 5
"""Parameters that are written beneath a picture; the table has all."""
INK, FAINT, RED = (30, 30, 30), (110, 110, 110), (170, 30, 20)


def write(folder: Folder, sweep: Sweep) -> list[Path]:
    """Draw the runs that have ended, up to 64 a sheet, and return where the sheets are.

    Raises:
        OSError: A sheet cannot be written.
    """
    ended = [run.name for run in sweep.runs if folder.outcome(run.name)]
    outcomes = {name: folder.outcome(name) for name in ended}
    pictures = _pictures(folder, outcomes)
    names = short_names(sweep.parameters)
    size = COLUMNS * MOST_ROWS
    pages = [ended[first : first + size] for first in range(0, len(ended), size)]
    for old in folder.path.glob("contact_sheet*.png"):
        old.unlink()
    paths = []
    for number, page in enumerate(pages, start=1):
        sheet = _sheet([(pictures[name], captions(outcomes[name], names)) for name in page])
        stem = "contact_sheet" if len(pages) == 1 else f"contact_sheet_{number}"
        path = folder.path / f"{stem}.png"
        part = path.with_suffix(".png.part")
        sheet.save(part, format="PNG", optimize=True)
        os.replace(part, path)
        paths.append(path)
    return paths


def _pictures(
    folder: Folder, outcomes: Mapping[str, Mapping[str, Any]]
) -> dict[str, Image.Image | str]:
    """A picture of each run that is whole, or the sentence that tells why there is none."""
    from . import thumbnail

    shapes: dict[str, list[thumbnail.Shape]] = {}
    found: dict[str, Image.Image | str] = {}
    for name, outcome in outcomes.items():
        if outcome["status"] != "done":
            found[name] = f"failed: {outcome['error']}"
            continue
        try:
            shapes[name] = thumbnail.last_frame(folder.runs / name)
        except thumbnail.Torn as torn:
            found[name] = str(torn)
    frame = thumbnail.frame_around(list(shapes.values()))
    return found | {name: thumbnail.draw(shape, frame, SIDE) for name, shape in shapes.items()}


def short_names(keys: Sequence[str]) -> dict[str, str]:
    """The last words of each parameter's path, as many as tell it from the others."""
    words = {key: key.replace("][", "].[").split(".") for key in keys}
    short = {}
    for key, own in words.items():
        for count in range(1, len(own) + 1):
            tail = own[-count:]
            if sum(other[-count:] == tail for other in words.values()) == 1:
                break
        short[key] = ".".join(tail)
    return short


def captions(outcome: Mapping[str, Any], names: Mapping[str, str]) -> list[str]:
    """What stands beneath a picture: the run, its first parameters, its largest strain and intersections."""
    parameters = list(outcome["parameters"].items())
    lines = [f"{names[key]} {_short(value)}" for key, value in parameters[:MOST_NAMED]]
    if len(parameters) > MOST_NAMED:
        lines.append(f"and {len(parameters) - MOST_NAMED} more")
    certificate = outcome.get("certificate") or {}
    strain, crossings = certificate.get("max_strain"), certificate.get("intersections")
    worth = [f"strain {strain:.2%}"] if strain is not None else []
    worth += [f"{crossings} intersections"] if crossings else []
    return [f"run {outcome['run']}", *lines, *([", ".join(worth)] if worth else [])]


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, list):
        return "(" + ", ".join(map(_short, value)) + ")"
    return str(value).lower() if isinstance(value, bool) else str(value)


def _sheet(cells: Sequence[tuple[Image.Image | str, list[str]]]) -> Image.Image:
    from matplotlib import get_data_path
    from PIL import Image, ImageDraw, ImageFont

    # Pillow's own font lacks the signs of units; matplotlib brings one that has them.
    font = ImageFont.truetype(Path(get_data_path(), "fonts", "ttf", "DejaVuSans.ttf"), FONT_SIZE)
    text_lines = max(len(lines) for _, lines in cells)
    height = SIDE + LINE * text_lines + GAP
    columns = min(COLUMNS, len(cells))
    rows = -(-len(cells) // columns)
    size = (columns * (SIDE + GAP) + GAP, rows * height + GAP)
    sheet = Image.new("RGB", size, (255, 255, 255))
    canvas = ImageDraw.Draw(sheet)
    for number, (picture, lines) in enumerate(cells):
        left, top = GAP + number % columns * (SIDE + GAP), GAP + number // columns * height
        if isinstance(picture, str):
            canvas.rectangle((left, top, left + SIDE, top + SIDE), outline=RED)
            wrapped = textwrap.wrap(picture, 30)[: SIDE // LINE - 1]
            canvas.multiline_text((left + 6, top + 6), "\n".join(wrapped), fill=RED, font=font)
        else:
            sheet.paste(picture, (left, top))
        for row, line in enumerate(lines):
            ink = INK if row > 0 else FAINT
            while canvas.textlength(line, font=font) > SIDE and len(line) > 1:
                line = line[:-2] + "…"
            canvas.text((left, top + SIDE + 2 + row * LINE), line, fill=ink, font=font)
    return sheet
