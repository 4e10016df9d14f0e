"""What operators share whose work may be refused."""

from __future__ import annotations

from collections.abc import Callable

from .. import native
from ..core.refusal import sentence_of


class Attempt:
    """An operator that tries something and reports."""

    def attempt(self, action: Callable[[], str | None], kind: str = "INFO") -> set[str]:
        """Do it and say what it says, in a report of this kind, or why it cannot be done."""
        try:
            text = action()
        except native.FAILURES as error:
            self.report({"ERROR"}, sentence_of(error))
            return {"CANCELLED"}
        if text:
            self.report({kind}, text)
        return {"FINISHED"}
