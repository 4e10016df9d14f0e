"""The exploration: its theory against tabled numbers, its boundaries against its theory, and what it leaves."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
EXPLORE = ROOT / "scripts" / "explore.py"

pytest.importorskip("matplotlib")

from exploring import limiters, meshes, ranges, stability, theory  # noqa: E402
from exploring.boundary import Runs  # noqa: E402
from exploring.sheet import Lattice, Point, grid  # noqa: E402


def run(*words):
    command = [sys.executable, str(EXPLORE), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


@pytest.fixture
def runs(tmp_path):
    return Runs(tmp_path, lambda *_told: None)


@pytest.mark.parametrize(
    ("ratios", "wanted"),
    [
        ((1.0, 0.0, 0.0), 3.9616),
        ((1.0, 1.0, 0.0), 7.8864),
        ((1.0, 0.5, 0.0), 5.9238),
        ((1.0, 0.0, 1.0), 6.1038),
        ((1.0, 1.0, 1.0), 9.9129),
    ],
)
def test_the_largest_eigenvalue_of_a_free_grid_is_the_tabled_one(ratios, wanted):
    # Of a 16 x 16 grid, computed independently of this project.
    values = theory.eigenvalues(grid(16), Lattice(*ratios))
    assert values[-1] == pytest.approx(wanted, abs=1e-4)


@pytest.mark.parametrize("integrator", theory.EXPLICIT)
def test_the_steps_of_a_single_oscillator_are_the_closed_ones(integrator):
    w_squared = np.array([9.0])
    step = theory.largest_step(integrator, w_squared, 0.0)
    assert step == pytest.approx(theory.UNDAMPED_LIMIT.get(integrator, 0.0) / 3.0)
    nearly = theory.largest_step(integrator, w_squared, 1e-9)
    if integrator in theory.UNDAMPED_LIMIT:
        assert nearly == pytest.approx(step, rel=1e-3)
    damped = theory.largest_step(integrator, w_squared, 0.02)
    if integrator == "forward_euler":
        assert damped == pytest.approx(0.02)  # h = c/w²
    if integrator == "symplectic_euler":  # h² w² + 2 c h = 4
        c = 0.02 * 9.0
        assert damped == pytest.approx((-c + math.sqrt(c * c + 36.0)) / 9.0)


def test_the_measured_boundary_is_within_5_percent_of_theory(runs):
    undamped = stability.undamped(runs, stability.QUICK)
    assert len(undamped.points) == 32
    assert np.isfinite(undamped.measured).all()
    assert np.abs(undamped.errors).max() < 0.05
    assert (undamped.safe < undamped.theory).all() and (undamped.safe > 0.5 * undamped.theory).all()
    damped = stability.damped(runs, stability.QUICK)
    assert {point.integrator for point in damped.points} == set(theory.EXPLICIT)
    assert np.abs(damped.errors).max() < 0.05
    assert runs.count == 10 * (32 + 24)


def test_a_boundary_that_is_not_in_its_bracket_is_not_made_up(runs):
    point = Point("verlet", 0.01, 500.0)
    step = stability.boundary(runs, "one", [point], 8).measured[0]
    for low, high in ((0.1 * step, 0.5 * step), (2.0 * step, 4.0 * step)):
        assert math.isnan(runs.bisect("none", [point], [low], [high], 3)[0])


def test_without_damping_forward_euler_and_midpoint_gain_energy_at_any_step(runs):
    points = [Point(name, 0.01, 500.0) for name in ("forward_euler", "midpoint", "verlet")]
    w = stability.fastest(points[0])
    forward, midpoint, verlet = runs.growths("undamped", points, [0.5 / w] * 3)
    assert forward > 1e3 and midpoint > 10.0 and verlet < 1.5


def test_the_falling_sheet_bears_the_safe_step(runs):
    falling = stability.falling(runs, stability.QUICK)
    assert (falling.measured > falling.safe).all()
    assert (falling.measured < 2.0 * falling.safe).all()


def test_irregular_meshes_have_the_boundary_of_theory_and_no_slivers(runs):
    woven = meshes.meshes()
    steps, safe = meshes.boundaries(runs, woven)
    for step, bound, mesh in zip(steps, safe, woven.values(), strict=True):
        w = math.sqrt(theory.eigenvalues(mesh, meshes.PAPER)[-1] * meshes.STIFFNESS / meshes.MASS)
        assert step == pytest.approx(2.0 / w, rel=0.05)
        assert bound < step
        assert set(mesh.faces.flat) == set(range(meshes.VERTICES**2))


def test_a_biphasic_factor_of_1_is_the_sheet_without_a_limiter():
    plain = limiters.hang("none", "symplectic_euler", 6)
    same = limiters.hang_biphasic(1.0, 6, plain)
    assert same.steps == plain.steps
    assert same.strain == pytest.approx(plain.strain, rel=1e-3)
    assert same.energy == pytest.approx(plain.energy, abs=1e-4)
    stiff = limiters.hang_biphasic(100.0, 6, plain)
    assert 0.0 < stiff.overshoot < 0.2 * plain.overshoot


def test_ranges_hold_what_was_measured_and_are_those_that_are_kept(runs, tmp_path):
    size = stability.Size(dampings=10, rounds=9)
    found = ranges.ranges(stability.damped(runs, size))
    ranges.keep(found, tmp_path / "ranges.json")
    kept = json.loads((ROOT / "addon" / "core" / "ranges.json").read_text())
    assert json.loads((tmp_path / "ranges.json").read_text()).keys() == kept.keys()
    for name, row in found.items():
        # Ten dampings stand 50 % apart.
        assert row["damping_ratio"] == pytest.approx(kept[name]["damping_ratio"], rel=0.55), name
    assert ranges.table(kept).count("\n") == 8


def test_the_pictures_the_tables_and_the_numbers_are_made(tmp_path):
    done = run("--quick", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    index = (tmp_path / "out" / "index.md").read_text()
    for part in ("stability", "limiters", "integrators", "meshes"):
        picture = (tmp_path / "out" / f"{part}.png").read_bytes()
        assert picture.startswith(b"\x89PNG") and len(picture) > 20_000
        assert f"({part}.png)" in index
    assert index.count("\n| rk4") >= 2 and "| biphasic 100 |" in index
    numbers = json.loads((tmp_path / "out" / "numbers.json").read_text())
    assert numbers["stability"]["worst_error_percent"]["undamped"] < 5.0
    overshoot = {
        (row["limiter"], row["integrator"]): row["overshoot_points"] for row in numbers["limiters"]
    }
    for integrator in ("symplectic_euler", "bdf2"):
        assert overshoot["project", integrator] < 0.1 < overshoot["stiffen", integrator]


@pytest.mark.parametrize(
    "words",
    [["--threads", "many"], ["--only", "everything"], ["--frames", "3"], ["--threads", "-1"]],
)
def test_wrong_words_get_one_sentence(words):
    done = run(*words)
    assert done.returncode == 2
    assert done.stderr.startswith("explore.py: ") and done.stderr.count("\n") == 1


def test_a_folder_that_cannot_be_made_gets_one_sentence(tmp_path):
    (tmp_path / "file").write_text("in the way")
    done = run("--quick", "--only", "meshes", "--out", tmp_path / "file" / "out")
    assert done.returncode == 4
    assert done.stderr.startswith("explore.py: ") and done.stderr.count("\n") == 1
