"""The panels in another language, whose words are longer: photographed to see what Blender cuts.

Runs inside Blender, pulled by gui_inside.py.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

from gui_scenario import Skipped, in_view, open_every_panel, photo_of_panels

LANGUAGE = "fr_FR"


def panels_in_french() -> Iterator[Any]:
    """All panels open, in French."""
    view = bpy.context.preferences.view
    for obj in [*bpy.data.objects]:
        bpy.data.objects.remove(obj)
    with in_view():
        bpy.ops.boucle.add_cloth()
    yield from open_every_panel()
    try:
        view.language = LANGUAGE
    except TypeError as error:
        raise Skipped(f"this Blender speaks English only: {error}") from error
    view.use_translate_interface = True
    try:
        yield from photo_of_panels("panels_french")
        return bpy.app.translations.pgettext_iface("Pin Group")
    finally:
        view.language = "DEFAULT"
        view.use_translate_interface = False


STEPS = (panels_in_french,)
