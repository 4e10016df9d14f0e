"""What the user sees in the Physics tab; panels only lay out."""

from . import (
    cache,
    cloth,
    collisions,
    fabric,
    field_weights,
    forces,
    look,
    overlay,
    presets,
    problems,
    result,
    shape,
    solver,
    springs,
    tailoring,
    takes,
    tear,
    water,
)

_PARENTS = (
    cloth,
    springs,
    fabric,
    shape,
    collisions,
    forces,
    solver,
    cache,
)
"""Blender wants them before their subpanels; where each stands is its `bl_order`."""

_OTHERS = (
    field_weights,
    look,
    overlay,
    presets,
    problems,
    result,
    tailoring,
    takes,
    tear,
    water,
)

CLASSES = tuple(cls for module in (*_PARENTS, *_OTHERS) for cls in module.CLASSES)
