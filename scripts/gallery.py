"""Bake the scenes of contact at a moderate size and render one frame of each: the pictures of README's gallery.

Run by the Python of .venv (`python3 scripts/dev.py build` makes it). Exit codes: 0 done, 2 wrong use.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import boucle_core
import numpy as np

from gallery_scenes import EXHIBITS, Exhibit

ROOT = Path(__file__).resolve().parent.parent
SCENES = ROOT / "tests" / "scenes"
README_PICTURES = ROOT / "scripts" / "pictures" / "gallery"
WIDTH = 480
"""Pixels; heights follow from the views, 3 to 4."""
QUALITY = 84
"""Of the JPEG files: keeps each below 60 kB."""
PC2_HEADER = 32
"""Bytes before the samples."""


def parser() -> argparse.ArgumentParser:
    """The command line of this script."""
    lines = argparse.ArgumentParser(prog="gallery.py", description=__doc__, allow_abbrev=False)
    lines.add_argument("--out", metavar="DIR", type=Path, default=ROOT / "out" / "gallery")
    names = [exhibit.scene for exhibit in EXHIBITS]
    lines.add_argument("--only", metavar="SCENE", nargs="+", choices=names, default=names)
    lines.add_argument(
        "--again", action="store_true", help="render what --out holds from before, without baking"
    )
    lines.add_argument(
        "--readme", action="store_true", help="put the pictures into scripts/pictures/gallery"
    )
    return lines


def bake(exhibit: Exhibit, folder: Path) -> dict[str, Any]:
    """Bake a scene as far as its picture needs, and return its report."""
    scene = SCENES / f"{exhibit.scene}.toml"
    overrides = list(exhibit.overrides)
    return boucle_core.bake(str(scene), str(folder), threads=0, overrides=overrides, resume=False)


def told(exhibit: Exhibit, report: dict[str, Any], seconds: float) -> str:
    """What a bake was like, in one line."""
    rows = report["frames"]
    crossings = [row["intersections"] or 0 for row in rows]
    worst = max(row["max_strain"] for row in rows)
    return (
        f"{exhibit.scene}: {len(rows)} frames, {seconds:.0f} s, {sum(crossings)} intersections "
        f"in {sum(map(bool, crossings))} frames, strain {100.0 * worst:.2f} %"
    )


def frame_of(cache: Path, number: int) -> np.ndarray:
    """Positions (m) in a PC2 file at a sample."""
    with cache.open("rb") as file:
        header = file.read(PC2_HEADER)
        points, samples = (int.from_bytes(header[at : at + 4], "little") for at in (16, 28))
        file.seek(PC2_HEADER + 12 * points * min(number, samples - 1))
        return np.frombuffer(file.read(12 * points), np.float32).reshape(-1, 3)


def faces_of(mesh: Path) -> list[list[int]]:
    """The faces of an OBJ file."""
    lines = mesh.read_text(encoding="utf-8").splitlines()
    corners = [line.split()[1:] for line in lines if line.startswith("f ")]
    return [[int(corner.partition("/")[0]) - 1 for corner in face] for face in corners]


def picture(studio: Any, exhibit: Exhibit, folder: Path, path: Path) -> None:
    """Render a baked scene at the exhibit's frame."""
    first = 1
    cloths = [
        (frame_of(mesh.with_suffix(".pc2"), exhibit.frame - first), faces_of(mesh))
        for mesh in sorted(folder.glob("*.obj"))
    ]
    studio.show(exhibit, SCENES / f"{exhibit.scene}.toml", cloths, WIDTH, path)


def main(words: Sequence[str] | None = None) -> int:
    """Make the pictures that the command line asks for."""
    options = parser().parse_args(words)
    from paper.gallery_studio import GalleryStudio

    studio = GalleryStudio()
    for exhibit in EXHIBITS:
        if exhibit.scene not in options.only:
            continue
        folder = options.out / exhibit.scene
        folder.mkdir(parents=True, exist_ok=True)
        if not (options.again and list(folder.glob("*.pc2"))):
            started = time.monotonic()
            report = bake(exhibit, folder)
            print(told(exhibit, report, time.monotonic() - started), flush=True)
        with tempfile.TemporaryDirectory() as shots:
            shot = Path(shots) / "shot.png"
            picture(studio, exhibit, folder, shot)
            place = README_PICTURES if options.readme else options.out
            place.mkdir(parents=True, exist_ok=True)
            write_small(shot, place / f"{exhibit.scene}.jpg")
    return 0


def write_small(shot: Path, target: Path) -> None:
    """Write a picture as JPEG, on white."""
    from PIL import Image

    with Image.open(shot) as image:
        white = Image.new("RGBA", image.size, "white")
        white.alpha_composite(image.convert("RGBA"))
        white.convert("RGB").save(target, quality=QUALITY, optimize=True)


if __name__ == "__main__":
    sys.exit(main())
