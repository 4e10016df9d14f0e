"""The function bake: progress, stopping, resuming."""

import json
from pathlib import Path

import boucle_core
import pytest


def hashes(report):
    return [(row["frame"], row["hash"]) for row in report["frames"]]


def test_a_bake_returns_the_report_that_it_writes(small_scene, tmp_path, read_report):
    report = boucle_core.bake(str(small_scene), str(tmp_path / "out"), threads=2)
    assert report == read_report(tmp_path / "out")
    assert [row["frame"] for row in report["frames"]] == list(range(1, 13))


def test_progress_hears_of_every_frame(small_scene, tmp_path):
    told = []
    boucle_core.bake(str(small_scene), str(tmp_path / "out"), progress=told.append)
    assert [step["frame"] for step in told] == list(range(1, 13))
    assert {(step["first"], step["last"]) for step in told} == {(1, 12)}
    assert all(step["seconds"] >= 0 for step in told)


@pytest.mark.parametrize("kind", [KeyboardInterrupt, ValueError, SystemExit, OSError])
def test_an_exception_of_progress_stops_the_bake_and_a_resumed_one_is_equal_to_the_bit(
    small_scene, tmp_path, kind
):
    whole = boucle_core.bake(str(small_scene), str(tmp_path / "whole"))

    def stop(step):
        if step["frame"] == 5:
            raise kind("enough")

    out = tmp_path / "stopped"
    with pytest.raises(kind, match="enough"):
        boucle_core.bake(str(small_scene), str(out), progress=stop)
    assert (out / "boucle.checkpoint").exists()
    assert len(json.loads((out / "report.json").read_text())["frames"]) == 5
    told = []
    resumed = boucle_core.bake(str(small_scene), str(out), resume=True, progress=told.append)
    assert told[0]["frame"] == 6
    assert hashes(resumed) == hashes(whole)
    assert resumed["frames"][:5] == json.loads((out / "report.json").read_text())["frames"][:5]
    assert (out / "sheet.pc2").read_bytes() == (tmp_path / "whole" / "sheet.pc2").read_bytes()


def test_an_exception_at_the_last_frame_still_reaches_the_caller(small_scene, tmp_path):
    def stop(step):
        if step["frame"] == step["last"]:
            raise ValueError("late")

    with pytest.raises(ValueError, match="late"):
        boucle_core.bake(str(small_scene), str(tmp_path / "out"), progress=stop)


def test_overrides_and_frames_are_taken(small_scene, tmp_path):
    report = boucle_core.bake(
        small_scene,
        tmp_path / "out",
        frames=(3, 6),
        overrides=["cloth.sheet.grid.vertices=[4, 5]", "solver.integrator=rk4"],
    )
    assert [row["frame"] for row in report["frames"]] == [3, 4, 5, 6]
    assert report["cloths"] == [{"name": "sheet", "vertices": 20, "triangles": 24, "springs": 77}]
    assert report["integrator"] == "rk4"


@pytest.mark.parametrize(
    "options",
    [
        {"frames": (2**40, 2**41)},
        {"frames": (5, 3)},
        {"threads": -1},
        {"threads": 10**6},
        {"overrides": ["nothing"]},
        {"overrides": ["cloth.sail.density=1"]},
    ],
)
def test_wrong_options_are_refused(small_scene, tmp_path, options):
    with pytest.raises(boucle_core.SceneError) as caught:
        boucle_core.bake(str(small_scene), str(tmp_path / "out"), **options)
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "out").exists()


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(boucle_core.SceneError, match=r"nowhere\.toml.*No such file"):
        boucle_core.bake(str(tmp_path / "nowhere.toml"), str(tmp_path / "out"))


def test_a_cache_error_is_an_error_of_the_system(small_scene, tmp_path):
    (tmp_path / "out").write_text("a file in the way")
    with pytest.raises(boucle_core.CacheError, match="out cannot be made") as caught:
        boucle_core.bake(str(small_scene), str(tmp_path / "out"))
    assert isinstance(caught.value, OSError)


def test_the_hashes_are_those_of_a_simulation_of_the_same_sheet(small_scene, tmp_path, make_sheet):
    report = boucle_core.bake(str(small_scene), str(tmp_path / "out"))
    sheet = make_sheet(12)
    rows = Path(tmp_path / "out" / "sheet.obj").read_text().splitlines()
    for index, row in enumerate(line for line in rows if line.startswith("v ")):
        sheet.positions[3 * index : 3 * index + 3] = sheet.positions.__class__(
            "d", map(float, row.split()[1:])
        )
    scene = sheet.scene(springs={"damping": 0.01})
    simulation = boucle_core.Simulation(scene, [sheet.mesh()])
    assert simulation.certificate()["hash"] == report["frames"][0]["hash"]
    assert [simulation.advance()["hash"] for _ in range(11)] == [
        row["hash"] for row in report["frames"][1:]
    ]
