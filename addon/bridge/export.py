"""Bakes for other programs, by Blender's own exporters of USD and Alembic."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import bpy

from ..core.refusal import Refusal, sentence_of
from . import cache, registry, runtime


def exportable(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """The cloths of a scene whose bake can be played, by their names."""
    found = [obj for obj in registry.cloths_of(scene) if cache.is_baked(obj)]
    return sorted((obj for obj in found if not cache.problem(obj)), key=lambda obj: obj.name)


def frames(cloths: Sequence[bpy.types.Object]) -> tuple[int, int]:
    """The first and the last frame that the bakes hold."""
    ranges = [cache.frame_range(obj) for obj in cloths]
    return min(first for first, _ in ranges), max(last for _, last in ranges)


def to_usd(cloths: Sequence[bpy.types.Object], path: str) -> tuple[int, int]:
    """Write cloths with their motion into a USD file; the frames that it holds.

    Raises:
        Refusal: A bake cannot be played, or Blender cannot write the file.
    """
    with _alone(cloths) as (first, last):
        if first < 0:
            raise Refusal(
                f'"{path}" is not exported: the bakes begin at frame {first}, and Blender writes USD from '
                "frame 0 on: export Alembic, or bake from frame 0 or later"
            )
        _call(
            bpy.ops.wm.usd_export,
            path,
            selected_objects_only=True,
            export_animation=True,
            export_uvmaps=True,
            export_normals=True,
            export_mesh_colors=True,
            evaluation_mode="RENDER",
        )
    return first, last


def to_alembic(cloths: Sequence[bpy.types.Object], path: str) -> tuple[int, int]:
    """Write cloths with their motion into an Alembic file; the frames that it holds.

    Raises:
        Refusal: A bake cannot be played, or Blender cannot write the file.
    """
    with _alone(cloths) as (first, last):
        _call(
            bpy.ops.wm.alembic_export,
            path,
            as_background_job=False,
            selected=True,
            start=first,
            end=last,
            uvs=True,
            normals=True,
            vcolors=True,
            evaluation_mode="RENDER",
        )
    return first, last


def _call(operator: object, path: str, **settings: object) -> None:
    try:
        done = operator("EXEC_DEFAULT", filepath=path, check_existing=False, **settings)
    except RuntimeError as error:
        raise Refusal(f'"{path}" is not exported: {sentence_of(error)}') from error
    if "FINISHED" not in done:
        raise Refusal(f'"{path}" is not exported: choose a file that you may write to')


@contextmanager
def _alone(cloths: Sequence[bpy.types.Object]) -> Iterator[tuple[int, int]]:
    """Only these objects selected, and the scene's range that of their bakes; restored after."""
    for obj in cloths:
        if not cache.is_baked(obj) or cache.problem(obj):
            raise Refusal(cache.problem(obj) or f'"{obj.name}" is not baked: bake it first')
    first, last = frames(cloths)
    scene, layer = bpy.context.scene, bpy.context.view_layer
    selected, active = [obj.name for obj in layer.objects if obj.select_get()], layer.objects.active
    frame, subframe = scene.frame_current, scene.frame_subframe
    start, end = scene.frame_start, scene.frame_end
    runtime.busy.add("export")  # live cloths stand still while Blender walks through the frames
    try:
        for obj in layer.objects:
            obj.select_set(obj in cloths)
        refused = [obj.name for obj in cloths if not obj.select_get()]
        if refused:
            raise Refusal(f'"{refused[0]}" is hidden and cannot be exported: show it first')
        layer.objects.active = cloths[0]
        # The exporter of USD takes the scene's range; the end is set first, as the start may not lie behind it.
        scene.frame_end = last
        scene.frame_start = first
        yield first, last
    finally:
        scene.frame_end, scene.frame_start = end, start
        scene.frame_end = end
        for obj in layer.objects:
            obj.select_set(obj.name in selected)
        layer.objects.active = active
        scene.frame_set(frame, subframe=subframe)
        runtime.busy.discard("export")
