"""scripts/sweep.py on this machine: results, failures, deaths, resuming, the table and the contact sheet."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import psutil
import pytest
from PIL import Image

SWEEP = Path(__file__).resolve().parents[2] / "scripts" / "sweep.py"
GRID = """
[sweep]
scene = "small.toml"
method = "grid"
{head}
[parameters]
"cloth.sheet.density" = {densities}
"cloth.sheet.springs.shear" = [10, 100.5]
"""


def sweep_command(*words):
    return [sys.executable, str(SWEEP), *map(str, words)]


@pytest.fixture
def run_sweep(tmp_path):
    """Run sweep.py to its end and return it."""

    def run(*words, code=0):
        done = subprocess.run(
            sweep_command(*words), cwd=tmp_path, capture_output=True, text=True, timeout=120
        )
        assert done.returncode == code, done
        assert "Traceback" not in done.stderr
        assert all(line.startswith("sweep.py: ") for line in done.stderr.splitlines())
        return done

    return run


@pytest.fixture
def start_sweep(start_command):
    """Start sweep.py and return the process."""
    return lambda *words: start_command(sweep_command(*words))


@pytest.fixture
def grid(small_scene):
    """The path of a sweep of the small scene; 4 runs unless told otherwise."""

    def write(densities="[0.1, 0.2]", head=""):
        path = small_scene.with_name("grid.toml")
        path.write_text(GRID.format(densities=densities, head=head))
        return path

    return write


def outcome(folder):
    return json.loads((folder / "run.json").read_text())


def workers_of(process):
    """The processes that bake for a sweep."""
    children = psutil.Process(process.pid).children()
    return [child.pid for child in children if "spawn_main" in " ".join(child.cmdline())]


def wait_for(condition, seconds=60):
    until = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < until, "waited in vain"
        time.sleep(0.01)


def test_each_run_is_what_bake_makes_of_the_same_words(
    run_sweep, run_bake, grid, tmp_path, small_scene
):
    done = run_sweep(grid(), "--out", "out", "--workers", 2)
    assert "run 4/4, " in done.stdout
    assert "s left" in done.stdout
    runs = tmp_path / "out" / "runs"
    assert sorted(path.name for path in runs.iterdir()) == ["000", "001", "002", "003"]
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "contact_sheet.png",
        "runs",
        "sweep.json",
        "table.parquet",
    ]
    for run in runs.iterdir():
        kept = outcome(run)
        words = ["--out", f"single{run.name}", "--set", *kept["overrides"]]
        assert run_bake(small_scene, *words).returncode == 0
        single = tmp_path / f"single{run.name}"
        assert (run / "sheet.pc2").read_bytes() == (single / "sheet.pc2").read_bytes()
        report = json.loads((run / "report.json").read_text())
        other = json.loads((single / "report.json").read_text())
        assert [row["hash"] for row in report["frames"]] == [row["hash"] for row in other["frames"]]
        assert report["threads"] == 1
        assert sorted(path.name for path in run.iterdir()) == [
            "report.json",
            "run.json",
            "sheet.obj",
            "sheet.pc2",
        ]
    assert outcome(runs / "003")["parameters"] == {
        "cloth.sheet.density": 0.2,
        "cloth.sheet.springs.shear": 100.5,
    }


def test_the_summed_up_certificate_is_that_of_the_frames(run_sweep, grid, tmp_path):
    run_sweep(grid(), "--out", "out", "--quiet")
    run = tmp_path / "out" / "runs" / "002"
    rows = json.loads((run / "report.json").read_text())["frames"]
    kept = outcome(run)["certificate"]
    assert kept["frames"] == len(rows) == 12
    assert (kept["first_frame"], kept["last_frame"]) == (1, 12)
    assert kept["max_strain"] == max(row["max_strain"] for row in rows) > 0
    assert rows[kept["max_strain_frame"] - 1]["max_strain"] == kept["max_strain"]
    assert kept["p99_strain"] == max(row["p99_strain"] for row in rows)
    assert kept["iterations"] == sum(row["iterations"] for row in rows) > 0
    assert kept["substeps"] == sum(row["substeps"] for row in rows)
    assert kept["hash"] == rows[-1]["hash"]
    assert kept["intersections"] is None, "nothing collides in this scene"
    assert kept["vertices"] == 144


def test_a_failing_run_is_told_and_kept_apart_and_stops_no_other(run_sweep, grid, tmp_path):
    done = run_sweep(grid("[0.1, -1, 0.3]"), "--out", "out", "--workers", 2, code=3)
    out = tmp_path / "out"
    assert sorted(path.name for path in (out / "runs").iterdir()) == ["000", "001", "004", "005"]
    assert sorted(path.name for path in (out / "failed").iterdir()) == ["002", "003"]
    said = outcome(out / "failed" / "002")
    assert said["status"] == "failed"
    assert "cloth.sheet.density = -1.0; accepted: above 0" in said["error"]
    lines = done.stderr.splitlines()
    assert sum("failed: " in line and "density = -1.0" in line for line in lines) == 2
    assert lines[-1].startswith("sweep.py: 2 of 6 runs failed")


def test_a_run_that_diverges_keeps_its_frames_and_its_sentence(run_sweep, small_scene, tmp_path):
    path = small_scene.with_name("list.toml")
    path.write_text(
        '[sweep]\nscene = "small.toml"\nmethod = "list"\n'
        'set = { "cloth.0.springs.limiter" = "none", "scene.frames" = [1, 400] }\n'
        '[[run]]\nsolver = { integrator = "forward_euler", substeps = 2, allow_unstable = true }\n'
        "[[run]]\n"
    )
    run_sweep(path, "--out", "out", code=3)
    kept = outcome(tmp_path / "out" / "failed" / "000")
    assert "diverged at frame" in kept["error"]
    frames = kept["certificate"]["frames"]
    assert 2 < frames < 400
    size = (tmp_path / "out" / "failed" / "000" / "sheet.pc2").stat().st_size
    assert size == 32 + 12 * 144 * frames
    assert (tmp_path / "out" / "runs" / "001" / "sheet.pc2").exists()


def test_resume_leaves_whole_runs_alone_and_bakes_torn_missing_and_failed_ones(
    run_sweep, grid, tmp_path
):
    path = grid("[0.1, 0.2, 0.3, 0.4]")
    run_sweep(path, "--out", "out")
    out = tmp_path / "out"
    runs = sorted((out / "runs").iterdir())
    before = {run.name: (run / "sheet.pc2").read_bytes() for run in runs}
    stamps = {run.name: (run / "run.json").stat().st_mtime_ns for run in runs}
    with (runs[1] / "sheet.pc2").open("r+b") as cache:
        cache.truncate(500)
    (runs[3] / "run.json").unlink()
    (runs[4] / "run.json").write_text('{"status": "do')
    (runs[6] / "sheet.obj").unlink()
    os.rename(runs[7], out / "moved away")
    torn = {"001", "003", "004", "006", "007"}
    (out / "failed" / "007").mkdir(parents=True)
    (out / "failed" / "007" / "run.json").write_text('{"status": "failed", "error": "x"}')
    done = run_sweep(path, "--out", "out", "--resume")
    assert "3 of 8 runs are whole" in done.stdout
    assert not (out / "failed").exists()
    for run in sorted((out / "runs").iterdir()):
        assert (run / "sheet.pc2").read_bytes() == before[run.name]
        is_new = (run / "run.json").stat().st_mtime_ns != stamps[run.name]
        assert is_new == (run.name in torn), run.name


def test_a_sweep_begins_anew_only_where_nothing_is_lost(run_sweep, grid, small_scene):
    path = grid()
    run_sweep(path, "--out", "out", "--resume", "--quiet")  # with nothing to resume it starts
    done = run_sweep(path, "--out", "out", code=2)
    assert "out holds a sweep; accepted: --resume to go on, or another folder" in done.stderr
    grid("[0.1, 0.5]")
    done = run_sweep(path, "--out", "out", "--resume", code=2)
    assert "holds another sweep, or its scene has changed since" in done.stderr
    grid()
    small_scene.write_text(small_scene.read_text() + "\n# changed\n")
    assert "has changed" in run_sweep(path, "--out", "out", "--resume", code=2).stderr


def test_a_sweep_without_any_whole_run_may_be_mended_and_begun_again(run_sweep, grid, tmp_path):
    run_sweep(grid("[-1, -2]"), "--out", "out", code=3)
    run_sweep(grid("[0.1]"), "--out", "out")
    assert not (tmp_path / "out" / "failed").exists()
    assert len(list((tmp_path / "out" / "runs").iterdir())) == 2
    assert len(json.loads((tmp_path / "out" / "sweep.json").read_text())["runs"]) == 2


def test_a_killed_worker_loses_nothing_and_its_run_is_baked_again(
    run_sweep, start_sweep, grid, tmp_path
):
    path = grid("[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]", 'set = { "scene.frames" = [1, 300] }')
    process = start_sweep(path, "--out", "out", "--workers", 2)
    runs = tmp_path / "out" / "runs"
    for count in (1, 5):
        wait_for(lambda count=count: runs.is_dir() and len(list(runs.iterdir())) >= count)
        os.kill(workers_of(process)[0], signal.SIGKILL)
    output, errors = process.communicate(timeout=100)
    assert (process.returncode, errors) == (0, "")
    assert "run 12/12" in output
    assert len(list(runs.iterdir())) == 12
    assert not (tmp_path / "out" / "parts").exists()
    run_sweep(path, "--out", "alone", "--workers", 1)
    for run in runs.iterdir():
        alone = tmp_path / "alone" / "runs" / run.name
        assert (run / "sheet.pc2").read_bytes() == (alone / "sheet.pc2").read_bytes()


def test_a_run_that_kills_its_process_every_time_fails_alone(start_sweep, grid, tmp_path):
    path = grid("[0.1, 0.2]", 'set = { "scene.frames" = [1, 100000] }')
    process = start_sweep(path, "--out", "out", "--workers", 1)
    parts, seen = tmp_path / "out" / "parts", set()

    def baked_now():
        caches = parts.glob("*/000.*/sheet.pc2")
        return {cache.parent.name for cache in caches} - seen

    for _ in range(3):
        wait_for(baked_now)
        seen |= baked_now()
        os.kill(workers_of(process)[0], signal.SIGKILL)
    wait_for(lambda: list(parts.glob("*/001.*")))
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    lines = errors.splitlines()
    assert lines == [
        "sweep.py: run 000 failed: 3 processes died while they baked it (the last one by signal 9)",
        "sweep.py: stopped; what is whole is kept, --resume goes on",
    ]
    assert "3 processes died" in outcome(tmp_path / "out" / "failed" / "000")["error"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_a_sweep_that_is_stopped_goes_on_and_ends_with_the_same_bits(
    start_sweep, run_sweep, grid, tmp_path, number
):
    path = grid("[0.1, 0.2, 0.3]", 'set = { "scene.frames" = [1, 300] }')
    process = start_sweep(path, "--out", "out", "--workers", 2)
    runs = tmp_path / "out" / "runs"
    wait_for(lambda: runs.is_dir() and len(list(runs.iterdir())) >= 2)
    ours = workers_of(process)
    assert ours
    process.send_signal(number)
    _, errors = process.communicate(timeout=60)
    if number == signal.SIGKILL:
        assert process.returncode == -signal.SIGKILL
    else:
        assert process.returncode == 130
        assert errors == "sweep.py: stopped; what is whole is kept, --resume goes on\n"
        assert not (tmp_path / "out" / "parts").exists()
        assert (tmp_path / "out" / "table.parquet").exists()
    wait_for(lambda: not any(Path(f"/proc/{child}").exists() for child in ours))
    kept = {run.name: (run / "run.json").stat().st_mtime_ns for run in runs.iterdir()}
    assert 2 <= len(kept) < 6
    run_sweep(path, "--out", "out", "--resume")
    for name, stamp in kept.items():
        assert (runs / name / "run.json").stat().st_mtime_ns == stamp
    run_sweep(path, "--out", "alone", "--workers", 1)
    for run in (tmp_path / "alone" / "runs").iterdir():
        assert (runs / run.name / "sheet.pc2").read_bytes() == (run / "sheet.pc2").read_bytes()


def test_a_second_sweep_into_a_folder_is_refused_until_the_first_has_ended(
    start_sweep, run_sweep, grid, tmp_path
):
    path = grid(head='set = { "scene.frames" = [1, 100000] }')
    process = start_sweep(path, "--out", "out", "--workers", 1)
    wait_for(lambda: list((tmp_path / "out").glob("parts/*/*/sheet.pc2")))
    done = run_sweep(path, "--out", "out", "--resume", code=2)
    assert f"is being baked into by process {process.pid}" in done.stderr


def test_a_run_that_takes_too_long_has_failed(run_sweep, grid, tmp_path):
    path = grid("[0.1]", 'timeout = 0.2\nset = { "scene.frames" = [1, 100000] }')
    done = run_sweep(path, "--out", "out", code=3)
    assert done.stderr.count("it took longer than the timeout of 0.2 s") == 2
    assert outcome(tmp_path / "out" / "failed" / "000")["certificate"]["frames"] > 0


def test_the_table_has_parameters_and_certificates_in_either_format(run_sweep, grid, tmp_path):
    import pyarrow.parquet

    path = grid("[0.1, -1]")
    run_sweep(path, "--out", "out", "--table", "parquet", code=3)
    run_sweep(path, "--out", "out", "--table", "csv", "--resume", code=3)
    table = pyarrow.parquet.read_table(tmp_path / "out" / "table.parquet").to_pylist()
    with (tmp_path / "out" / "table.csv").open(newline="") as file:
        other = list(csv.DictReader(file))
    assert (
        [row["run"] for row in table]
        == [row["run"] for row in other]
        == ["000", "001", "002", "003"]
    )
    assert [row["status"] for row in table] == ["done", "done", "failed", "failed"]
    assert [row["cloth.sheet.density"] for row in table] == [0.1, 0.1, -1.0, -1.0]
    assert [row["cloth.sheet.springs.shear"] for row in table] == [10.0, 100.5, 10.0, 100.5]
    for row, text in zip(table[:2], other[:2], strict=True):
        kept = outcome(tmp_path / "out" / "runs" / row["run"])
        for key, value in kept["certificate"].items():
            assert row[key] == value, key
            assert text[key] == ("" if value is None else str(value)), key
        assert row["error"] is None
    assert "density" in table[2]["error"] and table[2]["max_strain"] is None
    assert other[2]["error"] == table[2]["error"] and other[2]["hash"] == ""


def test_parameters_of_mixed_kinds_are_texts_in_the_table():
    from sweeping import table

    assert table._uniform([1, 2.5, None]) == [1.0, 2.5, None]
    assert table._uniform([True, False]) == [True, False]
    assert table._uniform([[1, 2], "x", None]) == ["[1, 2]", '"x"', None]
    assert table._column("frames") == "parameter.frames"


def test_the_contact_sheet_shows_every_run_and_its_parameters(run_sweep, small_scene, tmp_path):
    path = small_scene.with_name("list.toml")
    heights = "".join(
        f'[[run]]\n"cloth.sheet.grid.size" = [1.0, {0.25 * n}]\n' for n in range(1, 5)
    )
    path.write_text(
        f'[sweep]\nscene = "small.toml"\nmethod = "list"\n{heights}[[run]]\n"scene.fps" = -1\n'
    )
    run_sweep(path, "--out", "out", code=3)
    from sweeping import contact_sheet as sheet

    with Image.open(tmp_path / "out" / "contact_sheet.png") as image:
        pixels = np.asarray(image.convert("RGB")).astype(int)
    step = sheet.SIDE + sheet.GAP
    assert pixels.shape[1] == 5 * step + sheet.GAP
    covered, written = [], []
    for column in range(5):
        left = sheet.GAP + column * step
        cell = pixels[:, left : left + sheet.SIDE]
        picture = cell[sheet.GAP : sheet.GAP + sheet.SIDE]
        reddish = (picture[..., 0] > picture[..., 1] + 30) & (picture[..., 0] > 60)
        covered.append(reddish.mean())
        written.append((cell[sheet.GAP + sheet.SIDE :].max(axis=2) < 160).sum())
    assert min(written) > 100, "every run's words stand beneath it"
    assert covered[3] > 0.25, "the highest sheet fills its picture"
    for number in range(3):
        assert covered[number] == pytest.approx(covered[3] * (number + 1) / 4, rel=0.15), (
            "one scale"
        )
    assert 0 < covered[4] < 0.1, "a failed run has only a frame and words"


def test_names_on_the_sheet_are_as_short_as_tells_them_apart():
    from sweeping.contact_sheet import short_names

    keys = ["cloth.a.density", "cloth.b.density", "solver.tolerance", 'objects["X"].boucle.shear']
    assert list(short_names(keys).values()) == ["a.density", "b.density", "tolerance", "shear"]


def test_many_runs_take_several_sheets(run_sweep, grid, tmp_path):
    path = grid(str([0.1 + 0.01 * n for n in range(33)]), 'set = { "scene.frames" = [1, 2] }')
    run_sweep(path, "--out", "out", "--quiet")
    assert sorted(p.name for p in (tmp_path / "out").glob("*.png")) == [
        "contact_sheet_1.png",
        "contact_sheet_2.png",
    ]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "SWEEP.toml"),
        (["nowhere.toml"], "nowhere.toml cannot be read"),
        (["GRID", "--workers", "0"], "'0'; accepted: 1 to 1024"),
        (["GRID", "--workers", "2", "--scheduler", "tcp://a:1"], "not allowed with"),
        (["GRID", "--table", "xlsx"], "'xlsx'"),
        (["GRID", "--blender", "blender"], "--blender blender: accepted only with a .blend"),
    ],
)
def test_wrong_usage_is_told_in_one_line(run_sweep, grid, words, said, tmp_path):
    path = grid()
    done = run_sweep(*[path if word == "GRID" else word for word in words], code=2)
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_written_ends_with_4(run_sweep, grid, tmp_path):
    (tmp_path / "out").write_text("in the way")
    done = run_sweep(grid(), "--out", "out", code=4)
    assert "the result cannot be written" in done.stderr
