"""When the cloth tears."""

from bpy.props import BoolProperty, FloatProperty, IntProperty, StringProperty

from .changes import FIXED, OVERRIDABLE, changed


class TearProperties:
    """Settings of how one cloth tears; they are taken once."""

    in_presets = ("tear_stress",)

    use_tear: BoolProperty(
        name="Tearing",
        description="Let the cloth tear along its edges; no face is lost, and its pieces collide as cloth",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    tear_stress: FloatProperty(
        name="Stress",
        description="Tension over the width that an edge stands for, beyond which it breaks, whatever the resolution; 0 for "
        "never. A fabric's is its breaking strength: newtons of a strip of 50 mm, times 20 (N/m)",
        default=20.0, min=0.0, max=1e9, soft_max=20000.0, precision=1, step=100,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    tear_force: FloatProperty(
        name="Force",
        description="Tension of an edge beyond which it breaks (N); 0 for never. A finer mesh has more edges, each "
        "with less of the load: Stress is the same on any",
        default=0.0, min=0.0, max=1e9, soft_max=100.0, precision=3, step=10,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    tear_strain: FloatProperty(
        name="Strain",
        description="Strain beyond which an edge breaks (L/L0 - 1); 0 for never. If it is not below the Deformation Rate, the "
        "limiter does not act",
        default=0.0, min=0.0, max=1e6, soft_max=2.0, precision=3, step=1,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    tear_noise: FloatProperty(
        name="Noise",
        description="By which part the thresholds differ from edge to edge, up and down (fraction). More makes tears "
        "more ragged",
        default=0.0, min=0.0, max=1.0, subtype="FACTOR", precision=3,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    tear_seed: IntProperty(
        name="Seed",
        description="Chooses the random numbers of the noise: another number tears elsewhere",
        default=0, min=0, max=2_000_000_000, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    tear_strength_group: StringProperty(
        name="Strength Group",
        description="Vertex group whose weights are the part of the thresholds that holds at each vertex; vertices outside of "
        "it hold in full",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    seam_force: FloatProperty(
        name="Seam Force",
        description="Force with which a sewing edge is pulled beyond which it comes undone; 0 for never (N)",
        default=0.0, min=0.0, max=1e9, soft_max=100.0, precision=3, step=10,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    tear_opening_group: StringProperty(
        name="Opening Group",
        description="Vertex group: edges and seams with both ends in it come undone at the Opening Frame; empty for none",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    tear_opening_frame: IntProperty(
        name="Opening Frame",
        description="The frame at whose end the edges of the Opening Group come undone",
        default=50, min=-1_000_000, max=1_000_000, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
