"""How a frame is cut into steps, and which rule takes them."""

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .changes import FIXED, OVERRIDABLE, changed


def _read_safe_step(settings: object) -> str:
    import bpy

    from ..bridge import safe_step

    return safe_step.describe(settings.id_data, bpy.context.scene)


def _read_is_implicit(settings: object) -> bool:
    from ..bridge import settings as bridge_settings

    return bridge_settings.is_implicit(settings.integrator)


class SolverProperties:
    """Settings of the solver."""

    in_presets = True

    speed: FloatProperty(
        name="Speed Multiplier",
        description="How much time passes for the cloth in each frame, as a multiple of the frame's own (fraction): below 1 "
        "it moves in slow motion",
        default=1.0, min=0.01, max=100.0, soft_min=0.1, soft_max=10.0, precision=3, step=10,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    integrator: EnumProperty(
        name="Integrator",
        description="The rule that moves the vertices. BDF2 suits nearly everything; explicit rules are the "
        "textbook's and need many short steps",
        items=(
            ("bdf2", "BDF2", "Implicit, second order: stable at any step, with little damping"),
            ("implicit_euler", "Implicit Euler", "Stable at any step; damps the motion"),
            ("forward_euler", "Forward Euler", "Explicit, the textbook's first: needs much damping"),
            ("symplectic_euler", "Symplectic Euler", "Explicit: velocity first, then position"),
            ("verlet", "Verlet", "Explicit: velocity Verlet, second order"),
            ("leapfrog", "Leapfrog", "Explicit: half a drift, a kick, half a drift"),
            ("midpoint", "Midpoint", "Explicit: Runge-Kutta, second order"),
            ("rk4", "Runge-Kutta 4", "Explicit: the classic fourth order"),
        ),
        default="bdf2", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    is_implicit: BoolProperty(
        name="Is Implicit",
        description="Whether the integrator is stable at any step",
        get=_read_is_implicit, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    quality: EnumProperty(
        name="Quality",
        description="How exact the automatic steps of an implicit integrator are: Draft to look, Normal to bake, "
        "Final where cloth trembles or tears",
        items=(
            ("draft", "Draft", "Few steps: error tolerance 0.02"),
            ("normal", "Normal", "Error tolerance 0.005"),
            ("final", "Final", "Many steps: error tolerance 0.001"),
            ("custom", "Custom", "An error tolerance of one's own"),
        ),
        default="normal", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    tolerance: FloatProperty(
        name="Tolerance",
        description="What a step may be off, as a fraction of the cloth's size; smaller takes more steps",
        default=5e-3, min=1e-6, max=1.0, soft_min=1e-4, soft_max=0.1, precision=5, step=0.1,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    linear_solver: EnumProperty(
        name="Linear Solver",
        description="What stands for the inverse of an implicit step's equations. Automatic is right unless you "
        "compare",
        items=(
            ("auto", "Automatic", "Fabric by its own equations, the rest by the number of vertices"),
            ("ldlt", "LDLT", "Exactly, by elimination"),
            ("multigrid", "Multigrid", "Nearly, over coarser and coarser equations"),
        ),
        default="auto", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    substeps: IntProperty(
        name="Substeps",
        description="Steps a frame; 0 takes as few as are stable and, if implicit, as exact as Quality asks. More "
        "moves more exactly and takes longer",
        default=0, min=0, max=100_000, soft_max=500,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    time_step: FloatProperty(
        name="Time Step",
        description="Cut the frame into equal steps of at most this (s); 0 leaves it to Substeps. Shorter moves more "
        "exactly and takes longer",
        default=0.0, min=0.0, max=1.0, soft_max=0.05, precision=5, step=0.1,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    allow_unstable: BoolProperty(
        name="Allow Unstable",
        description="Take explicit steps beyond the safe one as asked, to see the cloth break down",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    safe_step: StringProperty(
        name="Safe Time Step",
        description="The largest explicit time step that is stable and that the limiter keeps up with",
        get=_read_safe_step, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
