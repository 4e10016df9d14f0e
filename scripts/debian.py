"""A Debian 13 folder, for programs that this system lacks: a real Blender with a window, and Rust with its own source.

Made once by debootstrap from the mirror that this system's apt uses, outside the project: in the user's cache folder,
or where BOUCLE_DEBIAN13 says. Every command in it has mounts and processes of its own, which end with it, so that the
folder can be deleted at any time. Needs Debian or a descendant, root and the network; standard library only.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from environment import Missing, heading, run

RELEASE = "trixie"
PROGRAMS = ("apt-get", "debootstrap", "unshare", "chroot")
ENTER = """
set -e
root=$1; shift
mount --rbind /dev "$root/dev"
mount -t proc proc "$root/proc"
mount -t tmpfs tmpfs "$root/tmp"
while [ "$1" != -- ]; do
    if [ -d "$1" ]; then mkdir -p "$root$1"; else mkdir -p "$root${1%/*}"; touch "$root$1"; fi
    mount --bind "$1" "$root$1"
    shift
done
shift
exec "$@"
"""
"""Run in namespaces of its own: ENTER FOLDER SHARED-PATH... -- COMMAND, which changes the root itself."""
INSTALL = "apt-get update -qq && apt-get install -y -qq --no-install-recommends"
NAMES_OF_HOSTS = ("/etc/resolv.conf", "/etc/hosts")


def folder() -> Path:
    """Where the folder is or will be."""
    named = os.environ.get("BOUCLE_DEBIAN13")
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return Path(named) if named else cache / "boucle" / "debian13"


def require() -> None:
    """Check that a folder can be made and entered.

    Raises:
        Missing: It cannot; the message says all that is missing.
    """
    lacks = [f"the program {name}" for name in PROGRAMS if shutil.which(name) is None]
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        lacks.insert(0, "root")
    if lacks:
        raise Missing(f"a Debian 13 folder needs {', '.join(lacks)}, which this system has not")


def mirror() -> str:
    """The Debian mirror that this system's apt uses, with the main archive.

    Raises:
        Missing: apt names none.
    """
    form = "$(REPO_URI) $(ORIGIN) $(COMPONENT) $(SUITE)"
    command = ["apt-get", "indextargets", "--format", form, "Identifier: Packages"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    for line in done.stdout.splitlines():
        address, origin, component, suite = (line.split() + [""] * 4)[:4]
        if (origin, component) == ("Debian", "main") and "-" not in suite:
            return address
    raise Missing("apt names no Debian mirror on this system: run `apt-get update` first")


def ensure(*packages: str) -> None:
    """Make the folder if it is not there, and install the packages that it lacks.

    Raises:
        Missing: This system cannot.
        Failed: debootstrap or apt ended with an error.
    """
    require()
    if not (folder() / "made.stamp").exists():
        with heading(f"Make a Debian 13 folder in {folder()}"):
            shutil.rmtree(folder(), ignore_errors=True)
            folder().parent.mkdir(parents=True, exist_ok=True)
            variant = ["--variant=minbase", "--include=ca-certificates"]
            run(["debootstrap", *variant, RELEASE, folder(), mirror()], timeout=1200)
            # Services of installed packages must not start in the folder.
            policy = folder() / "usr" / "sbin" / "policy-rc.d"
            policy.write_text("#!/bin/sh\nexit 101\n", encoding="utf-8")
            policy.chmod(0o755)
            (folder() / "made.stamp").write_text(RELEASE, encoding="utf-8")
    stamp = folder() / "packages.stamp"
    known = set(stamp.read_text(encoding="utf-8").split()) if stamp.exists() else set()
    wanted = [name for name in packages if name not in known]
    if wanted:
        with heading(f"Install {', '.join(wanted)} in it"):
            line = " ".join([INSTALL, *wanted])
            run(inside(["sh", "-c", line], DEBIAN_FRONTEND="noninteractive"), timeout=1800)
            stamp.write_text(" ".join(sorted(known.union(wanted))), encoding="utf-8")


def inside(
    words: Sequence[object],
    *,
    shared: Sequence[Path] = (),
    root: Path | None = None,
    hears_signals: bool = False,
    **variables: str,
) -> list[str]:
    """The command that runs `words` in the folder.

    Args:
        words: Program and arguments, as the folder knows them.
        shared: Files and folders of this system that stand there too, under the same paths.
        root: Another folder of the same kind.
        hears_signals: Whether the program gets the signals of the command, instead of ending with it, children and all.
        variables: The environment, besides the usual; ours does not go in.
    """
    root = root or folder()
    settings: Mapping[str, str] = {
        "HOME": "/root",
        "PATH": "/usr/sbin:/usr/bin:/sbin:/bin",
        "LANG": "C.UTF-8",
        **variables,
    }
    processes = [] if hears_signals else ["--pid", "--fork", "--kill-child"]
    enter = ["unshare", "--mount", *processes, "sh", "-c", ENTER, "enter"]
    hosts = [name for name in NAMES_OF_HOSTS if Path(name).exists()]
    paths = [*(str(path.resolve()) for path in shared), *hosts]
    environment = [f"{name}={value}" for name, value in settings.items()]
    command = ["env", "-i", *environment, "chroot", str(root), *map(str, words)]
    return [*enter, str(root), *paths, "--", *command]
