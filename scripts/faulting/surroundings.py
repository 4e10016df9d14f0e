"""What is around a bake: clocks that jump, and memory that there is not."""

from __future__ import annotations

import os
import resource
import shutil
from pathlib import Path

from . import shim
from .subject import Row, Subject, differs, refused, resumed

DAY = 86400
YEARS = {"1971": 365 * DAY, "2100": 130 * 365 * DAY}
MEMORY = 1 << 30
"""Address space (bytes) that a process with too large a scene gets."""


def clocks(subject: Subject, half: Path, folder: Path, library: Path, times: int) -> Row:
    """A time of day that is another one at every look while it bakes, and files of other years."""
    row = Row("a clock that jumps, files of other years", subject.name)
    jumping = shim.environment(library, clock="jump")
    for number in range(times):
        out = folder / "jumping"
        done = subject.run(out, env=jumping)
        row.note(differs(subject, out) if done.returncode == 0 else done.stderr, f"bake {number}")
        shutil.rmtree(out)
        shutil.copytree(half, out)
        row.note(resumed(subject, out, env=jumping), f"resumed {number}")
        shutil.rmtree(out)
    for year, seconds in YEARS.items():
        out = folder / "old"
        shutil.copytree(half, out)
        for path in out.iterdir():
            os.utime(path, (seconds, seconds))
        row.note(resumed(subject, out), f"files of {year}")
        shutil.rmtree(out)
    return row


def limit() -> None:
    """Let the process that is about to start have so much memory and no more."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def memory(huge: Subject, folder: Path) -> Row:
    """Cloth for which there is no memory: refused with its size before anything is taken or written."""
    row, out = Row("cloth for which there is no memory", huge.name), folder / "huge"
    done = huge.run(out, preexec_fn=limit)
    trouble = refused(done, 2)
    if not trouble and "GB of memory" not in done.stderr:
        trouble = f"the size is not named: {done.stderr.strip()}"
    if not trouble and out.exists():
        trouble = "something was written"
    row.said = done.stderr.strip()
    row.note(trouble, "1 GB")
    return row
