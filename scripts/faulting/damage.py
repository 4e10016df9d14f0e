"""Damage to what a bake has left: cut files, changed bits, checkpoints of others."""

from __future__ import annotations

import random
import shutil
import struct
from collections.abc import Callable
from pathlib import Path

from . import shim
from .subject import Row, Subject, differs, refused

HALF = 0.6
"""Where a bake is stopped, as a part of its operations."""


def half_baked(subject: Subject, folder: Path, library: Path) -> Path:
    """A bake that was killed after about half of its operations, with a checkpoint."""
    out, number = folder / "half", 1
    while True:
        environment = shim.environment(library, "kill", number, out, "hurry")
        shutil.rmtree(out, ignore_errors=True)
        if subject.run(out, env=environment).returncode == 0:
            break
        number *= 2
    shutil.rmtree(out)
    environment = shim.environment(library, "kill", int(HALF * number / 2) or 1, out, "hurry")
    subject.run(out, env=environment)
    return out


def trial(
    subject: Subject, half: Path, folder: Path, row: Row, where: str, damage: Callable[[Path], None]
) -> None:
    """Damage a copy of a bake and go on: it ends as undisturbed, or says what is wrong and how to mend it."""
    out = folder / "damaged"
    shutil.copytree(half, out)
    damage(out)
    done = subject.run(out, resume=True)
    if done.returncode == 0:
        row.note(differs(subject, out), where)
        shutil.rmtree(out)
        return
    trouble = refused(done, 2, 4)
    row.said = row.said or done.stderr.strip()
    if not trouble:  # the cure that is named, taken
        again = subject.run(out)
        ending = f"exit code {again.returncode}: {again.stderr.strip()[-200:]}"
        trouble = ending if again.returncode else differs(subject, out)
    row.note(trouble, where)
    shutil.rmtree(out)


def kept(half: Path) -> list[Path]:
    """The files of a bake that a person might damage."""
    temporary = {".part", ".new", ".lock"}
    return [path for path in sorted(half.iterdir()) if path.suffix not in temporary]


def cuts(subject: Subject, half: Path, folder: Path, count: int, seed: int) -> Row:
    """Each file cut off at many lengths, and missing."""
    row, chance = Row("a file cut off or missing", subject.name), random.Random(seed)
    for path in kept(half):
        size = path.stat().st_size
        lengths = [None, 0, size - 1, *(chance.randrange(size) for _ in range(count))]
        for length in lengths:

            def cut(out: Path, name: str = path.name, length: int | None = length) -> None:
                if length is None:
                    (out / name).unlink()
                else:
                    with (out / name).open("r+b") as file:
                        file.truncate(length)

            trial(subject, half, folder, row, f"{path.name} at {length}", cut)
    return row


def bits(subject: Subject, half: Path, folder: Path, count: int, seed: int) -> Row:
    """A bit changed in each file: anywhere, and in its first bytes."""
    row, chance = Row("a bit changed", subject.name), random.Random(seed)
    for path in kept(half):
        size = path.stat().st_size
        for number in range(count):
            bit = chance.randrange(8 * (min(size, 64) if number % 3 == 0 else size))

            def change(out: Path, name: str = path.name, bit: int = bit) -> None:
                data = bytearray((out / name).read_bytes())
                data[bit // 8] ^= 1 << bit % 8
                (out / name).write_bytes(data)

            trial(subject, half, folder, row, f"{path.name}, bit {bit}", change)
    return row


def versions(subject: Subject, half: Path, folder: Path, other: Subject) -> Row:
    """Checkpoints of another version, older and newer, and of another scene."""
    row = Row("a checkpoint of another version or scene", subject.name)
    path = next(iter(sorted(half.glob("*.checkpoint"))))
    data = path.read_bytes()
    if path.name == "boucle.checkpoint":
        own = struct.unpack_from("<I", data, 8)[0]
        found = [data[:8] + struct.pack("<I", own + by) + data[12:] for by in (-1, 1)]
    else:
        found = [data.replace(b"CHECKPOINT 2", b"CHECKPOINT %d" % number) for number in (1, 3)]
    theirs = next(iter(sorted(other.undisturbed.glob("*.checkpoint"))))
    for where, content in zip(
        ("older", "newer", "another scene"), [*found, theirs.read_bytes()], strict=True
    ):

        def put(out: Path, content: bytes = content) -> None:
            (out / path.name).write_bytes(content)

        trial(subject, half, folder, row, where, put)
    return row
