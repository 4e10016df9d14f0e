"""The module for Linux on ARM, tried without such a machine: a Debian 13 folder for ARM, in which qemu runs its Python.

The folder is unpacked beside the other one (debian.py). Programs that Python itself starts would not be emulated: tests
that start some are left out. Standard library only.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import debian
from environment import OUT, ROOT, SCRIPTS, VENV, heading, run, venv_program

PACKAGES = ("debootstrap", "qemu-user-static")
QEMU = Path("usr", "bin", "qemu-aarch64-static")
TESTS = ("simulation", "colliders", "fields", "shape", "interrupter", "bake_function")
TEST_SECONDS = 3600


def folder() -> Path:
    """Where the folder for ARM is or will be."""
    return debian.folder().with_name(f"{debian.folder().name}-arm64")


def ensure() -> None:
    """Unpack the folder if it is not there: no program of its packages runs, which needs no emulator in the kernel."""
    debian.ensure(*PACKAGES)
    stamp = folder() / "made.stamp"
    if stamp.exists():
        return
    with heading(f"Unpack a Debian 13 folder for ARM in {folder()}"):
        shutil.rmtree(folder(), ignore_errors=True)
        folder().mkdir(parents=True)
        first = ["debootstrap", "--arch=arm64", "--foreign", "--variant=minbase"]
        first += ["--include=python3", debian.RELEASE, folder(), debian.mirror()]
        run(debian.inside(first, shared=[folder()]), timeout=1200)
        for package in sorted((folder() / "var" / "cache" / "apt" / "archives").glob("*.deb")):
            run(["dpkg-deb", "--extract", package, folder()], timeout=120)
        shutil.copy2(debian.folder() / QEMU, folder() / QEMU)
        stamp.write_text(debian.RELEASE, encoding="utf-8")


def test(wheel: Path) -> None:
    """Load the module in the ARM Python and run its tests there.

    Raises:
        Missing: This system cannot make the folder.
        Failed: A test failed.
    """
    ensure()
    library = OUT / "package" / "arm64"
    with heading("Test the module for Linux on ARM, emulated"):
        shutil.rmtree(library, ignore_errors=True)
        install = [venv_program(VENV, "python"), "-m", "pip", "install", "--quiet", "--no-deps"]
        install += ["--target", library, "--only-binary", ":all:", "--python-version", "3.13"]
        install += ["--platform", "manylinux_2_28_aarch64", "--platform", "manylinux_2_27_aarch64"]
        run([*install, "--requirement", SCRIPTS / "requirements-arm64.txt", wheel])
        words = ["-m", "pytest", "-q", "-p", "no:cacheprovider"]
        words += [ROOT / "tests" / "native" / f"test_{name}.py" for name in TESTS]
        python = [f"/{QEMU}", "/usr/bin/python3", *words]
        variables = {"PYTHONPATH": str(library), "PYTHONDONTWRITEBYTECODE": "1"}
        run(
            debian.inside(python, shared=[ROOT], root=folder(), **variables),
            timeout=TEST_SECONDS,
        )
