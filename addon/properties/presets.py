"""The names of the presets, for the popover that lists them."""

from bpy.props import StringProperty

from .changes import FIXED, OVERRIDABLE


def _read_shipped(_settings: object) -> str:
    from ..bridge import presets

    return "\n".join(presets.shipped_names())


def _read_own(_settings: object) -> str:
    from ..bridge import presets

    return "\n".join(presets.own_names())


class PresetProperties:
    """What presets there are. A group whose settings they hold says so by `in_presets`."""

    shipped_presets: StringProperty(
        name="Shipped Presets",
        description="Names of the presets that come with Boucle, one a line",
        get=_read_shipped, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    own_presets: StringProperty(
        name="Own Presets",
        description="Names of the presets that were saved here, one a line",
        get=_read_own, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
