"""Which way the warp of a fabric runs on a mesh."""

from __future__ import annotations

import bpy

from ..core import points
from ..core.points import Points
from ..core.refusal import Refusal


def uvs(obj: bpy.types.Object) -> Points | None:
    """(u, v) of each corner of the mesh, float32, flat, if the warp follows a UV map.

    Raises:
        Refusal: The mesh has no such map.
    """
    settings = obj.boucle
    if settings.model != "fabric" or settings.warp != "uv":
        return None
    layers = obj.data.uv_layers
    name = settings.warp_uv_map
    layer = layers.get(name) if name else layers.active
    if layer is None:
        known = ", ".join(f'"{one.name}"' for one in layers)
        if name and known:
            raise Refusal(
                f'"{obj.name}": the warp follows the UV map "{name}", which the mesh does not have (it '
                f"has {known}): choose one of them or clear the field"
            )
        raise Refusal(
            f'"{obj.name}": the warp follows a UV map, but the mesh has none: unwrap it (Edit Mode, UV > '
            "Unwrap), or choose an axis under Fabric > Warp"
        )
    found = points.empty("f", 2 * len(obj.data.loops))
    layer.uv.foreach_get("vector", found)
    return found
