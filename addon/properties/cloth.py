"""The whole of `object.boucle`."""

import bpy
from bpy.props import BoolProperty, PointerProperty
from bpy.types import PropertyGroup

from .._identifiers import POINTER
from .cache import CacheProperties
from .changes import FIXED, OVERRIDABLE, switched
from .collisions import CollisionProperties
from .fabric import FabricProperties, MicroProperties, WarpProperties
from .field_weights import BOUCLE_PG_field_weights, FieldWeightProperties
from .forces import ForceProperties
from .overlay import OverlayProperties
from .presets import PresetProperties
from .pressure import PressureProperties
from .problems import ProblemProperties
from .rest import RestProperties
from .sewing import SewingProperties
from .shape import ShapeProperties
from .solver import SolverProperties
from .springs import SpringProperties
from .steps import StepProperties
from .takes import BOUCLE_PG_take, TakeProperties
from .tear import TearProperties
from .water import WaterProperties


class BOUCLE_PG_cloth(
    FabricProperties,
    WarpProperties,
    MicroProperties,
    SpringProperties,
    ShapeProperties,
    RestProperties,
    PressureProperties,
    SewingProperties,
    CollisionProperties,
    TearProperties,
    ForceProperties,
    WaterProperties,
    FieldWeightProperties,
    SolverProperties,
    StepProperties,
    CacheProperties,
    PresetProperties,
    ProblemProperties,
    TakeProperties,
    OverlayProperties,
    PropertyGroup,
):
    """Settings of one cloth"""

    enabled: BoolProperty(
        name="Boucle Cloth",
        description="Simulate this object as cloth",
        default=False, options=FIXED, override=OVERRIDABLE, update=switched,
    )  # fmt: skip


CLASSES = (BOUCLE_PG_field_weights, BOUCLE_PG_take, BOUCLE_PG_cloth)


def attach() -> None:
    """Give every object its settings."""
    pointer = PointerProperty(
        type=BOUCLE_PG_cloth,
        name="Boucle Cloth",
        description="Cloth settings",
        override=OVERRIDABLE,
    )
    setattr(bpy.types.Object, POINTER, pointer)


def detach() -> None:
    """Take the settings away."""
    delattr(bpy.types.Object, POINTER)
