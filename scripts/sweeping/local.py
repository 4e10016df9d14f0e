"""Runs on this machine: one process a core, each with one run at a time.

The processes are started anew, not forked: threads of the solver do not outlive a fork. A process that dies takes only the
run with it that it was baking, which another process bakes again.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Iterator, Sequence
from multiprocessing.connection import Connection, wait
from typing import Any

from .run import Job, perform, record_failure

MOST_DEATHS = 3
"""So many processes may die over one run until it counts as failed: by then it is the run that kills them."""


def outcomes(jobs: Sequence[Job], workers: int) -> Iterator[dict[str, Any]]:
    """Bake all runs and yield what became of each, in the order in which they end.

    Closing the generator ends the processes.
    """
    context = multiprocessing.get_context("spawn")
    waiting = deque(jobs)
    deaths: dict[str, int] = {}
    pool = [_Worker(context) for _ in range(min(workers, len(jobs)))]
    try:
        while True:
            for worker in pool:
                if worker.job is None and waiting:
                    worker.begin(waiting.popleft())
            busy = [worker for worker in pool if worker.job is not None]
            if not busy:
                return
            ready = wait([worker.pipe for worker in busy])
            for worker in busy:
                if worker.pipe not in ready:
                    continue
                job = worker.job
                try:
                    outcome = worker.end()
                except (EOFError, OSError):
                    code = worker.close()
                    pool[pool.index(worker)] = _Worker(context)
                    deaths[job["run"]] = deaths.get(job["run"], 0) + 1
                    if deaths[job["run"]] < MOST_DEATHS:
                        waiting.appendleft(job)
                        continue
                    outcome = record_failure(job, _epitaph(code))
                if outcome is not None:
                    yield outcome
    finally:
        for worker in pool:
            worker.close()


def _epitaph(code: int) -> str:
    how = f"signal {-code}" if code < 0 else f"exit code {code}"
    return f"{MOST_DEATHS} processes died while they baked it (the last one by {how})"


class _Worker:
    """A process that bakes."""

    def __init__(self, context: Any) -> None:
        self.pipe, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs,), daemon=True)
        self.process.start()
        theirs.close()
        self.job: Job | None = None

    def begin(self, job: Job) -> None:
        self.job = job
        with contextlib.suppress(OSError):  # it has died already: `end` tells
            self.pipe.send(job)

    def end(self) -> dict[str, Any] | None:
        """What became of the run.

        Raises:
            EOFError, OSError: The process has died.
        """
        outcome = self.pipe.recv()
        self.job = None
        return outcome

    def close(self) -> int:
        """End the process and return its exit code."""
        self.pipe.close()
        self.process.join(0.2 if self.job is None else 0)
        self.process.kill()
        self.process.join()
        return self.process.exitcode or 0


def _serve(pipe: Connection) -> None:
    """Bake what comes through the pipe until it is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all; the first process decides
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with contextlib.suppress(EOFError, OSError):
        while True:
            pipe.send(perform(pipe.recv()))


def _end_with_parent() -> None:
    wait([multiprocessing.parent_process().sentinel])
    os._exit(130)
