"""The bake of one cloth in Blender: the generator that a window and a script both pull."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import bpy

from .. import native
from ..core import bake as core_bake
from ..core import drift, points, progress, report
from ..core.bake import Plan, Pose, Step, Store
from ..core.cache_paths import CacheFiles
from ..core.refusal import Refusal, sentence_of
from . import (
    cache,
    live,
    pins,
    preflight,
    registry,
    runtime,
    sampling,
    settings,
    simulation,
    slot,
    vertex_attributes,
)
from .colliders import Colliders


@dataclass(frozen=True)
class Options:
    """How to bake."""

    resume: bool = False
    frames: tuple[int, int] | None = None
    """First and last frame to keep; the object's own range if None."""
    files: CacheFiles | None = None
    """Where to write; the object's own cache if None."""
    threads: int = 0
    """0 takes every core."""


class Bake:
    """One cloth's bake. Only its `session_uid` is held between two steps, never the object."""

    def __init__(
        self, obj: bpy.types.Object, scene: bpy.types.Scene, options: Options | None = None
    ) -> None:
        """Prepare nothing yet; `steps` does all the work."""
        self.name = obj.name
        self.options = options or Options()
        self.uid = obj.session_uid
        self._scene_name = scene.name
        self.store: Store | None = None
        self._began = (0.0, 1 << 30)
        """When the first frame was asked for, and which one it was."""
        self.end = self.options.frames[1] if self.options.frames else obj.boucle.frame_end

    @property
    def last_frame(self) -> int | None:
        """The last frame that is kept."""
        return self.store.last_frame if self.store and self.store.sample_count else None

    def progress(self, step: Step) -> str:
        """How far the bake is, for the status bar."""
        began, first = self._began
        frames = step.frame - first
        mean = (time.monotonic() - began) / frames if frames > 0 else 0.0
        return progress.line(self.name, step.frame, self.end, mean, self.end - step.frame + 1)

    def steps(self) -> Iterator[Step]:
        """Simulate and write; leaves the scene at the frame where it stood.

        Raises:
            Refusal, native.BoucleError: One sentence; the frames before it are kept.
        """
        with self._quiet():
            yield from self._steps()

    def _steps(self) -> Iterator[Step]:
        obj, scene = self._object(), self._scene()
        preflight.refuse_errors(obj, scene)
        start = obj.boucle.frame_start
        depsgraph = self._go_to(start)
        description = settings.describe(obj, scene, with_groups=True)
        self._restrict(description)
        sampling.refuse_other_count(obj, depsgraph)
        matrix = sampling.object_matrix(obj, depsgraph)
        rest_world = points.transform(sampling.targets(obj, depsgraph), matrix, "d")
        met = Colliders(obj, scene, depsgraph)
        make = simulation.maker(obj, description, rest_world, self.options.threads, met.arrays)
        build = Step(start, make)
        record = self._record(obj, description)
        yield build
        solver = build.result()
        self.store = self._make_store(self._object(), description, record, solver)
        held = pins.Pins(description, record["vertices"])

        def pose_at(frame: int) -> Pose:
            if frame < self._began[1]:
                self._began = (time.monotonic(), frame)
            return self._pose(frame, held, met)

        try:
            yield from core_bake.bake(
                solver, self.store, pose_at, self.options.resume, native.InternalError
            )
        finally:
            self._attach(record)

    def _restrict(self, description: dict[str, Any]) -> None:
        """Frames that are kept may end before or after the object's own range."""
        if self.options.frames is None:
            return
        first, end = self.options.frames
        start = description["scene"]["frames"][0]
        if end < first or first < start:
            raise Refusal(
                f'"{self.name}": frames {first} to {end} cannot be kept: accepted is a range '
                f"that begins at the cloth's start frame {start} or later"
            )
        description["scene"]["frames"][1] = end

    def _record(self, obj: bpy.types.Object, description: dict[str, Any]) -> dict[str, Any]:
        record = settings.record(obj, description)
        kept = self.options.frames
        first = kept[0] if kept else description["scene"]["frames"][0]
        return {**record, "first": first, "end": self.end, "is_part": kept is not None}

    def _make_store(
        self,
        obj: bpy.types.Object,
        description: dict[str, Any],
        record: dict[str, Any],
        solver: Any,
    ) -> Store:
        plan = Plan(
            start=description["scene"]["frames"][0],
            first=record["first"],
            end=self.end,
            vertex_count=record["vertices"],
            digest=drift.whole_digest({**record, "end": None}),
            keeps=vertex_attributes.wanted(obj),
        )
        mesh = obj.data
        cloth = {
            "name": obj.name,
            "vertices": len(mesh.vertices),
            "triangles": len(mesh.loops) - 2 * len(mesh.polygons),
            "springs": solver.spring_count(0),
        }
        threads = self.options.threads or os.cpu_count() or 1
        rows = report.Report(native.manifest_version(), bpy.data.filepath, threads, cloth)
        rows.head["integrator"] = description["solver"]["integrator"]
        rows.head["hash_algorithm"] = "xxh3-64"
        rows.record = record
        files = self.options.files or cache.own_files(obj)
        return Store(files, plan, rows, keeps_previous=self.options.files is None)

    def _pose(self, frame: int, held: pins.Pins, met: Colliders) -> Pose:
        depsgraph, obj = self._go_to(frame), self._object()
        pose = sampling.pose(obj, depsgraph, held.are_there, met.targets(depsgraph))
        return held.hold(pose, obj, depsgraph)

    def _attach(self, record: dict[str, Any]) -> None:
        """Play what is there, if it is the object's own cache; a folder elsewhere is left alone."""
        obj = registry.by_uid(self.uid)
        if self.options.files is None and obj is not None and self.store.sample_count:
            cache.attach(obj, self.store.files.pc2, record)

    def _object(self) -> bpy.types.Object:
        obj = registry.by_uid(self.uid)
        if obj is None or not registry.is_cloth(obj):
            raise Refusal(f'"{self.name}" is no Boucle cloth any more: frames so far are kept')
        return obj

    def _scene(self) -> bpy.types.Scene:
        scene = bpy.data.scenes.get(self._scene_name)
        if scene is None:
            raise Refusal(f'the scene "{self._scene_name}" is gone: frames so far are kept')
        return scene

    def _go_to(self, frame: int) -> bpy.types.Depsgraph:
        scene = self._scene()
        scene.frame_set(frame)
        layer = registry.layer_of(self._object(), scene)
        return layer.depsgraph if layer.depsgraph else bpy.context.evaluated_depsgraph_get()

    @contextmanager
    def _quiet(self) -> Iterator[None]:
        """Live mode still, the rest shape in place, modifiers below the slot off; all restored after."""
        obj, scene = self._object(), self._scene()
        frame, subframe = scene.frame_current, scene.frame_subframe
        live.drop(obj)
        slot.ensure(obj)
        slot.find(obj).cache.show_viewport = False
        shown = {modifier.name: modifier.show_viewport for modifier in slot.below(obj)}
        runtime.busy.add("bake")
        try:
            for name in shown:
                obj.modifiers[name].show_viewport = False
            yield
        finally:
            self._restore(shown)
            if bpy.data.scenes.get(self._scene_name) is not None:
                self._scene().frame_set(frame, subframe=subframe)
            runtime.busy.discard("bake")
            self._show_attributes()

    def _show_attributes(self) -> None:
        obj, scene = registry.by_uid(self.uid), bpy.data.scenes.get(self._scene_name)
        if registry.is_cloth(obj) and scene is not None:
            live.show_attributes(obj, scene)

    def _restore(self, shown: dict[str, bool]) -> None:
        obj = registry.by_uid(self.uid)
        if obj is None:
            return
        for name, state in shown.items():
            if obj.modifiers.get(name) is not None:
                obj.modifiers[name].show_viewport = state
        found = slot.find(obj)
        if found is not None:
            found.cache.show_viewport = bool(slot.played(found.cache))


def outcome(done: Bake, error: BaseException | None) -> str:
    """What became of a bake, in one sentence."""
    kept = f"frames up to {done.last_frame} are kept" if done.last_frame is not None else ""
    if error is None:
        return f'"{done.name}" is baked to frame {done.last_frame}'
    if isinstance(error, GeneratorExit):
        return f'"{done.name}" was stopped' + (f"; {kept}, Resume goes on" if kept else "")
    text = sentence_of(error)
    return f"{text}; {kept}" if kept and "kept" not in text else text
