"""A value as TOML text, as `bake.py --set key=value` reads it."""

from __future__ import annotations

import json
import math
import re
from typing import Any


def text_of(value: Any) -> str:
    """The TOML text of a number, text, true or false, or a list or table of those.

    Raises:
        ValueError: There is no such text: dates, or numbers that are none.
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ValueError(f"{value} is no finite number")
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list):
        return "[" + ", ".join(text_of(each) for each in value) + "]"
    if isinstance(value, dict):
        entries = (f"{key_of(key)} = {text_of(each)}" for key, each in value.items())
        return "{ " + ", ".join(entries) + " }"
    raise ValueError(f"{value} is of no accepted kind")


def key_of(name: str) -> str:
    """A key, in quotes where it needs them."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else text_of(name)
