"""Bake the systems of the literature and render a picture of each, one panel a run: README's section "The literature".

Run by the Python of .venv (`python3 scripts/dev.py build` makes it). Exit codes: 0 done, 2 wrong use.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gallery import PC2_HEADER, ROOT, bake, faces_of, frame_of, picture, write_small
from gallery_scenes import Exhibit
from literature_scenes import SYSTEMS, System

README_PICTURES = ROOT / "scripts" / "pictures" / "literature"
PANEL = 280
"""Pixels, the width of a panel."""
TITLE = 13
"""Pixels, the height of a panel's title."""


def parser() -> argparse.ArgumentParser:
    """The command line of this script."""
    lines = argparse.ArgumentParser(prog="literature.py", description=__doc__, allow_abbrev=False)
    lines.add_argument("--out", metavar="DIR", type=Path, default=ROOT / "out" / "literature")
    names = [system.name for system in SYSTEMS]
    lines.add_argument("--only", metavar="SYSTEM", nargs="+", choices=names, default=names)
    lines.add_argument(
        "--readme", action="store_true", help="put the pictures into scripts/pictures/literature"
    )
    return lines


def elongation(positions: np.ndarray, rest: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Largest elongation (%) of the edges at each vertex."""
    a, b = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    now, then = (np.linalg.norm(x[a] - x[b], axis=1) for x in (positions, rest))
    strain = 100.0 * (now / then - 1.0)
    largest = np.zeros(len(rest))
    for ends in (a, b):
        np.maximum.at(largest, ends, strain)
    return largest


def held(cache: Path, rest: np.ndarray) -> list[int]:
    """Vertices that have not moved by the last frame of a cache."""
    samples = (cache.stat().st_size - PC2_HEADER) // (12 * len(rest))
    still = [(frame_of(cache, sample) == rest).all(axis=1) for sample in range(samples)]
    return np.flatnonzero(np.all(still, axis=0)).tolist()


def strained(
    studio: Any, exhibit: Exhibit, largest: float, folder: Path, width: int, path: Path
) -> None:
    """Render the one cloth of a baked scene in the colors of its elongation (%), the last of which is the largest."""
    from paper.view import Shot

    (mesh,) = folder.glob("*.obj")
    cache = mesh.with_suffix(".pc2")
    rest, faces = frame_of(cache, 0).astype(float), np.array(faces_of(mesh))
    positions = frame_of(cache, exhibit.frame - 1).astype(float)
    values = elongation(positions, rest, faces)
    shot = Shot(positions, faces, values, largest, held(cache, frame_of(cache, 0)))
    studio.render(shot, exhibit.view, width, path)


def told(system: System, row: dict[str, Any], first: dict[str, Any]) -> str:
    """What the title of a panel gives of its frame."""
    if system.tells == "strain":
        return f": {100.0 * row['max_strain']:.0f} %"
    if system.tells == "energy":
        now, then = (each["kinetic_energy"] + each["potential_energy"] for each in (row, first))
        won = round(now - then, 2)
        return f": {won:+.2f} J" if won else ": 0.00 J"
    return ""


def panel(studio: Any, system: System, exhibit: Exhibit, folder: Path) -> tuple[Any, str]:
    """The rendered panel of one run and its title."""
    from PIL import Image

    report = bake(exhibit, folder)
    row = report["frames"][exhibit.frame - 1]
    shot = folder / "shot.png"
    if system.largest is None:
        picture(studio, exhibit, folder, shot)
    else:
        strained(studio, exhibit, system.largest, folder, PANEL, shot)
    title = exhibit.words + told(system, row, report["frames"][0])
    print(f"{system.name}, frame {row['frame']}, {title}", flush=True)
    with Image.open(shot) as image:
        height = round(image.height * PANEL / image.width)
        return image.convert("RGBA").resize((PANEL, height), Image.Resampling.LANCZOS), title


def assemble(panels: Sequence[tuple[Any, str]], columns: int) -> Any:
    """Panels in rows, each beneath its title."""
    import matplotlib
    from PIL import Image, ImageDraw, ImageFont

    font = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
    letters = ImageFont.truetype(font, TITLE)
    columns = min(columns, len(panels))
    head = 2 * TITLE
    width, height = PANEL, head + panels[0][0].height
    sheet = Image.new("RGBA", (columns * width, -(-len(panels) // columns) * height), "white")
    pen = ImageDraw.Draw(sheet)
    for number, (image, title) in enumerate(panels):
        row, column = divmod(number, columns)
        place = column * width, row * height
        sheet.alpha_composite(image, (place[0], place[1] + head))
        middle = place[0] + width // 2, place[1] + head // 2
        pen.text(middle, title, fill="#222222", font=letters, anchor="mm")
    return sheet


def main(words: Sequence[str] | None = None) -> int:
    """Make the pictures that the command line asks for."""
    options = parser().parse_args(words)
    from paper.gallery_studio import GalleryStudio

    studio = GalleryStudio()
    place = README_PICTURES if options.readme else options.out
    place.mkdir(parents=True, exist_ok=True)
    for system in SYSTEMS:
        if system.name not in options.only:
            continue
        with tempfile.TemporaryDirectory() as work:
            panels = []
            for number, exhibit in enumerate(system.panels):
                folder = Path(work) / str(number)
                folder.mkdir()
                panels.append(panel(studio, system, exhibit, folder))
            whole = Path(work) / "whole.png"
            assemble(panels, system.columns).save(whole)
            write_small(whole, place / f"{system.name}.jpg")
    return 0


if __name__ == "__main__":
    sys.exit(main())
