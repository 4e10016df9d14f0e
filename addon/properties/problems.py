"""What the last check found."""

from bpy.props import StringProperty

from .changes import FIXED, OVERRIDABLE


def _read_problems(settings: object) -> str:
    from ..bridge import findings

    return findings.as_text(settings.id_data)


class ProblemProperties:
    """What is known of the problems of a cloth."""

    problems: StringProperty(
        name="Problems",
        description="What the last check of this session found, as a JSON list: severity, sentence, whether it selects "
        "vertices, and the object that the cloth passes through; empty before the first one",
        get=_read_problems, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
