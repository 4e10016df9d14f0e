"""Stiffness, damping and deformation of the classic mass-spring model."""

from bpy.props import BoolProperty, EnumProperty, FloatProperty

from .changes import FIXED, OVERRIDABLE, changed

_LARGEST = 1e9


class SpringProperties:
    """Settings of the springs."""

    in_presets = True

    stretch: FloatProperty(
        name="Stretch",
        translation_context="Boucle",
        description="Stiffness of the springs along mesh edges (N/m). More sags less; how far edges may stretch at "
        "the most is the Deformation Rate's affair",
        default=500.0, min=0.0, max=_LARGEST, soft_max=10_000.0, precision=2,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    shear: FloatProperty(
        name="Shear",
        description="Stiffness against shear (N/m): of the springs across faces, or of the fabric. Less lets the "
        "cloth hug round things and fold on the bias, more makes it like paper",
        default=100.0, min=0.0, max=_LARGEST, soft_max=10_000.0, precision=2,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    bend: FloatProperty(
        name="Bending",
        description="Stiffness of the springs to the vertex after next (N/m). More makes tight folds broader; broad "
        "bends hardly feel it, and another mesh bends otherwise",
        default=5.0, min=0.0, max=_LARGEST, soft_max=1000.0, precision=2,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    stiffness_from: EnumProperty(
        name="Stiffness From",
        description="What the three numbers are the stiffness of. Membrane keeps the cloth as it is when you refine "
        "its mesh",
        items=(
            (
                "springs",
                "Springs",
                "Of each spring, as in the papers: another mesh of the same cloth is softer or stiffer",
            ),
            (
                "continuum",
                "Membrane",
                "Of the cloth: each spring gets its own from the mesh, so that a finer mesh moves alike",
            ),
        ),
        default="springs", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    damping: FloatProperty(
        name="Damping",
        description="Damping of every spring (N·s/m). More calms ripples sooner; too much looks like syrup",
        default=0.01, min=0.0, max=_LARGEST, soft_max=1.0, precision=4, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    damping_per_kind: BoolProperty(
        name="Per Kind",
        description="Give stretch, shear and bend springs a damping of their own: 0.1 and more for Bending calms "
        "folds that look like a chessboard",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    damping_stretch: FloatProperty(
        name="Stretch",
        translation_context="Boucle",
        description="Damping of the springs along mesh edges (N·s/m). More takes the bounce out of stretching",
        default=0.01, min=0.0, max=_LARGEST, soft_max=1.0, precision=4, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    damping_shear: FloatProperty(
        name="Shear",
        description="Damping of the springs across faces (N·s/m). More slows how cloth slants and settles on the bias",
        default=0.01, min=0.0, max=_LARGEST, soft_max=1.0, precision=4, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    damping_bend: FloatProperty(
        name="Bending",
        description="Damping of the springs to the vertex after next (N·s/m). More calms small folds sooner",
        default=0.01, min=0.0, max=_LARGEST, soft_max=1.0, precision=4, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    damping_law: EnumProperty(
        name="Law",
        translation_context="Boucle",
        description="Which part of the relative velocity of a spring's ends is damped. Axial leaves turning and "
        "folding free: livelier",
        items=(
            ("relative", "Relative", "All of the relative velocity"),
            ("axial", "Axial", "Only its part along the spring"),
        ),
        default="relative", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    air_damping: FloatProperty(
        name="Air",
        description="Viscous damping of every vertex by the air (N·s/m). More brings swinging cloth to rest sooner "
        "and slows its fall; a finer mesh has more vertices and so more of it",
        default=0.0, min=0.0, max=_LARGEST, soft_max=0.1, precision=5, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    deformation_rate: FloatProperty(
        name="Deformation Rate",
        description="Elongation that edges are allowed, as a fraction of their rest length: 0.1 is 10 %, about that "
        "of woven cloth. Less hangs tauter, more stretches like rubber",
        default=0.10, min=0.0, max=0.999, soft_max=0.5, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    limiter: EnumProperty(
        name="Limiter",
        description="What keeps edges to the deformation rate. Project holds it; the others are the papers', to "
        "compare",
        items=(
            ("none", "None", "Nothing: the cloth stretches as its stiffness allows"),
            ("stiffen", "Stiffen", "Springs grow stiffer beyond the allowed length (k L/L0); not for fabric"),
            ("provot", "Provot", "The ends are moved back (Provot 1995)"),
            (
                "project",
                "Project",
                "The ends are moved back and lose the velocity that parts them",
            ),
        ),
        default="project", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
