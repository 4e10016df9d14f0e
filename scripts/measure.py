"""Measure a fabric as a lab does: `measure.py PRESET`, or `measure.py all` for one line of each.

Leaves the sheet, its pictures and its numbers in out/measure/PRESET. Run by the Python of .venv (`python3 scripts/dev.py build`
makes it). Exit codes: 0 done, 2 wrong use, 3 a specimen did not come to rest.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import boucle_core

from instruments import plots, sheet
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
SUMMARY = (
    "fabric",
    "Y warp N/m",
    "Y weft N/m",
    "Y bias N/m",
    "G N/m",
    "B warp µN·m",
    "B weft µN·m",
    "c warp cm",
    "c weft cm",
    "DC %",
    "nodes",
    "said",
    "",
)


def parser() -> argparse.ArgumentParser:
    """The command line of this script."""
    lines = argparse.ArgumentParser(prog="measure.py", description=__doc__, allow_abbrev=False)
    lines.add_argument("preset", metavar="PRESET", help="a fabric of the module, or all")
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
        "--specimens", type=int, metavar="N", help="discs to drape (3; of all fabrics 1)"
    )
    lines.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="another number, SI units"
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


def ordered(options: argparse.Namespace) -> sheet.Order:
    """What the command line asks for.

    Raises:
        ValueError: A count is out of range.
    """
    default = 1 if options.preset == ALL else 3
    specimens = default if options.specimens is None else options.specimens
    if options.cells is not None and not 8 <= options.cells <= 400:
        raise ValueError(f"--cells {options.cells}: accepted: 8 to 400")
    if not 1 <= specimens <= 20:
        raise ValueError(f"--specimens {specimens}: accepted: 1 to 20")
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
    for path in plots.save(read, folder):
        print(path)


def summarize(order: sheet.Order, own: dict[str, float], out: Path) -> bool:
    """Measure all fabrics, a line of the table for each; whether all came to rest."""
    results, rows = {}, []
    for preset in boucle_core.fabric_presets():
        started = time.monotonic()
        try:
            read = sheet.measure(Fabric(preset, own), order)
        except Restless as fault:
            print(f"{preset}: {fault}", file=sys.stderr)
            continue
        results[preset] = sheet.numbers(read)
        rows.append(summary(read))
        print(" ".join(rows[-1]), f"({time.monotonic() - started:.0f} s)", flush=True)
    print("\n" + sheet.table(SUMMARY, rows))
    out.mkdir(parents=True, exist_ok=True)
    keep(out / "all.json", results)
    return len(results) == len(boucle_core.fabric_presets())


def summary(read: sheet.Sheet) -> tuple[str, ...]:
    """The key numbers of a fabric; empty where nothing was measured."""

    def each(found: dict, ways: Sequence[str], number: str, scale: float = 1.0) -> list[str]:
        return [
            sheet.figure(scale * getattr(found[way], number), 3) if way in found else ""
            for way in ways
        ]

    drapes = ["", "", "", ""]
    if read.drapes:
        band = read.fabric.band
        said = "" if band is None else f"{band[0]:g} to {band[1]:g}"
        verdict = {True: "in", False: "OUT", None: ""}[read.is_in_band]
        nodes = sum(one.nodes for one in read.drapes) / len(read.drapes)
        drapes = [f"{read.coefficient:.1f}", f"{nodes:.0f}", said, verdict]
    return (
        read.fabric.preset,
        *each(read.tensile, sheet.DIRECTIONS, "stiffness"),
        *each(read.shear, ("warp",), "stiffness"),
        *each(read.cantilever, sheet.YARNS, "rigidity", 1e6),
        *each(read.cantilever, sheet.YARNS, "bending_length", 100.0),
        *drapes,
    )


def keep(path: Path, content: object) -> None:
    """Write numbers as strict JSON."""
    text = json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")
    print(path)


def main(words: Sequence[str] | None = None) -> int:
    """Measure what the command line asks for."""
    options = parser().parse_args(words)
    try:
        own, order = changes(options.set), ordered(options)
        if options.preset != ALL:
            report(Fabric(options.preset, own), order, options.out / options.preset)
        elif not summarize(order, own, options.out):
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
