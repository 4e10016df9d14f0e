#!/usr/bin/env python3
"""The Python 3.13 of a Debian 13 folder with Blender 5.2 in it, as a program that tests can name.

BOUCLE_BPY52_PYTHON is set to this file by `dev.py blender52`: run with the arguments of a Python, it runs that Python in the
folder, in the same working folder and with the variables that tests/blender/conftest.py sets. Standard library only.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from pathlib import Path

import debian
from environment import ROOT, SCRIPTS, VENV, heading, run, venv_program

PACKAGES = (
    "python3", "libgl1", "libegl1", "libsm6", "libvulkan1", "libx11-6", "libxfixes3", "libxi6", "libxkbcommon0",
    "libxrender1", "libxxf86vm1",
)  # fmt: skip
"""Python 3.13 is Debian 13's own; the rest is what Blender is linked to."""
PASSED_ON = ("BLENDER_USER_RESOURCES", "PYTHONDONTWRITEBYTECODE", "TMPDIR")
REQUIREMENTS = SCRIPTS / "requirements-bpy52.txt"
TEST_SECONDS = 3600


def library() -> Path:
    """Where the packages for that Python are."""
    return debian.folder().with_name("bpy52")


def stamp() -> Path:
    """The requirements that are installed there."""
    return library() / "requirements.stamp"


def is_ready() -> bool:
    """Whether Blender 5.2 is installed."""
    return stamp().exists() and stamp().read_bytes() == REQUIREMENTS.read_bytes()


def ensure() -> None:
    """Install Blender and its requirements, unless they are there."""
    debian.ensure(*PACKAGES)
    if is_ready():
        return
    with heading("Install Blender 5.2 for the Python of the Debian 13 folder"):
        # Our own pip does it, with its own settings: the folder has none.
        words = [venv_program(VENV, "python"), "-m", "pip", "install", "--quiet", "--no-deps"]
        words += ["--target", library(), "--upgrade", "--no-compile", "--only-binary", ":all:"]
        words += ["--python-version", "3.13", "--ignore-requires-python"]
        for kind in ("manylinux_2_28", "manylinux_2_27", "manylinux_2_17", "manylinux2014"):
            words += ["--platform", f"{kind}_x86_64"]
        run([*words, "--requirement", REQUIREMENTS], timeout=1800)
        # Compiled for the folder's Python: each test starts a Blender anew.
        compiling = ["/usr/bin/python3", "-m", "compileall", "-q", "-j", "0", library()]
        run(debian.inside(compiling, shared=[library()]), timeout=1800)
        shutil.copy2(REQUIREMENTS, stamp())


def test(arguments: list[str]) -> None:
    """Run the Blender tests in version 5.2.

    Raises:
        Missing: This system cannot make the folder.
        Failed: A test failed.
    """
    ensure()
    words = [venv_program(VENV, "python"), "-m", "pytest", "-k", "5.2", "tests/blender", *arguments]
    run(words, timeout=TEST_SECONDS, BOUCLE_BPY52_PYTHON=str(SCRIPTS / "blender52.py"))


def main(arguments: list[str]) -> None:
    """Become the Python in the folder."""
    variables = {name: os.environ[name] for name in PASSED_ON if name in os.environ}
    paths = [Path(path) for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if path]
    named = [Path(value) for value in variables.values() if os.path.isabs(value)]
    folders = (Path(tempfile.gettempdir()), ROOT, library(), Path.cwd(), *paths, *named)
    shared = [path for path in folders if path.exists()]
    variables["PYTHONPATH"] = os.pathsep.join(map(str, [*paths, library()]))
    words = ["env", "-C", Path.cwd(), "/usr/bin/python3", *arguments]
    command = debian.inside(words, shared=shared, hears_signals=True, **variables)
    os.execvp(command[0], command)


if __name__ == "__main__":
    main(sys.argv[1:])
