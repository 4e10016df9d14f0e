"""Integrators against each other: error against cost, and the energy that they lose or gain, over the step.

A sheet held along an edge falls and swings for half a second. The error is the root mean square distance of its vertices from
those of a reference, the classic Runge-Kutta rule at a 64th of its stable step, by the sheet's size.
"""

from __future__ import annotations

import json
import math
import time
from dataclasses import dataclass

import boucle_core
import numpy as np
from matplotlib.figure import Figure

from integrator_words import WORDS
from paper.looks import page

from .sheet import PAPER, Point, grid, scene_text
from .stability_picture import COLORS
from .theory import EXPLICIT, eigenvalues, largest_step

VERTICES = 10
"""Along each side."""
EDGE = 0.1
MASS, STIFFNESS = 0.01, 500.0
SECONDS, FRAMES = 0.5, 5
RATIO = 0.1
"""Damping ratio of the fastest oscillation: with none, two of the integrators have no stable step."""
SIZE = EDGE * (VERTICES - 1)


@dataclass
class Swing:
    """A run at one step."""

    integrator: str
    step: float  # s
    seconds: float  # wall-clock time
    error: float  # by the sheet's size
    energy: float  # J, kinetic and potential, at the end
    strain: float  # largest, of all frames


def swing(integrator: str, step: float, damping_time: float) -> tuple[Swing, np.ndarray]:
    """Swing once, in steps of at most so many seconds; the error is not known yet."""
    mesh = grid(VERTICES, EDGE)
    cloth = {
        "name": "sheet",
        "pins": {"vertices": list(range(VERTICES * (VERTICES - 1), VERTICES**2))},
        "mass_per_vertex": MASS,
        "springs": Point(integrator, MASS, STIFFNESS, PAPER, damping_time).springs(),
    }
    substeps = math.ceil(SECONDS / FRAMES / step * (1.0 - 1e-9))
    solver = {"integrator": integrator, "substeps": substeps, "allow_unstable": True}
    timing = {"frames": [1, 1 + FRAMES], "fps": FRAMES / SECONDS}
    simulation = boucle_core.Simulation(scene_text(timing, cloth, solver), [mesh.arrays()], 1)
    began = time.perf_counter()
    rows = [simulation.advance() for _ in range(FRAMES)]
    seconds = time.perf_counter() - began
    out = np.empty_like(mesh.positions)
    simulation.read_positions(0, out)
    energy = rows[-1]["kinetic_energy"] + rows[-1]["potential_energy"]
    strain = max(row["max_strain"] for row in rows)
    taken = SECONDS / FRAMES / substeps
    return Swing(integrator, taken, seconds, math.nan, energy, strain), out


def measure(halvings: int = 6) -> tuple[list[Swing], Swing]:
    """Every integrator at steps that are halved so often; and the reference."""
    values = eigenvalues(grid(VERTICES, EDGE), PAPER) * STIFFNESS / MASS
    damping_time = 2.0 * RATIO / math.sqrt(values[-1])
    finest = largest_step("rk4", values, damping_time) / 64.0
    reference, true = swing("rk4", finest, damping_time)
    swings = []
    for integrator in (*EXPLICIT, "implicit_euler", "bdf2"):
        if integrator in EXPLICIT:
            # What falls and folds bears a little less than a flat sheet.
            longest = 0.9 * largest_step(integrator, values, damping_time)
        else:
            longest = 1.0 / 24.0
        for number in range(halvings):
            step = longest / 2.0**number
            tries = [swing(integrator, step, damping_time) for _ in range(3)]
            each, positions = min(tries, key=lambda found: found[0].seconds)
            difference = np.linalg.norm(positions - true, axis=1)
            each.error = float(np.sqrt((difference**2).mean())) / SIZE
            swings.append(each)
    return swings, reference


def draw(swings: list[Swing], reference: Swing) -> Figure:
    """Error against cost, and energy against step."""
    figure = page(4.6)
    left, right = figure.subplots(1, 2)
    scale = VERTICES**2 * MASS * 9.81 * SIZE
    for integrator in dict.fromkeys(each.integrator for each in swings):
        kept = [each for each in swings if each.integrator == integrator]
        look = {"color": COLORS[integrator], "label": WORDS[integrator], "ms": 4, "lw": 1.2}
        left.plot([1000 * e.seconds / SECONDS for e in kept], [e.error for e in kept], "o-", **look)
        change = [100 * (e.energy - reference.energy) / scale for e in kept]
        right.plot([1000 * e.step for e in kept], change, "o-", **look)
    left.set(xscale="log", yscale="log", xlabel="cost (ms of computing for a second of cloth)")
    left.set(ylabel="error (of the sheet's size)", title="error against cost")
    right.set(xscale="log", xlabel="step (ms)", ylabel="energy - reference (% of m g size)")
    right.set_yscale("symlog", linthresh=0.01)
    right.axhline(0.0, color="#222222", lw=0.6)
    right.set_title("energy lost or gained in half a second")
    left.set_ylim(top=30.0)
    left.legend(fontsize=7.5, ncols=2, loc="upper right")
    return figure


def table(swings: list[Swing]) -> str:
    """For each integrator the cheapest run within an error, as a Markdown table."""
    lines = ["| integrator | error | step (ms) | cost (ms a second) |", "|---|---|---|---|"]
    for wanted in (1e-2, 1e-3):
        for integrator in dict.fromkeys(each.integrator for each in swings):
            kept = [e for e in swings if e.integrator == integrator and e.error <= wanted]
            best = min(kept, key=lambda each: each.seconds, default=None)
            cells = ["not reached", "", ""]
            if best is not None:
                cost = 1000 * best.seconds / SECONDS
                cells = [f"{best.error:.1e}", f"{1000 * best.step:.3g}", f"{cost:.3g}"]
            lines.append(f"| {integrator}, within {wanted:g} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def quality(swings: list[Swing], reference: Swing) -> str:
    """What a step costs in quality where any is stable: energy lost and strain of the implicit integrators, as Markdown."""
    lines = [
        "| integrator | step (ms) | error | energy - reference (% of m g size) | largest strain (%) |",
        "|---|---|---|---|---|",
        f"| reference | {1000 * reference.step:.2g} | 0 | 0 | {100 * reference.strain:.2f} |",
    ]
    for each in swings:
        if each.integrator in EXPLICIT:
            continue
        energy = 100 * (each.energy - reference.energy) / (VERTICES**2 * MASS * 9.81 * SIZE)
        cells = [f"{1000 * each.step:.3g}", f"{each.error:.1e}", f"{energy:.3g}"]
        lines.append(
            f"| {each.integrator} | " + " | ".join([*cells, f"{100 * each.strain:.2f}"]) + " |"
        )
    return "\n".join(lines)


def numbers(swings: list[Swing]) -> list[dict[str, object]]:
    """The runs as rows for a file."""
    return [json.loads(json.dumps(vars(each))) for each in swings]
