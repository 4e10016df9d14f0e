"""What the user can do: each operator checks, calls the bridge and reports."""

from . import (
    add,
    apply,
    bake,
    cache,
    cloth,
    copy_from_cloth,
    drape,
    export,
    grab,
    material,
    presets,
    problems,
    proxy,
    sewing,
    starters,
    takes,
    worst,
)

_MODULES = (
    add,
    apply,
    bake,
    cache,
    cloth,
    copy_from_cloth,
    drape,
    export,
    grab,
    material,
    presets,
    problems,
    proxy,
    sewing,
    starters,
    takes,
    worst,
)

CLASSES = tuple(cls for module in _MODULES for cls in module.CLASSES)
