"""Figure 8: length and stiffness of the spring next to a pin over time, under each limiter."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes

from .looks import INK, LIMITER_COLORS, Plate, page
from .sheet import Recipe, Sheet

RECIPE = Recipe(vertices=7, size=1.0, fps=240)
"""Mass 0.1 kg a particle, k 500 N/m and d 1 N·s/m are the paper's; grid and size are ours."""
SECONDS = 4.0
TITLES = {
    "stiffen": "stiffen: k grows with length (eq. 6)",
    "provot": "provot: ends moved back",
    "project": "project: positions and velocities",
}


@dataclass
class Track:
    """One spring over time, as seen at every frame."""

    times: np.ndarray  # s
    lengths: np.ndarray  # m
    stiffnesses: np.ndarray  # N/m
    rest_length: float
    allowed_length: float
    worst_strain: float  # of any edge at any frame

    def peak_over_allowed(self) -> float:
        """By how many percentage points of its rest length the spring passes its allowed length, at most."""
        return 100.0 * (float(self.lengths.max()) - self.allowed_length) / self.rest_length

    def end_over_allowed(self) -> float:
        """The same at the end."""
        return 100.0 * (float(self.lengths[-1]) - self.allowed_length) / self.rest_length


def follow(recipe: Recipe, seconds: float) -> Track:
    """Follow the edge spring below the first pin from rest."""
    sheet = Sheet(recipe)
    pin = sheet.pins[0]
    springs = sheet.springs()
    number = springs.between(pin, pin - recipe.vertices)
    rest = float(springs.rest_lengths[number])
    rows = []
    worst = 0.0
    for frame in range(round(seconds * recipe.fps) + 1):
        if frame:
            sheet.advance()
        springs = sheet.springs()
        length = springs.lengths(sheet.positions())[number]
        rows.append((frame / recipe.fps, length, springs.stiffnesses[number]))
        worst = max(worst, float(sheet.strain().max()))
    times, lengths, stiffnesses = np.array(rows).T
    return Track(times, lengths, stiffnesses, rest, (1.0 + recipe.rate) * rest, worst)


def make() -> Plate:
    """Length above, stiffness below; the paper's limiter first, without any limit in grey behind each."""
    free = follow(replace(RECIPE, limiter="none"), SECONDS)
    tracks = {name: follow(replace(RECIPE, limiter=name), SECONDS) for name in TITLES}
    drawing = page(5.6)
    panels = drawing.subplots(2, 3, sharex=True, sharey="row", height_ratios=[1.7, 1.0])
    for column, (name, track) in zip(panels.T, tracks.items(), strict=True):
        draw_length(column[0], name, track, free)
        draw_stiffness(column[1], name, track)
    panels[0, 0].set_ylabel("spring length (mm)")
    panels[1, 0].set_ylabel("stiffness (N/m)")
    panels[0, 0].legend(loc="upper right", fontsize=9)
    first = tracks["stiffen"]
    over = {name: track.peak_over_allowed() for name, track in tracks.items()}
    caption = (
        f"The edge spring below a pin of a sheet of {RECIPE.words()}, hung from rest by its two top corners. Rest length "
        f"{1000 * first.rest_length:.1f} mm, deformation rate {100 * RECIPE.rate:.0f} %, allowed length "
        f"{1000 * first.allowed_length:.1f} mm. Beyond the allowed length at most, in percentage points of the rest "
        f"length: stiffen {over['stiffen']:.1f}, provot {over['provot']:.1f}, project {over['project']:.2f}. Equation 6 "
        "raises k only while the spring is too long, so that it always lets it pass."
    )
    numbers: dict[str, object] = {
        name: {
            "peak_over_allowed_points": track.peak_over_allowed(),
            "end_over_allowed_points": track.end_over_allowed(),
            "peak_length_m": float(track.lengths.max()),
            "largest_stiffness": float(track.stiffnesses.max()),
            "worst_edge_percent": 100.0 * track.worst_strain,
        }
        for name, track in {"none": free, **tracks}.items()
    }
    numbers |= {"rest_length_m": first.rest_length, "allowed_length_m": first.allowed_length}
    title = "length and stiffness of the spring next to a pin"
    return Plate(8, "spring_over_time", title, caption, drawing, numbers)


def draw_length(axes: Axes, name: str, track: Track, free: Track) -> None:
    """Length over time, with rest and allowed length as dashed lines."""
    axes.set_title(TITLES[name], fontsize=10.5)
    axes.plot(free.times, 1000 * free.lengths, color="#b5b5b5", lw=1.3, label="no limit")
    axes.plot(track.times, 1000 * track.lengths, color=LIMITER_COLORS[name], lw=2.2, label=name)
    for length, words in ((track.allowed_length, "allowed"), (track.rest_length, "rest")):
        axes.axhline(1000 * length, color=INK, lw=1.1, ls=(0, (5, 3)), zorder=1.5)
        axes.annotate(
            words,
            (track.times[-1], 1000 * length),
            xytext=(0, 3),
            textcoords="offset points",
            ha="right",
            fontsize=9,
        )


def draw_stiffness(axes: Axes, name: str, track: Track) -> None:
    """Stiffness over time."""
    axes.plot(track.times, track.stiffnesses, color=LIMITER_COLORS[name], lw=2.2)
    axes.axhline(RECIPE.stretch, color=INK, lw=1.1, ls=(0, (5, 3)), zorder=1.5)
    axes.annotate(
        "k = 500 N/m",
        (track.times[-1], RECIPE.stretch),
        xytext=(0, -12),
        textcoords="offset points",
        ha="right",
        fontsize=9,
    )
    axes.set_xlabel("time (s)")
    axes.set_xlim(0.0, track.times[-1])
    axes.set_ylim(RECIPE.stretch - 40.0, None)
