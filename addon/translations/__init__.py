"""The interface in other languages.

Each language has a folder of TOML files, of the same stems as the panels where they are about one, with lines of
`"English" = "translation"`. Blender looks up labels, tooltips and names of choices by the English text. Sentences
that are put together with names and numbers (status, reports, refusals) are English in every language.
"""

from __future__ import annotations

import tomllib
from pathlib import Path

import bpy

LANGUAGES = {"fr_FR": "fr"}
"""Folders by Blender's names of languages: by a shorter name Blender would miss those of other add-ons."""

_CONTEXTS = ("*", "Operator", "Boucle")
"""Where Blender looks: an operator's name has a context of its own. Blender's own words come first in both; what means
something else here (to Blender, "Stretch" is a verb) is looked up in ours."""


def read(folder: str) -> dict[str, str]:
    """The translations of a language by their English texts."""
    found: dict[str, str] = {}
    for path in sorted((Path(__file__).parent / folder).glob("*.toml")):
        found |= tomllib.loads(path.read_text(encoding="utf-8"))
    return found


def register() -> None:
    """Tell Blender the translations."""
    tables = {
        language: {
            (context, text): translated
            for text, translated in read(folder).items()
            for context in _CONTEXTS
        }
        for language, folder in LANGUAGES.items()
    }
    bpy.app.translations.register(__package__, tables)


def unregister() -> None:
    """Take them back."""
    bpy.app.translations.unregister(__package__)
