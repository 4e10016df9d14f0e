"""Kills: at random moments, and in the midst of every operation on a file."""

from __future__ import annotations

import random
import shutil
import signal
import time
from collections.abc import Iterator
from pathlib import Path

from . import shim
from .subject import Row, Subject, lost, resumed

CHAIN = 10
"""Kills of one bake before it may end."""


def at_random(subject: Subject, folder: Path, library: Path, kills: int, seed: int) -> Row:
    """Kill -9 at random moments of a bake's life; after some of them it goes on to the end.

    Time seems to hurry, so that a checkpoint is written after every frame.
    """
    row, chance = Row("kill -9 at a random moment", subject.name), random.Random(seed)
    environment = shim.environment(library, clock="hurry")
    begin = time.monotonic()
    subject.run(folder / "timed", env=environment)
    life = time.monotonic() - begin
    for chain in range(-(-kills // CHAIN)):
        out = folder / f"killed{chain}"
        for number in range(min(CHAIN, kills - chain * CHAIN)):
            with subject.start(out, resume=True, env=environment) as process:
                time.sleep(chance.uniform(0.0, 1.05 * life))
                process.send_signal(signal.SIGKILL)
            row.note(lost(subject, out), f"chain {chain}, kill {number}")
        row.note(resumed(subject, out, env=environment), f"chain {chain}, resumed")
        row.tried -= 1
        shutil.rmtree(out)
    return row


def moments(stride: int, seed: int) -> Iterator[int]:
    """Numbers of operations, every one or about one in so many."""
    chance, number = random.Random(seed), 1
    while True:
        yield number
        number += 1 if stride == 1 else chance.randint(1, 2 * stride - 1)


def at_every_operation(
    subject: Subject, folder: Path, library: Path, stride: int, seed: int
) -> Row:
    """Kill in the midst of each operation on a file of the bake, and in the midst of each after the bake goes on."""
    row = Row("kill in the midst of a write, rename, removal", subject.name)
    for number in moments(stride, seed):
        out = folder / "struck"
        environment = shim.environment(library, "kill", number, out, "hurry")
        done = subject.run(out, env=environment)
        if done.returncode != -signal.SIGKILL:
            trouble = "" if done.returncode == 0 else f"exit code {done.returncode}: {done.stderr}"
            row.note(trouble, f"operation {number}")
            row.tried -= 1
            shutil.rmtree(out)
            return row
        trouble = lost(subject, out)
        again = random.Random(number).randint(1, 40)
        environment = shim.environment(library, "kill", again, out, "hurry")
        subject.run(out, resume=True, env=environment)
        trouble = trouble or lost(subject, out) or resumed(subject, out)
        row.note(trouble, f"operation {number}, then {again}")
        shutil.rmtree(out)
    return row
