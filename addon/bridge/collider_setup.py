"""Making an object a collider of a cloth."""

from __future__ import annotations

import bpy

from ..core.refusal import Refusal
from . import findings

SMALLEST, LARGEST = 0.001, 1.0
"""What Blender accepts as Outer Thickness (m)."""


def make(cloth: bpy.types.Object, scene: bpy.types.Scene, name: str, thickness: float) -> str:
    """Give an object Collision physics with this Outer Thickness (m; 0: the cloth's own); what was done, in a sentence.

    Raises:
        Refusal: It is no mesh of this scene that this file may change.
    """
    other = scene.objects.get(name)
    if other is None or other.type != "MESH" or other == cloth:
        raise Refusal(
            f'"{name}" is no other mesh object of the scene: name one that the cloth meets'
        )
    if other.library is not None:
        raise Refusal(f'"{name}" is linked: make a library override of it first')
    add(other, thickness or cloth.boucle.thickness)
    findings.drop_passing(cloth, name)
    also = []
    if not cloth.boucle.object_collision:
        cloth.boucle.object_collision = True
        also.append("Object Collisions is on now")
    wanted = cloth.boucle.collision_collection
    if wanted is not None and name not in wanted.all_objects:
        also.append(f'put it into the Collision Collection "{wanted.name}", or the cloth misses it')
    text = f'"{name}" is a collider now'
    return f"{text}; {'; '.join(also)}" if also else text


def add(obj: bpy.types.Object, thickness: float, friction: float | None = None) -> None:
    """The Collision modifier, switched on; thickness (m) is kept free around the object, friction is a coefficient."""
    modifier = next((m for m in obj.modifiers if m.type == "COLLISION"), None)
    if modifier is None:
        modifier = obj.modifiers.new("Collision", "COLLISION")
    modifier.show_viewport = True
    obj.collision.use = True
    obj.collision.thickness_outer = min(max(thickness, SMALLEST), LARGEST)
    if friction is not None:
        obj.collision.cloth_friction = 100.0 * friction
