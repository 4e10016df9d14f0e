"""The rest shape and shrink."""

from bpy.props import BoolProperty, FloatProperty, StringProperty

from .changes import FIXED, OVERRIDABLE, changed


class RestProperties:
    """Settings of the lengths that springs have at rest."""

    use_dynamic_mesh: BoolProperty(
        name="Dynamic Mesh",
        description="Rest lengths follow the mesh at every frame as shape keys and the modifiers above Boucle's leave it",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    rest_shape_key: StringProperty(
        name="Rest Shape Key",
        description="Shape key whose lengths and areas are those of the cloth at rest; it starts from the shape that is "
        "shown. Empty for the shape that is shown",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    shrink_min: FloatProperty(
        name="Shrinking Factor",
        description="By which fraction rest lengths are less; below 0 the cloth grows. With a Shrink Group, where its "
        "weight is 0",
        default=0.0, min=-10.0, max=0.99, soft_min=-1.0, soft_max=0.9, precision=3, step=5,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    shrink_group: StringProperty(
        name="Shrink Group",
        description="Vertex group that says where the cloth shrinks more; empty for the same everywhere",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    shrink_max: FloatProperty(
        name="Max Shrinking",
        description="By which fraction rest lengths are less where the weight in the Shrink Group is 1",
        default=0.0, min=-10.0, max=0.99, soft_min=-1.0, soft_max=0.9, precision=3, step=5,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
