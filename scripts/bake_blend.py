"""The .blend half of bake.py: bakes every Boucle cloth of a file, in the embedded Blender or in another one.

In the embedded Blender (the bpy package) everything happens in this process. Another Blender runs in background as a process
of its own and tells every frame on its standard output; a request to stop is passed on to it.
"""

from __future__ import annotations

import importlib.util
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import bake_blend_inside as inside
import bake_lock
import embedded
from bake_progress import Progress, progress_on

DONE, WRONG_INPUT = 0, 2


def main(
    path: str,
    out: str | None,
    frames: tuple[int, int] | None,
    threads: int,
    overrides: Sequence[str],
    resume: bool,
    quiet: bool,
    blender: str | None,
) -> int:
    """Bake every cloth of a .blend and return the exit code of bake.py.

    Args:
        path: The .blend file.
        out: Folder of the result; each cloth's own cache, and the file is saved so that it plays it, if None.
        frames: First and last frame to keep.
        threads: 0 takes every core.
        overrides: "OBJECT.property=value" each, TOML values.
        resume: Go on where a stopped bake left off.
        quiet: Show no progress.
        blender: Program of the Blender that opens the file; the embedded one if None.
    """
    if not Path(path).is_file():
        return refuse(f"{path} is missing; accepted: a .blend file")
    request = {
        "path": str(Path(path).resolve()),
        "out": str(Path(out).resolve()) if out else None,
        "frames": list(frames) if frames else None,
        "threads": threads,
        "overrides": list(overrides),
        "resume": resume,
    }
    try:
        with (
            bake_lock.held(result_folder(request)),
            tempfile.TemporaryDirectory(prefix="boucle") as folder,
            stop_request() as stop,
            ExitStack() as stack,
        ):
            teller = Teller(quiet, stack)
            if blender is None:
                return run_here(request, Path(folder), teller, stop)
            return run_in(blender, request, Path(folder), teller, stop)
    except bake_lock.Busy as busy:
        return refuse(str(busy))


def result_folder(request: Mapping[str, Any]) -> Path:
    """Where the bake goes: --out, or the file's own cache folder."""
    if request["out"]:
        return Path(request["out"])
    blend = Path(request["path"])
    return blend.parent / "boucle_cache" / blend.stem


def refuse(message: str) -> int:
    """Say in one line what is wrong with the input."""
    print(f"bake.py: {message}", file=sys.stderr, flush=True)
    return WRONG_INPUT


class Teller:
    """Shows what the bake tells: a progress of its own for each cloth."""

    def __init__(self, quiet: bool, stack: ExitStack) -> None:
        self._quiet = quiet
        self._stack = stack
        self._progress: Progress | None = None

    def tell(self, event: Mapping[str, Any]) -> None:
        """Hear an event: a cloth begins, a frame is done, a sentence, or a complaint."""
        kind = event["kind"]
        if kind == "complaint":
            print(f"bake.py: {' '.join(event['text'].split())}", file=sys.stderr, flush=True)
        elif kind == "cloth":
            self._stack.close()
            self._progress = self._stack.enter_context(progress_on(self._quiet))
            self._progress.say(event["text"])
        elif self._progress is not None and kind == "frame":
            self._progress.tell(event)
        elif self._progress is not None:
            self._progress.say(event["text"])


class StopRequest:
    """Ctrl-C or SIGTERM, taken as a request to stop after the frame that is being simulated."""

    def __init__(self) -> None:
        self.is_asked = False
        self._process: subprocess.Popen[str] | None = None

    def __call__(self, _number: int, _frame: object) -> None:
        """Hear the signal."""
        self.is_asked = True
        if self._process is not None:
            self._process.send_signal(signal.SIGINT)

    def pass_on_to(self, process: subprocess.Popen[str]) -> None:
        """Let another Blender hear it, too."""
        self._process = process
        if self.is_asked:
            process.send_signal(signal.SIGINT)


@contextmanager
def stop_request() -> Iterator[StopRequest]:
    """Listen to requests to stop."""
    request = StopRequest()
    kept = {number: signal.signal(number, request) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield request
    finally:
        for number, handler in kept.items():
            signal.signal(number, handler)


def run_here(request: dict[str, Any], folder: Path, teller: Teller, stop: StopRequest) -> int:
    """Bake in the embedded Blender."""
    embedded.start(folder / "user")
    return inside.bake_file(request, teller.tell, lambda: stop.is_asked)


def run_in(
    blender: str,
    request: dict[str, Any],
    folder: Path,
    teller: Teller,
    stop: StopRequest,
) -> int:
    """Bake in another Blender, in background."""
    extensions = folder / "user" / "extensions" / "user_default"
    extensions.mkdir(parents=True)
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(embedded.ROOT / "addon", extensions / "boucle", ignore=ignored)
    request_file = folder / "request.json"
    request_file.write_text(json.dumps({**request, "module": str(copy_module(folder))}))
    command = [blender, "--background", "--factory-startup", "--python-exit-code", "1"]
    command += ["--python", str(Path(inside.__file__)), "--", str(request_file)]
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(folder / "user")}
    errors = folder / "errors.txt"
    try:
        with errors.open("w") as standard_error:
            process = subprocess.Popen(
                command, env=environment, stdout=subprocess.PIPE, stderr=standard_error, text=True
            )
    except OSError as error:
        return refuse(f"--blender {blender} cannot be started ({error.strerror})")
    stop.pass_on_to(process)
    return follow(process, teller, errors)


def copy_module(folder: Path) -> Path:
    """A folder with the compiled module and nothing else, so that the other Python finds no strange packages."""
    target = folder / "module"
    target.mkdir()
    origin = Path(importlib.util.find_spec("boucle_core").origin)
    if origin.name == "__init__.py":
        shutil.copytree(origin.parent, target / "boucle_core")
    else:
        shutil.copy(origin, target)
    return target


def follow(process: subprocess.Popen[str], teller: Teller, errors: Path) -> int:
    """Show what the other Blender tells until it ends."""
    said = False
    for line in process.stdout:
        if line.startswith(inside.MARK):
            event = json.loads(line[len(inside.MARK) :])
            said = said or event["kind"] == "complaint"
            teller.tell(event)
    code = process.wait()
    if code != DONE and not said:
        last_words = errors.read_text(errors="replace").strip().splitlines()
        reason = last_words[-1] if last_words else f"exit code {code}"
        teller.tell({"kind": "complaint", "text": f"Blender ended before the bake: {reason}"})
    return code if code >= 0 else inside.FAULT
