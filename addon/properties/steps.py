"""Who says how many steps a frame takes: one choice in place of two numbers, of which 0 means "automatic"."""

from bpy.props import EnumProperty
from bpy.types import PropertyGroup

from .changes import FIXED, OVERRIDABLE

_AUTOMATIC, _SUBSTEPS, _TIME_STEP = range(3)
_FIRST_SUBSTEPS = 10
"""What the artist begins from where nothing is known of a frame."""
_FIRST_TIME_STEP = 0.001
"""(s)."""


def _read(settings: PropertyGroup) -> int:
    if settings.substeps:
        return _SUBSTEPS
    return _TIME_STEP if settings.time_step else _AUTOMATIC


def _write(settings: PropertyGroup, choice: int) -> None:
    """Begin from what the present frame took, so that the choice alone changes nothing."""
    if choice == _read(settings):
        return
    taken = settings.substeps or _taken(settings)
    settings.substeps = taken if choice == _SUBSTEPS else 0
    settings.time_step = _FIRST_TIME_STEP if choice == _TIME_STEP else 0.0


def _taken(settings: PropertyGroup) -> int:
    import bpy

    from ..bridge import certificate

    row = certificate.row_of(settings.id_data, bpy.context.scene)
    return int(row.get("substeps") or _FIRST_SUBSTEPS)


class StepProperties:
    """The choice; it stands for two numbers of the solver's settings and keeps nothing itself."""

    step_mode: EnumProperty(
        name="Steps",
        description="Who says how many steps a frame takes",
        items=(
            ("auto", "Automatic", "As few as are stable and, if implicit, as exact as Quality asks", _AUTOMATIC),
            ("substeps", "Per Frame", "As many as Substeps says, the same in every frame", _SUBSTEPS),
            ("time_step", "Time Step", "Equal steps of at most this length", _TIME_STEP),
        ),
        get=_read, set=_write, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
