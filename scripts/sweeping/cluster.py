"""Runs on a Dask cluster whose machines see the folders of the scene, the scripts and the result under the same names.

The scheduler gives the runs of a worker that dies to others. When the scheduler itself is lost, we try to reach it again for
a while and hand over what is not whole. A worker may bake a run that another one has finished in the meantime, or hands back
what it finds: only one result gets the run's place.
"""

from __future__ import annotations

import contextlib
import logging
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from .run import Job, record_failure

SCRIPTS = Path(__file__).resolve().parent.parent
CONNECT_SECONDS = 10.0
SECONDS_BETWEEN_LOOKS = 2.0
MOST_HANDED_OVER = 256
"""Runs that the scheduler has at a time; more would only make it and us slower."""
MOST_VAIN_CONNECTIONS = 5
"""So many connections in a row may break before any run ends on them."""

Warn = Callable[[str], None]


class Lost(Exception):
    """The scheduler is not there, or not any more; one sentence."""


class _Disconnected(Exception):
    """The connection broke."""


def outcomes(
    jobs: Sequence[Job], address: str, patience: float, warn: Warn
) -> Iterator[dict[str, Any]]:
    """Bake all runs and yield what became of each, in the order in which they end.

    Closing the generator takes back what has not ended.

    Args:
        jobs: The runs.
        address: The scheduler's, tcp://HOST:PORT.
        patience: How long (s) to look for a scheduler that was lost.
        warn: Hears what is wrong, in one line.

    Raises:
        Lost: The scheduler cannot be reached.
    """
    logging.disable(
        logging.CRITICAL
    )  # Dask logs tracebacks of every broken connection: we say it in a line
    remaining = {job["run"]: job for job in jobs}
    client = _connect(address, CONNECT_SECONDS)
    vain = 0
    while True:
        before = len(remaining)
        try:
            yield from _collect(client, remaining, address, warn)
        except _Disconnected:
            warn(f"the connection to {address} is lost; trying again for {patience:g} s")
        finally:
            _close(client)
        if not remaining:
            return
        vain = vain + 1 if len(remaining) == before else 0
        if vain == MOST_VAIN_CONNECTIONS:
            raise Lost(f"the connection to {address} broke {vain} times without a run ending on it")
        client = _connect(address, patience)


def _connect(address: str, seconds: float) -> Any:
    import distributed

    until = time.monotonic() + seconds
    while True:
        left = until - time.monotonic()
        try:
            return distributed.Client(address, timeout=max(1.0, left))
        except OSError as error:  # a refusal, or the time is up
            if time.monotonic() >= until:
                raise Lost(f"no scheduler answers at {address}") from error
        time.sleep(0.5)


def _collect(
    client: Any, remaining: dict[str, Job], address: str, warn: Warn
) -> Iterator[dict[str, Any]]:
    """Hand over what remains, take it out as it ends, and yield its outcome.

    Dask gives a run up when several workers have died that had it, also if it was another one that they died of. Such runs
    are baked again at the end, one at a time: then it is clear which one is at fault.
    """
    import distributed

    task = _task()

    def hand_over(name: str) -> None:
        key = f"boucle-{uuid.uuid4().hex[:8]}-{name}"
        futures[client.submit(task, str(SCRIPTS), dict(remaining[name]), key=key)] = name

    waiting, suspects = deque(remaining), deque[str]()
    suspected: set[str] = set()
    futures: dict[Any, str] = {}
    has_workers = True
    try:
        while futures or waiting or suspects:
            while waiting and len(futures) < MOST_HANDED_OVER:
                hand_over(waiting.popleft())
            if not futures:
                hand_over(suspects.popleft())
            try:
                pending = list(futures)
                done = distributed.wait(pending, SECONDS_BETWEEN_LOOKS, "FIRST_COMPLETED").done
            except TimeoutError:
                if client.status != "running":
                    raise _Disconnected from None
                has_workers = _look_for_workers(client, has_workers, address, warn)
                continue
            except distributed.CancelledError as error:
                raise _Disconnected from error
            for future in done:
                name = futures[future]
                try:
                    outcome = _outcome(future, remaining[name])
                except distributed.KilledWorker as error:
                    if name not in suspected:
                        del futures[future]
                        suspected.add(name)
                        suspects.append(name)
                        continue
                    outcome = record_failure(remaining[name], f"workers died over it ({error})")
                del futures[future]
                job = remaining.pop(name)
                yield outcome or record_failure(job, "its worker took the sweep for ended")
    finally:
        with contextlib.suppress(Exception):
            client.cancel(list(futures))


def _task() -> Callable[[str, dict[str, Any]], dict[str, Any] | None]:
    """What a worker is sent. A function made here travels whole, so that workers need not have our scripts in their path."""

    def bake(scripts: str, job: dict[str, Any]) -> dict[str, Any] | None:
        import sys

        if scripts not in sys.path:
            sys.path.append(scripts)  # last: the worker's own packages come first
        from sweeping.run import perform

        return perform(job)

    return bake


def _outcome(future: Any, job: Job) -> dict[str, Any] | None:
    """What a future that has ended holds.

    Raises:
        _Disconnected: Nothing, since it has been lost with the scheduler.
        distributed.KilledWorker: Nothing, since workers died that had it.
    """
    import distributed

    if future.status in {"cancelled", "lost"}:
        raise _Disconnected
    try:
        return future.result(timeout=30)
    except distributed.KilledWorker:
        raise
    except (TimeoutError, distributed.CancelledError, distributed.comm.CommClosedError) as error:
        raise _Disconnected from error
    except Exception as error:  # noqa: BLE001 - whatever a worker raises is that run's failure alone
        return record_failure(
            job, f"its worker could not bake it ({type(error).__name__}: {error})"
        )


def _look_for_workers(client: Any, has_workers: bool, address: str, warn: Warn) -> bool:
    """Say once that nobody is there to bake."""
    try:
        count = len(client.nthreads())
    except Exception as error:  # the connection broke just now, in one of many ways
        raise _Disconnected from error
    if not count and has_workers:
        warn(f"no worker is at {address}; waiting for one: dask worker {address} --nthreads 1")
    return bool(count)


def _close(client: Any) -> None:
    with contextlib.suppress(Exception):
        client.close(timeout=2)
