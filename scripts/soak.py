"""Simulate for hours in one process: `python scripts/soak.py [--frames N] [--seconds S] [--blender ROUNDS]`.

The contact scenes of tests/scenes and a heap of 24 cloths, over and over. Memory must stay flat within 1 % once it is warm,
the same frames must take the same time, every run of a scene must give the same hashes, and nothing may pass through anything.
`--blender` bakes, frees and plays a cloth so many times in embedded Blender instead, where the bridge and Python may leak, too.
Times are of the processor, held against a fixed piece of work beside them, so that what else the machine does counts less.

Run by the Python of .venv (`python3 scripts/dev.py build` makes it); Linux only. Exit codes: 0 all held, 1 something did
not, 2 wrong use. Ctrl-C (or SIGTERM) ends it earlier, with the table so far.
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import os
import signal
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from soaking.scenes import Subject, subjects
from soaking.watch import Watch, gauge, resident_bytes

TELL_SECONDS = 60.0


def parser() -> argparse.ArgumentParser:
    """The command line of this script."""
    lines = argparse.ArgumentParser(prog="soak.py", description=__doc__, allow_abbrev=False)
    lines.add_argument("--frames", metavar="N", type=int, default=100_000, help="of all scenes")
    lines.add_argument("--seconds", metavar="S", type=float, default=float("inf"), help="at most")
    lines.add_argument("--threads", metavar="N", type=int, default=1)
    lines.add_argument("--only", metavar="SCENE", nargs="+", help="scenes by name; '24 cloths'")
    lines.add_argument(
        "--blender",
        metavar="ROUNDS",
        type=int,
        help="rounds of baking, freeing and playing in Blender",
    )
    return lines


def chosen(scenes: Sequence[Subject], names: Sequence[str] | None) -> list[Subject]:
    """The scenes of these names; all of them without."""
    known = {subject.name for subject in scenes}
    if unknown := set(names or ()) - known:
        parser().error(f"no scene {min(unknown)!r}; accepted: {', '.join(sorted(known))}")
    return [subject for subject in scenes if not names or subject.name in names]


def simulate(watch: Watch, subject: Subject, threads: int) -> None:
    """Bake a scene once and look at what it did."""
    import boucle_core

    with tempfile.TemporaryDirectory() as out:
        before = gauge()
        begin = time.process_time()
        report = boucle_core.bake(str(subject.path), out, threads=threads)
        seconds = time.process_time() - begin
        unit = (before + gauge()) / 2.0
    watch.add(subject.name, report["frames"], seconds, unit)


def soak(watch: Watch, scenes: Sequence[Subject], options: argparse.Namespace) -> None:
    """Run rounds of all scenes until there are enough frames or the time is up."""
    end = time.monotonic() + options.seconds
    told, number = time.monotonic(), 0
    while watch.frames < options.frames and time.monotonic() < end:
        for subject in scenes:
            if number % subject.every == 0 and time.monotonic() < end:
                simulate(watch, subject, options.threads)
        gc.collect()
        watch.memory.append(resident_bytes())
        number += 1
        if time.monotonic() - told > TELL_SECONDS:
            told = time.monotonic()
            memory = watch.memory[-1] / 1e6
            print(f"round {number}: {watch.frames} frames, {memory:.1f} MB", flush=True)


def main(words: Sequence[str] | None = None) -> int:
    """Do what the command line asks for and return the exit code."""
    options = parser().parse_args(words)
    watch = Watch()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # also where it is ignored
    with tempfile.TemporaryDirectory() as folder, contextlib.suppress(KeyboardInterrupt):
        if options.blender:
            from soaking import blender

            blender.soak(watch, Path(folder), options.blender)
        else:
            soak(watch, chosen(subjects(Path(folder)), options.only), options)
    print(watch.table())
    found = watch.verdicts()
    for sentence in found:
        print(f"not held: {sentence}")
    print("all held" if not found else f"{len(found)} not held", flush=True)
    return 1 if found else 0


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    os._exit(code)  # embedded Blender may hang where it ends
