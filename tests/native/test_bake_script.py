"""scripts/bake.py from its command line to its exit code."""

import functools
import os
import pty
import resource
import signal
import struct
import subprocess
import sys
import termios
from pathlib import Path

import numpy as np
import pytest

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def pc2(path):
    data = path.read_bytes()
    magic, version, count, start, rate, samples = struct.unpack("<12siiffi", data[:32])
    assert (magic, version, rate) == (b"POINTCACHE2\0", 1, 1.0)
    rows = np.frombuffer(data[32 : 32 + 12 * count * samples], "<f4")
    return start, rows.reshape(samples, count, 3)


def complaint(result, code):
    """The one line on standard error of a bake that ended with this code."""
    assert result.returncode == code, result
    assert result.stderr.count("\n") == 1, result.stderr
    assert result.stderr.startswith("bake.py: ")
    assert "Traceback" not in result.stderr
    return result.stderr


def test_a_bake_leaves_what_the_contract_says(run_bake, small_scene, tmp_path, read_report):
    result = run_bake(small_scene, "--out", "out", "--threads", "2")
    assert (result.returncode, result.stderr) == (0, "")
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "boucle.checkpoint",
        "report.json",
        "sheet.obj",
        "sheet.pc2",
    ]
    report = read_report(tmp_path / "out")
    assert list(report) == [
        "boucle",
        "scene",
        "threads",
        "integrator",
        "hash_algorithm",
        "cloths",
        "frames",
        "total_seconds",
        "peak_memory_bytes",
    ]
    assert report["boucle"] == "0.1.0"
    assert report["scene"] == str(small_scene)
    assert report["threads"] == 2
    assert report["integrator"] == "bdf2"
    assert report["hash_algorithm"] == "xxh3-64"
    springs = 2 * 12 * 11 + 2 * 11**2 + 2 * 12 * 10
    assert report["cloths"] == [
        {"name": "sheet", "vertices": 144, "triangles": 242, "springs": springs}
    ]
    assert report["total_seconds"] >= sum(row["seconds"] for row in report["frames"]) * 0.999
    assert report["peak_memory_bytes"] > 2**20
    for frame, row in enumerate(report["frames"], start=1):
        assert row["frame"] == frame
        assert (row["substeps"] > 0) == (frame > 1)
        assert (row["iterations"] > 0) == (frame > 1)
        assert row["clipped"] == row["contacts"] == 0
        assert row["intersections"] is None
        assert -1 < row["p99_strain"] <= row["max_strain"] <= 0.101
        assert isinstance(row["max_shear_strain"], float)
        assert len(row["hash"]) == 16
    assert report["frames"][0]["kinetic_energy"] == 0
    energies = [row["kinetic_energy"] + row["potential_energy"] for row in report["frames"]]
    assert energies[-1] < energies[0]


def test_the_first_sample_is_the_rest_mesh_and_the_order_is_the_same(
    run_bake, small_scene, tmp_path
):
    run_bake(small_scene, "--out", "out")
    start, rows = pc2(tmp_path / "out" / "sheet.pc2")
    assert (start, rows.shape) == (1.0, (12, 144, 3))
    lines = (tmp_path / "out" / "sheet.obj").read_text().splitlines()
    vertices = [line.split()[1:] for line in lines if line.startswith("v ")]
    faces = [line.split()[1:] for line in lines if line.startswith("f ")]
    assert np.array_equal(rows[0], np.array(vertices, np.float32))
    assert len(faces) == 121
    assert (rows[:, [132, 143]] == rows[0, [132, 143]]).all(), "the pinned corners"
    assert rows[-1, 0, 2] < rows[0, 0, 2]


@pytest.mark.parametrize("name", ["curtain", "pinned2", "pinned4", "numpy_demo"])
def test_the_scenes_bake(run_bake, scenes, tmp_path, read_report, name):
    small = ["cloth.0.grid.vertices=[14, 14]", "scene.frames=[1, 6]"]
    result = run_bake(scenes / f"{name}.toml", "--out", "out", "--quiet", "--set", *small)
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
    report = read_report(tmp_path / "out")
    assert len(report["frames"]) == 6
    assert report["cloths"][0]["vertices"] == 196


def test_the_folder_is_named_after_the_scene_if_none_is_given(run_bake, small_scene, tmp_path):
    assert run_bake(small_scene).returncode == 0
    assert (tmp_path / "out" / "small" / "sheet.pc2").exists()


def test_frames_are_kept_from_a_to_b_as_the_whole_bake_has_them(
    run_bake, small_scene, tmp_path, read_report
):
    run_bake(small_scene, "--out", "whole")
    assert run_bake(small_scene, "--out", "part", "--frames", "4:7").returncode == 0
    whole, part = (read_report(tmp_path / name)["frames"] for name in ("whole", "part"))
    assert [(row["frame"], row["hash"]) for row in part] == [
        (row["frame"], row["hash"]) for row in whole[3:7]
    ]
    start, rows = pc2(tmp_path / "part" / "sheet.pc2")
    assert start == 4.0
    assert np.array_equal(rows, pc2(tmp_path / "whole" / "sheet.pc2")[1][3:7])


def test_negative_frames_are_no_options(run_bake, small_scene, tmp_path, read_report):
    result = run_bake(
        small_scene, "--out", "out", "--frames", "-3:2", "--set", "scene.frames=[-5, 3]"
    )
    assert result.returncode == 0, result.stderr
    assert [row["frame"] for row in read_report(tmp_path / "out")["frames"]] == list(range(-3, 3))


def test_set_takes_indices_and_names_several_times_before_and_after_the_file(
    run_bake, small_scene, tmp_path, read_report
):
    words = ["--set", "cloth.0.grid.vertices=[5, 5]", small_scene, "--out", "out", "--set"]
    result = run_bake(*words, "cloth.sheet.springs.bend=0", "solver.integrator=verlet")
    assert result.returncode == 0, result.stderr
    report = read_report(tmp_path / "out")
    assert report["cloths"][0]["vertices"] == 25
    assert report["integrator"] == "verlet"


def test_progress_is_plain_lines_in_a_pipe_and_nothing_when_quiet(run_bake, small_scene):
    lines = run_bake(small_scene).stdout.splitlines()
    assert lines[0].startswith("frame 12/12, ")
    assert "s/frame" in lines[0]
    assert "s left" in lines[0]
    assert lines[-1].startswith("12 frames in ")
    assert run_bake(small_scene, "--quiet").stdout == ""


def test_progress_is_a_bar_on_a_terminal(start_bake, small_scene):
    ours, theirs = pty.openpty()
    termios.tcsetwinsize(theirs, (24, 100))
    process = start_bake(small_scene, preexec_fn=lambda: os.dup2(theirs, 2))
    os.close(theirs)
    shown = b""
    while True:
        try:
            part = os.read(ours, 4096)
        except OSError:  # the other end is closed
            break
        if not part:
            break
        shown += part
    assert process.wait(60) == 0
    os.close(ours)
    assert b"frame 12 |" in shown
    assert b"12/12" in shown
    assert b"left" in shown


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ([], "the file is missing"),
        (["--out", "x"], "the file is missing"),
        (["SCENE", "--frames", "1-5"], "'1-5' is no range of frames; accepted: A:B"),
        (["SCENE", "--frames", "1:99999999999"], "no range of frames"),
        (["SCENE", "--frames", "7:3"], "frames = 7:3; accepted: A:B within 1:12"),
        (["SCENE", "--frames", "0:3"], "frames = 0:3; accepted"),
        (["SCENE", "--threads", "-1"], "--threads"),
        (["SCENE", "--threads", "many"], "'many'; accepted: 1 to 1024"),
        (["SCENE", "--threads", "99999"], "'99999'; accepted: 1 to 1024"),
        (["SCENE", "--sett", "a=1"], "--sett"),
        (["SCENE", "other.toml"], "other.toml"),
        (["SCENE", "--set"], "--set"),
        (["SCENE", "--set", "density"], "--set density: there is no"),
        (["SCENE", "--set", "cloth.3.density=1"], 'no element "3"'),
        (["SCENE", "--set", "cloth.0.density=-1"], "cloth.sheet.density = -1.0; accepted"),
        (["SCENE", "--set", "cloth.0.densiti=1"], 'did you mean "density"'),
        (["SCENE", "--blender", "blender"], "--blender blender: accepted only with a .blend"),
        (["nowhere.toml"], "nowhere.toml: it cannot be read: No such file"),
        (["."], ".: it cannot be read: it is a folder"),
    ],
)
def test_wrong_usage_is_told_in_one_line(run_bake, small_scene, words, expected):
    words = [small_scene if word == "SCENE" else word for word in words]
    assert expected in complaint(run_bake(*words), 2)


def test_a_divergence_ends_with_3_and_keeps_the_frames_before_it(
    run_bake, small_scene, tmp_path, read_report
):
    result = run_bake(
        small_scene,
        "--out",
        "out",
        "--quiet",
        "--set",
        "solver.integrator=forward_euler",
        "solver.substeps=2",
        "solver.allow_unstable=true",
        "cloth.0.springs.limiter=none",
        "scene.frames=[1, 3000]",
    )
    line = complaint(result, 3)
    kept = read_report(tmp_path / "out")["frames"]
    assert f"diverged at frame {len(kept) + 1}, vertex " in line
    assert 'of cloth "sheet"' in line
    assert len(kept) > 2
    assert pc2(tmp_path / "out" / "sheet.pc2")[1].shape[0] == len(kept)


def test_a_step_that_becomes_unstable_ends_with_3_and_names_the_frame(
    run_bake, small_scene, tmp_path, read_report
):
    soft = "cloth.0.springs={ stretch = 20, shear = 5, bend = 0.5, limiter = 'stiffen' }"
    explicit = "solver.integrator=symplectic_euler"
    words = [
        small_scene,
        "--out",
        "out",
        "--quiet",
        "--set",
        "scene.frames=[1, 60]",
        soft,
        explicit,
    ]
    line = complaint(run_bake(*words, "solver.substeps=1"), 2)
    least = line.partition("at least ")[2].partition(" ")[0]
    line = complaint(run_bake(*words, f"solver.substeps={least}"), 3)
    kept = read_report(tmp_path / "out")["frames"]
    assert f"frame {len(kept) + 1} cannot be simulated: solver: the step of " in line
    assert line.endswith("; the frames before it are kept\n")
    assert len(kept) > 1
    assert pc2(tmp_path / "out" / "sheet.pc2")[1].shape[0] == len(kept)
    assert (tmp_path / "out" / "boucle.checkpoint").exists()


@pytest.mark.parametrize(
    "prepare",
    [
        lambda out: out.write_text("a file in the way"),
        lambda out: (out / "sheet.pc2").mkdir(parents=True),
        lambda out: (out / "report.json" / "full").mkdir(parents=True),
        lambda out: (out.mkdir(), (out / "sheet.pc2").symlink_to("/dev/full")),
        lambda out: (out.mkdir(), (out / "report.json.part").symlink_to("/dev/full")),
        lambda out: (out.mkdir(), (out / "sheet.obj.part").symlink_to("/dev/full")),
    ],
    ids=["file", "cache", "report", "full cache", "full report", "full mesh"],
)
def test_a_cache_that_cannot_be_written_ends_with_4(run_bake, small_scene, tmp_path, prepare):
    prepare(tmp_path / "out")
    line = complaint(run_bake(small_scene, "--out", "out"), 4)
    assert "out" in line
    assert "cannot be" in line


def test_a_folder_in_which_nobody_may_write_ends_with_4(run_bake, small_scene):
    assert "/proc/out cannot be made" in complaint(run_bake(small_scene, "--out", "/proc/out"), 4)


def test_names_of_files_may_be_no_text(run_bake, tmp_path, small_scene):
    name = os.fsdecode(b"caf\xe9.toml")
    small_scene.rename(tmp_path / name)
    result = run_bake(name)
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "out" / os.fsdecode(b"caf\xe9") / "sheet.pc2").exists()
    (tmp_path / name).write_text("[scene")
    complaint(run_bake(name), 2)


def test_a_disk_that_fills_up_keeps_the_frames_so_far_and_a_resumed_bake_is_equal_to_the_bit(
    run_bake, small_scene, tmp_path, read_report
):
    assert run_bake(small_scene, "--out", "whole").returncode == 0
    limit = 32 + 144 * 12 * 7 + 100  # room for 7 samples and a part of the eighth

    def fill():
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    line = complaint(run_bake(small_scene, "--out", "out", "--quiet", preexec_fn=fill), 4)
    assert "sheet.pc2 cannot be written" in line
    assert len(read_report(tmp_path / "out")["frames"]) == 7
    assert pc2(tmp_path / "out" / "sheet.pc2")[1].shape[0] == 7
    assert run_bake(small_scene, "--out", "out", "--resume").returncode == 0
    caches = [(tmp_path / name / "sheet.pc2").read_bytes() for name in ("out", "whole")]
    assert caches[0] == caches[1]


def test_a_bake_whose_reader_goes_away_goes_on(start_bake, small_scene, tmp_path):
    process = start_bake(small_scene, "--out", "out")
    process.stdout.close()
    process.stdout = None
    assert process.wait(60) == 0
    assert pc2(tmp_path / "out" / "sheet.pc2")[1].shape[0] == 12


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_bake_that_is_stopped_ends_with_130_in_one_line(
    start_bake, scenes, tmp_path, read_report, number
):
    words = [scenes / "curtain.toml", "--out", "out", "--set", "scene.frames=[1, 100000]"]
    process = start_bake(*words)
    assert process.stdout.readline().startswith("frame ")
    process.send_signal(number)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said == "bake.py: stopped; the frames so far are kept, --resume goes on\n"
    kept = read_report(tmp_path / "out")["frames"]
    assert len(kept) == len(pc2(tmp_path / "out" / "curtain.pc2")[1]) > 1


def test_a_second_bake_into_a_folder_is_refused_until_the_first_has_ended(
    start_bake, run_bake, scenes, small_scene, tmp_path
):
    words = [scenes / "curtain.toml", "--out", "out", "--set", "scene.frames=[1, 100000]"]
    first = start_bake(*words)
    assert first.stdout.readline().startswith("frame ")
    held = (tmp_path / "out" / "curtain.obj").read_bytes()
    line = complaint(run_bake(small_scene, "--out", "out"), 2)
    assert f"out is being baked into by process {first.pid}; accepted: another folder" in line
    assert not (tmp_path / "out" / "sheet.pc2").exists()
    assert (tmp_path / "out" / "curtain.obj").read_bytes() == held
    assert run_bake(small_scene, "--out", "other").returncode == 0
    first.kill()
    assert first.wait() == -signal.SIGKILL
    assert (tmp_path / "out" / "boucle.lock").exists(), "nobody could take it away"
    assert run_bake(small_scene, "--out", "out").returncode == 0
    assert not (tmp_path / "out" / "boucle.lock").exists()


def test_a_refused_bake_leaves_no_folder_behind(run_bake, small_scene, tmp_path):
    complaint(run_bake(small_scene, "--out", "a/b/c", "--set", "cloth.0.density=-1"), 2)
    assert not (tmp_path / "a").exists()


def test_of_many_bakes_at_once_the_lock_lets_one_in(tmp_path):
    """Processes that take and give back the lock as fast as they can never hold it two at a time."""
    script = (
        "import sys, pathlib, bake_lock\n"
        "folder, done = pathlib.Path('held'), 0\n"
        "while done < 200:\n"
        "    try:\n"
        "        with bake_lock.held(folder):\n"
        "            (folder / 'inside').touch(exist_ok=False)\n"
        "            (folder / 'inside').unlink()\n"
        "            done += 1\n"
        "    except bake_lock.Busy:\n"
        "        continue\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(SCRIPTS)}
    command = [sys.executable, "-c", script]
    start = functools.partial(subprocess.Popen, command, cwd=tmp_path, env=environment)
    processes = [start(stderr=subprocess.PIPE) for _ in range(4)]
    said = [process.communicate(timeout=60)[1] for process in processes]
    assert [process.returncode for process in processes] == [0, 0, 0, 0], said
    assert not list((tmp_path / "held").glob("*"))


def test_a_folder_that_vanishes_while_it_is_made_is_made_again(tmp_path):
    """`mkdir` finds the folder there, and looks once more when another bake has just taken it away."""
    script = (
        "import pathlib, bake_lock\n"
        "make, calls = pathlib.Path.mkdir, []\n"
        "def vanishing(path, **options):\n"
        "    calls.append(path)\n"
        "    if len(calls) == 1:\n"
        "        raise FileExistsError(path)\n"
        "    make(path, **options)\n"
        "pathlib.Path.mkdir = vanishing\n"
        "with bake_lock.held(pathlib.Path('held')):\n"
        "    assert pathlib.Path('held', bake_lock.NAME).exists()\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(SCRIPTS)}
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, env=environment, check=True)
