"""What the viewports show on the cloth."""

from bpy.props import EnumProperty, FloatProperty

from .changes import FIXED, OVERRIDABLE, overlay_redrawn, overlay_switched


class OverlayProperties:
    """Settings of the heat map; none changes the simulation."""

    overlay: EnumProperty(
        name="Heat Map",
        description="Colour the cloth in the viewports by what happens to it, beside a legend; bakes keep the numbers",
        items=(
            ("none", "None", "No colours"),
            ("strain", "Strain", "Largest strain of the edges at each vertex (L/L0 - 1)"),
            ("tension", "Tension", "Largest tension of the springs at each vertex (N)"),
            ("force", "Force in Edges", "Force in each edge, drawn on the edge (N)"),
            ("contact", "Contact", "Force with which contacts press each vertex (N)"),
            ("intersection", "Intersections", "Edges and faces at each vertex that pass through others"),
        ),
        default="none", options=FIXED, override=OVERRIDABLE, update=overlay_switched,
    )  # fmt: skip
    overlay_range: EnumProperty(
        name="Range",
        description="Which numbers the colours span",
        items=(
            ("auto", "Automatic", "From 0 to a round number above the largest in the present frame"),
            ("tear", "Tearing", "From 0 to what an edge bears before it tears, where it tears; automatic for others"),
            ("manual", "Manual", "From Minimum to Maximum, the same in every frame"),
        ),
        default="auto", options=FIXED, override=OVERRIDABLE, update=overlay_redrawn,
    )  # fmt: skip
    overlay_minimum: FloatProperty(
        name="Minimum",
        description="What has the darkest colour (strain as a fraction, forces in N)",
        default=0.0, min=-1e6, max=1e6, precision=3,
        options=FIXED, override=OVERRIDABLE, update=overlay_redrawn,
    )  # fmt: skip
    overlay_maximum: FloatProperty(
        name="Maximum",
        description="What has the brightest colour (strain as a fraction, forces in N)",
        default=0.1, min=-1e6, max=1e6, precision=3,
        options=FIXED, override=OVERRIDABLE, update=overlay_redrawn,
    )  # fmt: skip
    overlay_opacity: FloatProperty(
        name="Opacity",
        description="How much the colours cover the shaded cloth (fraction): at 1 folds no longer show",
        default=0.85, min=0.0, max=1.0, subtype="FACTOR",
        options=FIXED, override=OVERRIDABLE, update=overlay_redrawn,
    )  # fmt: skip
