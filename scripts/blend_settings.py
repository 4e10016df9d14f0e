"""Settings of a .blend by name, for --set; runs inside Blender.

`OBJECT.property` is a setting of a Boucle cloth. A Blender data path is any property of the file, as Blender's own interface
copies it (Copy Full Data Path), with or without `bpy.data.` before it:

```text
objects["Cloth"].boucle.shear       scenes["Shot"].gravity[2]       objects["Fan"].field.strength
objects["Ball"].location            objects["Ball"]["size"]         materials["Silk"].roughness
```

Nothing is evaluated as a program: a path is names, and numbers and texts in brackets.
"""

from __future__ import annotations

import difflib
import importlib
import json
import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

MODULE = "bl_ext.user_default.boucle"
STEP = re.compile(r'\.([A-Za-z_]\w*)|\[(\d{1,9})\]|\[("(?:[^"\\]|\\.)*")\]')
SIMPLE = {"BOOLEAN", "INT", "FLOAT", "STRING", "ENUM"}

Step = tuple[str, str | int]
"""("name", attribute) or ("key", number or text)."""


class WrongInput(Exception):
    """The file or the command line is wrong; one sentence."""


@dataclass(frozen=True)
class Setting:
    """A property of the file that is open, found anew at each use: no reference into Blender is kept."""

    path: tuple[Step, ...]

    def write(self, value: Any) -> None:
        """Set it to a value that it has had."""
        _set(_walk(self.path[:-1]), self.path[-1], value)


def change(words: Sequence[str]) -> list[tuple[Setting, Any]]:
    """Set what --set says, with TOML values, and return what it was before.

    Raises:
        WrongInput: There is no such setting, or the value is not accepted.
    """
    before = []
    for text in words:
        path, written = _data_path(text) or _cloth_path(text)
        before.append((Setting(path), _change(path, written, text)))
    return before


def _data_path(text: str) -> tuple[tuple[Step, ...], str] | None:
    """The path of a Blender data path, and the value's text; nothing if it is none."""
    import bpy

    found = re.match(r"\s*(?:bpy\.data\.)?([a-z_]+)(?=\[)", text)
    if found is None or not _is_collection(bpy.data, found[1]):
        return None
    path: list[Step] = [("name", found[1])]
    at = found.end()
    while step := STEP.match(text, at):
        name, number, quoted = step.groups()
        if name is not None:
            path.append(("name", name))
        else:
            path.append(("key", json.loads(quoted) if number is None else int(number)))
        at = step.end()
    rest = text[at:].lstrip()
    if not rest.startswith("=") or len(path) < 3:
        raise WrongInput(
            f'--set {text}: the data path cannot be read; accepted: objects["NAME"].property=value'
        )
    return tuple(path), rest[1:]


def _is_collection(owner: Any, name: str) -> bool:
    prop = owner.bl_rna.properties.get(name)
    return prop is not None and prop.type == "COLLECTION"


def _cloth_path(text: str) -> tuple[tuple[Step, ...], str]:
    """The path of a cloth's setting, OBJECT.property, and the value's text."""
    import bpy

    target, equals, written = text.partition("=")
    name, dot, key = target.strip().rpartition(".")
    if not equals or not dot:
        raise WrongInput(f"--set {text}; accepted: OBJECT.property=value")
    obj = bpy.data.objects.get(name)
    registry = importlib.import_module(f"{MODULE}.bridge.registry")
    names = [obj.name for obj in registry.local_cloths()]
    if obj is None or obj.name not in names:
        raise WrongInput(f'--set {text}: "{name}" is no Boucle cloth; accepted: {listed(names)}')
    settable = [p.identifier for p in obj.boucle.bl_rna.properties if _is_settable(p)]
    settable = [name for name in settable if name not in {"name", "rna_type", "enabled"}]
    if key not in settable:
        raise WrongInput(f'--set {text}: "{key}" is no setting; accepted: {listed(settable)}')
    return (("name", "objects"), ("key", obj.name), ("name", "boucle"), ("name", key)), written


def _is_settable(prop: Any) -> bool:
    return not prop.is_readonly and not prop.is_hidden


def _change(path: tuple[Step, ...], written: str, text: str) -> Any:
    """Set one property and return what it was. What Blender itself would cut without a word is refused."""
    try:
        value = tomllib.loads(f"value = {written.strip()}")["value"]
    except tomllib.TOMLDecodeError as error:
        raise WrongInput(
            f"--set {text}: {written.strip()} is no TOML value ({error}); accepted: a number, "
            "a text in quotes, true, false, or a list"
        ) from error
    place = _walk(path[:-1], text)
    before = _get(place, path[-1], text)
    prop = _property(path, text)
    if prop is None:
        check_kind(before, value, text)
    else:
        value = checked(prop, value, text)
    if hasattr(before, "__len__") and not isinstance(before, str | set):
        before = tuple(before)
    try:
        _set(place, path[-1], value)
    except (TypeError, ValueError, AttributeError) as error:
        reason = str(error).rpartition(": ")[2]
        raise WrongInput(f"--set {text} is not accepted ({' '.join(reason.split())})") from error
    return before


def _walk(path: Sequence[Step], text: str = "") -> Any:
    """What a path leads to."""
    import bpy

    place: Any = bpy.data
    for step in path:
        place = _get(place, step, text)
        if place is None:
            raise WrongInput(f'--set {text}: "{step[1]}" is empty; accepted: a path to a value')
    return place


def _get(place: Any, step: Step, text: str) -> Any:
    kind, name = step
    if kind == "name":
        properties = getattr(getattr(place, "bl_rna", None), "properties", {})
        if name not in properties:
            known = list(properties.keys())
            near = difflib.get_close_matches(str(name), known, 5, 0.5) or known[:20]
            raise WrongInput(f'--set {text}: there is no "{name}"; accepted: {listed(near)}')
        return getattr(place, str(name))
    try:
        return place[name]
    except (KeyError, IndexError, TypeError) as error:
        known = list(place.keys())[:20] if hasattr(place, "keys") else []
        accepted = listed(known) if known else "what the file holds"
        raise WrongInput(f'--set {text}: there is no "{name}"; accepted: {accepted}') from error


def _set(place: Any, step: Step, value: Any) -> None:
    kind, name = step
    if kind == "name":
        setattr(place, str(name), value)
    else:
        place[name] = value
    owner = getattr(place, "id_data", None) or getattr(place, "owner", None)
    if hasattr(owner, "update_tag"):
        owner.update_tag()  # a custom property moves its drivers only so


def _property(path: tuple[Step, ...], text: str) -> Any:
    """The description of the property that a path ends at; nothing for a custom one.

    Raises:
        WrongInput: It cannot be set, or not to good use.
    """
    names = path[:-1] if path[-1][0] == "key" and path[-2][0] == "name" else path
    if names[-1][0] == "key":
        return None
    place = _walk(names[:-1], text)
    prop = place.bl_rna.properties[names[-1][1]]
    if names is not path and not getattr(prop, "is_array", False):
        return None
    if prop.type not in SIMPLE or prop.is_readonly or prop.identifier == "name":
        raise WrongInput(
            f'--set {text}: "{prop.identifier}" cannot be set; accepted: numbers, vectors, texts, '
            "choices and switches"
        )
    if _is_cloth_setting(path):
        return prop  # keyed ones are known to the bake: it takes them at its first frame, or follows them
    animation = importlib.import_module(f"{MODULE}.bridge.animation")
    owner = place.id_data
    own_path = place.path_from_id(prop.identifier)
    if owner is not None and animation.moves(owner, own_path):
        raise WrongInput(
            f"--set {text}: its keys or its driver would set it back at every frame; accepted: a "
            "property without either"
        )
    return prop


def _is_cloth_setting(path: tuple[Step, ...]) -> bool:
    return path[0] == ("name", "objects") and path[2] == ("name", "boucle")


def checked(prop: Any, value: Any, text: str) -> Any:
    """A value as a property takes it.

    Raises:
        WrongInput: It is of another kind, or out of range.
    """
    if prop.type == "FLOAT" and isinstance(value, int) and not isinstance(value, bool):
        value = float(value)
    if prop.type in {"INT", "FLOAT"}:
        check_range(prop, value, text)
    if prop.type == "BOOLEAN" and not isinstance(value, bool | list):
        raise WrongInput(f"--set {text}; accepted: true or false")
    if prop.type == "ENUM" and prop.is_enum_flag and isinstance(value, list):
        return set(value)
    return value


def check_range(prop: Any, value: Any, text: str) -> None:
    """Refuse numbers that are none, or out of range."""
    numbers = value if isinstance(value, list) else [value]
    kinds = int if prop.type == "INT" else (int, float)
    for number in numbers:
        is_number = isinstance(number, kinds) and not isinstance(number, bool)
        if not is_number or not prop.hard_min <= number <= prop.hard_max:
            kind = "a whole number" if prop.type == "INT" else "a number"
            raise WrongInput(
                f"--set {text}; accepted: {kind} from {prop.hard_min:g} to {prop.hard_max:g}"
            )


def check_kind(before: Any, value: Any, text: str) -> None:
    """Refuse a custom property's value of another kind than it has."""
    kinds = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}
    kind = type(before)
    is_same = type(value) is kind or (kind is float and type(value) is int)
    if kind not in kinds or not is_same or value != value:
        raise WrongInput(f"--set {text}; accepted: {kinds.get(kind, 'a simple custom property')}")


def listed(names: Sequence[str]) -> str:
    """Names for a sentence."""
    return ", ".join(f'"{name}"' for name in names) or "none"
