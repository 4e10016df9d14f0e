"""Mass and pins."""

from bpy.props import EnumProperty, FloatProperty, StringProperty

from .changes import FIXED, OVERRIDABLE, changed


class ShapeProperties:
    """Settings of what the cloth weighs and where it is held."""

    in_presets = ("mass_mode", "density", "mass_per_vertex")

    mass_mode: EnumProperty(
        name="Mass",
        description="How the mass is given",
        items=(
            ("density", "By Area", "Mass of a square metre of cloth"),
            ("vertex", "Per Vertex", "Mass of every vertex"),
        ),
        default="density", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    density: FloatProperty(
        name="Density",
        description="Areal density (kg/m²)",
        default=0.2, min=1e-6, max=1e6, soft_min=0.01, soft_max=5.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    mass_per_vertex: FloatProperty(
        name="Mass per Vertex",
        description="Mass of every vertex (kg)",
        default=0.1, min=1e-9, max=1e6, soft_min=1e-4, soft_max=1.0, precision=5, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    pin_group: StringProperty(
        name="Pin Group",
        description="Vertex group whose vertices are held: they follow the object and its armature",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
