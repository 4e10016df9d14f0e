"""Do to a bake what may happen to it, and see that nothing is lost: `python scripts/faults.py [--kills N] [--only FAULT ...]`.

Small scenes with contact and with tears are baked by bake.py and by the add-on (without Blender), and killed, run out of disk,
damaged. Each goes on afterwards; what it leaves must be, byte for byte, what an undisturbed bake leaves, or it must say in one
sentence what is wrong and how to mend it. A table tells what was tried, how often, and what broke.

Run by the Python of .venv (`python3 scripts/dev.py build` makes it); Linux only, with a C compiler; `unshare` and `mount` for
small disks. Exit codes: 0 nothing broke, 1 something did, 2 wrong use.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

from faulting import damage, disk, kills, shim, surroundings
from faulting.subject import CONTACT, Row, Subject, addon, headless, subjects

FAULTS = ("kills", "operations", "full", "gone", "disks", "cuts", "bits", "versions", "clocks")
ALONE = "BOUCLE_FAULTS_ALONE"
"""Set where mounts are seen by nobody else."""
HUGE = "cloth.lower.grid.vertices=[1500,1500]"


def parser() -> argparse.ArgumentParser:
    """The command line of this script."""
    lines = argparse.ArgumentParser(prog="faults.py", description=__doc__, allow_abbrev=False)
    lines.add_argument("--kills", metavar="N", type=int, default=100, help="of each bake")
    lines.add_argument(
        "--only",
        metavar="FAULT",
        nargs="+",
        choices=(*FAULTS, "memory"),
        default=(*FAULTS, "memory"),
    )
    lines.add_argument(
        "--every", metavar="N", type=int, default=1, help="one operation in about N (default all)"
    )
    lines.add_argument("--cuts", metavar="N", type=int, default=15, help="of each file")
    lines.add_argument("--bits", metavar="N", type=int, default=40, help="of each file")
    lines.add_argument("--sizes", metavar="N", type=int, default=12, help="of small disks")
    lines.add_argument("--frames", metavar="N", type=int, default=14, help="of the scenes")
    lines.add_argument("--seed", metavar="N", type=int, default=1)
    lines.add_argument("--workers", metavar="N", type=int, default=os.cpu_count() or 1)
    return lines


def may_mount() -> bool:
    """Whether small disks can be had, here or after a start in a place of our own."""
    command = ["unshare", "--map-root-user", "--mount", "mount", "-t", "tmpfs", "tmpfs", "/mnt"]
    return (
        shutil.which("unshare") is not None
        and not subprocess.run(command, capture_output=True, check=False).returncode
    )


def work(
    subject: Subject, other: Subject, folder: Path, library: Path, options: argparse.Namespace
) -> Iterator[Row]:
    """All faults of one bake, one after the other."""
    seed, every, only = options.seed, options.every, options.only
    if "kills" in only:
        yield kills.at_random(subject, folder, library, options.kills, seed)
    if "operations" in only:
        yield kills.at_every_operation(subject, folder, library, every, seed)
    for kind in disk.WAYS:
        if kind in only:
            yield disk.from_an_operation_on(subject, folder, library, kind, every, seed)
    if "disks" in only and os.environ.get(ALONE):
        yield disk.small(subject, folder, options.sizes, seed)
        yield disk.read_only(subject, folder)
    if not {"cuts", "bits", "versions", "clocks"} & set(only):
        return
    half = damage.half_baked(subject, folder, library)
    if "cuts" in only:
        yield damage.cuts(subject, half, folder, options.cuts, seed)
    if "bits" in only:
        yield damage.bits(subject, half, folder, options.bits, seed)
    if "versions" in only:
        yield damage.versions(subject, half, folder, other)
    if "clocks" in only:
        yield surroundings.clocks(subject, half, folder, library, 3)


def rows(folder: Path, library: Path, options: argparse.Namespace) -> list[Row]:
    """Do everything; rows in the order of the bakes."""
    found = subjects(folder, options.frames)

    def all_of(number: int) -> list[Row]:
        own = folder / f"work{number}"
        own.mkdir()
        out = []
        other = found[(number + 2) % len(found)]
        for row in work(found[number], other, own, library, options):
            print(tell(row), flush=True)
            out.append(row)
        return out

    with ThreadPoolExecutor(options.workers) as pool:
        out = [row for part in pool.map(all_of, range(len(found))) for row in part]
    if "memory" in options.only:
        scene = folder / "huge.toml"
        scene.write_text(CONTACT.replace("FRAMES", "9"), encoding="utf-8")
        huge = headless("bake.py, 2 million vertices", scene, "--set", HUGE)
        bakes = huge, addon("add-on, 490 thousand vertices", "contact", "--side", "700")
        found_rows = map(partial(surroundings.memory, folder=folder), bakes)
        for row in found_rows:
            print(tell(row), flush=True)
            out.append(row)
    return out


def tell(row: Row) -> str:
    """A row of the table."""
    line = f"{row.fault:47} {row.subject:30} {row.tried:5} tried {len(row.broke):4} broke"
    return "\n".join([line, *(f"  broke: {one}" for one in row.broke)])


def main(words: Sequence[str] | None = None) -> int:
    """Do what the command line asks for and return the exit code."""
    options = parser().parse_args(words)
    if not os.environ.get(ALONE) and "disks" in options.only:
        if may_mount():
            own = ["unshare", "--map-root-user", "--mount", sys.executable, *sys.argv]
            os.execvpe(own[0], own, {**os.environ, ALONE: "1"})
        print("no mount is allowed here: small and read-only disks are left out")
    with tempfile.TemporaryDirectory() as folder:
        try:
            library = shim.build(Path(folder).resolve())
        except (OSError, subprocess.CalledProcessError) as error:
            print(f"faults.py: a C compiler (cc) is needed: {error}", file=sys.stderr)
            return 2
        found = rows(library.parent, library, options)
    print("\nwhat a user is told, once for each:")
    for said in dict.fromkeys(f"  {row.fault}: {row.said}" for row in found if row.said):
        print(said.replace(folder, "..."))
    tried, broke = sum(row.tried for row in found), sum(len(row.broke) for row in found)
    print(f"{tried} faults, {broke} broke", flush=True)
    return 1 if broke else 0


if __name__ == "__main__":
    sys.exit(main())
