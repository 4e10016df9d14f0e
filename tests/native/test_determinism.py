"""The same bits from the same scene: on 1 to 8 threads, gone on with from any frame, and from a build of another kind."""

import json
import subprocess
import sys

import boucle_core
import pytest

from .conftest import ROOT

IMPLICIT = ("bdf2", "implicit_euler")
EXPLICIT = ("symplectic_euler", "forward_euler", "verlet", "leapfrog", "midpoint", "rk4")
SPRINGS = {"springs": {"stretch": 60.0, "shear": 20.0, "bend": 1.0, "damping": 0.02}}
FABRIC = {
    "model": "fabric",
    "fabric": {"stretch_warp": 60.0, "stretch_weft": 50.0, "shear": 20.0, "yield_curvature": 5.0},
}
MODELS = {"springs": SPRINGS, "fabric": FABRIC}
SIDES = {"springs": 70, "fabric": 50}
"""Vertices along a side: enough that there is work for eight threads."""


def scene(integrator, model, n, frames):
    """A sheet that is thrown at a ball, blown at by gusts and opened across the middle in frame 3; it tears besides."""
    middle = n // 2 * n
    pairs = [[middle + i, middle + i + 1] for i in range(n // 4, n - 1)]
    cloth = {
        "name": "sheet",
        "density": 2.0,
        "velocity": [0.0, 5.0, 0.0],
        "pins": {"vertices": [n * (n - 1), n * n - 1]},
        "tear": {"openings": [{"frame": 3, "pairs": pairs}]},
        **MODELS[model],
    }
    # Heavy cloth and short frames: stable with few steps each.
    return {
        "scene": {"fps": 500, "frames": [1, frames]},
        "cloth": [cloth],
        "tear": {"enabled": True, "strain": 0.06, "noise": 0.3, "seed": 3},
        "collision": {"thickness": 0.2 / n, "friction": 0.4},
        "collider": [{"name": "ball", "sphere": {"center": [0.4, 0.105, 0.4], "radius": 0.1}}],
        "force": [{"kind": "wind", "velocity": [3.0, 6.0, 1.0], "air_density": 1.2,
                   "gusts": {"strength": 0.5, "period": 0.02}}],
        "solver": {"integrator": integrator, "allow_unstable": True, "substeps": 2 if integrator in IMPLICIT else 8},
    }  # fmt: skip


@pytest.fixture
def make(make_sheet):
    """Make a simulation of the scene on so many threads."""

    def made(integrator, model, n, threads):
        text = json.dumps(scene(integrator, model, n, 99))
        return boucle_core.Simulation(text, [make_sheet(n).mesh()], threads)

    return made


def toml(value):
    """A value in a line of TOML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(part)}" for key, part in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def told(simulation, frames):
    """What so many frames tell of themselves, but for what their clock says."""
    rows = [simulation.advance() for _ in range(frames)]
    assert not any("second" in key for row in rows for key in row)
    return rows


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("integrator", IMPLICIT + EXPLICIT)
def test_one_to_eight_threads_give_the_same_bits_in_contact_and_while_tearing(
    make, integrator, model
):
    runs = []
    for threads in range(1, 9):
        simulation = make(integrator, model, SIDES[model], threads)
        runs.append((told(simulation, 3), simulation.checkpoint(), simulation.torn_edges(0)))
    rows, _, torn = runs[0]
    assert rows[-1]["contacts"] > 20 and len(torn) > 50
    for threads, run in enumerate(runs, 1):
        assert run == runs[0], f"{threads} threads"


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("integrator", IMPLICIT + EXPLICIT)
def test_from_every_frame_a_new_simulation_goes_on_with_the_same_bits(make, integrator, model):
    whole, saved, rows = make(integrator, model, 14, 1), [], []
    for _ in range(12):
        saved.append(whole.checkpoint())
        rows.extend(told(whole, 1))
    end = whole.checkpoint()
    assert whole.torn_edges(0)
    for frame, checkpoint in enumerate(saved):
        # On other threads, and from a state that has gone elsewhere: nothing of it may be left.
        other = make(integrator, model, 14, 1 + frame % 3)
        told(other, frame % 5)
        other.restore(checkpoint)
        assert told(other, 12 - frame) == rows[frame:], f"from frame {frame + 1}"
        assert other.checkpoint() == end


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("integrator", IMPLICIT + EXPLICIT[:2])
def test_a_build_with_debug_assertions_gives_the_bits_of_the_release(
    tmp_path, read_report, integrator, model
):
    keys = scene(integrator, model, 24, 9)
    keys["cloth"][0]["grid"] = {"size": [1, 1], "vertices": [24, 24], "plane": "xz", "center": [0.5, 0, 0.5]}  # fmt: skip
    path = tmp_path / "scene.toml"
    path.write_text("\n".join(f"{key} = {toml(value)}" for key, value in keys.items()))
    example = ["cargo", "run", "--quiet", "-p", "boucle-scene", "--example", "bake", "--"]
    subprocess.run([*example, path, tmp_path / "debug"], cwd=ROOT, check=True, timeout=600)
    release = [sys.executable, ROOT / "scripts" / "bake.py", path, "--out", tmp_path / "release"]
    subprocess.run([*release, "--quiet"], check=True, timeout=600)
    kinds = [tmp_path / "debug", tmp_path / "release"]
    one, other = ([row["hash"] for row in read_report(kind)["frames"]] for kind in kinds)
    assert one == other and len(one) == 9
    assert (
        kinds[0].joinpath("sheet.pc2").read_bytes() == kinds[1].joinpath("sheet.pc2").read_bytes()
    )
