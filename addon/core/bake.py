"""A bake: simulate frames in order, write each one, and keep what is done whatever happens.

The bake is a generator of steps. A step's `run` may be called on any thread: it holds no Blender data and the solver lets
the interpreter go. Everything between two steps (moving the scene, reading pins, writing files) happens in the caller's
thread, when it asks for the next step. A window and a script so pull the same generator:

    for step in bake(...):
        step.run()
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple, Protocol

from . import points, quantity
from .fields import Forces
from .points import Affine, Points
from .quantity import Numbers, Sizes
from .settle import Settle
from .shape import Shape
from .store import Plan, Sample, Stores
from .torn import Layout


class Simulation(Protocol):
    """What a bake needs of the solver."""

    frame: int

    def set_pin_targets(self, cloth: int, targets: Points) -> None: ...
    def set_pin_weights(self, cloth: int, weights: Points) -> None: ...
    def set_pin_stiffness(self, cloth: int, stiffness: float) -> None: ...
    def set_collider_targets(self, collider: int, targets: Points) -> None: ...
    def set_gravity(self, gravity: tuple[float, float, float]) -> None: ...
    def set_fields(self, fields: str) -> None: ...
    def set_wind_velocity(self, wind: int, velocity: tuple[float, float, float]) -> None: ...
    def set_water(self, level: float, velocity: tuple[float, float, float]) -> None: ...
    def advance(self) -> dict[str, Any]: ...
    def certificate(self, cloth: int | None = None) -> dict[str, Any]: ...
    def set_positions(self, cloth: int, positions: Points) -> None: ...
    def read_positions(self, cloth: int, out: Points) -> None: ...
    def read_corners(self, cloth: int, out: Points) -> None: ...
    def read_corner_numbers(self, cloth: int, quantity: str, out: Points) -> None: ...
    def read_strain(self, cloth: int, out: Points) -> None: ...
    def read_tension(self, cloth: int, out: Points) -> None: ...
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
    """What the scene says of a cloth at a frame: where its pins go (m, world space), world to object space, the shape."""

    targets: Points | None
    """For all vertices; None without pins."""
    to_object: Affine
    shape: Shape = Shape()
    hold: Hold | None = None
    """None if it is as before."""

    def aim(self, simulation: Simulation, cloth: int) -> None:
        """Tell a simulation where the pins of a cloth go in the next frame, how firmly, and what its shape is to be."""
        if self.targets is not None:
            simulation.set_pin_targets(cloth, self.targets)
        if self.hold is not None:
            simulation.set_pin_weights(cloth, self.hold.weights)
            simulation.set_pin_stiffness(cloth, self.hold.stiffness)
        self.shape.aim(simulation, cloth)


class Moment(NamedTuple):
    """What the scene says of a frame: the pose of every cloth, and where colliders go (m, world space)."""

    poses: Sequence[Pose]
    colliders: Sequence[Points] = ()
    forces: Forces | None = None
    """None where gravity stays as it is and there are no fields."""
    winds: Sequence[tuple[int, tuple[float, float, float]]] = ()
    """Numbers of winds that change, and their velocities (m/s)."""
    water: tuple[float, tuple[float, float, float]] | None = None
    """Level (m) and current (m/s) of a water that changes."""

    def aim(self, simulation: Simulation) -> None:
        """Tell a simulation what goes where in the next frame, and what pushes."""
        if self.forces is not None:
            simulation.set_gravity(self.forces.gravity)
            simulation.set_fields(self.forces.fields)
        for wind, velocity in self.winds:
            simulation.set_wind_velocity(wind, velocity)
        if self.water is not None:
            simulation.set_water(*self.water)
        for cloth, pose in enumerate(self.poses):
            pose.aim(simulation, cloth)
        for number, targets in enumerate(self.colliders):
            simulation.set_collider_targets(number, targets)


class Buffers(NamedTuple):
    """What is read of a cloth after each frame."""

    world: Points
    """Positions (m) of the vertices, or of the corners of a cloth that may tear, world space, float64."""
    numbers: Numbers
    sizes: Sizes
    layout: Layout | None

    @classmethod
    def of(cls, plan: Plan) -> Buffers:
        """Room for what a plan keeps."""
        count = plan.corner_count if plan.layout else plan.vertex_count
        numbers = quantity.empty(plan.keeps, plan.sizes)
        return cls(points.empty("d", 3 * count), numbers, plan.sizes, plan.layout)

    def read(self, simulation: Simulation, cloth: int) -> None:
        """Read a cloth of a simulation."""
        if self.layout is None:
            simulation.read_positions(cloth, self.world)
        else:
            simulation.read_corners(cloth, self.world)
        quantity.read(simulation, cloth, self.numbers, self.sizes)

    def positions(self, to_object: Affine) -> Points:
        """Positions (m) of the points of a sample, object space, float32."""
        positions = points.transform(self.world, to_object, "f")
        return positions if self.layout is None else self.layout.gather(positions)


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


def bake(
    simulation: Simulation,
    stores: Stores,
    moment_at: Callable[[int], Moment],
    resume: bool,
    fatal: type[Exception],
) -> Iterator[Step]:
    """Simulate the plan's frames in order, write each one, and yield a step for every frame.

    Args:
        simulation: At rest at the plan's start, or before it by the frames of settling; left at the last frame reached.
        stores: Receive every frame, one for each cloth in their order; closed at the end, whatever happens.
        moment_at: Brings the scene to a frame and reads it; called between steps.
        resume: Go on from the stores' checkpoint if there is one.
        fatal: The error after which the simulation must not be touched again.

    Raises:
        Refusal: Resume is not possible, or a file cannot be written; earlier frames stay.
        DivergedError: A position left the finite numbers; earlier frames stay.
        UnstableError: The next frame would not be stable with these settings; earlier frames stay.
        InterruptionError: The step under way was interrupted; earlier frames stay.
    """
    plan = stores.plan
    buffers = [Buffers.of(store.plan) for store in stores.each]
    pending: tuple[Step, Moment] | None = None
    usable = True
    try:
        if not (resume and stores.resume(simulation)):
            moment = moment_at(plan.start)
            moment.aim(simulation)
            yield from _settle(simulation, stores)
            stores.begin()
            begin = Step(plan.start, lambda: _read(simulation, simulation.certificate(), buffers))
            begin.run()
            _commit(stores, buffers, begin, moment)
            stores.mark(simulation)
        for frame in range(simulation.frame + 1, plan.end + 1):
            moment = moment_at(frame)
            step = Step(frame, lambda moment=moment: _advance(simulation, moment, buffers))
            pending = (step, moment)
            yield step
            pending = None
            _commit(stores, buffers, step, moment)
            stores.save(simulation)
    except fatal:
        usable = False
        raise
    finally:
        try:
            if pending and pending[0].succeeded:
                _commit(stores, buffers, *pending)
            stores.finish(simulation if usable else None)
        finally:
            stores.close()


def _commit(stores: Stores, buffers: Sequence[Buffers], step: Step, moment: Moment) -> None:
    samples = [
        Sample(read.positions(pose.to_object), read.numbers, certificate)
        for read, pose, certificate in zip(buffers, moment.poses, step.result(), strict=True)
    ]
    stores.write(step.frame, samples, step.seconds)


def _settle(simulation: Simulation, stores: Stores) -> Iterator[Step]:
    """A step for every frame of settling; nothing on disk is touched before they are done."""
    counts = [store.plan.vertex_count for store in stores.each]
    settle = Settle(simulation, stores.plan.settling, counts)
    while not settle.is_done:
        step = Step(simulation.frame + 1, settle.advance)
        yield step
        step.result()


def _advance(
    simulation: Simulation, moment: Moment, buffers: Sequence[Buffers]
) -> list[dict[str, Any]]:
    moment.aim(simulation)
    return _read(simulation, simulation.advance(), buffers)


def _read(
    simulation: Simulation, certificate: dict[str, Any], buffers: Sequence[Buffers]
) -> list[dict[str, Any]]:
    """Fill the buffers and give the certificate of each cloth; `certificate` is that of all."""
    for cloth, read in enumerate(buffers):
        read.read(simulation, cloth)
    if len(buffers) == 1:
        return [certificate]
    return [simulation.certificate(cloth) for cloth in range(len(buffers))]
