"""What inflates the cloth."""

from bpy.props import BoolProperty, FloatProperty, StringProperty

from .changes import FIXED, OVERRIDABLE, changed


class PressureProperties:
    """Settings of the pressure inside one cloth."""

    use_pressure: BoolProperty(
        name="Pressure",
        description="Let pressure push the cloth along the normals of its faces: for balloons, cushions, inflated "
        "coats",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    uniform_pressure_force: FloatProperty(
        name="Pressure",
        description="The part of the pressure that does not depend on the volume (N/m²). More inflates further; "
        "below 0 it sucks",
        default=0.0, min=-1e6, max=1e6, soft_min=-1000.0, soft_max=1000.0, precision=2, step=100,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    use_pressure_volume: BoolProperty(
        name="Custom Volume",
        description="Balance the filling at the Target Volume, not at the volume of the rest shape",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    target_volume: FloatProperty(
        name="Target Volume",
        description="Volume (m³) at which the filling and the air around it balance; 0 for a pressure that does not "
        "depend on the volume",
        default=0.0, min=0.0, max=1e6, soft_max=10.0, precision=4, step=1, unit="VOLUME",
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    pressure_factor: FloatProperty(
        name="Pressure Scale",
        description="Pressure of the air around the filling (N/m²): it adds this times (balanced volume / volume - 1). "
        "The volume of an open mesh ignores its holes",
        default=1000.0, min=0.0, max=1e7, soft_max=1e5, precision=1, step=1000,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    pressure_group: StringProperty(
        name="Pressure Group",
        description="Vertex group by whose weights the pressure acts; empty for the whole cloth. Faces with a weight of 0 "
        "do not count for the volume",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
