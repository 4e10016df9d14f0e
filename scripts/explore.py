"""Map which steps are stable over mass, stiffness, damping and time step, and compare limiters, integrators and meshes.

Leaves in `--out` (out/explore): stability.png, limiters.png, integrators.png, meshes.png; tables in index.md; numbers.json.
Exit codes: 0 done, 2 wrong use, 4 the result cannot be written, 130 stopped by the user.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

ROOT = Path(__file__).resolve().parent.parent
README_PICTURES = ROOT / "scripts" / "pictures"
RANGES = ROOT / "addon" / "core" / "ranges.json"
PARTS = ("stability", "limiters", "integrators", "meshes")
DONE, WRONG_USE, CANNOT_WRITE, STOPPED = 0, 2, 4, 130


class Parser(argparse.ArgumentParser):
    """Tells wrong usage in one line."""

    def error(self, message: str) -> NoReturn:
        """Refuse the command line."""
        print(f"explore.py: {message} (--help tells what is accepted)", file=sys.stderr)
        sys.exit(WRONG_USE)


def thread_count(text: str) -> int:
    """The number of threads that was written."""
    if not (text.isascii() and text.isdecimal()) or not 0 <= int(text) <= 1024:
        raise argparse.ArgumentTypeError(f"{text!r}; accepted: 1 to 1024, or 0 for every core")
    return int(text)


def parser() -> Parser:
    """The command line of this script."""
    lines = Parser(prog="explore.py", description=__doc__, allow_abbrev=False)
    lines.add_argument("--out", metavar="DIR", type=Path, default=ROOT / "out" / "explore")
    lines.add_argument("--only", metavar="PART", nargs="+", choices=PARTS, default=list(PARTS))
    lines.add_argument("--threads", metavar="N", type=thread_count, default=0)
    lines.add_argument("--quick", action="store_true", help="a few hundred runs")
    lines.add_argument("--quiet", action="store_true", help="no progress")
    lines.add_argument(
        "--keep",
        action="store_true",
        help="also renew the picture in scripts/pictures and the ranges that the add-on warns by",
    )
    return lines


def listener(quiet: bool) -> Callable[[str, int, int], None]:
    """What tells of batches: a line a second."""
    shown = [time.monotonic()]

    def say(what: str, done: int, total: int) -> None:
        now = time.monotonic()
        if not quiet and now - shown[0] >= 1.0:
            shown[0] = now
            print(f"{what}: run {done}/{total}", flush=True)

    return say


def main(words: Sequence[str] | None = None) -> int:
    """Do what the command line asks for and return the exit code."""
    options = parser().parse_args(words)
    try:
        from exploring import report
    except ImportError as error:
        print(f"explore.py: {error}; python3 scripts/dev.py build makes it", file=sys.stderr)
        return WRONG_USE
    try:
        options.out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as folder:
            made = report.Report(Path(folder), listener(options.quiet), options)
            for part in PARTS:
                if part in options.only:
                    made.add(part)
            print(made.write(), flush=True)
            if options.keep and "stability" in options.only:
                made.keep(README_PICTURES, RANGES)
    except OSError as error:
        print(f"explore.py: {options.out} cannot be written: {error}", file=sys.stderr)
        return CANNOT_WRITE
    except KeyboardInterrupt:
        print("explore.py: stopped", file=sys.stderr)
        return STOPPED
    return DONE


if __name__ == "__main__":
    sys.exit(main())
