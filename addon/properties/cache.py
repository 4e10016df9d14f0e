"""Frame range, live mode and the bake."""

from bpy.props import BoolProperty, IntProperty, StringProperty

from .changes import FIXED, OVERRIDABLE, attributes_switched, changed

_HIDDEN = {"HIDDEN"}


def _read_status(settings: object) -> str:
    import bpy

    from ..bridge import cache, live

    obj = settings.id_data
    return cache.status(obj, bpy.context.scene) or live.status(obj)


def _read_certificate(settings: object) -> str:
    import bpy

    from ..bridge import certificate

    return certificate.line(settings.id_data, bpy.context.scene)


def _read_warning(settings: object) -> str:
    import bpy

    from ..bridge import certificate

    return certificate.warning(settings.id_data, bpy.context.scene)


def _read_is_baked(settings: object) -> bool:
    from ..bridge import cache

    return cache.is_baked(settings.id_data)


def _read_is_foreign(settings: object) -> bool:
    from ..bridge import cache

    return cache.is_foreign(settings.id_data)


def _read_has_previous(settings: object) -> bool:
    from ..bridge import cache

    return cache.has_previous(settings.id_data)


class CacheProperties:
    """Settings of what is simulated when, and what is known of the result."""

    frame_start: IntProperty(
        name="Start",
        description="The frame at which the cloth is at rest, and from which on it moves",
        default=1, min=-1_000_000, max=1_000_000,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    frame_end: IntProperty(
        name="End",
        description="The last frame that is simulated, live or by Bake",
        default=250, min=-1_000_000, max=1_000_000,
        options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    settle_frames: IntProperty(
        name="Settle",
        description="Frames that are simulated before the first, with pins and colliders held as they are at the start: the "
        "cloth begins where it then hangs or lies; 0 begins at rest",
        default=0, min=0, max=10_000, soft_max=200,
        options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    settle_damped: BoolProperty(
        name="Settle Damped",
        description="While it settles, take the cloth's velocity whenever its swing is fastest, and at the end: it comes to "
        "rest in few frames and begins at rest",
        default=True, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    use_live: BoolProperty(
        name="Live",
        description="Simulate while the animation plays, as long as the cloth is not baked. Off, playback is fast "
        "and shows the rest shape",
        default=True, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    use_strain: BoolProperty(
        name="Strain Attribute",
        description="Tell the largest strain of the edges at each vertex in the attribute boucle_strain (L/L0 - 1); "
        "bakes keep it beside the cache",
        default=False, options=FIXED, override=OVERRIDABLE, update=attributes_switched,
    )  # fmt: skip
    use_tension: BoolProperty(
        name="Tension Attribute",
        description="Tell the largest tension of the springs at each vertex in the attribute boucle_tension (N); bakes "
        "keep it beside the cache",
        default=False, options=FIXED, override=OVERRIDABLE, update=attributes_switched,
    )  # fmt: skip
    use_contact: BoolProperty(
        name="Contact Attribute",
        description="Tell the force with which contacts press on each vertex in the attribute boucle_contact (N); bakes "
        "keep it beside the cache",
        default=False, options=FIXED, override=OVERRIDABLE, update=attributes_switched,
    )  # fmt: skip
    use_intersection: BoolProperty(
        name="Intersection Attribute",
        description="Tell in how many intersections each vertex takes part in the attribute boucle_intersection; bakes "
        "keep it beside the cache",
        default=False, options=FIXED, override=OVERRIDABLE, update=attributes_switched,
    )  # fmt: skip
    use_force: BoolProperty(
        name="Force Attribute",
        description="Tell the force in each edge in the attribute boucle_force, at each corner of a face that of the edge to "
        "the next corner (N); bakes keep it beside the cache",
        default=False, options=FIXED, override=OVERRIDABLE, update=attributes_switched,
    )  # fmt: skip
    certificate: StringProperty(
        name="Certificate",
        description="Stretch, work, energy and hash of the present frame, live or baked",
        get=_read_certificate, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    warning: StringProperty(
        name="Warning",
        description="Edges that are longer in the present frame than the deformation rate allows",
        get=_read_warning, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    status: StringProperty(
        name="Status",
        description="What is baked or in memory, and what is wrong with it",
        get=_read_status, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    is_baked: BoolProperty(
        name="Is Baked",
        description="Whether the object plays a bake",
        get=_read_is_baked, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    is_foreign: BoolProperty(
        name="Is Foreign",
        description="Whether the bake that the object plays belongs to another file or object",
        get=_read_is_foreign, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    has_previous: BoolProperty(
        name="Has Previous",
        description="Whether the bake before this one is kept",
        get=_read_has_previous, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    uuid: StringProperty(
        name="Identity",
        description="Name of the cloth's cache files",
        default="", options=_HIDDEN, override=OVERRIDABLE,
    )  # fmt: skip
    bake_record: StringProperty(
        name="Bake Record",
        description="What the bake remembers of the cloth, to tell whether it is outdated",
        default="", options=_HIDDEN, override=OVERRIDABLE,
    )  # fmt: skip
