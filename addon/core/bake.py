"""A bake: simulate frames in order, write each one, and keep what is done whatever happens.

The bake is a generator of steps. A step's `run` may be called on any thread: it holds no Blender data and the solver lets
the interpreter go. Everything between two steps (moving the scene, reading pins, writing files) happens in the caller's
thread, when it asks for the next step. A window and a script so pull the same generator:

    for step in bake(...):
        step.run()
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple, Protocol

from . import checkpoint_file, points, quantity, report, vertex_file
from .cache_paths import CacheFiles
from .pc2 import Writer
from .points import Affine, Points
from .quantity import Numbers
from .refusal import Refusal, cannot_write

CHECKPOINT_SECONDS = 5.0
"""A kill loses at most about this much work; writing a checkpoint takes milliseconds."""


class Simulation(Protocol):
    """What a bake needs of the solver: one cloth, number 0."""

    frame: int

    def set_pin_targets(self, cloth: int, targets: Points) -> None: ...
    def set_pin_weights(self, cloth: int, weights: Points) -> None: ...
    def set_pin_stiffness(self, cloth: int, stiffness: float) -> None: ...
    def set_collider_targets(self, collider: int, targets: Points) -> None: ...
    def advance(self) -> dict[str, Any]: ...
    def certificate(self) -> dict[str, Any]: ...
    def read_positions(self, cloth: int, out: Points) -> None: ...
    def read_strain(self, cloth: int, out: Points) -> None: ...
    def read_contacts(self, cloth: int, out: Points) -> None: ...
    def read_intersections(self, cloth: int, out: Points) -> None: ...
    def checkpoint(self) -> bytes: ...
    def restore(self, checkpoint: bytes) -> None: ...


class Hold(NamedTuple):
    """How firmly pins are held from a frame on."""

    weights: Points
    """0 free to 1 hard, one for each vertex of the mesh."""
    stiffness: float
    """(N/m), of pins that hang together, at weight 1."""


class Pose(NamedTuple):
    """What the scene says of a frame: where pins and colliders go (m, world space) and world to object space."""

    targets: Points | None
    """For all vertices; None without pins."""
    to_object: Affine
    colliders: Sequence[Points] = ()
    hold: Hold | None = None
    """None if it is as before."""

    def aim(self, simulation: Simulation) -> None:
        """Tell a simulation where pins and colliders go in the next frame."""
        if self.targets is not None:
            simulation.set_pin_targets(0, self.targets)
        if self.hold is not None:
            simulation.set_pin_weights(0, self.hold.weights)
            simulation.set_pin_stiffness(0, self.hold.stiffness)
        for number, targets in enumerate(self.colliders):
            simulation.set_collider_targets(number, targets)


class Plan(NamedTuple):
    """What to bake: simulated from start to end, kept from first to end."""

    start: int
    first: int
    end: int
    vertex_count: int
    digest: str
    keeps: tuple[str, ...] = ()
    """Keys of the quantities that are kept beside the positions."""


class Step:
    """One piece of work for any thread."""

    def __init__(self, frame: int, work: Callable[[], Any]) -> None:
        """Work that leads to a frame."""
        self.frame = frame
        self.seconds = 0.0
        self._work = work
        self._outcome: tuple[Any, BaseException | None] | None = None

    def run(self) -> None:
        """Do the work; an error is kept for `result`."""
        begin = time.perf_counter()
        try:
            self._outcome = (self._work(), None)
        except Exception as error:  # noqa: BLE001 (raised again by `result`, in the caller's thread)
            self._outcome = (None, error)
        self.seconds = time.perf_counter() - begin

    @property
    def succeeded(self) -> bool:
        """Whether the work is done and raised nothing."""
        return self._outcome is not None and self._outcome[1] is None

    def result(self) -> Any:
        """What the work gave; raises what it raised."""
        if self._outcome is None:
            raise RuntimeError("a step must run before the next one is asked for")
        value, error = self._outcome
        if error is not None:
            raise error
        return value


class Store:
    """The files of one bake: samples, report and checkpoint."""

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
        self._saved_at = time.monotonic()
        self.last_frame: int | None = None

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
                for path in self.files.existing():
                    os.remove(path)
        except OSError as error:
            raise cannot_write(self.files.pc2, error) from error
        self._writer = Writer.create(self.files.pc2, self.plan.vertex_count, self.plan.first)
        for key in self.plan.keeps:
            path = getattr(self.files, key)
            self._numbers[key] = vertex_file.Writer.create(path, self.plan.vertex_count)

    def resume(self, simulation: Simulation) -> bool:
        """Take up the checkpoint; False if there is none.

        Raises:
            Refusal: The checkpoint is damaged or of another cloth.
        """
        checkpoint = checkpoint_file.read(self.files.checkpoint)
        if checkpoint is None:
            return False
        if checkpoint.digest != self.plan.digest:
            raise Refusal(
                f'the checkpoint "{self.files.checkpoint}" is of other settings or another mesh: '
                "undo the change or bake from the start"
            )
        simulation.restore(checkpoint.state)
        self._writer = Writer.reopen(
            self.files.pc2, self.plan.vertex_count, checkpoint.sample_count
        )
        self._resume_numbers(checkpoint.sample_count)
        self.rows.keep_first(checkpoint.sample_count, report.read(self.files.report))
        self.last_frame = checkpoint.frame
        return True

    def _resume_numbers(self, sample_count: int) -> None:
        """Numbers that were not kept from the start cannot be made up for: what is there goes."""
        for key in (one.key for one in quantity.ALL):
            path, writer = getattr(self.files, key), None
            if key in self.plan.keeps:
                writer = vertex_file.Writer.reopen(path, self.plan.vertex_count, sample_count)
            if writer is not None:
                self._numbers[key] = writer
            elif os.path.isfile(path):
                os.remove(path)

    def write(
        self, frame: int, positions: Points, numbers: Numbers, row: dict[str, Any], step: Step
    ) -> None:
        """Add a frame: positions (m), object space, float32, numbers at its vertices and its certificate."""
        if frame >= self.plan.first:
            for key, writer in self._numbers.items():
                writer.append(numbers[key])
            self._writer.append(positions)
            self.rows.add(row, step.seconds)
        self.last_frame = frame

    def save(self, simulation: Simulation) -> None:
        """Write report and checkpoint, if it is time."""
        if time.monotonic() - self._saved_at >= CHECKPOINT_SECONDS:
            self._save(simulation)

    def finish(self, simulation: Simulation | None) -> None:
        """Write report and checkpoint; no checkpoint of a state that the file does not end with."""
        if self.last_frame is None:
            return
        if simulation is not None and simulation.frame == self.last_frame:
            self._save(simulation)
        else:
            self.rows.write(self.files.report)

    def _save(self, simulation: Simulation) -> None:
        state = checkpoint_file.Checkpoint(
            self.last_frame, self.sample_count, self.plan.digest, simulation.checkpoint()
        )
        self.rows.write(self.files.report)
        checkpoint_file.write(self.files.checkpoint, state)
        self._saved_at = time.monotonic()

    def close(self) -> None:
        """Close the files."""
        for writer in (self._writer, *self._numbers.values()):
            if writer:
                writer.close()


def set_aside(files: CacheFiles) -> None:
    """Keep the files of an earlier bake under the name `previous`."""
    if not os.path.isfile(files.pc2):
        return
    for path, kept in zip(files, files.previous, strict=True):
        if os.path.isfile(path):
            os.replace(path, kept)
        elif os.path.isfile(kept):
            os.remove(kept)


def bake(
    simulation: Simulation,
    store: Store,
    pose_at: Callable[[int], Pose],
    resume: bool,
    fatal: type[Exception],
) -> Iterator[Step]:
    """Simulate the plan's frames in order, write each one, and yield a step for every frame.

    Args:
        simulation: At rest at the plan's start; left at the last frame reached.
        store: Receives every frame; closed at the end, whatever happens.
        pose_at: Brings the scene to a frame and reads it; called between steps.
        resume: Go on from the store's checkpoint if there is one.
        fatal: The error after which the simulation must not be touched again.

    Raises:
        Refusal: Resume is not possible, or a file cannot be written; earlier frames stay.
        DivergedError: A position left the finite numbers; earlier frames stay.
        UnstableError: The next frame would not be stable with these settings; earlier frames stay.
    """
    plan = store.plan
    world = points.empty("d", 3 * plan.vertex_count)
    numbers = quantity.empty(plan.keeps, plan.vertex_count)
    pending: tuple[Step, Pose] | None = None
    usable = True

    def commit(step: Step, pose: Pose) -> None:
        certificate = step.result()
        positions = points.transform(world, pose.to_object, "f")
        store.write(step.frame, positions, numbers, certificate, step)

    try:
        if not (resume and store.resume(simulation)):
            store.begin()
            begin = Step(plan.start, lambda: _rest(simulation, world, numbers))
            begin.run()
            commit(begin, pose_at(plan.start))
        for frame in range(simulation.frame + 1, plan.end + 1):
            pose = pose_at(frame)
            step = Step(frame, lambda pose=pose: _advance(simulation, pose, world, numbers))
            pending = (step, pose)
            yield step
            pending = None
            commit(step, pose)
            store.save(simulation)
    except fatal:
        usable = False
        raise
    finally:
        try:
            if pending and pending[0].succeeded:
                commit(*pending)
            store.finish(simulation if usable else None)
        finally:
            store.close()


def _rest(simulation: Simulation, world: Points, numbers: Numbers) -> dict[str, Any]:
    _read(simulation, world, numbers)
    return simulation.certificate()


def _advance(simulation: Simulation, pose: Pose, world: Points, numbers: Numbers) -> dict[str, Any]:
    pose.aim(simulation)
    certificate = simulation.advance()
    _read(simulation, world, numbers)
    return certificate


def _read(simulation: Simulation, world: Points, numbers: Numbers) -> None:
    simulation.read_positions(0, world)
    quantity.read(simulation, numbers)
