"""Square lattices of springs: the largest stable step, the step that `auto` picks, and the elastic sheet that they are."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, partial
from typing import Any

import boucle_core
import numpy as np

from . import reference
from .row import EXACTLY, Curve, Finding, Range, Row, Tolerance
from .specimen import STILL, Setting, Specimen, even_grid

CHAPTER = "lattice"
SIDE = 16
STIFFNESS = 1e4
"""N/m, where the table has 1; particles weigh 1 kg."""
SHAKE = 1e-9
"""m: how far particles are moved at the start, so little that springs of 1 m stay linear."""
RULES = {"symplectic_euler": 2.0, "verlet": 2.0, "leapfrog": 2.0, "rk4": math.sqrt(8.0)}
"""The largest stable w dt of each rule."""
BOUNDED = 1e3
"""Just below the limit the fastest mode swings ten times as far as it is pushed; a thousand times is bounded."""
STEPS = 10_000

MODULI = Tolerance(1e-6)
"""Central differences over a strain of 1e-4, whose square is their error, with room."""
RATIO = Tolerance(1e-6, is_relative=False)
PULLED = Tolerance(1e-4)
"""Strains of 1e-5 are linear to 1e-5 of themselves, and a little motion is left."""
PULLED_RATIO = Tolerance(1e-4, is_relative=False)


@cache
def lattices() -> list[dict[str, Any]]:
    """The lines of the table, with their numbers as numbers."""
    return [
        {key: text if key == "springs" else float(text) for key, text in line.items()}
        for line in reference.table(reference.LATTICES)
    ]


def springs_of(line: dict[str, Any], factor: float = 1.0) -> dict[str, Any]:
    """The springs of a line, so many times as stiff."""
    keys = {"stretch": "ks", "shear": "kd", "bend": "kb"}
    return {**STILL, **{key: factor * line[column] for key, column in keys.items()}}


def fastest(line: dict[str, Any]) -> float:
    """The largest frequency (rad/s) of the free lattice of 16 x 16."""
    return math.sqrt(line["lambda_max_16x16_free"] * STIFFNESS)


def excursion(line: dict[str, Any], rule: str, step: float) -> float:
    """How much farther than it was shaken the lattice gets over 10 000 steps (s); infinity if it diverges."""
    shape = even_grid(SIDE, SIDE, 1.0)
    start = shape.positions + np.random.default_rng(1).uniform(-SHAKE, SHAKE, shape.positions.shape)
    substeps = 100
    solver = {"substeps": substeps, "allow_unstable": True}
    setting = Setting(rule, fps=1.0 / (step * substeps), solver=solver)
    cloth = {"mass_per_vertex": 1.0, "springs": springs_of(line, STIFFNESS)}
    sheet = Specimen(shape, cloth, setting, start=start)
    most = 0.0
    for _ in range(STEPS // substeps):
        try:
            sheet.advance()
        except boucle_core.DivergedError:
            return math.inf
        most = max(most, float(np.abs(sheet.positions() - shape.positions).max()))
    return most / SHAKE


def bracket(line: dict[str, Any]) -> Finding:
    """Of how many rules the bound is bracketed: bounded at 0.98 of it, not at 1.02."""
    parts, held = (0.98, 1.02), 0
    found: dict[str, list[float]] = {}
    for rule, limit in RULES.items():
        bound = limit / fastest(line)
        found[rule] = [excursion(line, rule, part * bound) for part in parts]
        below, above = found[rule]
        # Above it Runge-Kutta may end in a crumpled lattice that tumbles at some metres.
        held += below < BOUNDED and above > 1.0 / SHAKE

    def draw(axes: Any) -> None:
        for rule, (below, above) in found.items():
            axes.plot(
                parts, [below, min(above, 1e14)], "o-", ms=4, lw=1.2, label=rule.replace("_", " ")
            )
        axes.axhline(BOUNDED, ls="--", lw=1.0, color="0.5")
        axes.set_yscale("log")
        axes.set_xlabel("step / bound")
        axes.set_ylabel("excursion / push")

    return Finding(held, len(RULES), draw)


def auto_part(line: dict[str, Any]) -> Finding:
    """The step that `auto` picks, as a part of the bound; of four rules the one nearest to the range's ends."""
    parts = []
    shape = even_grid(SIDE, SIDE, 1.0)
    cloth = {"mass_per_vertex": 1.0, "springs": springs_of(line, STIFFNESS)}
    for rule, limit in RULES.items():
        sheet = Specimen(shape, cloth, Setting(rule, fps=1.0))
        parts.append(1.0 / sheet.simulation.substeps * fastest(line) / limit)

    def draw(axes: Any) -> None:
        axes.bar(range(len(parts)), parts, color="C1", width=0.6)
        axes.set_xticks(range(len(parts)), ["sympl.", "Verlet", "leapfrog", "RK4"], fontsize=8)
        axes.axhspan(0.5, 1.0, color="C0", alpha=0.15)
        axes.set_ylabel("step / bound")

    return Finding(max(parts, key=lambda part: abs(part - 0.75)), Range(0.5, 1.0), draw)


def energy_of_cell(line: dict[str, Any]) -> Callable[[np.ndarray], float]:
    """The energy (J/m²) of an inner cell at a strain: what a row and a column more add, less what each adds alone."""
    counts = ((8, 8, 1), (7, 8, -1), (8, 7, -1), (7, 7, 1))
    cloth = {"mass_per_vertex": 1.0, "springs": springs_of(line)}
    sheets = [
        (Specimen(even_grid(columns, rows, 1.0), cloth, Setting(step=1.0)), sign)
        for columns, rows, sign in counts
    ]

    def energy(strain: np.ndarray) -> float:
        e11, e22, e12 = strain
        gradient = np.array([[1.0 + e11, e12, 0.0], [e12, 1.0 + e22, 0.0], [0.0, 0.0, 1.0]])
        total = 0.0
        for sheet, sign in sheets:
            sheet.simulation.set_positions(0, np.ascontiguousarray(sheet.rest @ gradient))
            total += sign * sheet.simulation.certificate()["potential_energy"]
        return total

    return energy


@cache
def moduli(number: int) -> tuple[float, float]:
    """Young's modulus (N/m) and Poisson's number of a lattice, by second differences of its energy."""
    energy, e = energy_of_cell(lattices()[number]), 1e-4
    along, across = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])

    def second(a: np.ndarray, b: np.ndarray) -> float:
        mixed = (
            energy(e * (a + b)) - energy(e * (a - b)) - energy(e * (b - a)) + energy(-e * (a + b))
        )
        return mixed / (4.0 * e * e)

    c11, c12 = second(along, along), second(along, across)
    return c11 - c12 * c12 / c11, c12 / c11


@cache
def pulled(number: int) -> tuple[float, float]:
    """The same of a strip that is drawn out at its ends, from strains in its middle and the forces of its springs.

    The strip is drawn by a hundred-thousandth. Its borders are stiffer than a sheet's inside, for which a strip of one
    row more is drawn, too: what that row adds is the sheet's.
    """
    line, forces, ratio = lattices()[number], [], 0.0
    for rows in (4, 5):
        columns, strain = 45, 1e-5
        shape = even_grid(columns, rows, 1.0)
        number_of = np.arange(columns * rows).reshape(rows, columns)
        ends = np.concatenate([number_of[:, 0], number_of[:, -1]])
        # Between the stiff motions of a cell (w = 2/s) and the slow ones of the strip's length.
        cloth = {"mass_per_vertex": 1.0, "springs": {**springs_of(line), "air_damping": 0.3}}
        start = shape.positions * np.array([1.0 + strain, 1.0, 1.0])
        setting = Setting("implicit_euler", fps=0.5, solver={"substeps": 4})
        strip = Specimen(shape, cloth, setting, pins=ends, start=start)
        strip.advance(600)
        x = strip.positions().reshape(rows, columns, 3)
        middle = columns // 2
        along = x[0, middle + 1, 0] - x[0, middle - 1, 0] - 2.0
        across = x[-1, middle, 1] - x[0, middle, 1] - (rows - 1)
        ratio = -(across / (rows - 1)) / (0.5 * along)
        forces.append(pull_across(strip, middle + 0.5) / (0.5 * along))
    return forces[1] - forces[0], ratio


def pull_across(strip: Specimen, x: float) -> float:
    """With which force (N) along x the springs pull that cross a line, which lies at x (m) at rest."""
    ends, _, _ = strip.springs()
    crosses = (strip.rest[ends[:, 0], 0] - x) * (strip.rest[ends[:, 1], 0] - x) < 0.0
    way = strip.positions()[ends[:, 1]] - strip.positions()[ends[:, 0]]
    parts = np.abs(way[:, 0]) / np.linalg.norm(way, axis=1)
    return float((strip.tensions() * parts)[crosses].sum())


def of_lattices(
    measure: Callable[[int], tuple[float, float]], part: int, tolerance: Tolerance, most_bend: float
) -> Finding:
    """Modulus (part 0) or Poisson's number (part 1) of all lattices whose bend springs are no stiffer than that."""
    chosen = [i for i, line in enumerate(lattices()) if line["kb"] <= most_bend]
    column = ("Y_uniaxial", "nu_uniaxial")[part]
    results = [measure(number)[part] for number in chosen]
    expected = [lattices()[number][column] for number in chosen]
    label = ("Y (N/m)", "Poisson's number")[part]
    return Curve([number + 1 for number in chosen], results, expected, "lattice", label).worst(
        tolerance
    )


def rows() -> list[Row]:
    """All rows of the chapter."""
    found, source = [], reference.SOURCES[reference.LATTICES]
    for line in lattices():
        springs = f"(ks, kd, kb) = ({line['ks']:g}, {line['kd']:g}, {line['kb']:g})"
        what = "rules bounded at 0.98 and diverged at 1.02 of the bound, in 10 000 steps"
        test = "ten_thousand_steps_stay_bounded_below_the_lattices_limit_and_diverge_above_it"
        measure = partial(bracket, line)
        found.append(
            Row(
                CHAPTER,
                f"lattice {springs}: largest stable step",
                what,
                "rules",
                source,
                test,
                measure,
                EXACTLY,
            )
        )
        test = "auto_takes_between_half_and_all_of_the_lattices_limit"
        name, what = f"lattice {springs}: the step that auto picks", "step / bound"
        found.append(Row(CHAPTER, name, what, "", source, test, partial(auto_part, line)))
    cases = (
        ("by its energy", "a_cell_of_the_lattice_has_the_moduli_of_the_table", moduli, math.inf),
        ("drawn out", "a_pulled_lattice_is_as_stiff_and_as_narrow_as_the_table_says", pulled, 0.0),
    )
    for how, test, measure, most_bend in cases:
        tolerances = (MODULI, RATIO) if measure is moduli else (PULLED, PULLED_RATIO)
        for part, (what, unit) in enumerate(
            (("Young's modulus Y", "N/m"), ("Poisson's number", ""))
        ):
            run = partial(of_lattices, measure, part, tolerances[part], most_bend)
            name = f"lattice {how}: {what}"
            found.append(Row(CHAPTER, name, what, unit, source, test, run, tolerances[part]))
    return found
