"""Hold the compiled module against closed forms and numbers that it did not make; write a report.

Run by the Python of .venv (`python3 scripts/dev.py build` makes it). Prints a table and writes report.html and overview.png.
Exit codes: 0 every row holds, 1 some do not, 2 wrong use.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from validation import reference
from validation.chapters import CHAPTERS, not_measured, rows_of
from validation.row import Result, Row

ROOT = Path(__file__).resolve().parent.parent
README_PICTURE = ROOT / "scripts" / "pictures" / "validation.png"
HEADINGS = ("row", "quantity", "result", "reference", "error", "tolerance", "")


def parser() -> argparse.ArgumentParser:
    """The command line of this script."""
    lines = argparse.ArgumentParser(prog="validate.py", description=__doc__, allow_abbrev=False)
    lines.add_argument("--out", metavar="DIR", type=Path, default=ROOT / "out" / "validation")
    lines.add_argument(
        "--only", metavar="CHAPTER", nargs="+", choices=CHAPTERS, default=list(CHAPTERS),
        help=f"chapters to run, of {', '.join(CHAPTERS)}",
    )  # fmt: skip
    lines.add_argument(
        "--tables", metavar="DIR", type=Path, default=reference.TABLES,
        help="where the reference tables are read",
    )  # fmt: skip
    lines.add_argument(
        "--readme", action="store_true", help="also renew the small copy of the overview in scripts/pictures"
    )  # fmt: skip
    return lines


def run(rows: Sequence[Row]) -> list[Result]:
    """Measure rows one after the other, and tell each as soon as it is there."""
    results = []
    for number, row in enumerate(rows, 1):
        result = row.run()
        word = "pass" if result.has_passed else "FAIL"
        line = f"[{number}/{len(rows)}] {word} {result.seconds:6.1f} s  {row.name}"
        print(line, file=sys.stderr, flush=True)
        results.append(result)
    return results


def table(results: Sequence[Result]) -> str:
    """All results in columns; of a row that broke down, why."""
    lines = [HEADINGS]
    for result in results:
        quantity = (
            f"{result.row.quantity} ({result.row.unit})" if result.row.unit else result.row.quantity
        )
        word = "pass" if result.has_passed else f"FAIL {result.message}".rstrip()
        lines.append((result.row.name, quantity, *result.cells(), word))
    widths = [max(len(line[column]) for line in lines) for column in range(len(HEADINGS) - 1)]
    return "\n".join(
        "  ".join(
            [*(cell.ljust(width) for cell, width in zip(line, widths, strict=False)), line[-1]]
        )
        for line in lines
    )


def main(words: Sequence[str] | None = None) -> int:
    """Run what the command line asks for."""
    options = parser().parse_args(words)
    if not options.tables.is_dir():
        print(f"validate.py: --tables {options.tables}: no such folder", file=sys.stderr)
        return 2
    reference.folder = options.tables
    try:
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        print(f"validate.py: --out {options.out}: {fault.strerror}", file=sys.stderr)
        return 2
    # In the report's order, whatever the order of the words.
    chapters = [chapter for chapter in CHAPTERS if chapter in options.only]
    results = run([row for chapter in chapters for row in rows_of(chapter)])
    # Matplotlib takes a second to load, and rows draw nothing.
    from validation import overview, report

    report.write(results, not_measured(), options.out / "report.html")
    overview.draw(results, options.out / "overview.png")
    if options.readme:
        overview.shrink(options.out / "overview.png", README_PICTURE)
    passed = sum(result.has_passed for result in results)
    print(table(results))
    print(f"{passed} of {len(results)} rows hold, {sum(each.seconds for each in results):.0f} s")
    print(options.out / "report.html")
    return 0 if passed == len(results) else 1


if __name__ == "__main__":
    sys.exit(main())
