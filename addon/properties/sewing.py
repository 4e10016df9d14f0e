"""Seams along loose edges."""

from bpy.props import BoolProperty, FloatProperty

from .changes import FIXED, OVERRIDABLE, changed


class SewingProperties:
    """Settings of what draws the ends of loose edges together."""

    use_sewing_springs: BoolProperty(
        name="Sewing",
        description="Draw the ends of every loose edge (an edge without faces) together",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    sewing_force_max: FloatProperty(
        name="Max Sewing Force",
        description="Largest force (N) of one loose edge; 0 for no limit. Less closes seams more gently, or leaves "
        "them open where they are pulled",
        default=0.0, min=0.0, max=1e6, soft_max=10.0, precision=3, step=10,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    weld_distance: FloatProperty(
        name="Weld Distance",
        description="Ends that come nearer than this (m) stay joined for good; 0 for never",
        default=0.0, min=0.0, max=10.0, soft_max=0.05, precision=4, step=0.1, unit="LENGTH",
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
