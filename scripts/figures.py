"""Redo the paper's figures 2 to 8 with this code, and add 9: pictures, captions and the numbers behind them.

Run by the Python of .venv (`python3 scripts/dev.py build` makes it). Exit codes: 0 done, 2 wrong use.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from paper import breakdown, deformations, elongation, energy, hanging, spring_diagram
from paper.looks import RESOLUTION, Plate, shrink
from paper.view import Pictures, Plotted, Rendered

ROOT = Path(__file__).resolve().parent.parent
README_PICTURES = ROOT / "scripts" / "pictures"
FOR_README = range(2, 10)
"""Figures that the README shows: all of them."""


def parser() -> argparse.ArgumentParser:
    """The command line of this script."""
    lines = argparse.ArgumentParser(prog="figures.py", description=__doc__, allow_abbrev=False)
    lines.add_argument("--out", metavar="DIR", type=Path, default=ROOT / "out" / "figures")
    lines.add_argument(
        "--quick", action="store_true", help="smaller sheets, plotted instead of rendered"
    )
    lines.add_argument(
        "--only",
        metavar="N",
        type=int,
        nargs="+",
        choices=range(2, 10),
        default=list(range(2, 10)),
        help="numbers of the figures to make, 2 to 9",
    )
    lines.add_argument(
        "--readme", action="store_true", help="also renew the small copies in scripts/pictures"
    )
    return lines


def makers(pictures: Pictures, quick: bool) -> dict[int, Callable[[], Plate]]:
    """What makes each figure, by number."""
    return {
        2: deformations.make,
        3: spring_diagram.make,
        4: lambda: hanging.with_and_without(pictures, quick),
        5: lambda: hanging.stretch_stiffness(pictures, quick),
        6: lambda: hanging.shear_stiffness(pictures, quick),
        7: lambda: breakdown.make(pictures),
        8: elongation.make,
        9: lambda: energy.make(quick),
    }


def choose_pictures(quick: bool, folder: Path) -> Pictures:
    """Rendered pictures where Blender's package is installed, plotted ones otherwise."""
    if quick:
        return Plotted()
    try:
        return Rendered(folder, RESOLUTION)
    except ModuleNotFoundError as missing:
        if missing.name != "bpy":
            raise
        print("figures.py: no bpy package here, so cloth is plotted, not rendered", file=sys.stderr)
        return Plotted()


def write_index(folder: Path, plates: Sequence[Plate]) -> None:
    """Write index.md, which shows every figure with its caption, and numbers.json."""
    parts = ["# The paper's figures, redone with Boucle", ""]
    for plate in plates:
        parts += [f"## Figure {plate.number}: {plate.title}", ""]
        parts += [f"![Figure {plate.number}]({plate.file_name})", "", plate.caption, ""]
    parts += ["The numbers behind the figures are in `numbers.json`."]
    (folder / "index.md").write_text("\n".join(parts) + "\n", encoding="utf-8")
    numbers = {f"figure{plate.number}": plate.numbers for plate in plates}
    text = json.dumps(numbers, indent=2, ensure_ascii=False, allow_nan=False)
    (folder / "numbers.json").write_text(text + "\n", encoding="utf-8")


def main(words: Sequence[str] | None = None) -> int:
    """Make the figures that the command line asks for."""
    options = parser().parse_args(words)
    try:
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        print(f"figures.py: --out {options.out}: {fault.strerror}", file=sys.stderr)
        return 2
    plates = []
    with tempfile.TemporaryDirectory() as shots:
        make = makers(choose_pictures(options.quick, Path(shots)), options.quick)
        for number in sorted(set(options.only)):
            started = time.monotonic()
            plate = make[number]()
            path = plate.save(options.out)
            plates.append(plate)
            if options.readme and number in FOR_README:
                shrink(path, README_PICTURES / plate.file_name)
            print(f"{path}  {time.monotonic() - started:.1f} s", flush=True)
    write_index(options.out, plates)
    print(options.out / "index.md")
    return 0


if __name__ == "__main__":
    sys.exit(main())
