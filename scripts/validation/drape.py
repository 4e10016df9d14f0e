"""Drape of named fabrics."""

from __future__ import annotations

from .row import Row

CHAPTER = "drape"


def rows() -> list[Row]:
    """All rows of the chapter."""
    return []
