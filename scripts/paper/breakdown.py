"""Figure 7: what a too large time step does."""

from __future__ import annotations

from dataclasses import dataclass, replace

import boucle_core
import numpy as np
from matplotlib.axes import Axes

from .looks import INK, KIND_COLORS, Plate, page
from .sheet import Recipe, Sheet
from .view import Pictures, Shot, View

TIME_STEP = 0.010
"""Seconds: beyond the safe step of the sheet, but not by much."""
FPS = 100
"""A frame a step, so that every step is seen."""
SHOWN = 6
BROKEN = 150.0
"""Elongation (%) of the last colour."""


@dataclass
class Run:
    """Frames of a sheet, and how it ended."""

    shots: list[Shot]  # frames 1, 2, ...
    elongations: list[float]  # largest of each frame
    message: str  # of the divergence, or nothing
    safe_time_step: float
    faulty_frame: int = 0
    faulty_vertex: int = 0


def simulate(recipe: Recipe, frames: int) -> Run:
    """Advance a sheet until it diverges or the frames are done."""
    sheet = Sheet(recipe)
    run = Run([], [], "", sheet.simulation.safe_time_step)

    def keep() -> None:
        strain = sheet.strain()
        run.shots.append(Shot.of(sheet, 100.0 * strain, BROKEN))
        run.elongations.append(float(strain.max()))

    keep()
    try:
        for _ in range(frames):
            sheet.advance()
            keep()
    except boucle_core.DivergedError as diverged:
        run.message = str(diverged)
        run.faulty_frame, run.faulty_vertex = diverged.frame, diverged.vertex
    return run


def make(pictures: Pictures) -> Plate:
    """The last frames that can be shown, and how the elongation grew until the numbers ended."""
    recipe = Recipe(fps=FPS, tilt=60.0)
    view = View(center=(0.0, -0.75, 0.75), width=2.7, height=2.7, turn=14.0, lift=6.0)
    broken = simulate(replace(recipe, time_step=TIME_STEP), 400)
    kept = simulate(recipe, len(broken.shots) - 1)
    drawing = page(5.6)
    grid = drawing.add_gridspec(2, SHOWN, height_ratios=[1.0, 1.35])
    last = first_out_of_view(broken.shots, view)
    for column, index in enumerate(range(last - SHOWN + 1, last + 1)):
        axes = drawing.add_subplot(grid[0, column])
        axes.set_title(f"frame {index + 1}")
        view.frame(axes)
        pictures.show(axes, broken.shots[index], view)
    draw_growth(drawing.add_subplot(grid[1, :]), broken, kept)
    step, safe = 1000.0 * TIME_STEP, 1000.0 * broken.safe_time_step
    caption = (
        f"{recipe.words()}, symplectic Euler, no limit of the elongation. Steps of {step:g} ms, one a frame, where "
        f"{safe:.1f} ms are safe (allow_unstable = true). It ends as: {broken.message}; the "
        f"{len(broken.shots)} frames before are kept. The darkest colour is an elongation of {BROKEN:.0f} % and more. "
        "Below, the same sheet with safe steps for comparison."
    )
    numbers = {
        "message": broken.message,
        "frame": broken.faulty_frame,
        "vertex": broken.faulty_vertex,
        "frames_kept": len(broken.shots),
        "time_step_s": TIME_STEP,
        "safe_time_step_s": broken.safe_time_step,
        "largest_elongation_percent": 100.0 * broken.elongations[-1],
        "largest_elongation_percent_with_safe_steps": 100.0 * max(kept.elongations),
        "message_with_safe_steps": kept.message,
    }
    return Plate(7, "breakdown", "breakdown at a too large time step", caption, drawing, numbers)


def first_out_of_view(shots: list[Shot], view: View) -> int:
    """The first shot, but not before the sixth, that reaches beyond the view; the last if none does."""
    for index in range(SHOWN - 1, len(shots)):
        flat, _ = view.project(shots[index].positions)
        if (np.abs(flat) > 0.5 * view.width).any():
            return index
    return len(shots) - 1


def draw_growth(axes: Axes, broken: Run, kept: Run) -> None:
    """Largest elongation over the frames, on a logarithmic scale, for both runs."""
    for run, color, words in (
        (broken, KIND_COLORS[1], f"steps of {1000 * TIME_STEP:g} ms"),
        (kept, KIND_COLORS[0], f"safe steps, at most {1000 * kept.safe_time_step:.1f} ms"),
    ):
        frames = np.arange(2, len(run.elongations) + 1)  # frame 1 is the rest pose
        percent = 100.0 * np.array(run.elongations[1:])
        axes.plot(frames, percent, color=color, lw=2.0, marker="o", ms=3.0, label=words)
    axes.set_yscale("log")
    axes.set_ylim(bottom=0.1)
    axes.set_xlabel("frame")
    axes.set_ylabel("largest elongation (%)")
    axes.margins(x=0.02)
    axes.set_xlim(right=broken.faulty_frame + 1.5)
    axes.axvline(broken.faulty_frame, color=INK, lw=1.0, ls=(0, (4, 3)))
    axes.text(
        broken.faulty_frame - 0.4,
        0.4,
        broken.message.replace(" of cloth", "\nof cloth"),
        transform=axes.get_xaxis_transform(),
        ha="right",
        va="center",
        fontsize=10,
    )
    axes.legend(loc="upper left")
