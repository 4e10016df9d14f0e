"""Disks: full, taken away, read-only."""

from __future__ import annotations

import random
import shutil
import subprocess
from pathlib import Path

from . import shim
from .kills import moments
from .subject import Row, Subject, lost, refused, resumed

WAYS = {"full": "disk full from an operation on", "gone": "disk gone from an operation on"}
PAGE = 4096


def from_an_operation_on(
    subject: Subject, folder: Path, library: Path, kind: str, stride: int, seed: int
) -> Row:
    """From each operation on there is no room, or no disk; then there is again, and the bake goes on."""
    row = Row(WAYS[kind], subject.name)
    for number in moments(stride, seed):
        out = folder / kind
        environment = shim.environment(library, kind, number, out, "hurry")
        done = subject.run(out, env=environment)
        if done.returncode == 0:
            shutil.rmtree(out)
            return row
        trouble = refused(done, 4) or lost(subject, out) or resumed(subject, out)
        row.note(trouble, f"operation {number}")
        row.said = row.said or done.stderr.strip()
        shutil.rmtree(out, ignore_errors=True)
    return row


def mount(place: Path, size: int) -> None:
    """A small disk at a place."""
    place.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", place]
    subprocess.run(command, check=True)


def change(place: Path, option: str) -> None:
    """Change how a disk is mounted."""
    subprocess.run(["mount", "-o", f"remount,{option}", place], check=True)


def small(subject: Subject, folder: Path, sizes: int, seed: int) -> Row:
    """A disk of a real size that is too small; it grows, and the bake goes on."""
    row, chance = Row("a disk too small", subject.name), random.Random(seed)
    whole = sum(-(-path.stat().st_size // PAGE) for path in subject.undisturbed.iterdir())
    for number in range(sizes):
        place = folder / "disk"
        pages = chance.randint(1, whole - 1) if number else 1
        mount(place, PAGE * pages)
        try:
            out = place / "out"
            done = subject.run(out)
            trouble = refused(done, 4) or lost(subject, out)
            row.said = row.said or done.stderr.strip()
            change(place, f"size={PAGE * 8 * whole}")
            row.note(trouble or resumed(subject, out), f"{pages} of {whole} pages")
        finally:
            subprocess.run(["umount", place], check=True)
            place.rmdir()
    return row


def read_only(subject: Subject, folder: Path) -> Row:
    """A folder that nobody may write to: from the start, and after a bake, which must stay as it is."""
    row, place = Row("a folder that is read-only", subject.name), folder / "locked"
    mount(place, 1 << 24)
    try:
        for kind in ("from the start", "after a bake"):
            out = place / "out"
            if kind == "after a bake":
                shutil.rmtree(out)
                shutil.copytree(subject.undisturbed, out)
            before = {path.name: path.read_bytes() for path in out.glob("*")}
            change(place, "ro")
            for resume in (False, True):
                done = subject.run(out, resume=resume)
                now = {path.name: path.read_bytes() for path in out.glob("*")}
                trouble = refused(done, 4) or ("" if now == before else "files have changed")
                row.note(trouble, f"{kind}{', --resume' if resume else ''}")
                row.said = row.said or done.stderr.strip()
            change(place, "rw")
            row.note(resumed(subject, out), f"{kind}, then writable")
    finally:
        subprocess.run(["umount", place], check=True)
        place.rmdir()
    return row
