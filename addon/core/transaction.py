"""Registration as a transaction: all steps or none."""

from collections.abc import Callable, Sequence
from typing import NamedTuple


class Step(NamedTuple):
    """One thing to do and how to undo it."""

    apply: Callable[[], object]
    revert: Callable[[], object]


def apply_all(steps: Sequence[Step]) -> None:
    """Apply the steps in order; if one fails, revert those before it and raise its error."""
    done: list[Step] = []
    try:
        for step in steps:
            step.apply()
            done.append(step)
    except BaseException:
        revert_all(done)
        raise


def revert_all(steps: Sequence[Step]) -> None:
    """Revert the steps in reverse order: every one is tried, then the first error is raised."""
    first_error: Exception | None = None
    for step in reversed(steps):
        try:
            step.revert()
        except Exception as error:  # noqa: BLE001 (the other steps must revert; raised below)
            first_error = first_error or error
    if first_error is not None:
        raise first_error
