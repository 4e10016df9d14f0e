"""Wind. Gravity is the scene's."""

from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, StringProperty

from .changes import FIXED, OVERRIDABLE, changed


class ForceProperties:
    """Settings of the wind on one cloth."""

    use_wind: BoolProperty(
        name="Wind",
        description="Let the wind blow on this cloth",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_velocity: FloatVectorProperty(
        name="Velocity",
        description="Velocity of the wind in the world (m/s)",
        default=(0.0, 3.0, 0.0), min=-1e4, max=1e4, soft_min=-50.0, soft_max=50.0, size=3,
        subtype="VELOCITY", override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_law: EnumProperty(
        name="Law",
        description="How wind becomes force",
        items=(
            ("vertex", "Per Vertex", "A coefficient times the velocity along the vertex normal"),
            ("face", "By Area", "Air pressure on every face"),
        ),
        default="vertex", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_coefficient: FloatProperty(
        name="Coefficient",
        description="Force per velocity along the normal, on every vertex (N·s/m)",
        default=0.001, min=0.0, max=1e6, soft_max=0.1, precision=5, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_air_density: FloatProperty(
        name="Air Density",
        description="Density of the air (kg/m³)",
        default=1.2, min=0.0, max=1e6, soft_max=10.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_group: StringProperty(
        name="Wind Group",
        description="Vertex group on which the wind blows; empty for the whole cloth",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
