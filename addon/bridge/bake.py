"""The bake of cloths in Blender, mostly of one: the generator that a window and a script both pull."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

import bpy

from .. import native
from ..core import bake as core_bake
from ..core import drift, joint, points, progress, report, scene_json, torn
from ..core.bake import Moment, Step
from ..core.cache_paths import CacheFiles
from ..core.refusal import Refusal, sentence_of
from ..core.store import Plan, Store, Stores
from . import (
    bake_view,
    cache,
    colliders,
    live,
    pins,
    preflight,
    record,
    registry,
    runtime,
    sampling,
    settings,
    simulation,
    slot,
    tearing,
    vertex_attributes,
)
from .fields import Fields
from .winds import Water, Winds


@dataclass(frozen=True)
class Options:
    """How to bake."""

    resume: bool = False
    frames: tuple[int, int] | None = None
    """First and last frame to keep; the cloths' own range if None."""
    files: Sequence[CacheFiles] | None = None
    """Where to write, for each cloth; the objects' own caches if None."""
    threads: int = 0
    """0 takes every core."""


class Bake:
    """A bake of cloths that are simulated together. Only their `session_uid` is held between two steps, never an object."""

    def __init__(
        self,
        cloths: Sequence[bpy.types.Object],
        scene: bpy.types.Scene,
        options: Options | None = None,
    ) -> None:
        """Prepare nothing yet; `steps` does all the work."""
        self.names = [obj.name for obj in cloths]
        self.options = options or Options()
        self.uids = [obj.session_uid for obj in cloths]
        self._scene_name = scene.name
        self.stores: Stores | None = None
        self._interrupter: Any = None
        self._began = (0.0, 1 << 30)
        """When the first frame was asked for, and which one it was."""
        ends = (obj.boucle.frame_end for obj in cloths)
        self.end = self.options.frames[1] if self.options.frames else max(ends)

    @property
    def title(self) -> str:
        """What is baked, in words."""
        return " and ".join(
            [", ".join(self.names[:-1]), self.names[-1]] if self.names[1:] else self.names
        )

    @property
    def last_frame(self) -> int | None:
        """The last frame that is kept."""
        return self.stores.last_frame if self.stores and self.stores.sample_count else None

    def progress(self, step: Step) -> str:
        """How far the bake is, for the status bar."""
        began, first = self._began
        frames = step.frame - first
        mean = (time.monotonic() - began) / frames if frames > 0 else 0.0
        return progress.line(self.title, step.frame, self.end, mean, self.end - step.frame + 1)

    def part(self, step: Step) -> float:
        """How far the bake is, from 0 to 1."""
        first = min(self._began[1], step.frame)
        return (step.frame - first) / max(self.end + 1 - first, 1)

    def interrupt(self) -> None:
        """Let the step that is running end at once, without its frame."""
        if self._interrupter is not None:
            self._interrupter.interrupt()

    def steps(self) -> Iterator[Step]:
        """Simulate and write; leaves the scene at the frame where it stood.

        Raises:
            Refusal, native.BoucleError: One sentence; the frames before it are kept.
        """
        with self._quiet():
            yield from self._steps()

    def _steps(self) -> Iterator[Step]:
        cloths, scene = self._objects(), self._scene()
        for obj in cloths:
            preflight.refuse_errors(obj, scene)
        start = cloths[0].boucle.frame_start
        self._go_to(start)
        description = self._describe(cloths, scene)
        self._restrict(description)
        met = colliders.Colliders(cloths, scene, self._depsgraph_of(cloths[0]))
        pushing, blowing = Fields(cloths[0], scene), Winds(cloths, description)
        water = Water(cloths[0], description)
        given = [simulation.given(obj, self._start(obj), self._matrix(obj)) for obj in cloths]
        make = simulation.maker(description, given, self.options.threads, met.arrays)
        build = Step(start, make)
        records = self._records(cloths, scene)
        yield build
        solver = build.result()
        self._interrupter = solver.interrupter()
        self.stores = self._make_stores(description, records, solver)
        counts = [own["vertices"] for own in records]
        held = [pins.Pins(description, cloth, count) for cloth, count in enumerate(counts)]

        def moment_at(frame: int) -> Moment:
            if start < frame < self._began[1]:
                self._began = (time.monotonic(), frame)
            moment = self._moment(frame, held, met)
            depsgraph = self._depsgraph_of(self._objects()[0])
            return moment._replace(
                forces=pushing.sample(depsgraph),
                winds=blowing.sample(depsgraph),
                water=water.sample(depsgraph),
            )

        bake_view.begin(dict(zip(self.uids, self._growing(), strict=True)))
        try:
            yield from core_bake.bake(
                solver, self.stores, moment_at, self.options.resume, native.InternalError
            )
            yield from self._join(solver)
        finally:
            bake_view.end()
            self._attach()

    def _growing(self) -> list[bake_view.Growing]:
        """The caches that grow, and the edges to draw of each."""
        pairs = zip(self._objects(), self.stores.each, strict=True)
        return [bake_view.growing(obj, store.files.pc2, store.plan.layout) for obj, store in pairs]

    def _join(self, solver: Any) -> Iterator[Step]:
        """Leave caches of torn cloths with no more points than their tears ask for."""
        for number, (obj, store) in enumerate(zip(self._objects(), self.stores.each, strict=True)):
            full = store.plan.layout
            if full is None or not (self.options.files or tearing.may_mark(obj)):
                continue
            least = tearing.layout(obj.data, solver.torn_edges(number))
            work = partial(torn.arrange, store.files.pc2, store.files.tear, full, least)
            step = Step(self.end, work)
            yield step
            step.result()

    def _describe(
        self, cloths: Sequence[bpy.types.Object], scene: bpy.types.Scene
    ) -> dict[str, Any]:
        """The scene description of all cloths."""
        if len(cloths) == 1:
            return settings.describe(cloths[0], scene, with_groups=True)
        by_name = {obj.name: obj for obj in cloths}
        described = [settings.describe(obj, scene, True, others=cloths) for obj in cloths]
        return joint.join(
            described, lambda one, other: colliders.meet(by_name[one], by_name[other])
        )

    def _start(self, obj: bpy.types.Object) -> points.Points:
        """The positions (m, world space) from which a cloth starts."""
        depsgraph = self._depsgraph_of(obj)
        sampling.refuse_other_count(obj, depsgraph)
        return points.transform(sampling.targets(obj, depsgraph), self._matrix(obj), "d")

    def _matrix(self, obj: bpy.types.Object) -> points.Affine:
        return sampling.object_matrix(obj, self._depsgraph_of(obj))

    def _restrict(self, description: dict[str, Any]) -> None:
        """Frames that are kept may end before or after the cloths' own range."""
        if self.options.frames is None:
            return
        first, end = self.options.frames
        start = description["scene"]["frames"][0]
        if end < first or first < start:
            raise Refusal(
                f'"{self.names[0]}": frames {first} to {end} cannot be kept: accepted is a range '
                f"that begins at the cloth's start frame {start} or later"
            )
        description["scene"]["frames"][1] = end

    def _records(
        self, cloths: Sequence[bpy.types.Object], scene: bpy.types.Scene
    ) -> list[dict[str, Any]]:
        """What the bake remembers of each cloth."""
        kept = self.options.frames
        cache.ensure_identity()
        known = {obj.boucle.uuid: obj.name for obj in cloths}
        records = []
        for obj in cloths:
            made = record.of(obj, scene, others=cloths)
            first = kept[0] if kept else obj.boucle.frame_start
            made.update(first=first, end=self.end, is_part=kept is not None)
            if len(cloths) > 1:
                made["together"] = {u: name for u, name in known.items() if u != obj.boucle.uuid}
                made["order"] = list(known)
            records.append(made)
        return records

    def _make_stores(
        self, description: dict[str, Any], records: list[dict[str, Any]], solver: Any
    ) -> Stores:
        left_out = {"end": None, "together": None, "order": None}
        remembered = [{**own, **left_out} for own in records]
        digest = drift.whole_digest(remembered[0] if len(records) == 1 else {"all": remembered})
        stores = []
        for number, (obj, own) in enumerate(zip(self._objects(), records, strict=True)):
            plan = Plan(
                start=description["scene"]["frames"][0],
                first=own["first"],
                end=self.end,
                vertex_count=own["vertices"],
                corner_count=len(obj.data.loops),
                layout=tearing.layout(obj.data, None) if obj.boucle.use_tear else None,
                digest=digest,
                keeps=vertex_attributes.wanted(obj),
                settling=scene_json.settling(description),
            )
            rows = self._report(obj, description, solver.spring_count(number))
            rows.record = own
            files = self.options.files[number] if self.options.files else cache.own_files(obj)
            stores.append(Store(files, plan, rows, keeps_previous=self.options.files is None))
        return Stores(stores)

    def _report(
        self, obj: bpy.types.Object, description: dict[str, Any], springs: int
    ) -> report.Report:
        mesh = obj.data
        cloth = {
            "name": obj.name,
            "vertices": len(mesh.vertices),
            "triangles": len(mesh.loops) - 2 * len(mesh.polygons),
            "springs": springs,
        }
        threads = self.options.threads or os.cpu_count() or 1
        rows = report.Report(native.manifest_version(), bpy.data.filepath, threads, cloth)
        rows.head["integrator"] = description["solver"]["integrator"]
        rows.head["hash_algorithm"] = "xxh3-64"
        if len(self.uids) > 1:
            rows.head["together"] = self.names
        return rows

    def _moment(self, frame: int, held: Sequence[pins.Pins], met: colliders.Colliders) -> Moment:
        self._go_to(frame)
        cloths = self._objects()
        depsgraphs = [self._depsgraph_of(obj) for obj in cloths]
        poses = [
            sampling.pose(obj, depsgraph, own)
            for obj, depsgraph, own in zip(cloths, depsgraphs, held, strict=True)
        ]
        return Moment(poses, met.targets(depsgraphs[0]))

    def _attach(self) -> None:
        """Play what is there, if it is the objects' own caches; a folder elsewhere is left alone."""
        if self.options.files is not None or not self.stores.sample_count:
            return
        for uid, store in zip(self.uids, self.stores.each, strict=True):
            obj = registry.by_uid(uid)
            if obj is not None:
                cache.attach(obj, store.files.pc2, store.rows.record)

    def _objects(self) -> list[bpy.types.Object]:
        found = []
        for uid, name in zip(self.uids, self.names, strict=True):
            obj = registry.by_uid(uid)
            if obj is None or not registry.is_cloth(obj):
                raise Refusal(f'"{name}" is no Boucle cloth any more: frames so far are kept')
            found.append(obj)
        return found

    def _scene(self) -> bpy.types.Scene:
        scene = bpy.data.scenes.get(self._scene_name)
        if scene is None:
            raise Refusal(f'the scene "{self._scene_name}" is gone: frames so far are kept')
        return scene

    def _go_to(self, frame: int) -> None:
        self._objects()
        self._scene().frame_set(frame)

    def _depsgraph_of(self, obj: bpy.types.Object) -> bpy.types.Depsgraph:
        layer = registry.layer_of(obj, self._scene())
        return layer.depsgraph if layer.depsgraph else bpy.context.evaluated_depsgraph_get()

    @contextmanager
    def _quiet(self) -> Iterator[None]:
        """Live mode still, the rest shape in place, modifiers below the slot off; all restored after."""
        cloths, scene = self._objects(), self._scene()
        frame, subframe = scene.frame_current, scene.frame_subframe
        shown: list[dict[str, bool]] = []
        for obj in cloths:
            live.drop(obj)
            slot.show(slot.ensure(obj), False)
            # One of Collision costs little, and says that others collide with the cloth.
            below = [modifier for modifier in slot.below(obj) if modifier.type != "COLLISION"]
            shown.append({modifier.name: modifier.show_viewport for modifier in below})
        runtime.busy.add("bake")
        try:
            for obj, names in zip(cloths, shown, strict=True):
                for name in names:
                    obj.modifiers[name].show_viewport = False
            yield
        finally:
            for uid, states in zip(self.uids, shown, strict=True):
                _restore(registry.by_uid(uid), states)
            if bpy.data.scenes.get(self._scene_name) is not None:
                self._scene().frame_set(frame, subframe=subframe)
            runtime.busy.discard("bake")
            self._show_attributes()

    def _show_attributes(self) -> None:
        scene = bpy.data.scenes.get(self._scene_name)
        for uid in self.uids:
            obj = registry.by_uid(uid)
            if registry.is_cloth(obj) and scene is not None:
                live.show_attributes(obj, scene)


def _restore(obj: bpy.types.Object | None, shown: dict[str, bool]) -> None:
    """Let a cloth's modifiers be seen again as they were."""
    if obj is None:
        return
    for name, state in shown.items():
        if obj.modifiers.get(name) is not None:
            obj.modifiers[name].show_viewport = state
    found = slot.find(obj)
    if found is not None:
        slot.show(found, bool(slot.played(found.cache)))


def outcome(done: Bake, error: BaseException | None) -> str:
    """What became of a bake, in one sentence."""
    names = ", ".join(f'"{name}"' for name in done.names)
    are = "are" if len(done.names) > 1 else "is"
    kept = f"frames up to {done.last_frame} are kept" if done.last_frame is not None else ""
    if error is None:
        together = " together" if len(done.names) > 1 else ""
        return f"{names} {are} baked{together} to frame {done.last_frame}"
    if isinstance(error, GeneratorExit | native.InterruptionError):
        were = "were" if len(done.names) > 1 else "was"
        return f"{names} {were} stopped" + (f"; {kept}, Resume goes on" if kept else "")
    text = sentence_of(error)
    if isinstance(error, native.DivergedError):
        text += ": take smaller steps, or a stiffness that fits them"
    return f"{text}; {kept}" if kept and "kept" not in text else text
