"""Integrators on x'' = -w² x: a mass of 1 kg on a spring of 1 N/m, so that a step of z seconds is z radians."""

from __future__ import annotations

import cmath
import math
from functools import cache, partial
from typing import Any

import boucle_core
import numpy as np

from integrator_words import WORDS

from . import reference
from .row import Curve, Finding, Row, Tolerance
from .specimen import STILL, Setting, Specimen, grid

CHAPTER = "integrators"
NAMES_IN_TABLE = {
    "verlet": "velocity_verlet",
    "leapfrog": "velocity_verlet",
    "midpoint": "rk2_midpoint",
    "implicit_euler": "backward_euler",
}
ORDERS = {
    "forward_euler": 1,
    "symplectic_euler": 1,
    "verlet": 2,
    "leapfrog": 2,
    "midpoint": 2,
    "rk4": 4,
    "implicit_euler": 1,
    "bdf2": 2,
}
LIMITS = {"symplectic_euler": 2.0, "verlet": 2.0, "leapfrog": 2.0, "rk4": math.sqrt(8.0)}
GROWING = {"forward_euler": 0.05, "midpoint": 0.2}
"""Rules that no undamped step keeps, and a z of the table at which a thousand steps are looked at."""

EXPLICIT_TEST = "every_rule_has_the_energy_factor_and_the_period_of_the_table"
IMPLICIT_TEST = "test_implicit_rules_have_the_energy_factor_and_the_period_of_their_formulas"
IMPLICIT_ORDER_TEST = "test_implicit_rules_converge_at_their_order"

FACTOR = Tolerance(1e-9)
"""The table has ten digits or more; a force of an elongation of 0.05 m is right to 1e-14."""
SWING = Tolerance(1e-4)
"""Thousands of steps fall all over the period, and energy is flat at its extremes."""
LIMIT = Tolerance(2e-3)
"""Found by halving to a thousandth."""
GROWTH = Tolerance(1e-6)
"""The table has eight digits."""
ORDER = Tolerance(0.03, is_relative=False)
"""The next term of the error's series, at these steps."""


def oscillator(kind: str, z: float, amplitude: float) -> Specimen:
    """Two pins and two masses at the corners of a square: drawn out together, each is one mass on one spring."""
    shape = grid([0.0, 1.0], [0.0, 1.0])
    start = shape.positions + np.array([amplitude, 0.0, 0.0]) * [[0.0], [1.0], [0.0], [1.0]]
    cloth = {"mass_per_vertex": 1.0, "springs": {**STILL, "stretch": 1.0}}
    return Specimen(shape, cloth, Setting(kind, step=z), pins=[0, 2], start=start)


def follow(kind: str, z: float, amplitude: float, steps: int) -> np.ndarray:
    """Elongation and speed at the start and after each step, in units of the first elongation, (steps + 1, 2)."""
    mass = oscillator(kind, z, amplitude)
    states = [(mass.positions()[1, 0] - 1.0, mass.velocities()[1, 0])]
    for _ in range(steps):
        mass.advance()
        states.append((mass.positions()[1, 0] - 1.0, mass.velocities()[1, 0]))
    return np.array(states) / amplitude


@cache
def multiplier(kind: str, z: float) -> complex:
    """What a step multiplies a free oscillation by, as a complex number."""
    if kind == "bdf2":
        # A rule of two steps: its other root, a third, has died out after thirty.
        late = follow(kind, z, 0.05, 31) @ np.array([1.0, -1.0j])
        return complex(late[31] / late[30])
    quarter = math.ceil(0.5 * math.pi / z)
    states = follow(kind, z, 0.05, quarter + 1)
    matrix = states[[1, quarter + 1]].T @ np.linalg.inv(states[[0, quarter]].T)
    values = np.linalg.eigvals(matrix)
    return complex(values[np.argmax(values.imag)])


def closed_multiplier(kind: str, z: float) -> complex:
    """The same from the rule's formula: of dx/dt = i w x, or of the matrix of symplectic rules."""
    y = 1j * z
    if kind in ("symplectic_euler", "verlet", "leapfrog"):
        return cmath.exp(2j * math.asin(0.5 * z))
    if kind == "bdf2":
        return (2.0 + cmath.sqrt(1.0 + 2.0 * y)) / (3.0 - 2.0 * y)
    if kind == "implicit_euler":
        return 1.0 / (1.0 - y)
    terms = {"forward_euler": 1, "midpoint": 2, "rk4": 4}[kind]
    return sum(y**n / math.factorial(n) for n in range(terms + 1))


def factor_of(root: complex) -> float:
    """By which a step multiplies the energy."""
    return abs(root) ** 2


def period_of(root: complex, z: float) -> float:
    """Period over the true one."""
    return z / cmath.phase(root)


def tabled(kind: str) -> list[dict[str, float]]:
    """What is known of a rule at some z: by the table, BDF2 by its characteristic polynomial."""
    if kind == "bdf2":
        known = []
        for z in (0.01, 0.05, 0.1, 0.2, 0.5, 1.0):
            root = closed_multiplier(kind, z)
            known.append({"z": z, "factor": factor_of(root), "period": period_of(root, z)})
        return known
    name = NAMES_IN_TABLE.get(kind, kind)
    lines = [line for line in reference.table(reference.INTEGRATORS) if line["integrator"] == name]
    columns = {"z": "z", "factor": "energy_factor_per_step", "period": "period_ratio"}
    columns["after"] = "energy_ratio_1000steps"
    return [{key: float(line[column]) for key, column in columns.items()} for line in lines]


def tabled_source(kind: str) -> str:
    """Where the numbers of `tabled` come from."""
    if kind == "bdf2":
        return (
            "closed form: the root of (3 - 2iz) r² - 4 r + 1 = 0, BDF2's characteristic polynomial"
        )
    return reference.SOURCES[reference.INTEGRATORS]


def along_z(kind: str, column: str) -> Finding:
    """Energy factor or period at every z of the table."""
    known = tabled(kind)
    zs = [line["z"] for line in known]
    fine = np.linspace(0.01, 1.0, 100)

    def of(root: complex, z: float) -> float:
        return factor_of(root) if column == "factor" else period_of(root, z)

    curve = Curve(
        zs,
        [of(multiplier(kind, z), z) for z in zs],
        [line[column] for line in known],
        "z",
        "energy a step" if column == "factor" else "T / T0",
        (fine, [of(closed_multiplier(kind, z), z) for z in fine]),
    )
    return curve.worst(FACTOR)


def order(kind: str) -> Finding:
    """By how much halving the step lessens the error after ten radians."""
    counts = (200, 400, 800, 1600)
    errors = []
    for steps in counts:
        x, v = follow(kind, 10.0 / steps, 0.1, steps)[-1]
        errors.append(math.hypot(x - math.cos(10.0), v + math.sin(10.0)))
    reached = math.log2(errors[-2] / errors[-1])
    slopes = [errors[-1] * (counts[-1] / count) ** ORDERS[kind] for count in counts]
    plot = Curve(counts, errors, slopes, "steps", "error", logarithmic="xy")
    return Finding(reached, ORDERS[kind], plot)


def is_bounded(kind: str, z: float) -> bool:
    """Whether two thousand steps leave the mass within a thousand times its first elongation."""
    mass = oscillator(kind, z, 1e-6)
    for _ in range(40):
        try:
            mass.advance(50)
        except boucle_core.DivergedError:
            return False
        if abs(mass.positions()[1, 0] - 1.0) > 1e-3:
            return False
    return True


def largest_stable(kind: str) -> Finding:
    """The largest z that stays bounded, found by halving."""
    low, high = 0.9 * LIMITS[kind], 1.13 * LIMITS[kind]
    tries = []
    while high - low > 1e-3 * low:
        middle = 0.5 * (low + high)
        tries.append((middle, is_bounded(kind, middle)))
        low, high = (middle, high) if tries[-1][1] else (low, middle)

    def draw(axes: Any) -> None:
        x, held = np.array(tries, dtype=float).T
        axes.plot(x, held, "o", color="C1", mfc="none", mew=1.6)
        axes.axvline(LIMITS[kind], color="C0", lw=2.2)
        axes.set_yticks([0, 1], ["diverged", "bounded"])
        axes.set_ylim(-0.5, 1.5)
        axes.set_xlabel("z")

    return Finding(low, LIMITS[kind], draw)


def after_a_thousand(kind: str) -> Finding:
    """What a thousand steps make of the energy."""
    z = GROWING[kind]
    (line,) = (line for line in tabled(kind) if line["z"] == z)
    energies = (follow(kind, z, 1e-3, 1000) ** 2).sum(axis=1)
    steps = np.arange(1001)
    exact = factor_of(closed_multiplier(kind, z)) ** steps
    plot = Curve(steps[::50], energies[::50], exact[::50], "steps", "energy", logarithmic="y")
    return Finding(float(energies[-1]), line["after"], plot)


def swing(kind: str) -> Finding:
    """The ratio of largest to least energy of a rule that keeps it bounded."""

    def exact(z: float) -> float:
        if kind == "symplectic_euler":
            return (1.0 + 0.5 * z) / (1.0 - 0.5 * z)
        return 1.0 / (1.0 - 0.25 * z * z)

    zs, fine = [0.1, 0.37, 0.9, 1.7], np.linspace(0.05, 1.75, 100)
    ratios = []
    for z in zs:
        energies = (follow(kind, z, 1e-2, 5000) ** 2).sum(axis=1)
        ratios.append(energies.max() / energies.min())
    curve = Curve(
        zs, ratios, [exact(z) for z in zs], "z", "Emax / Emin", (fine, [exact(z) for z in fine])
    )
    return curve.worst(SWING)


def long_steps(kind: str) -> Finding:
    """Energy after four steps of a hundred radians, by the rule's own formula and by the module."""
    y, count = 100.0j, 4
    exact = [1.0, 1.0 / (1.0 - y)]
    for _ in range(count - 1):
        one_step, two_steps = exact[-1] / (1.0 - y), (4.0 * exact[-1] - exact[-2]) / (3.0 - 2.0 * y)
        exact.append(one_step if kind == "implicit_euler" else two_steps)
    expected = [abs(value) ** 2 for value in exact]
    energies = (follow(kind, 100.0, 0.05, count) ** 2).sum(axis=1)
    plot = Curve(range(count + 1), energies, expected, "steps", "energy", logarithmic="y")
    return Finding(float(energies[-1]), expected[-1], plot)


def stability_row(kind: str) -> Row:
    """The row that tells for which steps a rule is stable."""
    if kind in LIMITS:
        what, tolerance, measure = "largest stable z", LIMIT, partial(largest_stable, kind)
        source = f"closed form: {'2 sqrt 2, where |1 + y + y²/2 + y³/6 + y⁴/24| = 1' if kind == 'rk4' else '2'}"
        test = "bounded_rules_stay_bounded_below_their_limit_and_diverge_above_it"
    elif kind in GROWING:
        what = f"energy after 1000 steps of z = {GROWING[kind]:g}: never stable undamped"
        tolerance, measure = GROWTH, partial(after_a_thousand, kind)
        source, test = tabled_source(kind), "a_thousand_steps_leave_the_energy_of_the_table"
    else:
        what, tolerance, measure = (
            "energy after 4 steps of z = 100: stable",
            GROWTH,
            partial(long_steps, kind),
        )
        source, test = "closed form: the rule's own recurrence on dy/dt = i y", IMPLICIT_TEST
    return Row(CHAPTER, f"{WORDS[kind]}: {what}", what, "", source, test, measure, tolerance)


def rows() -> list[Row]:
    """All rows of the chapter."""
    found = []
    for kind, words in WORDS.items():
        is_implicit = kind in ("implicit_euler", "bdf2")
        of_table = IMPLICIT_TEST if is_implicit else EXPLICIT_TEST
        of_order = IMPLICIT_ORDER_TEST if is_implicit else "every_rule_converges_at_its_order"
        for column, what in (("factor", "energy factor a step"), ("period", "period ratio T/T0")):
            name, measure = f"{words}: {what}", partial(along_z, kind, column)
            found.append(
                Row(CHAPTER, name, what, "", tabled_source(kind), of_table, measure, FACTOR)
            )
        name, measure = f"{words}: order of convergence", partial(order, kind)
        known = "textbook order of the rule"
        found.append(Row(CHAPTER, name, "order", "", known, of_order, measure, ORDER))
        found.append(stability_row(kind))
    for kind in ("symplectic_euler", "verlet", "leapfrog"):
        name, what = f"{WORDS[kind]}: swing of the energy", "Emax/Emin"
        form = "(1 + z/2)/(1 - z/2)" if kind == "symplectic_euler" else "1/(1 - z²/4)"
        test = "the_energy_of_symplectic_rules_swings_by_the_closed_form"
        found.append(
            Row(CHAPTER, name, what, "", f"closed form: {form}", test, partial(swing, kind), SWING)
        )
    return found
