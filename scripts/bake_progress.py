"""How a bake tells how far it is: a bar on a terminal, plain lines elsewhere, or nothing."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Iterator, Mapping
from typing import Protocol

from tqdm import tqdm

SECONDS_BETWEEN_LINES = 1.0


class Progress(Protocol):
    """Hears of every frame."""

    def tell(self, step: Mapping[str, float]) -> None:
        """Hear of a frame: `frame`, `first`, `last`, `seconds`."""

    def say(self, text: str) -> None:
        """Show a line."""


class Silence:
    """Shows nothing."""

    def tell(self, step: Mapping[str, float]) -> None:
        """Hear of a frame."""

    def say(self, text: str) -> None:
        """Hear of a line."""


class Lines:
    """Shows a line every second, and one for the last frame."""

    def __init__(self) -> None:
        self.began = self.shown = time.monotonic()
        self.count = 0

    def tell(self, step: Mapping[str, float]) -> None:
        """Show how far the bake is, if a second has passed."""
        self.count += 1
        now = time.monotonic()
        frame, last = step["frame"], step["last"]
        if frame < last and now - self.shown < SECONDS_BETWEEN_LINES:
            return
        self.shown = now
        pace = (now - self.began) / self.count
        left = pace * (last - frame)
        self.say(f"frame {frame}/{last}, {pace:.3g} s/frame, {left:.0f} s left")

    def say(self, text: str) -> None:
        """Show a line; nobody may be reading."""
        print_line(text)


def print_line(text: str) -> None:
    """Print a line; when the reader has gone, drop it and all that follow, the flush at exit included."""
    try:
        print(text, flush=True)
    except OSError:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


class Bar:
    """Shows a bar on the terminal of standard error."""

    def __init__(self) -> None:
        self.bar: tqdm | None = None

    def tell(self, step: Mapping[str, float]) -> None:
        """Move the bar on."""
        if self.bar is None:
            self.bar = tqdm(
                total=step["last"] - step["first"] + 1,
                initial=step["frame"] - step["first"],
                bar_format="frame {desc} |{bar}| {n_fmt}/{total_fmt}, {rate_inv_fmt}, {remaining} left",
                unit="frame",
                dynamic_ncols=True,
                file=sys.stderr,
            )
        self.bar.set_description_str(str(step["frame"]), refresh=False)
        self.bar.update()

    def say(self, text: str) -> None:
        """Show a line."""
        print_line(text)

    def close(self) -> None:
        """Leave the terminal as it was found."""
        if self.bar is not None:
            self.bar.close()


@contextlib.contextmanager
def progress_on(quiet: bool) -> Iterator[Progress]:
    """Choose how progress is shown here."""
    if quiet:
        yield Silence()
    elif sys.stderr is not None and sys.stderr.isatty():
        with contextlib.closing(Bar()) as bar:
            yield bar
    else:
        yield Lines()
