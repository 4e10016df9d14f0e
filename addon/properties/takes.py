"""Takes: results that are kept under a name."""

from bpy.props import CollectionProperty, IntProperty, StringProperty
from bpy.types import PropertyGroup

from .changes import FIXED, OVERRIDABLE


def _read_comparison(settings: object) -> str:
    from ..bridge import takes

    return takes.comparison(settings.id_data)


class BOUCLE_PG_take(PropertyGroup):
    """One take of a cloth"""

    name: StringProperty(
        name="Name", description="What the take is called; its files keep their names", default="",
        options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    date: StringProperty(
        name="Date", description="When the take was kept", default="",
        options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    note: StringProperty(
        name="Note", description="What to know about the take: its key settings, or words of one's own",
        default="", options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    path: StringProperty(
        name="Path", description="The PC2 file of the take; its report and the others lie beside it",
        default="", options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    settings: StringProperty(
        name="Settings", description="The settings of the cloth when the take was kept, as JSON",
        default="", options={"HIDDEN"}, override=OVERRIDABLE,
    )  # fmt: skip


class TakeProperties:
    """The takes of one cloth."""

    takes: CollectionProperty(
        type=BOUCLE_PG_take, name="Takes", description="Results that are kept under a name",
        override={*OVERRIDABLE, "USE_INSERTION"},
    )  # fmt: skip
    take_index: IntProperty(
        name="Take", description="The chosen take, counted from 0", default=0, min=0, max=100_000,
        options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    take_comparison: StringProperty(
        name="Comparison", description="What tells the take from the result that is played, since Compare was pressed",
        get=_read_comparison, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
