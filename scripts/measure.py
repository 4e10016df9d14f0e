"""Measure a fabric as a lab does: `measure.py PRESET`; several, or `all`, give a table with a line of each.

Leaves the sheet, its pictures and its numbers in out/measure/PRESET; a table, and the numbers of each fabric as soon as it is
measured, in out/measure/table, from where `--resume` goes on. A fabric of a table takes 12 to 45 s, all of them about a
quarter of an hour. Run by the Python of .venv (`python3 scripts/dev.py build` makes it). Exit codes: 0 done, 2 wrong use,
3 a specimen did not come to rest.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import boucle_core

from instruments import lineup, plots, sheet
from instruments.fabric import Fabric
from instruments.resting import Restless

ROOT = Path(__file__).resolve().parent.parent
ALL = "all"
KEYS = (
    "density",
    *(f"{law}_{way}" for law in ("stretch", "compression", "bend") for way in sheet.YARNS),
    "shear",
    "yield_curvature",
    "hardening",
    "bend_hysteresis",
)
"""Numbers that --set changes."""


def parser() -> argparse.ArgumentParser:
    """The command line of this script."""
    lines = argparse.ArgumentParser(prog="measure.py", description=__doc__, allow_abbrev=False)
    lines.add_argument(
        "presets", metavar="PRESET", nargs="+", help="a fabric of the module, or several, or all"
    )
    lines.add_argument(
        "--instrument",
        action="append",
        choices=sheet.INSTRUMENTS,
        help="only this one; again: more",
    )
    lines.add_argument("--mesh", choices=("grid", "delaunay"), default="grid")
    lines.add_argument(
        "--cells", type=int, metavar="N", help="cells along the longest side of every specimen"
    )
    lines.add_argument(
        "--specimens", type=int, metavar="N", help="discs to drape (3; for a table 1)"
    )
    lines.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="another number, SI units"
    )
    lines.add_argument(
        "--resume", action="store_true", help="measure what a table that was stopped lacks"
    )
    lines.add_argument("--out", metavar="DIR", type=Path, default=ROOT / "out" / "measure")
    return lines


def changes(words: Sequence[str]) -> dict[str, float]:
    """The numbers of --set.

    Raises:
        ValueError: One is no KEY=VALUE with a known key and a number.
    """
    found = {}
    for word in words:
        key, _, value = word.partition("=")
        if key not in KEYS:
            raise ValueError(f"--set {word}: accepted keys: {', '.join(KEYS)}")
        try:
            found[key] = float(value)
        except ValueError:
            raise ValueError(f"--set {word}: accepted: {key}=NUMBER") from None
    return found


def is_table(presets: Sequence[str]) -> bool:
    """Whether a line of each is wanted, not a sheet."""
    return len(presets) > 1 or ALL in presets


def ordered(options: argparse.Namespace) -> sheet.Order:
    """What the command line asks for.

    Raises:
        ValueError: A count is out of range, or there is no table to resume.
    """
    default = 1 if is_table(options.presets) else 3
    specimens = default if options.specimens is None else options.specimens
    if options.cells is not None and not 8 <= options.cells <= 400:
        raise ValueError(f"--cells {options.cells}: accepted: 8 to 400")
    if not 1 <= specimens <= 20:
        raise ValueError(f"--specimens {specimens}: accepted: 1 to 20")
    if options.resume and not is_table(options.presets):
        raise ValueError(f"--resume of {options.presets[0]} alone; accepted: of all, or of several")
    instruments = options.instrument or sheet.INSTRUMENTS
    return sheet.Order(tuple(instruments), options.mesh, options.cells, specimens)


def report(fabric: Fabric, order: sheet.Order, folder: Path) -> None:
    """Measure one fabric: print its sheet, and leave it with pictures and numbers in a folder."""
    say = print if sys.stdout.isatty() else lambda _: None
    read = sheet.measure(fabric, order, say)
    text = sheet.table(sheet.HEADINGS, sheet.rows(read))
    title = boucle_core.fabric_presets()[fabric.preset]["title"]
    print(f"{title} ({fabric.preset}), {1000.0 * fabric.number('density'):g} g/m²\n\n{text}")
    if read.drapes and read.is_in_band is False:
        print(f"\nThe drape coefficient is outside of what is said: {fabric.band}.")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "sheet.txt").write_text(text + "\n", encoding="utf-8")
    keep(folder / "numbers.json", sheet.numbers(read))
    for path in (folder / "numbers.json", *plots.save(read, folder)):
        print(path)


def tabulate(fabrics: Sequence[Fabric], order: sheet.Order, folder: Path, resumes: bool) -> bool:
    """Measure fabrics, a line of the table for each, and keep all in a folder; whether all came to rest."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = []
    for fabric in fabrics:
        kept, started = folder / f"{fabric.preset}.json", time.monotonic()
        numbers = json.loads(kept.read_text("utf-8")) if resumes and kept.is_file() else {}
        if not lineup.is_of(numbers, order, fabric.changes):
            try:
                numbers = sheet.numbers(sheet.measure(fabric, order))
            except Restless as fault:
                print(f"measure.py: {fault}", file=sys.stderr)
                continue
            keep(kept, numbers)
        rows.append(lineup.row(numbers))
        print(
            f"{'  '.join(filter(None, rows[-1]))}  {time.monotonic() - started:.0f} s", flush=True
        )
    text = sheet.table(lineup.HEADINGS, rows)
    print(
        f"\n{text}\n\nIn brackets: the fabric's own numbers; of DC, between what it is said to lie."
    )
    (folder / "table.txt").write_text(text + "\n", encoding="utf-8")
    return len(rows) == len(fabrics)


def keep(path: Path, content: object) -> None:
    """Write numbers as strict JSON, whole or not at all."""
    text = json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False)
    part = path.with_suffix(".part")
    part.write_text(text + "\n", encoding="utf-8")
    part.replace(path)


def main(words: Sequence[str] | None = None) -> int:
    """Measure what the command line asks for."""
    options = parser().parse_args(words)
    presets = boucle_core.fabric_presets() if ALL in options.presets else options.presets
    try:
        own, order = changes(options.set), ordered(options)
        fabrics = [Fabric(preset, own) for preset in presets]
        if not is_table(options.presets):
            report(fabrics[0], order, options.out / fabrics[0].preset)
        elif not tabulate(fabrics, order, options.out / "table", options.resume):
            return 3
    except (ValueError, OSError) as fault:
        print(f"measure.py: {fault}", file=sys.stderr)
        return 2
    except Restless as fault:
        print(f"measure.py: {fault}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
