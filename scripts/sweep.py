"""Bake one scene or .blend many times, with other parameters each time.

The file says which scene and which runs: a grid, a list or a Latin hypercube (scripts/sweeping/description.py has all its
keys). Every run gets a folder of its own in `--out`, which is whole or not there; a table has the parameters and the
certificate of each, a contact sheet its last frame. Runs go to processes of this machine, or to a Dask cluster whose
machines see the same folders.

Exit codes: 0 all runs are whole; 2 the input is wrong, told in one line; 3 some runs failed (the others are there, the table
says why); 4 the result cannot be written; 5 the Dask scheduler is gone; 130 stopped by the user. After 3, 4, 5 and 130
`--resume` bakes what is not whole.
"""

from __future__ import annotations

import argparse
import os
import re
import signal
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any, NoReturn

import bake_lock
from sweeping import cluster, contact_sheet, description, local, packages, table
from sweeping.description import Sweep
from sweeping.folder import Folder, Other
from sweeping.progress import Progress, progress_of
from sweeping.run import Job

DONE, FAULT, WRONG_INPUT, RUNS_FAILED, CACHE, NO_SCHEDULER, STOPPED = 0, 1, 2, 3, 4, 5, 130


class WrongUsage(Exception):
    """The command line is wrong. The message is one line."""


class Parser(argparse.ArgumentParser):
    """Tells wrong usage in one line."""

    def error(self, message: str) -> NoReturn:
        """Refuse the command line."""
        raise WrongUsage(f"{message} (sweep.py --help tells what is accepted)")


def worker_count(text: str) -> int:
    """The number of processes that was written."""
    if not re.fullmatch(r"\d{1,4}", text) or not 1 <= int(text) <= 1024:
        raise argparse.ArgumentTypeError(f"{text!r}; accepted: 1 to 1024")
    return int(text)


def seconds(text: str) -> float:
    """The duration that was written."""
    if not re.fullmatch(r"\d{1,6}(\.\d{1,6})?", text):
        raise argparse.ArgumentTypeError(f"{text!r}; accepted: seconds")
    return float(text)


def scheduler_address(text: str) -> str:
    """The address that was written."""
    match = re.fullmatch(r"(tcp|tls)://[^\s/:]+(:[^\s/:]+)*:(\d{1,5})", text)
    if match is None or not 1 <= int(match[3]) <= 65535:
        raise argparse.ArgumentTypeError(f"{text!r}; accepted: tcp://HOST:PORT or tls://HOST:PORT")
    return text


def parser() -> Parser:
    """The command line of this script."""
    lines = Parser(prog="sweep.py", description=__doc__, allow_abbrev=False)
    lines.add_argument("file", metavar="SWEEP.toml", type=Path, help="what to sweep")
    lines.add_argument("--out", metavar="DIR", type=Path, help="folder of the result; out/NAME")
    where = lines.add_mutually_exclusive_group()
    where.add_argument(
        "--workers", metavar="N", type=worker_count, help="processes here; one a core by default"
    )
    where.add_argument(
        "--scheduler",
        metavar="tcp://HOST:PORT",
        type=scheduler_address,
        help="a Dask cluster's scheduler",
    )
    lines.add_argument(
        "--patience",
        metavar="SECONDS",
        type=seconds,
        default=60.0,
        help="how long to look for a scheduler that was lost; 60 by default",
    )
    lines.add_argument("--resume", action="store_true", help="bake only what is not there whole")
    lines.add_argument(
        "--table", choices=table.KINDS, help="kind of the table; Parquet if pyarrow is there"
    )
    lines.add_argument("--no-sheet", action="store_true", help="no contact sheet")
    lines.add_argument("--blender", metavar="PATH", help="the Blender that opens a .blend")
    lines.add_argument("--quiet", action="store_true", help="no progress")
    return lines


def core_count() -> int:
    """How many cores this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1


def job_of(
    sweep: Sweep, number: int, out: Path, session: Path, version: str, options: argparse.Namespace
) -> Job:
    """A run as plain data for another process or machine; all paths are absolute."""
    run = sweep.runs[number]
    return Job(
        run=run.name,
        scene=str(sweep.scene.resolve()),
        out=str(out),
        session=str(session),
        boucle=version,
        overrides=sweep.overrides(run),
        parameters=run.parameters,
        frames=sweep.frames,
        timeout=sweep.timeout,
        blender=options.blender,
    )


def bake_all(
    sweep: Sweep, folder: Folder, version: str, options: argparse.Namespace
) -> dict[str, dict[str, Any]]:
    """Bake all runs that are not whole and return what became of each that has ended."""
    found = {run.name: folder.whole(run.name) for run in sweep.runs}
    ended = {name: outcome for name, outcome in found.items() if outcome is not None}
    with (
        folder.session() as session,
        progress_of(len(sweep.runs), len(ended), options.quiet) as progress,
    ):
        if ended:
            progress.say(f"{len(ended)} of {len(sweep.runs)} runs are whole")
        jobs = []
        for number, run in enumerate(sweep.runs):
            if run.name not in ended:
                folder.drop_torn(run.name)
                jobs.append(job_of(sweep, number, folder.path, session, version, options))
        try:
            with closing(results(jobs, options, progress)) as outcomes:
                for outcome in outcomes:
                    ended[outcome["run"]] = outcome
                    progress.tell(outcome["run"], outcome["error"])
        finally:
            keep_table(sweep, folder, options, progress)
    return ended


def results(
    jobs: Sequence[Job], options: argparse.Namespace, progress: Progress
) -> Iterator[dict[str, Any]]:
    """Bake jobs where the command line says, and yield what becomes of each."""
    if jobs and options.scheduler:
        yield from cluster.outcomes(jobs, options.scheduler, options.patience, progress.warn)
    elif jobs:
        yield from local.outcomes(jobs, options.workers or core_count())


def keep_table(
    sweep: Sweep, folder: Folder, options: argparse.Namespace, progress: Progress
) -> None:
    """Write the table of all runs so far."""
    outcomes = {run.name: folder.outcome(run.name) for run in sweep.runs}
    path = table.write(folder.path, options.table, table.rows_of(sweep, outcomes))
    progress.say(f"table: {path}")


def tell_end(sweep: Sweep, ended: Mapping[str, Mapping[str, Any]], out: Path) -> int:
    """Say in one line what became of the sweep, and return the exit code."""
    failed = [outcome for outcome in ended.values() if outcome["status"] != "done"]
    if failed:
        complain(
            f"{len(failed)} of {len(sweep.runs)} runs failed, --resume tries them again: {out}"
        )
        return RUNS_FAILED
    return DONE


def sweep_all(options: argparse.Namespace) -> int:
    """Do what the command line asks for and return the exit code."""
    import boucle_core

    sweep = description.read(options.file)
    if options.blender is not None and sweep.scene.suffix.lower() != ".blend":
        raise WrongUsage(f"--blender {options.blender}: accepted only with a .blend")
    packages.require(options)
    folder = Folder((options.out or Path("out") / options.file.stem).resolve())
    head = {
        "boucle": boucle_core.__version__,
        "scene": str(sweep.scene.resolve()),
        "digest": sweep.digest(),
        "parameters": sweep.parameters,
        "runs": {run.name: run.parameters for run in sweep.runs},
    }
    with bake_lock.held(folder.path):
        folder.prepare(head, options.resume)
        ended = bake_all(sweep, folder, head["boucle"], options)
        if not options.no_sheet:
            sheets = contact_sheet.write(folder, sweep)
            if not options.quiet:
                print(f"contact sheet: {', '.join(map(str, sheets))}", flush=True)
    return tell_end(sweep, ended, folder.path)


def complain(message: object) -> None:
    """Tell an error in one line on standard error."""
    print(f"sweep.py: {' '.join(str(message).split())}", file=sys.stderr, flush=True)


def take_signals() -> None:
    """Take a request to end (SIGTERM) as Ctrl-C."""

    def stop(_number: int, _frame: object) -> NoReturn:
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, stop)
    signal.signal(signal.SIGINT, stop)  # also where a parent process had Ctrl-C ignored


def main(words: Sequence[str]) -> int:
    """Do what the command line asks for and return the exit code, whatever happens."""
    try:
        take_signals()
        return sweep_all(parser().parse_args(words))
    except (WrongUsage, description.Wrong, packages.Missing, Other, bake_lock.Busy) as wrong:
        complain(wrong)
        return WRONG_INPUT
    except ImportError as error:
        complain(f"{error}; python3 scripts/dev.py build makes what is missing")
        return WRONG_INPUT
    except cluster.Lost as lost:
        complain(f"{lost}; what is whole is kept, --resume goes on")
        return NO_SCHEDULER
    except OSError as error:
        complain(f"the result cannot be written ({error}); what is whole is kept, --resume goes on")
        return CACHE
    except KeyboardInterrupt:
        complain("stopped; what is whole is kept, --resume goes on")
        return STOPPED
    except Exception as error:  # noqa: BLE001 - a fault of our own ends in one line, too
        complain(f"{type(error).__name__}: {error}")
        return FAULT


if __name__ == "__main__":
    code = main(sys.argv[1:])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # nothing that a cluster's client has left running may hold up the end
