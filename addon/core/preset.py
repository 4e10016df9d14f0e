"""Presets: settings by their names, as TOML that a person can read and mend. A value that does not fit is refused by name."""

from __future__ import annotations

import difflib
import json
import math
import re
import sys
import tomllib
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from .refusal import Refusal

SUFFIX = ".toml"
NONE = "none"
"""Stands for no preset where one may be chosen."""

LONGEST_NAME = 64
_FORBIDDEN = re.compile(r'[<>:"/\\|?*\x00-\x1f\x7f]|^[. ]|[. ]$')
"""What some system does not allow in the name of a file."""
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d|none)(\.|$)", re.IGNORECASE)
_DESCRIPTION, _SETTINGS = "description", "settings"


class Setting(NamedTuple):
    """What a preset may say of one setting."""

    kind: str
    """Blender's type of the property: BOOLEAN, INT, FLOAT or ENUM."""
    minimum: float = -math.inf
    maximum: float = math.inf
    choices: tuple[str, ...] = ()


class Preset(NamedTuple):
    """One preset."""

    description: str
    values: Mapping[str, Any]


Schema = Mapping[str, Setting]
"""The settings that a preset may hold, by name."""


def parse(name: str, text: str, schema: Schema) -> Preset:
    """A preset from its TOML.

    Raises:
        Refusal: It is not TOML, names a setting that there is not, or gives one a value that it does not accept.
    """
    document = _load(name, text)
    values = {k: _checked(name, k, v, schema) for k, v in document.get(_SETTINGS, {}).items()}
    return Preset(document.get(_DESCRIPTION, ""), values)


def description(name: str, text: str) -> str:
    """What a preset says of itself."""
    return _load(name, text).get(_DESCRIPTION, "")


def write(preset: Preset) -> str:
    """The TOML of a preset."""
    lines = [f"{_DESCRIPTION} = {_literal(preset.description)}", "", f"[{_SETTINGS}]"]
    lines += [f"{key} = {_literal(value)}" for key, value in preset.values.items()]
    return "\n".join(lines) + "\n"


def checked_name(name: str, shipped: Iterable[str], own: Iterable[str]) -> str:
    """The name of a new preset, which is that of its file, too.

    Raises:
        Refusal: It cannot be a file's name, or is taken.
    """
    name = name.strip()
    if not name:
        raise Refusal("the preset has no name: type one")
    if len(name) > LONGEST_NAME:
        raise Refusal(f'the preset "{name[:20]}..." has a name of {len(name)} letters: '
                      f"{LONGEST_NAME} are accepted")  # fmt: skip
    if _FORBIDDEN.search(name) or _RESERVED.match(name):
        raise Refusal(
            f'"{" ".join(name.split())}" cannot be the name of a preset: use letters, digits, spaces, "-" and "_"'
        )
    for taken, cure in ((shipped, "choose another"), (own, "delete that one first")):
        if name.casefold() in {one.casefold() for one in taken}:
            raise Refusal(f'the name "{name}" is that of another preset: {cure}')
    return name


def _load(name: str, text: str) -> dict[str, Any]:
    try:
        document = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise Refusal(f'the preset "{name}" is not TOML ({error}): mend or delete it') from error
    kinds = {_DESCRIPTION: str, _SETTINGS: dict}
    for key, value in document.items():
        if not isinstance(value, kinds.get(key, ())):
            raise Refusal(
                f'the preset "{name}": "{key}" has no place: accepted are a text '
                f'"{_DESCRIPTION}" and a table "[{_SETTINGS}]"'
            )
    return document


def _checked(name: str, key: str, value: Any, schema: Schema) -> Any:
    setting = schema.get(key)
    if setting is None:
        near = difflib.get_close_matches(key, schema, 1)
        hint = f'did you mean "{near[0]}"?' if near else f"known are {', '.join(schema)}"
        raise Refusal(f'the preset "{name}": "{key}" is no setting of a preset: {hint}')
    accepted = _refused(value, setting)
    if accepted:
        raise Refusal(
            f'the preset "{name}": {key} is {_literal(value)}, but accepted is {accepted}'
        )
    return float(value) if setting.kind == "FLOAT" else value


def _refused(value: Any, setting: Setting) -> str:
    """What would be accepted instead of a value; empty if the value is."""
    if setting.kind == "BOOLEAN":
        return "" if isinstance(value, bool) else "true or false"
    if setting.kind == "ENUM":
        return "" if value in setting.choices else "one of " + ", ".join(setting.choices)
    kinds, words = (
        ((int,), "a whole number") if setting.kind == "INT" else ((int, float), "a number")
    )
    is_number = isinstance(value, kinds) and not isinstance(value, bool)
    # Whole numbers have no end in TOML, but numbers with a point have.
    is_number = is_number and abs(value) <= sys.float_info.max
    if is_number and setting.minimum <= value <= setting.maximum:
        return ""
    return f"{words} from {setting.minimum:g} to {setting.maximum:g}"


def _literal(value: Any) -> str:
    """A value as TOML."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return json.dumps(value, ensure_ascii=False, default=str)
