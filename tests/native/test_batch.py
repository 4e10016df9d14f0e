"""The function run_batch: many scenes in one call."""

import json
import time

import boucle_core
import pytest


def scene(side=6, frames=5, cloth=None, **solver):
    keys = {
        "name": "sheet",
        "grid": {"size": [1.0, 1.0], "vertices": [side, side], "plane": "xz"},
        "pins": ["top_left", "top_right"],
        **(cloth or {}),
    }
    timing = {"frames": [1, frames]}
    return json.dumps(
        {"scene": timing, "cloth": [keys], "solver": solver, "collision": {"enabled": False}}
    )


def alone(text, sheet):
    """The certificates of a scene run by the class Simulation."""
    keys = json.loads(text)
    del keys["cloth"][0]["grid"]
    keys["cloth"][0]["pins"] = {"vertices": sheet.top_corners}
    # The grid of a scene file is centred.
    positions = type(sheet.positions)("d", sheet.positions)
    for index in range(len(positions)):
        positions[index] -= 0.5 if index % 3 != 1 else 0.0
    simulation = boucle_core.Simulation(
        json.dumps(keys), [(positions, sheet.starts, sheet.corners)]
    )
    rows = [simulation.certificate()]
    return rows + [simulation.advance() for _ in range(keys["scene"]["frames"][1] - 1)]


def test_rows_are_those_of_each_scene_alone_in_their_order(make_sheet):
    integrators = ["bdf2", "implicit_euler", "verlet", "rk4"] * 2
    scenes = [
        scene(side, integrator=integrator)
        for side, integrator in zip(range(3, 11), integrators, strict=True)
    ]
    rows = boucle_core.run_batch(scenes)
    for side, text, row in zip(range(3, 11), scenes, rows, strict=True):
        certificates = alone(text, make_sheet(side))
        assert (row["ending"], row["error"]) == ("done", None)
        assert row["first"]["kinetic_energy"] == certificates[0]["kinetic_energy"]
        assert row["last"]["hash"] == certificates[-1]["hash"]
        assert row["largest_strain"] == max(each["max_strain"] for each in certificates)
        assert 0.0 < row["safe_time_step"] <= 1 / 24
    again = boucle_core.run_batch(scenes, threads=3)
    for row in rows + again:
        del row["seconds"]
    assert again == rows


def test_a_scene_that_fails_is_a_row_and_not_an_exception():
    wild = scene(
        40,
        60,
        {"springs": {"limiter": "none"}},
        integrator="symplectic_euler",
        substeps=10,
        allow_unstable=True,
    )
    rows = boucle_core.run_batch([scene(), wild, scene(1), "{", scene(solver=1)])
    assert [row["ending"] for row in rows] == ["done", "diverged"] + ["refused"] * 3
    assert rows[1]["error"].startswith(f"diverged at frame {rows[1]['last']['frame'] + 1}, vertex ")
    assert all("\n" not in row["error"] for row in rows[1:])
    assert rows[2]["last"] is None


def test_files_that_scenes_name_are_looked_for_in_the_folder(tmp_path):
    (tmp_path / "tile.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    text = json.dumps(
        {"cloth": [{"name": "tile", "mesh": "tile.obj"}], "scene": {"frames": [1, 3]}}
    )
    there, nowhere = (
        boucle_core.run_batch([text], folder=str(folder))[0]
        for folder in (tmp_path, tmp_path / "nowhere")
    )
    assert there["last"]["frame"] == 3
    assert nowhere["ending"] == "refused" and "tile.obj" in nowhere["error"]


def test_progress_hears_of_all_and_its_exception_stops_the_scenes_under_way():
    told = []
    boucle_core.run_batch([scene()] * 20, progress=told.append)
    counts = [step["done"] for step in told]
    assert counts == sorted(counts) and counts[-1] == 20
    assert {step["total"] for step in told} == {20}

    def stop(step):
        if step["seconds"] > 0.2:
            raise KeyboardInterrupt("enough")

    endless = scene(20, 1000, integrator="symplectic_euler", substeps=100_000)
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt, match="enough"):
        boucle_core.run_batch([endless] * 4, progress=stop)
    assert time.monotonic() - began < 5.0


def test_wrong_arguments_are_refused():
    assert boucle_core.run_batch([]) == []
    with pytest.raises(boucle_core.SceneError, match="threads = -1"):
        boucle_core.run_batch([scene()], threads=-1)
    with pytest.raises(TypeError):
        boucle_core.run_batch([1])
