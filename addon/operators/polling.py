"""Why an operator cannot run now: every `poll` says it."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_tip
from bpy.types import Context

from .. import native
from ..bridge import registry, runtime


def has_mesh(cls: type, context: Context) -> bool:
    """Whether the active object is a mesh of this file."""
    obj = context.object
    if obj is None or obj.type != "MESH":
        cls.poll_message_set(pgettext_tip("Select a mesh object"))
        return False
    return is_own(cls, obj)


def is_in_object_mode(cls: type, context: Context) -> bool:
    """Whether no object is edited: what is added or dressed then is an object of its own."""
    if context.mode != "OBJECT":
        cls.poll_message_set(pgettext_tip("Leave Edit Mode first"))
        return False
    return True


def has_cloth(cls: type, context: Context) -> bool:
    """Whether the active object is a Boucle cloth of this file."""
    if not has_mesh(cls, context):
        return False
    if not context.object.boucle.enabled:
        cls.poll_message_set(f'"{context.object.name}" is no Boucle cloth: enable it first')
        return False
    return True


def can_simulate(cls: type, context: Context) -> bool:
    """Whether the active cloth can be simulated now."""
    return has_cloth(cls, context) and is_free(cls)


def is_free(cls: type) -> bool:
    """Whether the compiled module is there and no bake runs."""
    if native.problem():
        cls.poll_message_set(native.problem())
        return False
    if runtime.busy:
        cls.poll_message_set(pgettext_tip("A bake or a grab is running: wait for it or press Esc"))
        return False
    return True


def is_own(cls: type, obj: bpy.types.Object) -> bool:
    """Whether this file may change the object."""
    if obj.library is not None:
        cls.poll_message_set(f'"{obj.name}" is linked: make a library override of it first')
        return False
    return True


def cloths_of(context: Context) -> list[bpy.types.Object]:
    """The cloths of the scene, in the order of their names."""
    return sorted(registry.cloths_of(context.scene), key=lambda obj: obj.name)
