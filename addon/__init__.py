"""Boucle: cloth for Blender, simulated by a compiled core.

Registration is a transaction: all steps or none.
"""

import bpy

from . import handlers, native, preferences
from .bridge import live, runtime, thickness_view
from .core.transaction import Step, apply_all, revert_all
from .operators import add, bake, sewing
from .operators import cache as cache_operators
from .operators import cloth as cloth_operators
from .panels import cache as cache_panels
from .panels import cloth as cloth_panels
from .panels import collisions, forces, shape, solver, springs, tailoring
from .properties import cloth as cloth_properties

_CLASSES = (
    *cloth_properties.CLASSES,
    *preferences.CLASSES,
    *add.CLASSES,
    *cloth_operators.CLASSES,
    *sewing.CLASSES,
    *bake.CLASSES,
    *cache_operators.CLASSES,
    *cloth_panels.CLASSES,
    *springs.CLASSES,
    *shape.CLASSES,
    *tailoring.CLASSES,
    *collisions.CLASSES,
    *forces.CLASSES,
    *solver.CLASSES,
    *cache_panels.CLASSES,
)


def _class_step(cls: type) -> Step:
    return Step(
        lambda: bpy.utils.register_class(cls),
        lambda: bpy.utils.unregister_class(cls),
    )


_STEPS = (
    *(_class_step(cls) for cls in _CLASSES),
    Step(cloth_properties.attach, cloth_properties.detach),
    Step(
        lambda: bpy.types.VIEW3D_MT_mesh_add.append(add.draw_menu),
        lambda: bpy.types.VIEW3D_MT_mesh_add.remove(add.draw_menu),
    ),
    Step(
        lambda: bpy.types.PHYSICS_PT_add.append(cloth_panels.draw_button),
        lambda: bpy.types.PHYSICS_PT_add.remove(cloth_panels.draw_button),
    ),
    Step(handlers.register, handlers.unregister),
    Step(lambda: None, thickness_view.end),
    Step(lambda: None, live.drop_all),
)


def register() -> None:
    """Switch the add-on on."""
    apply_all(_STEPS)
    if native.problem():
        runtime.warn(native.problem())


def unregister() -> None:
    """Switch the add-on off: live cloths get their rest shape back first."""
    revert_all(_STEPS)
