"""How a frame is cut into steps, and which rule takes them."""

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .changes import FIXED, OVERRIDABLE, changed


def _read_safe_step(settings: object) -> str:
    import bpy

    from ..bridge import safe_step

    return safe_step.describe(settings.id_data, bpy.context.scene)


class SolverProperties:
    """Settings of the solver."""

    integrator: EnumProperty(
        name="Integrator",
        description="The rule that moves the vertices",
        items=(
            ("forward_euler", "Forward Euler", "The textbook's first: needs much damping"),
            ("symplectic_euler", "Symplectic Euler", "Velocity first, then position"),
            ("verlet", "Verlet", "Velocity Verlet, second order"),
            ("leapfrog", "Leapfrog", "Half a drift, a kick, half a drift"),
            ("midpoint", "Midpoint", "Runge-Kutta, second order"),
            ("rk4", "Runge-Kutta 4", "The classic fourth order"),
        ),
        default="symplectic_euler", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    substeps: IntProperty(
        name="Substeps",
        description="Steps a frame; 0 takes as few as are stable",
        default=0, min=0, max=100_000, soft_max=500,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    time_step: FloatProperty(
        name="Time Step",
        description="Cut the frame into equal steps of at most this (s); 0 leaves it to Substeps",
        default=0.0, min=0.0, max=1.0, soft_max=0.05, precision=5, step=0.1,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    allow_unstable: BoolProperty(
        name="Allow Unstable",
        description="Take steps beyond the safe one as asked, to see the cloth break down",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    safe_step: StringProperty(
        name="Safe Time Step",
        description="The largest time step that keeps these springs stable and that the limiter keeps up with",
        get=_read_safe_step, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
