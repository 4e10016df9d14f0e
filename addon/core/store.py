"""The files of a bake: samples, numbers and report of every cloth, and the one checkpoint from which they go on together."""

from __future__ import annotations

import os
import time
import uuid
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from . import checkpoint_file, pc2, quantity, report, torn, vertex_file
from .cache_paths import CacheFiles
from .checkpoint_file import Checkpoint
from .pc2 import Writer
from .points import Points
from .quantity import Numbers, Sizes
from .refusal import Refusal, cannot_write
from .settle import Settling
from .torn import Layout

CHECKPOINT_SECONDS = 5.0
"""A kill loses at most about this much work; writing a checkpoint takes milliseconds."""


class Saved(Protocol):
    """What can be saved and taken up again."""

    frame: int

    def checkpoint(self) -> bytes: ...
    def restore(self, checkpoint: bytes) -> None: ...


class Plan(NamedTuple):
    """What to keep of a cloth: it is simulated from start to end, kept from first to end."""

    start: int
    first: int
    end: int
    vertex_count: int
    digest: str
    """Of everything that the motion depends on: one for all cloths of a bake."""
    keeps: tuple[str, ...] = ()
    """Keys of the quantities that are kept beside the positions."""
    settling: Settling = Settling()
    """Before the start."""
    corner_count: int = 0
    """Corners of the faces."""
    layout: Layout | None = None
    """Of a cloth that may tear, where it is split along all edges."""

    @property
    def point_count(self) -> int:
        """Points of a sample."""
        return self.layout.point_count if self.layout else self.vertex_count

    @property
    def sizes(self) -> Sizes:
        """How many numbers there are."""
        return Sizes(self.vertex_count, self.corner_count, self.layout is not None)


class Sample(NamedTuple):
    """One frame of one cloth."""

    positions: Points
    """(m), object space, float32."""
    numbers: Numbers
    certificate: Mapping[str, Any]


class Store:
    """The files of one cloth, but for the checkpoint."""

    def __init__(
        self, files: CacheFiles, plan: Plan, rows: report.Report, keeps_previous: bool = True
    ) -> None:
        """Nothing is written before `begin` or `resume`."""
        self._keeps_previous = keeps_previous
        self.files = files
        self.plan = plan
        self.rows = rows
        self._writer: Writer | None = None
        self._numbers: dict[str, vertex_file.Writer] = {}

    @property
    def name(self) -> str:
        """The cloth's name."""
        return str(self.rows.cloth["name"])

    @property
    def sample_count(self) -> int:
        """Frames in the file."""
        return self._writer.sample_count if self._writer else 0

    def begin(self) -> None:
        """Start afresh: files of an earlier bake are set aside as the previous ones, or removed."""
        try:
            if self._keeps_previous:
                set_aside(self.files)
            else:
                for path in _in_turn(self.files):
                    if os.path.isfile(path):
                        os.remove(path)
        except OSError as error:
            raise cannot_write(self.files.pc2, error) from error
        self._writer = Writer.create(self.files.pc2, self.plan.point_count, self.plan.first)
        if self.plan.layout:
            torn.write(self.files.tear, self.plan.layout)
        for key in self.plan.keeps:
            path, count = getattr(self.files, key), self.plan.sizes.count(key)
            self._numbers[key] = vertex_file.Writer.create(path, count)

    def resume(self, rows: Sequence[Mapping[str, Any]]) -> None:
        """Go on after the samples that rows of the report tell of."""
        if self.plan.layout:
            torn.restore_corners(self.files.pc2, self.files.tear, self.plan.layout)
        digests = [row["sample_hashes"][0] for row in rows]
        plan = self.plan
        self._writer = Writer.reopen(self.files.pc2, plan.point_count, plan.first, digests)
        self._resume_numbers(rows)
        self.rows.frames = [dict(row) for row in rows]

    def _resume_numbers(self, rows: Sequence[Mapping[str, Any]]) -> None:
        """Numbers that were not kept from the start cannot be made up for: what is there goes."""
        for key in (one.key for one in quantity.ALL):
            path, count = getattr(self.files, key), self.plan.sizes.count(key)
            known = [row["number_hashes"].get(key) for row in rows]
            if key not in self.plan.keeps or not all(known):
                if os.path.isfile(path):
                    os.remove(path)
            elif known:
                self._numbers[key] = vertex_file.Writer.reopen(path, count, known)
            else:
                self._numbers[key] = vertex_file.Writer.create(path, count)

    def write(self, frame: int, sample: Sample, seconds: float) -> None:
        """Add a frame, if it is one to keep."""
        if frame < self.plan.first:
            return
        for key, writer in self._numbers.items():
            writer.append(sample.numbers[key])
        self._writer.append(sample.positions)
        hashes = {key: pc2.digest(sample.numbers[key]) for key in self._numbers}
        self.rows.add(sample.certificate, seconds, pc2.digest(sample.positions), hashes)

    def close(self) -> None:
        """Close the files."""
        for writer in (self._writer, *self._numbers.values()):
            if writer:
                writer.close()


class Stores:
    """The files of all cloths of a bake.

    The first cloth's checkpoint holds the state of all; the others' hold none and tell by the bake's identity whose they are.
    """

    def __init__(self, each: Sequence[Store]) -> None:
        """Nothing is written before `begin` or `resume`."""
        self.each = list(each)
        self.identity = uuid.uuid4().hex
        """Of this bake; a resumed one keeps it."""
        self._saved_at = time.monotonic()
        self.last_frame: int | None = None

    @property
    def plan(self) -> Plan:
        """What is simulated: the same frames for all cloths."""
        return self.each[0].plan

    @property
    def sample_count(self) -> int:
        """Frames in every file."""
        return self.each[0].sample_count

    def begin(self) -> None:
        """Start afresh."""
        for store in self.each:
            store.begin()
        self._identify()

    def resume(self, simulation: Saved) -> bool:
        """Take up the checkpoint; False if there is none.

        Raises:
            Refusal: The checkpoint is damaged, or of other cloths.
        """
        found = [checkpoint_file.read(store.files.checkpoint) for store in self.each]
        if not any(found) or _was_begun_in_part(found):
            return False
        state = self._common(found)
        simulation.restore(state.state)
        for store, rows in zip(self.each, state.rows, strict=True):
            store.resume(rows)
        self.identity, self.last_frame = state.bake, state.frame
        self._identify()
        return True

    def _common(self, found: Sequence[Checkpoint | None]) -> Checkpoint:
        """The checkpoint with the state, if all belong to one bake of these cloths."""
        first = next(checkpoint for checkpoint in found if checkpoint)
        if len(self.each) == 1 and len(first.cloths) > 1:
            others = ", ".join(f'"{name}"' for name in first.cloths if name != self.each[0].name)
            raise Refusal(
                f'"{self.each[0].name}" was baked together with {others}: go on with all of them, '
                "or bake from the start"
            )
        for store, checkpoint in zip(self.each, found, strict=True):
            if checkpoint is None or checkpoint.bake != found[0].bake:
                odd = store.name if found[0] else self.each[0].name
                raise Refusal(
                    f'the bake of "{odd}" has gone or is another one than that of '
                    f'"{(self.each[0] if found[0] else self.each[1]).name}": bake them from the start'
                )
        if first.digest != self.plan.digest or len(first.cloths) > len(self.each):
            raise Refusal(
                f'the checkpoint "{self.each[0].files.checkpoint}" is of other settings or another '
                "mesh: undo the change or bake from the start"
            )
        return first

    def _identify(self) -> None:
        for store in self.each:
            store.rows.record["bake"] = self.identity

    def write(self, frame: int, samples: Sequence[Sample], seconds: float) -> None:
        """Add a frame of every cloth."""
        for store, sample in zip(self.each, samples, strict=True):
            store.write(frame, sample, seconds)
        self.last_frame = frame

    def mark(self, simulation: Saved) -> None:
        """At the start of a bake of several cloths: bind their files to each other."""
        if len(self.each) == 1:
            return
        self._save(simulation)
        for store in self.each[1:]:
            checkpoint_file.write(store.files.checkpoint, self._checkpoint(b"", ()))

    def save(self, simulation: Saved) -> None:
        """Write reports and checkpoint, if it is time."""
        if time.monotonic() - self._saved_at >= CHECKPOINT_SECONDS:
            self._save(simulation)

    def finish(self, simulation: Saved | None) -> None:
        """Write reports and checkpoint; no checkpoint of a state that the files do not end with."""
        if self.last_frame is None:
            return
        if simulation is not None and simulation.frame == self.last_frame:
            self._save(simulation)
        else:
            self._write_reports()

    def _save(self, simulation: Saved) -> None:
        self._write_reports()
        rows = [store.rows.frames for store in self.each]
        state = self._checkpoint(simulation.checkpoint(), rows)
        checkpoint_file.write(self.each[0].files.checkpoint, state)
        self._saved_at = time.monotonic()

    def _checkpoint(self, state: bytes, rows: Sequence[Sequence[Mapping[str, Any]]]) -> Checkpoint:
        names = tuple(store.name for store in self.each)
        place = self.last_frame, self.sample_count
        return Checkpoint(*place, self.plan.digest, state, self.identity, names, rows)

    def _write_reports(self) -> None:
        for store in self.each:
            store.rows.write(store.files.report)

    def close(self) -> None:
        """Close the files."""
        for store in self.each:
            store.close()


def _was_begun_in_part(found: Sequence[Checkpoint | None]) -> bool:
    """Whether a bake of several cloths ended while `mark` bound their files to each other: there is nothing to go on from."""
    first = found[0]
    return first is not None and first.sample_count <= 1 and None in found


def set_aside(files: CacheFiles) -> None:
    """Keep the files of an earlier bake under the name `previous`; after a kill in between the next call goes on."""
    pairs = dict(zip(files, files.previous, strict=True))
    if os.path.isfile(files.pc2):
        for path, kept in pairs.items():
            if os.path.isfile(kept) and not os.path.isfile(path):
                os.remove(kept)
    for path in _in_turn(files):
        if os.path.isfile(path):
            os.replace(path, pairs[path])


def _in_turn(files: CacheFiles) -> list[str]:
    """The files in the order in which an earlier bake leaves: first that from which another would go on."""
    return [files.checkpoint, *(path for path in files if path != files.checkpoint)]
