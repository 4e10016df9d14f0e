"""How a sweep tells how far it is: a bar on a terminal, plain lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

from tqdm import tqdm

from bake_progress import SECONDS_BETWEEN_LINES, print_line


class Progress:
    """Counts runs; the pace is that of this process, without the runs that it found whole."""

    def __init__(self, total: int, found: int, quiet: bool) -> None:
        self.total = total
        self.done = found
        self.failed = 0
        self._quiet = quiet
        self._found = found
        self._began = self._shown = time.monotonic()
        self._bar: tqdm | None = None
        if not quiet and sys.stderr is not None and sys.stderr.isatty():
            self._bar = tqdm(
                total=total,
                initial=found,
                bar_format="run {n_fmt}/{total_fmt} |{bar}| {desc}{rate_inv_fmt}, {remaining} left",
                unit="run",
                dynamic_ncols=True,
                file=sys.stderr,
            )

    def tell(self, name: str, error: str | None) -> None:
        """Hear that a run has ended, and why it failed if it did."""
        self.done += 1
        if error is not None:
            self.failed += 1
            self.warn(f"run {name} failed: {error}")
        if self._bar is not None:
            self._bar.set_description_str(f"{self.failed} failed, " if self.failed else "")
            self._bar.update()
        elif not self._quiet:
            self._line()

    def _line(self) -> None:
        now = time.monotonic()
        if self.done < self.total and now - self._shown < SECONDS_BETWEEN_LINES:
            return
        self._shown = now
        pace = (now - self._began) / (self.done - self._found)
        left = pace * (self.total - self.done)
        failed = f", {self.failed} failed" if self.failed else ""
        print_line(f"run {self.done}/{self.total}{failed}, {pace:.3g} s/run, {left:.0f} s left")

    def say(self, text: str) -> None:
        """Show a line."""
        if not self._quiet:
            print_line(text)

    def warn(self, text: str) -> None:
        """Show a line on standard error, without harm to the bar."""
        line = f"sweep.py: {text}"
        if self._bar is not None:
            self._bar.write(line, file=sys.stderr)
        else:
            print(line, file=sys.stderr, flush=True)

    def close(self) -> None:
        """Leave the terminal as it was found."""
        if self._bar is not None:
            self._bar.close()


@contextmanager
def progress_of(total: int, found: int, quiet: bool) -> Iterator[Progress]:
    """Show how far a sweep is as long as it takes."""
    progress = Progress(total, found, quiet)
    try:
        yield progress
    finally:
        progress.close()
