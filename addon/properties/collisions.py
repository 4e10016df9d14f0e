"""What the cloth collides with, how thick and how rough it is. Objects' own numbers are those of their Collision physics."""

import bpy
from bpy.props import BoolProperty, FloatProperty, PointerProperty, StringProperty

from .changes import FIXED, OVERRIDABLE, changed, thickness_switched


class CollisionProperties:
    """Settings of the contact of one cloth."""

    in_presets = ("friction",)

    thickness: FloatProperty(
        name="Thickness",
        description="How far the cloth reaches around its surface (m): nothing comes nearer. A quarter to a half of "
        "an edge works best; more is slow. Toward an object the Outer Thickness of its Collision physics is kept "
        "free besides",
        default=0.002, min=1e-5, max=100.0, soft_min=0.0005, soft_max=0.05, precision=4, step=0.1, unit="LENGTH",
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    show_thickness: BoolProperty(
        name="Show Thickness",
        description="Draw both sides of the cloth in the viewport, as far from its surface as it is thick",
        default=False, options=FIXED, override=OVERRIDABLE, update=thickness_switched,
    )  # fmt: skip
    friction: FloatProperty(
        name="Friction",
        description="Coefficient of friction of the cloth (the ratio of two forces): at 0 it slides off, at 1 it "
        "hardly slides. With an object the geometric mean of both counts; the object's is a hundredth of the "
        "Friction in its Collision physics (5 is 0.05)",
        default=0.3, min=0.0, max=100.0, soft_max=1.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    object_collision: BoolProperty(
        name="Object Collisions",
        description="Collide with the objects whose Collision modifier is on. Without it cloth falls through "
        "everything, in less time a frame",
        default=True, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    collision_group: StringProperty(
        name="Vertex Group",
        description="Triangles with all vertices in this group do not collide with objects; empty for none",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    collision_collection: PointerProperty(
        type=bpy.types.Collection,
        name="Collision Collection",
        description="Collide only with objects of this collection and of those in it; empty for all of the scene",
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    self_collision: BoolProperty(
        name="Self Collisions",
        description="Collide with the cloth itself. Without it folds pass through each other, in less time a frame",
        default=True, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    self_collision_group: StringProperty(
        name="Vertex Group",
        description="Triangles with all vertices in this group do not collide with the cloth itself; empty for none",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
