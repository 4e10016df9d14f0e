"""Wind. Gravity is the scene's."""

from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    StringProperty,
)

from .changes import FIXED, OVERRIDABLE, changed


class ForceProperties:
    """Settings of the wind on one cloth."""

    use_wind: BoolProperty(
        name="Wind",
        description="Let a wind of its own blow on this cloth, besides the scene's force fields",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_velocity: FloatVectorProperty(
        name="Velocity",
        description="Velocity of the wind in the world (m/s): 3 is a light breeze, 10 keeps a flag up, 20 is a gale. "
        "It may be keyed",
        default=(0.0, 3.0, 0.0), min=-1e4, max=1e4, soft_min=-50.0, soft_max=50.0, size=3,
        subtype="VELOCITY", override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_law: EnumProperty(
        name="Law",
        description="How wind becomes force. By Area goes by measured coefficients and is the same on any mesh; Per "
        "Vertex is that of the papers",
        items=(
            ("vertex", "Per Vertex", "A coefficient times the velocity along the vertex normal"),
            ("face", "By Area", "Air pressure on every face"),
        ),
        default="vertex", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_coefficient: FloatProperty(
        name="Coefficient",
        description="Force per velocity along the normal, on every vertex (N·s/m). More blows harder; a finer mesh "
        "has more vertices and needs less",
        default=0.001, min=0.0, max=1e6, soft_max=0.1, precision=5, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_air_density: FloatProperty(
        name="Air Density",
        description="Density of the air (kg/m³): 1.2 near the ground. More pushes harder at the same speed",
        default=1.2, min=0.0, max=1e6, soft_max=10.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_drag: FloatProperty(
        name="Drag Coefficient",
        description="Force on a face across the wind, as a part of the pressure of stopped air (fraction): about 1.2 "
        "for a plate. More lets the wind take the cloth along sooner",
        default=1.0, min=0.0, max=1000.0, soft_max=2.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    use_wind_lift: BoolProperty(
        name="Lift",
        description="Part the force on each face into drag along the wind and lift across it; else the air presses along "
        "the normal alone",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_lift: FloatProperty(
        name="Lift Coefficient",
        description="Force across the wind on a face that is inclined to it, as a part of the same pressure "
        "(fraction). More draws cloth sideways, as a sail",
        default=1.0, min=0.0, max=1000.0, soft_max=2.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_gusts: FloatProperty(
        name="Gusts",
        description="By how much of its velocity the wind grows in a gust at the most; 0 for a steady wind (fraction)",
        default=0.0, min=0.0, max=100.0, soft_max=2.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_gust_period: FloatProperty(
        name="Gust Period",
        description="How long each gust is (s). Long ones swing the whole cloth, short ones shake it",
        default=2.0, min=0.01, max=1e6, soft_max=20.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_turbulence: FloatProperty(
        name="Turbulence",
        description="Spread of the wind's velocity from place to place, as a part of it (fraction): 0.1 to 0.3 near "
        "the ground. More blows more unevenly",
        default=0.0, min=0.0, max=10.0, soft_max=1.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_turbulence_size: FloatProperty(
        name="Turbulence Size",
        description="Size of the largest eddies (m). Large ones move the whole cloth, small ones ripple it",
        default=1.0, min=0.001, max=1e6, soft_max=10.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_seed: IntProperty(
        name="Wind Seed",
        description="Chooses the random gusts and eddies: another number is another wind of the same kind",
        default=1, min=0, max=2**31 - 1, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    use_wind_shelter: BoolProperty(
        name="Shelter",
        description="The air is still behind objects that the cloth collides with: for cloth in the lee of a wall or "
        "a body",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wind_group: StringProperty(
        name="Wind Group",
        description="Vertex group on which the wind blows; empty for the whole cloth",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
