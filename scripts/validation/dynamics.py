"""Cloth in motion: falls, swings, drag and damping."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np
from scipy.special import ellipk, jn_zeros

from . import reference
from .integrators import WORDS
from .row import Curve, Finding, Row, Tolerance
from .specimen import STILL, G, Setting, Specimen, even_grid, grid, ladder

CHAPTER = "dynamics"
DOWN = (0.0, 0.0, -G)

EXACT = Tolerance(1e-11)
"""The rounding of a thousand additions, with room."""
STRAIGHT = Tolerance(1e-11, is_relative=False)
"""m: rounding of sums of a metre, with room."""
PENDULUM = Tolerance(5e-3)
"""What is wanted; the rod is a spring that the weight draws out by 1e-4."""
CHAIN = Tolerance(1e-4)
"""Elongations of 1e-4 and angles of 1e-3."""
CONTINUUM = Tolerance(1e-3)
"""From 20 and 50 masses, whose error falls as 1/N."""
DRAG = Tolerance(1e-9)
"""The fourth-order rule at a hundredth of the time constant is exact to 1e-10."""
DECREMENT = Tolerance(1e-5)
"""A parabola through three samples finds a peak to 1e-6 of it."""

STEP, STEPS = 1e-3, 1000
FALLS = {
    "verlet": ("½ g t²", 0),
    "leapfrog": ("½ g t²", 0),
    "midpoint": ("½ g t²", 0),
    "rk4": ("½ g t²", 0),
    "symplectic_euler": ("½ g h² n(n+1)", 1),
    "forward_euler": ("½ g h² n(n-1)", -1),
    "implicit_euler": ("½ g h² n(n+1)", 1),
}
"""The closed form of each rule, and by how much more than n its second factor is."""


@cache
def fallen(rule: str) -> tuple[np.ndarray, np.ndarray, float]:
    """Times (s) and depths (m) of a free sheet, and how far (m) a vertex leaves its place in it."""
    cloth = {"density": 0.2, "springs": {**STILL, "stretch": 5.0, "shear": 1.0, "bend": 0.05}}
    sheet = Specimen(even_grid(8, 8, 0.125), cloth, Setting(rule, step=STEP, gravity=DOWN))
    # The frame in which it was held left it at rest.
    times, depths = [0.0], [0.0]
    for _ in range(10):
        sheet.advance(STEPS // 10)
        times.append(times[-1] + STEP * STEPS / 10)
        depths.append(-float(sheet.positions()[0, 2]))
    way = sheet.positions() - sheet.rest
    return np.array(times), np.array(depths), float(np.abs(way - way[0]).max())


def fall(rule: str) -> Finding:
    """The depth after a thousand steps."""
    times, depths, _ = fallen(rule)
    n = times / STEP
    expected = 0.5 * G * STEP**2 * n * (n + FALLS[rule][1])
    plot = Curve(times, depths, expected, "t (s)", "depth (m)")
    return Finding(float(depths[-1]), float(expected[-1]), plot)


def whole() -> Finding:
    """The farthest that any rule lets a vertex leave its place in a falling sheet."""
    ways = {rule: fallen(rule)[2] for rule in FALLS}

    def draw(axes: Any) -> None:
        axes.bar(
            range(len(ways)), [max(way, 1e-18) for way in ways.values()], color="C1", width=0.6
        )
        axes.axhline(STRAIGHT.amount, color="C0", lw=2.0)
        axes.set_yscale("log")
        axes.set_xticks(range(len(ways)), [name.split("_")[0][:5] for name in ways], fontsize=7)
        axes.set_ylabel("bent by (m)")

    return Finding(max(ways.values()), 0.0, draw)


def mean_period(samples: np.ndarray, h: float) -> float:
    """The mean time (s) between passages upwards through zero; times between samples by a straight line."""
    before, after = samples[:-1], samples[1:]
    at = np.flatnonzero((before < 0.0) & (after >= 0.0))
    passages = h * (at - before[at] / (after[at] - before[at]))
    return float((passages[-1] - passages[0]) / (len(passages) - 1))


def record(specimen: Specimen, frames: int, of: Callable[[np.ndarray], float]) -> np.ndarray:
    """What a number of the positions is at the start and after each frame."""
    samples = [of(specimen.positions())]
    for _ in range(frames):
        specimen.advance()
        samples.append(of(specimen.positions()))
    return np.array(samples)


@cache
def swing_of_pendulum(degrees: float) -> float:
    """The period of a rod with a mass over that of small swings."""
    shape, angle = ladder([1.0], 0.5), math.radians(degrees)
    start = shape.positions.copy()
    start[2:, 0], start[2:, 2] = math.sin(angle), -math.cos(angle)
    cloth = {"mass_per_vertex": 1.0, "springs": {**STILL, "stretch": 1e4 * G}}
    setting = Setting("rk4", fps=200.0, gravity=DOWN)
    rod = Specimen(shape, cloth, setting, pins=[0, 1], start=start)
    period = mean_period(record(rod, 2000, lambda x: x[2, 0]), 1.0 / 200.0)
    return period * math.sqrt(G) / math.tau


def pendulum(degrees: float) -> Finding:
    """The row of one amplitude; the plot shows all."""
    angles, fine = [30.0, 90.0], np.linspace(1.0, 120.0, 100)

    def exact(angle: float) -> float:
        return 2.0 / math.pi * float(ellipk(math.sin(math.radians(0.5 * angle)) ** 2))

    results = [swing_of_pendulum(angle) for angle in angles]
    line = (fine, [exact(angle) for angle in fine])
    plot = Curve(
        angles, results, [exact(angle) for angle in angles], "amplitude (°)", "T / T0", line
    )
    return Finding(swing_of_pendulum(degrees), exact(degrees), plot)


def first_mode(count: int) -> np.ndarray:
    """The slowest mode of a hanging chain of equal masses, 1 at the tip: the largest root of its compliance."""
    below = np.arange(count, 0, -1)
    # A sideways force at mass j tilts all links above it by one over what hangs below them.
    compliance = np.array(
        [[sum(1.0 / below[: min(i, j) + 1]) for j in range(count)] for i in range(count)]
    )
    _, modes = np.linalg.eigh(compliance)
    return modes[:, -1] / modes[-1, -1]


@cache
def first_swing(count: int) -> float:
    """Frequency of a chain of 1 m that hangs, over sqrt(g/L), from its first mode; weight draws its links to equal lengths."""
    link = 1.0 / count
    stiffness = G / (1e-4 * link)
    tensions = G * np.arange(count, 0, -1) / count
    shape = ladder(link - tensions / stiffness, 0.1)
    start = shape.positions.copy()
    start[:, 2] = np.repeat(-link * np.arange(count + 1), 2)
    start[2:, 0] = np.repeat(1e-3 * first_mode(count), 2)
    cloth = {"mass_per_vertex": 1.0 / count, "springs": {**STILL, "stretch": stiffness}}
    setting = Setting("verlet", fps=500.0, gravity=DOWN)
    chain = Specimen(shape, cloth, setting, pins=[0, 1], start=start)
    return (
        math.tau / mean_period(record(chain, 2500, lambda x: x[-1, 0]), 1.0 / 500.0) / math.sqrt(G)
    )


def chain_plot() -> Curve:
    """Frequencies of chains beside the table."""
    line = reference.table(reference.CHAINS)[0]
    known = {count: float(line[f"omega_N{count}_endmass_full"]) for count in (5, 10, 20, 50)}
    counts = [20, 50]
    results, expected = [first_swing(n) for n in counts], [known[n] for n in counts]
    return Curve(
        counts, results, expected, "masses", "w1 / sqrt(g/L)", (list(known), list(known.values()))
    )


def chain_swing(count: int) -> Finding:
    """The first swing of a chain of so many masses."""
    line = reference.table(reference.CHAINS)[0]
    return Finding(first_swing(count), float(line[f"omega_N{count}_endmass_full"]), chain_plot())


def strip_swing() -> Finding:
    """The first swing as the masses become many."""
    fewer, more = first_swing(20), first_swing(50)
    limit = more + (more - fewer) * 20.0 / 30.0
    return Finding(limit, 0.5 * float(jn_zeros(0, 1)[0]), chain_plot())


def falling_speeds(
    cloth: dict[str, Any], forces: list[dict[str, Any]]
) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and speeds (m/s) of a flat sheet that falls through air: half a second in tenths, then four more."""
    keys = {
        **cloth,
        "springs": {**STILL, "stretch": 50.0, "shear": 10.0, "bend": 1.0, **cloth["springs"]},
    }
    setting = Setting("rk4", step=1e-3, gravity=DOWN, forces=forces)
    sheet = Specimen(even_grid(6, 6, 0.1), keys, setting)
    times, speeds = [], []
    for frames in [100] * 5 + [4000]:
        sheet.advance(frames)
        times.append((times[-1] if times else 0.0) + 1e-3 * frames)
        speeds.append(-float(sheet.velocities()[:, 2].mean()))
    return np.array(times), np.array(speeds)


@cache
def linear_fall() -> tuple[np.ndarray, np.ndarray]:
    """A fall through viscous air: 0.01 kg and 0.1 N·s/m a vertex."""
    return falling_speeds({"mass_per_vertex": 0.01, "springs": {"air_damping": 0.1}}, [])


def linear_drag(part: str) -> Finding:
    """Terminal speed, or the time constant from the first tenth of a second."""
    times, speeds = linear_fall()
    terminal, constant = 0.01 * G / 0.1, 0.01 / 0.1
    expected = terminal * (1.0 - np.exp(-times / constant))
    plot = Curve(times[:5], speeds[:5], expected[:5], "t (s)", "speed (m/s)")
    if part == "terminal":
        return Finding(float(speeds[-1]), terminal, plot)
    return Finding(float(-times[0] / np.log(1.0 - speeds[0] / speeds[-1])), constant, plot)


def quadratic_drag() -> Finding:
    """Terminal speed of a flat sheet under pressure on its faces, with a drag coefficient of 1."""
    density, air = 0.2, 1.2
    still = {"kind": "wind", "velocity": [0.0, 0.0, 0.0], "air_density": air}
    times, speeds = falling_speeds({"density": density, "springs": {}}, [still])
    terminal = math.sqrt(2.0 * density * G / air)
    expected = terminal * np.tanh(G * times / terminal)
    return Curve(times, speeds, expected, "t (s)", "speed (m/s)").worst(DRAG)


LAWS = {"relative": "relative damping", "axial": "axial damping", "air": "damping by the air"}


@cache
def decrement(law: str, damping_ratio: float) -> float:
    """The logarithm of the ratio of the first two peaks of a mass that swings once a second."""
    w, shape = math.tau, grid([0.0, 1.0], [0.0, 1.0])
    c = 2.0 * damping_ratio * w
    damping = {"air_damping": c} if law == "air" else {"damping_stretch": c, "damping_law": law}
    start = shape.positions + np.array([0.01, 0.0, 0.0]) * [[0.0], [1.0], [0.0], [1.0]]
    cloth = {"mass_per_vertex": 1.0, "springs": {**STILL, "stretch": w * w, **damping}}
    mass = Specimen(shape, cloth, Setting("rk4", step=1.0 / 200.0), pins=[0, 2], start=start)
    s = record(mass, 700, lambda x: x[1, 0] - 1.0)
    a, b, c = s[:-2], s[1:-1], s[2:]
    at = np.flatnonzero((b > 0.0) & (b >= a) & (b > c))
    peaks = b[at] + (c[at] - a[at]) ** 2 / (8.0 * (2.0 * b[at] - a[at] - c[at]))
    return float(np.log(peaks[0] / peaks[1]))


def damped_spring(law: str) -> Finding:
    """The decrements of three damping ratios."""
    ratios, fine = [0.02, 0.1, 0.3], np.linspace(0.0, 0.35, 50)

    def exact(part: float) -> float:
        return math.tau * part / math.sqrt(1.0 - part * part)

    results = [decrement(law, part) for part in ratios]
    line = (fine, [exact(part) for part in fine])
    expected = [exact(part) for part in ratios]
    return Curve(ratios, results, expected, "damping ratio", "decrement", line).worst(DECREMENT)


def rows() -> list[Row]:
    """All rows of the chapter."""
    closed = "closed form: "
    falls = "a_free_cloth_falls_as_each_rule_says_and_keeps_its_shape"
    implicit = "test_a_free_cloth_falls_under_implicit_euler_as_its_closed_form_says"
    found = [
        Row(CHAPTER, f"free fall, {WORDS[rule]}", "depth after 1 s", "m", closed + form,
            implicit if rule == "implicit_euler" else falls, partial(fall, rule), EXACT)
        for rule, (form, _) in FALLS.items()
    ]  # fmt: skip
    found.append(
        Row(CHAPTER, "free fall: the sheet stays as it is", "farthest vertex", "m",
            closed + "a free cloth falls like a point", falls, whole, STRAIGHT)
    )  # fmt: skip
    test = "a_pendulum_on_a_stiff_spring_swings_with_the_period_of_its_amplitude"
    for degrees in (30.0, 90.0):
        found.append(
            Row(CHAPTER, f"pendulum of {degrees:g}°", "T / T0", "", closed + "2/pi K(sin(theta/2))", test,
                partial(pendulum, degrees), PENDULUM)
        )  # fmt: skip
    test = "the_first_swing_of_a_hanging_strip_has_the_chains_frequency"
    for count in (20, 50):
        found.append(
            Row(CHAPTER, f"first swing of a hanging strip of {count} masses", "w1 / sqrt(g/L)", "",
                reference.SOURCES[reference.CHAINS], test, partial(chain_swing, count), CHAIN)
        )  # fmt: skip
    found.append(
        Row(CHAPTER, "first swing of a hanging strip", "w1 / sqrt(g/L)", "",
            closed + "half the first zero of the Bessel function J0", test, strip_swing, CONTINUUM)
    )  # fmt: skip
    viscous = "viscous_air_brings_a_falling_sheet_to_weight_over_damping_with_mass_over_damping"
    quadratic = "a_flat_sheet_falls_through_air_to_the_speed_whose_pressure_carries_it"
    found += [
        Row(CHAPTER, "linear drag: terminal speed", "speed", "m/s", closed + "m g/c", viscous,
            partial(linear_drag, "terminal"), DRAG),
        Row(CHAPTER, "linear drag: time constant", "time", "s", closed + "m/c", viscous,
            partial(linear_drag, "constant"), DRAG),
        Row(CHAPTER, "quadratic drag: speed on the way to the terminal one", "speed", "m/s",
            closed + "v_t tanh(g t/v_t), v_t = sqrt(2 sigma g/(rho Cd))", quadratic, quadratic_drag, DRAG),
    ]  # fmt: skip
    test = "a_damped_spring_has_the_logarithmic_decrement_of_its_damping_ratio"
    for law, words in LAWS.items():
        found.append(
            Row(CHAPTER, f"damped spring, {words}", "logarithmic decrement", "",
                closed + "2 pi zeta/sqrt(1 - zeta²)", test, partial(damped_spring, law), DECREMENT)
        )  # fmt: skip
    return found
