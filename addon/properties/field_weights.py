"""How much of the scene's gravity and force fields a cloth feels, by Blender's names."""

import bpy
from bpy.props import FloatProperty, PointerProperty, StringProperty
from bpy.types import PropertyGroup

from .changes import FIXED, OVERRIDABLE, changed


def _weight(name: str, what: str) -> object:
    return FloatProperty(
        name=name,
        description=f"How much the cloth feels of {what} (fraction): 0 nothing, 1 all, 2 twice of it",
        default=1.0, min=0.0, max=200.0, soft_max=1.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip


def _read_unsupported(weights: object) -> str:
    from ..bridge import fields

    return "\n".join(fields.unsupported(weights.id_data, bpy.context.scene))


class BOUCLE_PG_field_weights(PropertyGroup):
    """How much of each force a cloth feels"""

    collection: PointerProperty(
        type=bpy.types.Collection,
        name="Effector Collection",
        description="Feel only the force fields of this collection and of those in it; empty for all of the scene",
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    gravity: _weight("Gravity", "the scene's gravity")
    all: _weight("All", "all force fields")
    force: _weight("Force", "Force fields")
    vortex: _weight("Vortex", "Vortex fields")
    magnetic: _weight("Magnetic", "Magnetic fields")
    harmonic: _weight("Harmonic", "Harmonic fields")
    wind: _weight("Wind", "Wind fields")
    turbulence: _weight("Turbulence", "Turbulence fields")
    drag: _weight("Drag", "Drag fields")
    unsupported: StringProperty(
        name="Unsupported Fields",
        description="What force fields of the scene do not do to the cloth",
        get=_read_unsupported, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip


class FieldWeightProperties:
    """The weights among the settings of one cloth."""

    field_weights: PointerProperty(
        type=BOUCLE_PG_field_weights,
        name="Field Weights",
        description="How much the cloth feels of gravity and of the scene's force fields",
        override=OVERRIDABLE,
    )  # fmt: skip


CLASSES = (BOUCLE_PG_field_weights,)
