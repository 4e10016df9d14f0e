"""What a bake remembers, as it is read from a file that anybody may have written."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

_LAST_FRAME = 1_048_574
"""Blender's."""


def of_text(text: str) -> dict[str, Any]:
    """The record that a cloth keeps as JSON; empty if that is none."""
    try:
        return checked(json.loads(text or "{}"))
    except (ValueError, RecursionError):
        return {}


def of_report(content: Mapping[str, Any]) -> dict[str, Any]:
    """The record in the content of a report; empty if there is none."""
    return checked(content.get("bake"))


def checked(record: object) -> dict[str, Any]:
    """A record whose parts are of the kinds that a bake writes; empty if it is of another shape."""
    if not isinstance(record, dict) or "first" not in record:
        return {}
    parts = {name: record[name] for name in _KINDS if name in record}
    return record if all(_KINDS[name](part) for name, part in parts.items()) else {}


def _is_number(part: object) -> bool:
    return type(part) is int and abs(part) < 1 << 31


def _is_frame(part: object) -> bool:
    return _is_number(part) and abs(part) <= _LAST_FRAME


def _is_text(part: object) -> bool:
    return isinstance(part, str)


def _is_settings(part: object) -> bool:
    return isinstance(part, dict)


def _are_names(part: object) -> bool:
    return isinstance(part, dict) and all(map(_is_text, part.values()))


def _are_texts(part: object) -> bool:
    return isinstance(part, list) and all(map(_is_text, part))


_KINDS: dict[str, Callable[[object], bool]] = {
    "first": _is_frame,
    "end": _is_frame,
    "vertices": _is_number,
    "is_part": lambda part: isinstance(part, bool),
    "bake": _is_text,
    "topology": _is_text,
    "settings": _is_settings,
    "together": _are_names,
    "order": _are_texts,
}
