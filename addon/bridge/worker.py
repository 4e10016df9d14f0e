"""A thread that runs the steps of a bake while the window stays alive."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor, wait

from ..core.bake import Step


class Worker:
    """Runs one step at a time; only `Step.run` happens on its thread."""

    def __init__(self) -> None:
        """Start with nothing to do."""
        self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="boucle")
        self._future: Future[None] | None = None

    def begin(self, step: Step) -> None:
        """Start a step."""
        self._future = self._pool.submit(step.run)

    def is_done(self, seconds: float) -> bool:
        """Whether the step has ended, waiting at most this long."""
        if self._future is None:
            return True
        wait([self._future], timeout=seconds)
        return self._future.done()

    def end(self) -> None:
        """Wait for the step that is running and let the thread go."""
        self._pool.shutdown(wait=True)
