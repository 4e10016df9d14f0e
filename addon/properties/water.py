"""Water around a cloth, and how wet it becomes."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    PointerProperty,
)

from .changes import FIXED, OVERRIDABLE, changed


class WaterProperties:
    """Settings of the water around one cloth."""

    use_water: BoolProperty(
        name="Water",
        description="Let the cloth float, sink and drift in water that reaches up to a surface",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    water_object: PointerProperty(
        type=bpy.types.Object,
        name="Surface",
        description="Object at whose height the calm surface is, as it moves; empty for the Level",
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    water_level: FloatProperty(
        name="Level",
        description="Height of the calm surface in the world (m). It may be keyed: the cloth follows",
        default=0.0, min=-1e6, max=1e6, soft_min=-10.0, soft_max=10.0, precision=3, step=1,
        subtype="DISTANCE", override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    water_velocity: FloatVectorProperty(
        name="Current",
        description="Velocity of the water in the world (m/s): cloth drifts along with it. It may be keyed",
        default=(0.0, 0.0, 0.0), min=-1e3, max=1e3, soft_min=-5.0, soft_max=5.0, size=3,
        subtype="VELOCITY", override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    water_density: FloatProperty(
        name="Water Density",
        description="Density of the water (kg/m³): 1000 fresh, 1025 in the sea. More carries and drags more",
        default=1000.0, min=0.0, max=1e6, soft_min=500.0, soft_max=1500.0, precision=1, step=100,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    water_drag: FloatProperty(
        name="Water Drag",
        description="Drag coefficient of a face across the flow (fraction): about 1.2 for a plate. More sinks more "
        "slowly and drifts along sooner",
        default=1.0, min=0.0, max=1000.0, soft_max=2.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    water_friction: FloatProperty(
        name="Water Friction",
        description="Friction coefficient of a face along the flow, of both of its sides (fraction). More takes "
        "cloth along that lies in the flow",
        default=0.01, min=0.0, max=1000.0, soft_max=0.1, precision=4, step=0.1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wave_amplitude: FloatProperty(
        name="Wave Amplitude",
        description="Half of the height of waves from trough to crest; 0 for calm water (m)",
        default=0.0, min=0.0, max=1e3, soft_max=1.0, precision=3, step=1,
        subtype="DISTANCE", override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wave_length: FloatProperty(
        name="Wave Length",
        description="From crest to crest (m). Longer waves run faster and lift the whole cloth, shorter ones bend it",
        default=3.0, min=0.001, max=1e6, soft_min=0.1, soft_max=50.0, precision=3, step=1,
        subtype="DISTANCE", override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    wave_angle: FloatProperty(
        name="Wave Direction",
        description="Where the waves run, from the world's X axis towards its Y axis (degrees)",
        default=0.0, min=-1e3, max=1e3, soft_min=-3.14159265, soft_max=3.14159265, subtype="ANGLE",
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    bulk_density: FloatProperty(
        name="Bulk Density",
        description="What the dry cloth weighs by its volume, pores included: its density over its thickness. It floats "
        "below the density of the water (kg/m³)",
        default=500.0, min=1.0, max=1e5, soft_max=2000.0, precision=1, step=100,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    water_hull: EnumProperty(
        name="Inside",
        description="Whether water comes into the cloth",
        items=(
            ("auto", "Automatic", "Closed meshes keep water out, open ones do not"),
            ("dry", "Dry", "Water presses from outside alone, as on a boat or a ball; for closed meshes"),
            ("wet", "Wet", "Water is on both sides of the cloth"),
        ),
        default="auto", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    absorbency: FloatProperty(
        name="Absorbency",
        description="Mass of the water that the cloth takes up at the most, as a multiple of its own (fraction); 0 "
        "for none. More grows heavier, until it sinks",
        default=0.0, min=0.0, max=100.0, soft_max=5.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    soak_time: FloatProperty(
        name="Soak Time",
        description="Time in which dry cloth under water takes up all of it (s). Longer keeps it afloat longer",
        default=10.0, min=0.001, max=1e9, soft_max=60.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    dry_time: FloatProperty(
        name="Dry Time",
        description="Time in which wet cloth dries out of the water; 0 for never (s)",
        default=0.0, min=0.0, max=1e9, soft_max=600.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
