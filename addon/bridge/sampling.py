"""What the scene says of a cloth at a frame: where its pins go and how object space lies in the world."""

from __future__ import annotations

import bpy

from .._identifiers import TARGET_ATTRIBUTE
from ..core import points
from ..core.bake import Pose
from ..core.points import Affine, Points
from ..core.refusal import Refusal
from . import mesh_arrays, rest, shape, slot
from .pins import Pins


def is_evaluated(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether the depsgraph knows the object: it may be excluded from the view layer."""
    return obj.evaluated_get(depsgraph) != obj


def object_matrix(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Affine:
    """Object to world space, as evaluated."""
    return mesh_arrays.world_matrix(obj.evaluated_get(depsgraph))


def inverse(obj: bpy.types.Object, matrix: Affine) -> Affine:
    """World to object space.

    Raises:
        Refusal: The object is scaled to nothing.
    """
    found = points.inverse(matrix)
    if found is None:
        scale = ", ".join(f"{value:g}" for value in obj.matrix_world.to_scale())
        raise Refusal(
            f'"{obj.name}": its scale in the world is ({scale}), which flattens it: give every '
            "axis a scale other than 0"
        )
    return found


def targets(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Points:
    """Where the modifiers above the slot put every vertex (m, object space), float32, flat.

    Raises:
        Refusal: The evaluated mesh does not tell, because it was not evaluated or has other vertices.
    """
    if rest.is_displaced(obj.data):
        return rest.positions(obj.data)
    evaluated = obj.evaluated_get(depsgraph)
    attribute = evaluated.data.attributes.get(TARGET_ATTRIBUTE)
    count = len(obj.data.vertices)
    if attribute is None:
        raise Refusal(
            f'"{obj.name}": Blender does not evaluate its modifiers: show the object and its '
            "collection in the viewport, and the modifier that stores Boucle's target"
        )
    hiding = slot.hiding(obj, len(attribute.data), depsgraph.mode == "RENDER")
    if hiding is not None:
        raise Refusal(
            f'"{obj.name}": the modifier "{hiding.name}" below Boucle\'s hides where the pins go: '
            "switch it off in the viewport to play, or bake"
        )
    if len(attribute.data) < count:
        raise Refusal(_other_count(obj, len(attribute.data)))
    return mesh_arrays.read_vectors(attribute)[: 3 * count]


def pose(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, held: Pins) -> Pose:
    """The pose of a cloth at the depsgraph's frame."""
    matrix = object_matrix(obj, depsgraph)
    to_object = inverse(obj, matrix)
    moves_rest = obj.boucle.use_dynamic_mesh
    world = None
    if held.are_there or moves_rest:
        world = points.transform(targets(obj, depsgraph), matrix, "d")
    now = shape.at_frame(obj, obj.evaluated_get(depsgraph), world)
    return Pose(world if held.are_there else None, to_object, now, held.change(obj, depsgraph))


def refuse_other_count(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
    """Refuse a stack whose modifiers above the slot change the vertices.

    The modifiers below the slot must be off.
    """
    evaluated = obj.evaluated_get(depsgraph)
    count = len(evaluated.data.vertices)
    if evaluated != obj and count != len(obj.data.vertices):
        raise Refusal(_other_count(obj, count))


def _other_count(obj: bpy.types.Object, count: int) -> str:
    names = ", ".join(f'"{modifier.name}"' for modifier in slot.above(obj))
    return (
        f'"{obj.name}": the modifiers above Boucle\'s ({names}) make {count} vertices of '
        f"{len(obj.data.vertices)}: move those that add or remove vertices below it"
    )
