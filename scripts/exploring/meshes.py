"""Regular against irregular meshes: what becomes of the stable step, and of how far a sheet hangs down.

Six meshes of the same square: quads; triangles with parallel and with alternating diagonals; the latter with vertices moved by
up to 15 % and 30 % of an edge; and Delaunay triangles of points moved by 45 %. Each is run free for its boundary (Verlet,
undamped) and hung by its top edge, once with the numbers as those of the springs, once as those of the membrane.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import boucle_core
import numpy as np
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from paper.looks import INK, KIND_COLORS, PALE, page

from .boundary import GROWN, STEPS, Runs, growth
from .sheet import EDGE, FRAMES, JITTER, PAPER, Mesh, grid, jittered, scene_text
from .theory import eigenvalues

VERTICES = 12
"""Along each side."""
MASS, STIFFNESS = 0.002, 50.0
"""kg a particle (0.24 kg/m²) and N/m."""
ROUNDS = 11
HUNG = 48
"""Frames that a sheet hangs until it is at rest."""


@dataclass
class Woven:
    """What was found of a mesh."""

    name: str
    mesh: Mesh
    measured: float  # s
    theory: float
    safe: float
    drops: dict[str, float]  # m, mean of the lower edge, by stiffness_from


def triangles(alternate: bool) -> Mesh:
    """The grid with every quad cut in two."""
    quads = grid(VERTICES)
    a, b, c, d = quads.faces.T
    number = np.arange(len(a))
    row, column = number // (VERTICES - 1), number % (VERTICES - 1)
    is_other = ((row + column) % 2 == 1) & alternate
    one = np.where(is_other[:, None], np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    two = np.where(is_other[:, None], np.stack([b, c, d], 1), np.stack([a, c, d], 1))
    return Mesh(quads.positions, np.concatenate([one, two]))


def moved(mesh: Mesh, part: float) -> Mesh:
    """The same with the vertices inside moved by up to a part of the edge; the border keeps its shape."""
    shaken = jittered(mesh, part, seed=7)
    half = 0.5 * EDGE * (VERTICES - 1)
    is_inside = (np.abs(mesh.positions[:, :2]) < half - 1e-9).all(axis=1)
    return Mesh(np.where(is_inside[:, None], shaken.positions, mesh.positions), mesh.faces)


def delaunay(part: float) -> Mesh:
    """Delaunay triangles of points that are moved by up to a part of the edge; slivers at the border are left out."""
    points = moved(grid(VERTICES), part).positions
    faces = Triangulation(points[:, 0], points[:, 1]).triangles
    first, second, third = (points[faces[:, corner], :2] for corner in range(3))
    sides = second - first, third - first
    areas = 0.5 * np.abs(sides[0][:, 0] * sides[1][:, 1] - sides[0][:, 1] * sides[1][:, 0])
    return Mesh(points, faces[areas > 1e-3 * EDGE**2])


def meshes() -> dict[str, Mesh]:
    """The meshes by name."""
    alternating = triangles(alternate=True)
    return {
        "quads": grid(VERTICES),
        "parallel": triangles(alternate=False),
        "alternating": alternating,
        "moved 15 %": moved(alternating, 0.15),
        "moved 30 %": moved(alternating, 0.30),
        "Delaunay": delaunay(0.45),
    }


def boundaries(runs: Runs, woven: dict[str, Mesh]) -> tuple[np.ndarray, np.ndarray]:
    """The largest stable steps (s), measured by bisection, and the safe ones."""
    for number, mesh in enumerate(woven.values()):
        mesh.write(runs.folder / f"mesh{number}.obj")
        jittered(mesh, JITTER).write(runs.folder / f"rest{number}.obj")

    def rows(steps: np.ndarray) -> list[dict]:
        scenes = [free_scene(number, step) for number, step in enumerate(steps)]
        return runs.run("meshes", scenes)

    scale = math.sqrt(MASS / STIFFNESS)
    low, high = np.full(len(woven), 0.01 * scale), np.full(len(woven), 8.0 * scale)
    safe = np.array([row["safe_time_step"] for row in rows(low)])
    for _ in range(ROUNDS):
        middle = np.sqrt(low * high)
        is_stable = np.array([growth(row) < GROWN for row in rows(middle)])
        low, high = np.where(is_stable, middle, low), np.where(is_stable, high, middle)
    return np.sqrt(low * high), safe


def free_scene(number: int, step: float) -> str:
    """A mesh's sheet, free and without gravity, in steps of this length (s)."""
    each = STEPS // FRAMES
    cloth = {
        "name": "sheet",
        "mesh": f"mesh{number}.obj",
        "rest": f"rest{number}.obj",
        "mass_per_vertex": MASS,
        "springs": {**_springs(), "limiter": "none"},
    }
    solver = {"integrator": "verlet", "substeps": each, "allow_unstable": True}
    timing = {"frames": [1, 1 + FRAMES], "fps": 1.0 / (each * step), "gravity": [0.0, 0.0, 0.0]}
    return scene_text(timing, cloth, solver)


def _springs() -> dict[str, object]:
    kinds = ("stretch", "shear", "bend")
    return {kind: STIFFNESS * getattr(PAPER, kind) for kind in kinds}


def drop(mesh: Mesh, stiffness_from: str) -> float:
    """How far (m) the lower edge of a hung sheet goes down, in the mean."""
    upright = mesh.positions[:, [0, 2, 1]].copy()
    half = 0.5 * EDGE * (VERTICES - 1)
    top = np.flatnonzero(upright[:, 2] > half - 1e-9)
    springs = {**_springs(), "air_damping": 0.02, "limiter": "none"}
    cloth = {
        "name": "sheet",
        "pins": {"vertices": top.tolist()},
        "density": MASS / EDGE**2,
        "springs": {**springs, "stiffness_from": stiffness_from},
    }
    text = scene_text({}, cloth, {"integrator": "implicit_euler"})
    simulation = boucle_core.Simulation(text, [(upright, *mesh.arrays()[1:])], 1)
    for _ in range(HUNG):
        simulation.advance()
    out = np.empty_like(upright)
    simulation.read_positions(0, out)
    below = upright[:, 2] < -half + 1e-9
    return float((upright[below, 2] - out[below, 2]).mean())


def measure(runs: Runs) -> list[Woven]:
    """All of it."""
    woven = meshes()
    measured, safe = boundaries(runs, woven)
    found = []
    for number, (name, mesh) in enumerate(woven.items()):
        w = math.sqrt(eigenvalues(mesh, PAPER)[-1] * STIFFNESS / MASS)
        drops = {word: drop(mesh, word) for word in ("springs", "continuum")}
        found.append(
            Woven(name, mesh, float(measured[number]), 2.0 / w, float(safe[number]), drops)
        )
    return found


def draw(found: Sequence[Woven]) -> Figure:
    """The meshes above, their steps and drops below."""
    figure = page(5.6)
    places = figure.add_gridspec(2, len(found), height_ratios=(1.0, 1.7))
    for number, each in enumerate(found):
        axes = figure.add_subplot(places[0, number])
        for face in each.mesh.faces:
            outline = each.mesh.positions[[*face, face[0]], :2].T
            axes.plot(*outline, color=INK, lw=0.5)
        axes.set_aspect("equal")
        axes.axis("off")
        axes.set_title(each.name, fontsize=9)
    left = figure.add_subplot(places[1, : len(found) // 2])
    right = figure.add_subplot(places[1, len(found) // 2 :])
    x = np.arange(len(found))
    left.bar(x, [1000 * e.theory for e in found], 0.6, color="#d9d4c7", label="theory, flat")
    left.plot(x, [1000 * e.measured for e in found], "o", color=KIND_COLORS[0], label="measured")
    left.plot(
        x, [1000 * e.safe for e in found], "_", ms=18, color=KIND_COLORS[1], label="safe step"
    )
    left.set(ylabel="step (ms)", title="largest stable step, Verlet")
    for word, offset, color in (("springs", -0.2, PALE), ("continuum", 0.2, KIND_COLORS[2])):
        heights = [1000 * each.drops[word] for each in found]
        right.bar(x + offset, heights, 0.38, color=color, label=f'stiffness from "{word}"')
    right.set(ylabel="drop of the lower edge (mm)", title="hung by the top edge")
    for axes in (left, right):
        axes.set_xticks(x, [each.name.replace(" ", "\n", 1) for each in found], fontsize=8)
        axes.legend(fontsize=7.5)
        axes.set_ylim(top=1.3 * axes.get_ylim()[1])
    return figure


def table(found: Sequence[Woven]) -> str:
    """The steps and drops as a Markdown table."""
    lines = [
        "| mesh | measured (ms) | theory (ms) | safe (ms) | drop, springs (mm) | drop, continuum (mm) |",
        "|---|---|---|---|---|---|",
    ]
    for each in found:
        steps = [1000 * step for step in (each.measured, each.theory, each.safe)]
        drops = [1000 * each.drops[word] for word in ("springs", "continuum")]
        cells = " | ".join(f"{value:.3g}" for value in [*steps, *drops])
        lines.append(f"| {each.name} | {cells} |")
    return "\n".join(lines)


def numbers(found: Sequence[Woven]) -> list[dict[str, object]]:
    """The same as rows for a file."""
    names = ("name", "measured", "theory", "safe", "drops")
    return [{name: getattr(each, name) for name in names} for each in found]
