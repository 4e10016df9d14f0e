"""Which model the cloth is of, and the stiffness and damping of fabric."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from .changes import FIXED, OVERRIDABLE, changed

_LARGEST = 1e9
_MICRO = 1e-6


class FabricProperties:
    """Settings of the model and of fabric; deformation rate, limiter, shear and air damping are shared with springs."""

    in_presets = True

    model: EnumProperty(
        name="Model",
        description="What the cloth is made of: springs are fast, fabric folds like the real one. A preset sets the "
        "numbers of both",
        items=(
            ("springs", "Springs", "The classic mass-spring model: springs along edges and across faces"),
            (
                "fabric",
                "Fabric",
                "A continuum with warp and weft, in measured units: the same on any mesh, and slower",
            ),
        ),
        default="springs", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    stretch_warp: FloatProperty(
        name="Warp Stretch",
        description="Tensile stiffness along the warp (N/m): the force on a metre of width that would double the "
        "length. More sags less; real fabrics differ a hundredfold, so begin from a preset",
        default=2000.0, min=0.0, max=_LARGEST, soft_max=50_000.0, precision=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    stretch_weft: FloatProperty(
        name="Weft Stretch",
        description="Tensile stiffness along the weft, across the warp (N/m). More sags less; mostly it is less than "
        "along the warp",
        default=2000.0, min=0.0, max=_LARGEST, soft_max=50_000.0, precision=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    use_compression: BoolProperty(
        name="Own Compression",
        description="Give the fabric another stiffness where it is compressed; else it is that of stretch. Real "
        "yarns buckle: a hundredth for wovens, a tenth for knits",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    compression_warp: FloatProperty(
        name="Warp Compression",
        description="Stiffness against compression along the warp (N/m). Less drapes more softly, above all on "
        "coarse meshes",
        default=2000.0, min=0.0, max=_LARGEST, soft_max=50_000.0, precision=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    compression_weft: FloatProperty(
        name="Weft Compression",
        description="Stiffness against compression along the weft (N/m). Less drapes more softly, above all on "
        "coarse meshes",
        default=2000.0, min=0.0, max=_LARGEST, soft_max=50_000.0, precision=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    bend_warp: FloatProperty(
        name="Warp Bending",
        description="Bending stiffness of curvature along the warp (N·m). More gives broader folds, less finer ones",
        default=2e-5, min=0.0, max=_LARGEST, soft_max=1e-3, precision=6,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    bend_weft: FloatProperty(
        name="Weft Bending",
        description="Bending stiffness of curvature along the weft (N·m). More gives broader folds, less finer ones",
        default=2e-5, min=0.0, max=_LARGEST, soft_max=1e-3, precision=6,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    yield_curvature: FloatProperty(
        name="Crease Beyond",
        description="Curvature beyond which a bend stays as a crease (1/m: 100 is a bend of 1 cm radius); 0 for never",
        default=0.0, min=0.0, max=_LARGEST, soft_max=1000.0, precision=1, step=100,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    hardening: FloatProperty(
        name="Crease Hardening",
        description="How much stiffness is left beyond that, as a fraction: at 0 all of a further bend stays",
        default=0.0, min=0.0, max=0.99, precision=2, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    bend_hysteresis: FloatProperty(
        name="Bend Hysteresis",
        description=(
            "Friction of yarns as the fabric bends (N·m/m): the 2HB that the KES bending tester reads; 1 gf·cm/cm is "
            "0.0098. More keeps small wrinkles"
        ),
        default=0.0, min=0.0, max=_LARGEST, soft_max=0.01, precision=5, step=0.01,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    damping_ratio: FloatProperty(
        name="Damping Ratio",
        description="Damping of every motion, as a fraction of the critical at a wavelength of 0.1 m. More calms "
        "ripples sooner; real fabrics have a few hundredths. Swinging as a whole is calmed by Air",
        default=0.02, min=0.0, max=100.0, soft_max=0.2, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    damping_ratio_per_kind: BoolProperty(
        name="Per Kind",
        description="Give stretch, shear and bending a damping ratio of their own: more for Bending alone calms "
        "folds and leaves the rest lively",
        default=False, options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    damping_ratio_stretch: FloatProperty(
        name="Stretch",
        translation_context="Boucle",
        description="Damping of stretch, as a fraction of the critical at a wavelength of 0.1 m. More takes the "
        "bounce out of taut cloth",
        default=0.02, min=0.0, max=100.0, soft_max=0.2, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    damping_ratio_shear: FloatProperty(
        name="Shear",
        description="Damping of shear, as a fraction of the critical at a wavelength of 0.1 m. More slows how cloth "
        "slants",
        default=0.02, min=0.0, max=100.0, soft_max=0.2, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    damping_ratio_bend: FloatProperty(
        name="Bending",
        description="Damping of bending, as a fraction of the critical at a wavelength of 0.1 m. More calms folds "
        "sooner",
        default=0.02, min=0.0, max=100.0, soft_max=0.2, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip


class WarpProperties:
    """Which way the warp of a fabric runs on the mesh."""

    warp: EnumProperty(
        name="Warp",
        description="Which way the warp runs: the threads that are long on the loom, mostly the stiffer way",
        items=(
            ("x", "Local X", "Along the object's X axis, as far as it lies in each face"),
            ("y", "Local Y", "Along the object's Y axis, as far as it lies in each face"),
            (
                "z",
                "Local Z",
                "Along the object's Z axis, as far as it lies in each face; along Y where a face lies flat",
            ),
            ("uv", "UV Map", "Where V of a UV map grows: for garments whose pieces lie along the thread there"),
        ),
        default="z", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    warp_uv_map: StringProperty(
        name="UV Map",
        description="The UV map along whose V the warp runs; empty for the active one. For pattern pieces that are "
        "laid out along the thread",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip


def _read_bend_warp(settings: bpy.types.PropertyGroup) -> float:
    return settings.bend_warp / _MICRO


def _write_bend_warp(settings: bpy.types.PropertyGroup, value: float) -> None:
    settings.bend_warp = value * _MICRO


def _read_bend_weft(settings: bpy.types.PropertyGroup) -> float:
    return settings.bend_weft / _MICRO


def _write_bend_weft(settings: bpy.types.PropertyGroup, value: float) -> None:
    settings.bend_weft = value * _MICRO


class MicroProperties:
    """Bending stiffness in millionths, as laboratories tell it; a field shows six decimals at most. It keeps nothing itself."""

    bend_warp_micro: FloatProperty(
        name="Warp Bending",
        description="Bending stiffness of curvature along the warp (µN·m, millionths of a N·m). What the eye sees "
        "first: more gives broader folds, less finer ones",
        min=0.0, max=1e15, soft_max=1000.0, precision=2, step=100,
        get=_read_bend_warp, set=_write_bend_warp, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    bend_weft_micro: FloatProperty(
        name="Weft Bending",
        description="Bending stiffness of curvature along the weft (µN·m, millionths of a N·m). More gives broader "
        "folds, less finer ones",
        min=0.0, max=1e15, soft_max=1000.0, precision=2, step=100,
        get=_read_bend_weft, set=_write_bend_weft, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
