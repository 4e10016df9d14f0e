"""The library that is preloaded into a bake, and the environment that tells it what to do."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

SOURCE = Path(__file__).with_suffix(".c")


def build(folder: Path) -> Path:
    """Compile the library into a folder and return its path.

    Raises:
        OSError, subprocess.CalledProcessError: There is no C compiler, or it refused.
    """
    library = folder / "faults.so"
    command = ["cc", "-shared", "-fPIC", "-O1", "-w", "-o", library, SOURCE, "-ldl"]
    subprocess.run(command, check=True, capture_output=True)
    return library


def environment(
    library: Path, kind: str = "", at: int = 0, folder: Path | None = None, clock: str = ""
) -> dict[str, str]:
    """The environment of a bake to which something is done.

    Args:
        library: Of `build`.
        kind: "kill", "full" or "gone"; "" for nothing.
        at: At which operation on files of the folder.
        folder: Where the bake writes.
        clock: "jump" or "hurry"; "" for the right time.
    """
    told = {"LD_PRELOAD": str(library), "BOUCLE_CLOCK": clock}
    if kind:
        told |= {"BOUCLE_FAULT": kind, "BOUCLE_FAULT_AT": str(at), "BOUCLE_FAULT_IN": str(folder)}
    return {**os.environ, **told}
