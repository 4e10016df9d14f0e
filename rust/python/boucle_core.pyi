"""Boucle's physics: cloth as springs, moved frame by frame. SI units, Z up, world space.

Every array argument is any C-contiguous object with the buffer protocol (array.array, numpy array, memoryview); numpy is
not needed. Where (n, 3) stands, a flat array of 3 n numbers is taken too; where int32 stands, any integers of 4 or 8 bytes.
A simulation is used by one thread at a time. Work runs with the interpreter released. The same input gives the same bits
for any number of threads.
"""

from collections.abc import Buffer, Callable, Mapping, Sequence
from typing import Any, final

__version__: str

class BoucleError(Exception):
    """Anything that this module refuses or reports. The message is one sentence."""

class SceneError(BoucleError, ValueError):
    """The input is wrong: names the key or object, the value and what would be accepted."""

class DivergedError(BoucleError, ArithmeticError):
    """A position left the finite numbers: "diverged at frame F, vertex V of cloth NAME". Earlier frames are kept."""

    frame: int
    vertex: int

class UnstableError(BoucleError, ArithmeticError):
    """From this frame on the settings would not stay stable. Earlier frames are kept."""

    frame: int

class CacheError(BoucleError, OSError):
    """A result cannot be written or read (disk full, no permission). Earlier frames are kept."""

class InterruptionError(BoucleError, RuntimeError):
    """A frame was stopped by an Interrupter: the state is that of the frame before it."""

    frame: int

class InternalError(BoucleError, RuntimeError):
    """A fault of our own: a Rust panic, caught. The simulation must be thrown away."""

@final
class Simulation:
    """Cloths in motion, at the end of `frame`."""

    def __new__(
        cls,
        scene: str,
        meshes: Sequence[tuple[Buffer, Buffer, Buffer]],
        threads: int = 0,
        colliders: Sequence[tuple[Buffer, Buffer, Buffer]] = (),
        rests: Sequence[Buffer | None] = (),
        uvs: Sequence[Buffer | None] = (),
    ) -> Simulation:
        """Build a simulation at the scene's first frame, at rest but for the scene's `velocity`.

        The scene's `transform`, pin `motion` and `release`, and the `motion` of its colliders hold.

        Args:
            scene: The scene file's keys as a JSON object, but `grid` and `mesh` of each cloth stand in `meshes`, `rest` in
                `rests`, and `mesh` and `cache` of a collider in `colliders` and `set_collider_targets`.
            meshes: For each cloth, in the scene's order: positions (m) that it starts from, float32 or float64 (n, 3), world
                space; the first corner of each face, int32 (f,) or (f + 1,); the vertex of each corner, int32 (c,).
            threads: 0 takes every core.
            colliders: The same arrays for each collider of the scene that has no `sphere`, `plane`, `box` or `capsule`, in the
                scene's order: where it stands at the first frame.
            rests: For each cloth its rest positions (m), float32 or float64 (n, 3), or None where they are those that it starts
                from.
            uvs: For each cloth the UV coordinates of its corners, float32 or float64 (c, 2), or None: along v runs the warp of
                a fabric whose `warp` is "uv".

        Raises:
            SceneError: A key, a value or a mesh is not accepted.
        """

    @property
    def frame(self) -> int: ...
    @property
    def cloth_names(self) -> list[str]: ...
    @property
    def collider_names(self) -> list[str]: ...
    @property
    def safe_time_step(self) -> float:
        """Largest step (s) that is stable with this integrator and that the limiter keeps up with; 0 if there is none.

        A whole frame for implicit integrators, with which any step is stable.
        """

    @property
    def substeps(self) -> int:
        """Steps that the next frame takes."""

    def vertex_count(self, cloth: int) -> int: ...
    def spring_count(self, cloth: int) -> int: ...
    def collider_point_count(self, collider: int) -> int:
        """How many points a collider has: those of its mesh, 1 of a sphere, 2 of a plane or capsule, 8 of a box."""

    def set_positions(self, cloth: int, positions: Buffer) -> None:
        """Put the vertices at positions (m), float32 or float64 (n, 3), at rest; rest lengths and creases stay."""

    def set_pin_targets(self, cloth: int, targets: Buffer) -> None:
        """Say where pins go: they reach it in a straight line at the end of the next frame.

        Args:
            cloth: Its number.
            targets: Positions (m), float32 or float64 (n, 3), for *all* vertices of the cloth, of which only the pinned
                are read. Where the scene moves the pins of this cloth itself (`motion`), the scene's targets hold.
        """

    def set_rest(
        self, cloth: int, shape: Buffer | None = None, shrink: tuple[float, float] | None = None
    ) -> None:
        """Say what rest lengths are to be at the end of the next frame; they change evenly over it.

        Args:
            cloth: Its number.
            shape: A rest shape (m), float32 or float64 (n, 3), whose lengths hold; None for the cloth's own.
            shrink: By which fraction they are less at vertices of weight 0 and of weight 1 in the scene's `shrink`; None for
                that of the first frame. Where the scene has keyframes, these hold.
        """

    def set_pressure(
        self, cloth: int, uniform: float, factor: float = 0.0, target_volume: float | None = None
    ) -> None:
        """Say what the pressure of a cloth whose scene has `pressure` is to be at the end of the next frame.

        Args:
            cloth: Its number.
            uniform: The part that does not depend on the volume (N/m²).
            factor: How much pressure (N/m²) twice the density of the filling adds.
            target_volume: The volume (m³) at which it balances; None for that at rest, 0 for none.
        """

    def set_collider_targets(self, collider: int, targets: Buffer) -> None:
        """Say where the points of a collider go: they reach it in straight lines at the end of the next frame, and rest there.

        Args:
            collider: Its number.
            targets: Positions (m), float32 or float64 (n, 3), world space, for all points of the collider. Where the scene
                moves it itself (`motion`), the scene's targets hold.
        """

    def set_fields(self, fields: str) -> None:
        """Take these force fields in the place of those before, for all frames until they are told anew.

        Args:
            fields: A JSON list of tables with the keys of a scene's `[[force]]`, of any kind but "wind" and "water". Fields
                stand still during a frame.

        Raises:
            SceneError: A key or a value is not accepted; the fields before then stay.
        """

    def set_wind_velocity(self, wind: int, velocity: tuple[float, float, float]) -> None:
        """Let a wind blow with this velocity (m/s) from the next frame on.

        Args:
            wind: Its number among the winds of the scene's `[[force]]`, in their order.
            velocity: Of the air, world space, up to 1e4 m/s along an axis.

        Raises:
            SceneError: There is no such wind, or the velocity is not accepted; the one before then stays.
        """

    def set_water(self, level: float, velocity: tuple[float, float, float]) -> None:
        """Put the calm surface of the scene's water at a height, and let its current flow so, from the next frame on.

        Args:
            level: Height (m) in world space.
            velocity: Of the current (m/s), up to 1000 along an axis.

        Raises:
            SceneError: The scene has no water, or a number is not accepted; what was before then stays.
        """

    def set_gravity(self, gravity: tuple[float, float, float]) -> None:
        """Take this gravity (m/s²) in the place of the one before, for all frames until it is told anew."""

    def release_pins(self, cloth: int, vertices: Sequence[int] | None = None) -> None:
        """Let pinned vertices (all if None) go, keeping their velocity: their weight is 0 from now on."""

    def set_pin_weights(self, cloth: int, weights: Buffer) -> None:
        """Say how firmly pins are held from now on.

        Args:
            cloth: Its number.
            weights: 0 (free) to 1 (hard), float32 or float64 (n,), for *all* vertices of the cloth, of which only the pinned
                are read. Between them a goal spring draws the pin to its target.
        """

    def set_pin_stiffness(self, cloth: int, stiffness: float) -> None:
        """Set the stiffness (N/m) of goal springs from now on: of all pins together that edges join, at weight 1."""

    def grab(self, cloth: int, vertices: Sequence[int], targets: Buffer, weights: Buffer) -> None:
        """Hold vertices as a hand would, in place of any grabbed before; they need not be pins.

        Args:
            cloth: Its number.
            vertices: Which.
            targets: Positions (m), float32 or float64 (k, 3), where the grip is at the end of the next frame.
            weights: Each one's part in the grip, above 0 and at most 1, float32 or float64 (k,).
        """

    def let_go(self) -> None:
        """Let go what was grabbed, with the velocity it has."""

    def advance(self) -> dict[str, float | int | str | list[dict[str, object]] | None]:
        """Move on by one frame and return its certificate: a row of `frames` in report.json, without `seconds`.

        Where edges are overstretched the row counts them (`overstretched_count`) and names the worst 8 (`overstretched`:
        cloth, vertices, strain).

        Raises:
            DivergedError, UnstableError, InterruptionError: The state is that of the last good frame.
        """

    def certificate(
        self, cloth: int | None = None
    ) -> dict[str, float | int | str | list[dict[str, object]] | None]:
        """The certificate of the present state.

        Args:
            cloth: The number of the cloth whose strain, energies, hash and overstretched edges are told; all if None. The
                other parts are always those of the whole simulation.
        """

    def interrupter(self) -> Interrupter:
        """What stops this simulation from another thread."""

    def read_positions(self, cloth: int, out: Buffer) -> None:
        """Fill out, float32 or float64 (n, 3), with positions (m), world space."""

    def read_velocities(self, cloth: int, out: Buffer) -> None:
        """Fill out, float32 or float64 (n, 3), with velocities (m/s)."""

    def read_strain(self, cloth: int, out: Buffer) -> None:
        """Fill out, float32 (n,), with the largest strain of the edges at each vertex."""

    def read_tension(self, cloth: int, out: Buffer) -> None:
        """Fill out, float32 (n,), with the largest tension (N) of the springs at each vertex, 0 where all are slack.

        Stretch and shear springs count, and what implicit steps add to hold an edge at its allowed length; not damping.
        """

    def read_wetness(self, cloth: int, out: Buffer) -> None:
        """Fill out, float32 (n,), with how wet each vertex is: 0 dry to 1 as wet as its absorbency allows."""

    def read_contacts(self, cloth: int, out: Buffer) -> None:
        """Fill out, float32 (n,), with the force (N) with which contacts press each vertex."""

    def read_intersections(self, cloth: int, out: Buffer) -> None:
        """Fill out, float32 (n,), with the number of edges and triangles at each vertex that pass through others."""

    def read_corners(self, cloth: int, out: Buffer) -> None:
        """Fill out, float32 or float64 (c, 3), with the position (m) of each corner of each face, in the order of the faces.

        Where a cloth is torn, the corners of a vertex as it was given are in several places; other functions tell of the piece
        that keeps its number.
        """

    def read_corner_numbers(self, cloth: int, quantity: str, out: Buffer) -> None:
        """Fill out, float32 (c,), with a number at each corner of each face, in the order of the faces.

        Args:
            cloth: Its number.
            quantity: "strain", "tension", "contact" or "intersection": what `read_strain`, `read_tension`, `read_contacts` or
                `read_intersections` tell of a vertex, for the vertex that the corner is at now. Or "force": the tension (N) of
                the edge from this corner to the next of its face, as `edge_tension` has it.
            out: Each side of a tear has its own number.

        Raises:
            SceneError: There is no such quantity.
        """

    def vertex_origins(self, cloth: int) -> list[int]:
        """List, of each vertex that the cloth has now, the vertex that it was: itself, but for those that tearing has added.

        `edge_tension`, `overstretched_edges` and `read_springs` tell of vertices as they are now.
        """

    def torn_edges(self, cloth: int) -> list[tuple[int, int]]:
        """List the edges that are torn, by their vertices as given, in the order in which they tore."""

    def edge_tension(self, cloth: int) -> list[tuple[int, int, float]]:
        """List the edges of the faces as they are now: both vertices, and the tension (N) along the edge.

        Of springs it is their pull, of fabric the stress along the edge over a width as that of the triangles beside it: what
        `[tear] force` is compared with.
        """

    def overstretched_edges(self, cloth: int) -> list[tuple[int, int, float]]:
        """List the mesh edges that are longer than the deformation rate allows: both vertices and the strain, worst first.

        An edge is listed from a tenth of a percent of its rest length on beyond the rate; with the limiter "none", none is.
        """

    def read_springs(self, cloth: int) -> tuple[bytes, bytes, bytes, bytes, bytes]:
        """Return the springs as native-endian bytes, in this order.

        Ends int32 (s, 2); kind uint8 (s,) 0 stretch 1 shear 2 bend 3 sewing; rest length float64 (s,) (m); stiffness float64
        (s,) (N/m), as the limiter has it now; damping float64 (s,) (N·s/m).
        """

    def checkpoint(self) -> bytes:
        """The whole state, versioned and checksummed."""

    def restore(self, checkpoint: bytes) -> None:
        """Take up the state of a checkpoint of the same scene; what follows is bit-equal to never having stopped.

        Raises:
            SceneError: The checkpoint is damaged or of another scene.
        """

@final
class Interrupter:
    """Stops a simulation in the middle of a frame, from any thread."""

    def interrupt(self) -> None:
        """Let `advance` end within a step by raising InterruptionError; if none runs, the next one at once."""

def bake(
    scene: str,
    out: str,
    *,
    frames: tuple[int, int] | None = None,
    threads: int = 0,
    overrides: Sequence[str] = (),
    resume: bool = False,
    progress: Callable[[Mapping[str, float | int]], None] | None = None,
) -> Mapping[str, object]:
    """Bake a scene file into a folder: a PC2 and an OBJ per cloth, report.json and a checkpoint.

    Args:
        scene: Path of the TOML file.
        out: Folder, made if missing.
        frames: First and last frame kept; the scene's own range if None.
        threads: 0 takes every core.
        overrides: "key.path=value" each, TOML values.
        resume: Go on from the folder's checkpoint, if there is one.
        progress: Called after every frame with frame, first, last, seconds; an exception it raises (also
            KeyboardInterrupt) stops the bake after writing a checkpoint.

    Returns:
        The report, as in report.json.
    """

def run_batch(
    scenes: Sequence[str],
    *,
    folder: str | None = None,
    threads: int = 0,
    progress: Callable[[Mapping[str, float | int]], None] | None = None,
) -> list[dict[str, Any]]:
    """Run many scenes to their last frames, without files: small ones one a core, large ones one after the other.

    Args:
        scenes: Each a scene file's keys as a JSON object, `grid` and `mesh` included.
        folder: Where the files that scenes name are looked for; the working folder if None.
        threads: 0 takes every core. The rows do not depend on it, but for their seconds.
        progress: Called after every scene, and ten times a second, with done, total, seconds; an exception it raises (also
            KeyboardInterrupt) stops the batch within a step.

    Returns:
        For each scene, in their order: ending ("done", "diverged", "unstable" or "refused"); error (a sentence, or None);
        safe_time_step (s) at the first frame; largest_strain over all frames; first and last, the certificates of the first
        and the last good frame, as rows of report.json without seconds; seconds. What a scene did not reach is None.

    Raises:
        SceneError: The number of threads is not accepted.
    """

def fabric_presets() -> dict[str, dict[str, Any]]:
    """All fabrics that a scene's `preset` may name.

    Returns:
        By name, the keys of rust/scene/presets/fabrics.toml: group and title (for menus), density (kg/m²), thickness (m),
        stretch_warp, stretch_weft and shear (N/m), bend_warp and bend_weft (N·m), friction, deformation_rate, damping_ratio,
        source, where they are not as stretch compression_warp and compression_weft (N/m), and, where anybody has measured it,
        drape_coefficient ([lowest, highest], %).
    """

def fabric_springs(preset: str, edge: float) -> dict[str, Any]:
    """The springs that a scene's `preset` under `[cloth.springs]` makes of a fabric.

    Args:
        preset: A name out of `fabric_presets`.
        edge: The mean length (m) of the mesh's edges: the stiffness of bend springs depends on it.

    Returns:
        Keys of `[cloth.springs]`: stretch, shear and bend (N/m), damping_stretch, damping_shear and damping_bend (N·s/m),
        damping_law, stiffness_from, deformation_rate.

    Raises:
        SceneError: There is no such fabric, or the length is not above 0.
    """

def point_triangle_distance(points: Buffer, out: Buffer) -> None:
    """Fill out, float64 (n,), with the distances (m) of points and triangles.

    Args:
        points: Positions (m), float32 or float64 (n, 4, 3): the point, then the triangle.
        out: The distances.
    """

def edge_edge_distance(points: Buffer, out: Buffer) -> None:
    """Fill out, float64 (n,), with the distances (m) of two edges.

    Args:
        points: Positions (m), float32 or float64 (n, 4, 3): one edge, then the other.
        out: The distances.
    """

def point_triangle_impact(starts: Buffer, ends: Buffer, gap: float, out: Buffer) -> None:
    """Fill out, float64 (n,), with the times up to which points and triangles on straight paths surely keep a gap.

    Args:
        starts: Positions (m) at time 0, float32 or float64 (n, 4, 3): the point, then the triangle.
        ends: Positions (m) at time 1.
        gap: Distance (m) to be kept.
        out: The times: 0 where they are too near at the start, infinite where they keep the gap to the end.
    """

def edge_edge_impact(starts: Buffer, ends: Buffer, gap: float, out: Buffer) -> None:
    """Fill out, float64 (n,), with the times up to which two edges on straight paths surely keep a gap.

    Args:
        starts: Positions (m) at time 0, float32 or float64 (n, 4, 3): one edge, then the other.
        ends: Positions (m) at time 1.
        gap: Distance (m) to be kept.
        out: The times: 0 where they are too near at the start, infinite where they keep the gap to the end.
    """

def edge_crosses_triangle(points: Buffer, out: Buffer) -> None:
    """Fill out, uint8 (n,), with what edges and triangles have in common, exactly.

    Args:
        points: Positions (m), float32 or float64 (n, 5, 3): the edge, then the triangle.
        out: 0 no point; 1 a touch: an end of the edge in the plane of the triangle, or a passage through its border; 2 a
            crossing: the ends on either side, and a passage through the inside.
    """
