"""Bake a scene or a .blend file without a window.

Exit codes: 0 done; 2 the input is wrong, told in one line; 3 the simulation diverged, or would from
a frame on, because strained springs need smaller steps than were set; 4 the cache cannot be written;
130 stopped by the user. After 3, 4 and 130 the frames so far are kept, and after 130 `--resume` goes on.

A .blend with `--out` stays as it is; cloths whose files there would be the same ones are refused. Without `--out` each cloth
gets its own cache, and the file is saved with its own settings, not those of `--set`, so that it plays the frames; it is
not saved if there are none.

Ctrl-C (or SIGTERM) is heard at the end of the frame that is being simulated. One bake at a time goes into a folder: another
one is refused while the first runs.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import re
import signal
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NoReturn, Protocol

import bake_lock
from bake_progress import Progress, progress_on

DONE, FAULT, WRONG_INPUT, DIVERGED, CACHE, STOPPED = 0, 1, 2, 3, 4, 130


class WrongUsage(Exception):
    """The command line is wrong. The message is one line."""


class Parser(argparse.ArgumentParser):
    """Tells wrong usage in one line."""

    def error(self, message: str) -> NoReturn:
        """Refuse the command line."""
        raise WrongUsage(f"{message} (bake.py --help tells what is accepted)")


class Bake(Protocol):
    """`boucle_core`, as far as a bake needs it."""

    SceneError: type[Exception]
    DivergedError: type[Exception]
    UnstableError: type[Exception]
    CacheError: type[Exception]

    def bake(self, scene: str, out: str, **options: object) -> Mapping[str, object]:
        """Bake a scene file into a folder and return the report."""


def frame_range(text: str) -> tuple[int, int]:
    """The frames that A:B means."""
    match = re.fullmatch(r"(-?\d{1,9}):(-?\d{1,9})", text)
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r} is no range of frames; accepted: A:B")
    return int(match[1]), int(match[2])


def thread_count(text: str) -> int:
    """The number of threads that was written."""
    if not re.fullmatch(r"\d{1,4}", text) or int(text) > 1024:
        raise argparse.ArgumentTypeError(f"{text!r}; accepted: 1 to 1024, or 0 for every core")
    return int(text)


def parser() -> Parser:
    """The command line of this script."""
    lines = Parser(prog="bake.py", description=__doc__, allow_abbrev=False)
    lines.add_argument("file", nargs="?", metavar="SCENE.toml|FILE.blend", help="what to bake")
    lines.add_argument(
        "--out",
        metavar="DIR",
        help="folder of the result; without it out/NAME for a scene, the file's own cache folder for a .blend",
    )
    lines.add_argument(
        "--frames",
        metavar="A:B",
        type=frame_range,
        help="frames to keep; the simulation begins at the scene's first frame all the same",
    )
    lines.add_argument(
        "--threads", metavar="N", type=thread_count, default=0, help="every core by default"
    )
    lines.add_argument(
        "--set",
        metavar="key.path=value",
        dest="overrides",
        nargs="+",
        action="extend",
        default=[],
        help="overrides a key of the scene (cloth.0.density=0.3, cloth.curtain.springs.shear=50; TOML values), "
        "or a property of a .blend (OBJECT.property=value)",
    )
    lines.add_argument("--resume", action="store_true", help="go on where a stopped bake left off")
    lines.add_argument("--quiet", action="store_true", help="no progress")
    lines.add_argument("--blender", metavar="PATH", help="the Blender that opens a .blend")
    return lines


def parse(words: Sequence[str]) -> argparse.Namespace:
    """Read the command line.

    Raises:
        WrongUsage: It is not accepted.
    """
    joined = list(words)
    for index in reversed(range(len(joined) - 1)):
        if joined[index] == "--frames" and joined[index + 1].startswith("-"):
            joined[index : index + 2] = [
                f"--frames={joined[index + 1]}"
            ]  # a negative frame is no option
    options = parser().parse_args(joined)
    if options.file is None:
        # A file that follows --set was taken for another override.
        files = [text for text in options.overrides if "=" not in text]
        if not files:
            raise WrongUsage(
                "the file is missing; accepted: bake.py SCENE.toml|FILE.blend [options]"
            )
        options.file = files[0]
        options.overrides.remove(files[0])
    return options


def bake_scene(core: Bake, options: argparse.Namespace) -> int:
    """Bake a TOML scene and return the exit code."""
    out = options.out or str(Path("out") / Path(options.file).stem)
    with bake_lock.held(Path(out)), progress_on(options.quiet) as progress:
        report = core.bake(
            options.file,
            out,
            frames=options.frames,
            threads=options.threads,
            overrides=options.overrides,
            resume=options.resume,
            progress=progress.tell,
        )
    if not options.quiet:
        tell_end(progress, report, out)
    return DONE


def tell_end(progress: Progress, report: Mapping[str, object], out: str) -> None:
    """Say in one line what has been baked."""
    frames = report["frames"]
    worst = max((row["max_strain"] or 0.0 for row in frames), default=0.0)
    progress.say(
        f"{len(frames)} frames in {report['total_seconds']:.1f} s, worst strain {worst:.2%}: {out}"
    )


def bake_blend(options: argparse.Namespace) -> int:
    """Bake every cloth of a .blend and return the exit code."""
    import bake_blend as blend

    return blend.main(
        options.file,
        options.out,
        options.frames,
        options.threads,
        options.overrides,
        options.resume,
        options.quiet,
        options.blender,
    )


def complain(message: object) -> None:
    """Tell an error in one line on standard error."""
    line = " ".join(str(message).split())
    with contextlib.suppress(OSError):
        print(f"bake.py: {line}", file=sys.stderr, flush=True)


def take_signals() -> None:
    """Take a request to end (SIGTERM) as Ctrl-C."""

    def stop(_number: int, _frame: object) -> NoReturn:
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, stop)
    signal.signal(signal.SIGINT, stop)  # also where a parent process had Ctrl-C ignored


def run(words: Sequence[str]) -> int:
    """Bake what the command line asks for and return the exit code."""
    try:
        options = parse(words)
    except WrongUsage as wrong:
        complain(wrong)
        return WRONG_INPUT
    if Path(options.file).suffix.lower() == ".blend":
        return bake_blend(options)
    if options.blender is not None:
        complain(f"--blender {options.blender}: accepted only with a .blend")
        return WRONG_INPUT
    try:
        import boucle_core as core
    except ImportError as error:
        complain(f"boucle_core cannot be loaded ({error}); python3 scripts/dev.py build makes it")
        return WRONG_INPUT
    try:
        return bake_scene(core, options)
    except (core.SceneError, bake_lock.Busy) as error:
        complain(error)
        return WRONG_INPUT
    except (core.DivergedError, core.UnstableError) as error:
        complain(f"{error}; the frames before it are kept")
        return DIVERGED
    except core.CacheError as error:
        complain(f"{error}; the frames so far are kept")
        return CACHE


def main(words: Sequence[str]) -> int:
    """Bake what the command line asks for and return the exit code, whatever happens."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # a file name may be no text
    try:
        take_signals()
        return run(words)
    except KeyboardInterrupt:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # once is enough
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        complain("stopped; the frames so far are kept, --resume goes on")
        return STOPPED
    except Exception as error:  # noqa: BLE001 - a fault of our own ends in one line, too
        complain(f"{type(error).__name__}: {error}")
        return FAULT


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
