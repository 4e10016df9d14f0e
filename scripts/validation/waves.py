"""Standing waves of fabric: how fast they swing, and which part of the critical damping `damping_ratio` gives them.

Each specimen is cut so that a wave as long as ratios are defined for, 0.1 m, is one of its modes, sides included:

```text
stretch   a free strip, half a wave long               u = cos k x                               w = k sqrt(Y/rho)
shear     a free square cut on the bias, Lame's mode   u = cos q x sin q y, v = -sin q x cos q y,
                                                       q = k/sqrt 2, side pi/q                   w = k sqrt(G/rho)
bend      a strip half a wave long, hinged at its ends z = sin k x                               w = k² sqrt(B/rho)
```

Lame's mode is two shear waves along the yarns at once: it lengthens no yarn and pulls at no side. In every frame the
part of the mode is read, weighted by mass, and a damped oscillation is fitted to it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, partial

import numpy as np
from scipy.optimize import curve_fit

from . import strips
from .row import Curve, Finding, Range, Row, Tolerance
from .specimen import Setting, Shape, Specimen, grid

CHAPTER = "waves"
KINDS = ("stretch", "shear", "bend")

WAVELENGTH = 0.1
"""m, at which damping ratios hold."""
K = math.tau / WAVELENGTH
DENSITY, STRETCH, SHEAR, BEND = 0.2, 200.0, 50.0, 2e-4
"""kg/m², N/m, N/m, N·m."""
AMPLITUDE = 1e-5
"""m: strains of 6e-4."""
ROWS = 3
"""Cells across a strip."""

COARSE, FINE = 20, 40
"""Cells to a wave."""
RATIOS = (0.02, 0.1)
OTHERS = 0.05
"""Damping ratio of the two kinds that the wave is not of."""
UNLIKE = (0.5, 2.0)
"""Stiffness along the wave, as a part of the geometric mean of warp and weft."""
PERIODS = 3
STEPS = {"bdf2": 200, "rk4": 40}
"""Frames to a period; of BDF2 each is one step, of Runge-Kutta at least one."""

FREQUENCY = Tolerance(0.02)
"""As of a cantilever on an aligned mesh."""
RATIO = Tolerance(0.03)
"""What is wanted."""
OWN = 0.1 * min(RATIOS)
"""The most that steps may damp by themselves."""


@dataclass(frozen=True)
class Wave:
    """A specimen and one of its modes."""

    shape: Shape
    mode: np.ndarray
    """(n, 3), 1 where it is largest."""
    frequency: float
    """rad/s, without damping, by the closed form."""
    pins: Sequence[int] = ()
    warp: tuple[float, float, float] = (1.0, 0.0, 0.0)


def crossed(side: float, cells: int) -> Shape:
    """A square (m) of so many squares a side, each four triangles around its middle."""
    line = np.linspace(0.0, side, cells + 1)
    quads = grid(line, line)
    middles = quads.positions[quads.faces].mean(axis=1)
    last = len(quads.positions) + np.arange(len(middles))
    sides = [(quads.faces[:, i], quads.faces[:, (i + 1) % 4]) for i in range(4)]
    faces = np.concatenate([np.stack([a, b, last], axis=-1) for a, b in sides])
    return Shape(np.concatenate([quads.positions, middles]), faces)


def sheared(cells: int) -> Wave:
    """Lame's mode of a square cut on the bias, with so many cells to a wave."""
    q = K / math.sqrt(2.0)
    side = math.pi / q
    # Its middles lie between, so that it has as many vertices to an area as a grid with so many cells to a wave.
    shape = crossed(side, cells // 2)
    x, y, z = shape.positions.T
    u, v = np.cos(q * x) * np.sin(q * y), -np.sin(q * x) * np.cos(q * y)
    mode = np.stack([u, v, 0.0 * z], axis=-1)
    return Wave(shape, mode, K * math.sqrt(SHEAR / DENSITY), warp=(1.0, 1.0, 0.0))


def wave_of(kind: str, cells: int, part: float) -> Wave:
    """A wave with so many cells to its length, along yarns whose stiffness is such a part of the mean."""
    if kind == "shear":
        return sheared(cells)
    cell = WAVELENGTH / cells
    shape = strips.aligned(cell * np.arange(cells // 2 + 1), cell * np.arange(ROWS + 1))
    x = shape.positions[:, 0]
    if kind == "stretch":
        mode = np.outer(np.cos(K * x), [1.0, 0.0, 0.0])
        return Wave(shape, mode, K * math.sqrt(part * STRETCH / DENSITY))
    ends = np.flatnonzero((x < 1e-9) | (x > x.max() - 1e-9))
    mode = np.outer(np.sin(K * x), [0.0, 0.0, 1.0])
    return Wave(shape, mode, K * K * math.sqrt(part * BEND / DENSITY), ends.tolist())


def oscillation(
    angle: np.ndarray, decay: float, turn: float, even: float, odd: float
) -> np.ndarray:
    """What is fitted; time as the angle (rad) that the closed form has turned by then."""
    swing = even * np.cos(turn * angle) + odd * np.sin(turn * angle)
    return np.exp(-decay * angle) * swing


@cache
def swung(
    kind: str, cells: int, ratio: float, integrator: str = "bdf2", part: float = 1.0
) -> tuple[float, float]:
    """Damping ratio of a wave, and its frequency without damping over the closed form's."""
    wave = wave_of(kind, cells, part)
    others = OTHERS if ratio > 0.0 else 0.0
    keys = {f"damping_ratio_{each}": ratio if each == kind else others for each in KINDS}
    cloth = strips.fabric(
        part * STRETCH, part * BEND, DENSITY, stretch_weft=STRETCH / part, shear=SHEAR,
        bend_weft=BEND / part, warp=list(wave.warp), **keys,
    )  # fmt: skip
    frame = math.tau / wave.frequency / STEPS[integrator]
    setting = Setting(integrator, fps=1.0 / frame)
    if integrator == "bdf2":
        setting = Setting(integrator, step=frame)
    start = wave.shape.positions + AMPLITUDE * wave.mode
    strip = Specimen(wave.shape, cloth, setting, pins=wave.pins, start=start)
    weights = strips.masses(wave.shape, DENSITY)[:, None] * wave.mode
    weights /= AMPLITUDE * (weights * wave.mode).sum()
    parts = [1.0]
    for _ in range(PERIODS * STEPS[integrator]):
        strip.advance()
        parts.append(float((weights * (strip.positions() - strip.rest)).sum()))
    angles = wave.frequency * frame * np.arange(len(parts))
    (decay, turn, _, _), _ = curve_fit(oscillation, angles, parts, [ratio + 1e-3, 1.0, 1.0, 0.0])
    undamped = math.hypot(decay, turn)
    return float(decay / undamped), float(undamped)


def frequency(kind: str) -> Finding:
    """The frequency at both densities, without damping."""
    cells = (COARSE, FINE)
    results = [swung(kind, count, 0.0)[1] for count in cells]
    return Curve(cells, results, [1.0, 1.0], "cells to a wave", "w / closed form").worst(FREQUENCY)


def damping(kind: str, integrator: str, densities: Sequence[int]) -> Finding:
    """The damping ratio over the one asked for: the worst of some densities and of both ratios."""
    cases = [(cells, ratio) for cells in densities for ratio in RATIOS]
    found = [swung(kind, cells, ratio, integrator)[0] for cells, ratio in cases]
    results = [got / ratio for got, (_, ratio) in zip(found, cases, strict=True)]
    places = [ratio for _, ratio in cases]
    ones = [1.0] * len(cases)
    return Curve(places, results, ones, "damping ratio asked", "measured / asked").worst(RATIO)


def unlike(kind: str) -> Finding:
    """Waves along yarns that are stiffer or softer than the mean: the ratio holds at the mean, and goes with the frequency."""
    asked = RATIOS[0]
    results = [swung(kind, FINE, asked, part=part)[0] for part in UNLIKE]
    expected = [asked * math.sqrt(part) for part in UNLIKE]
    return Curve(UNLIKE, results, expected, "stiffness / mean", "damping ratio").worst(RATIO)


def own_damping() -> Finding:
    """The largest damping ratio of any wave without damping."""
    cases = [(kind, cells, "bdf2") for kind in KINDS for cells in (COARSE, FINE)]
    cases += [(kind, COARSE, "rk4") for kind in KINDS]
    found = [abs(swung(kind, cells, 0.0, integrator)[0]) for kind, cells, integrator in cases]
    places = range(1, len(cases) + 1)
    plot = Curve(places, found, [OWN] * len(cases), "wave", "damping ratio", logarithmic="y")
    return Finding(max(found), Range(high=OWN), plot)


def rows() -> list[Row]:
    """All rows of the chapter."""
    forms = {"stretch": "k sqrt(Y/rho)", "shear": "k sqrt(G/rho)", "bend": "k² sqrt(B/rho)"}
    swings = "test_a_wave_of_fabric_swings_as_its_closed_form_says"
    damps = "test_a_damping_ratio_is_that_of_a_wave_of_a_tenth_of_a_metre"
    means = "test_a_damping_ratio_holds_at_the_mean_of_warp_and_weft"
    steps = "test_steps_damp_waves_by_far_less_than_the_damping_that_is_measured"
    stands = "what `damping_ratio` says: part of the critical damping at 0.1 m"

    found = []
    for kind in KINDS:
        wave = f"standing wave of {kind}"
        closed = f"closed form: {forms[kind]}"
        found += [
            Row(CHAPTER, f"{wave}: frequency on two meshes", "w / closed form", "", closed, swings,
                partial(frequency, kind), FREQUENCY),
            Row(CHAPTER, f"{wave}: damping ratio on two meshes, BDF2", "measured / asked", "", stands, damps,
                partial(damping, kind, "bdf2", (COARSE, FINE)), RATIO),
            Row(CHAPTER, f"{wave}: damping ratio, Runge-Kutta 4", "measured / asked", "", stands, damps,
                partial(damping, kind, "rk4", (COARSE,)), RATIO),
        ]  # fmt: skip
    found += [
        Row(CHAPTER, f"standing wave of {kind} along stiffer and softer yarns", "damping ratio", "",
            "closed form: ratio x frequency / that of the geometric mean", means, partial(unlike, kind), RATIO)
        for kind in ("stretch", "bend")
    ]  # fmt: skip
    return [
        *found,
        Row(CHAPTER, "standing waves without damping: what steps damp", "damping ratio", "",
            "a tenth of the least that is measured", steps, own_damping),
    ]  # fmt: skip
