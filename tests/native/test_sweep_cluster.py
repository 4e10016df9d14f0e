"""scripts/sweep.py on a Dask cluster: a scheduler and workers in processes of their own, which talk over TCP and die."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import boucle_core
import pytest

from sweeping.folder import Folder
from sweeping.run import perform

SWEEP = Path(__file__).resolve().parents[2] / "scripts" / "sweep.py"
RUNS = """
[sweep]
scene = "small.toml"
method = "latin_hypercube"
samples = {samples}
set = {{ "scene.frames" = [1, {frames}] }}
[parameters]
"cloth.sheet.density" = {{ from = 0.1, to = 0.4 }}
"cloth.sheet.springs.shear" = {{ from = 10, to = 1000, scale = "log" }}
"""


class Cluster:
    """A scheduler and its workers; all end with the test."""

    def __init__(self, folder):
        self.folder = folder
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.processes = []
        self.start_scheduler()

    def start_scheduler(self):
        words = ["scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard"]
        self.scheduler = self.dask(*words)
        wait_for(self.is_listening)

    def start_worker(self):
        words = ["worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
        return self.dask(*words, "--death-timeout", "60")

    def dask(self, *words):
        log = self.folder / f"dask{len(self.processes)}.txt"
        with log.open("w") as output:
            process = subprocess.Popen(
                [sys.executable, "-m", "dask", *words],
                cwd=self.folder,  # neither the scripts nor the tests are in its path
                env={k: v for k, v in os.environ.items() if k != "PYTHONPATH"},
                stdout=output,
                stderr=subprocess.STDOUT,
            )
        self.processes.append(process)
        return process

    def is_listening(self):
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    def end(self):
        for process in reversed(self.processes):
            process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path):
    folder = tmp_path / "cluster"
    folder.mkdir()
    cluster = Cluster(folder)
    yield cluster
    cluster.end()


@pytest.fixture
def start_sweep(start_command, small_scene):
    """Start sweep.py on some runs of the small scene and return the process."""

    def start(*words, samples=64, frames=60):
        path = small_scene.with_name("runs.toml")
        path.write_text(RUNS.format(samples=samples, frames=frames))
        return start_command([sys.executable, str(SWEEP), str(path), *map(str, words)])

    return start


def wait_for(condition, seconds=60):
    until = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < until, "waited in vain"
        time.sleep(0.01)


def end_of(process, code=0, seconds=120):
    """What a sweep said on standard error until it ended with this code."""
    output, errors = process.communicate(timeout=seconds)
    assert process.returncode == code, output + errors
    assert "Traceback" not in errors
    assert all(line.startswith("sweep.py: ") for line in errors.splitlines()), errors
    return errors


def count(folder):
    return len(list(folder.iterdir())) if folder.is_dir() else 0


def outcomes(out):
    return {
        run.name: json.loads((run / "run.json").read_text()) for run in (out / "runs").iterdir()
    }


def assert_same_bits(one, other):
    names = sorted(path.name for path in (one / "runs").iterdir())
    assert names == sorted(path.name for path in (other / "runs").iterdir())
    for name in names:
        caches = [(out / "runs" / name / "sheet.pc2").read_bytes() for out in (one, other)]
        assert caches[0] == caches[1], name


def test_64_runs_on_two_workers_of_which_one_is_killed_are_those_of_a_sequential_sweep(
    cluster, start_sweep, tmp_path
):
    import pyarrow.parquet

    workers = [cluster.start_worker() for _ in range(2)]
    out = tmp_path / "out"
    process = start_sweep("--out", out, "--scheduler", cluster.address)
    wait_for(lambda: count(out / "runs") >= 16)
    workers[0].send_signal(signal.SIGKILL)
    kept = count(out / "runs")
    assert kept < 64, "the worker died in the midst of the sweep"
    assert end_of(process) == ""
    found = outcomes(out)
    assert sorted(found) == [f"{number:03}" for number in range(64)]
    assert {outcome["process"] for outcome in found.values()} == {w.pid for w in workers}
    assert not (out / "parts").exists() and not (out / "failed").exists()
    table = pyarrow.parquet.read_table(out / "table.parquet").to_pylist()
    assert [row["run"] for row in table] == sorted(found), "every run once"
    assert {row["status"] for row in table} == {"done"}
    assert len({row["hash"] for row in table}) == 64, "no two runs are the same"

    end_of(start_sweep("--out", tmp_path / "alone", "--workers", "1"))
    assert_same_bits(out, tmp_path / "alone")
    other = pyarrow.parquet.read_table(tmp_path / "alone" / "table.parquet").to_pylist()
    for row in (*table, *other):
        del row["seconds"]
    assert table == other


def test_a_scheduler_that_comes_back_is_given_what_is_not_whole(cluster, start_sweep, tmp_path):
    cluster.start_worker()
    out = tmp_path / "out"
    process = start_sweep("--out", out, "--scheduler", cluster.address, samples=24, frames=200)
    wait_for(lambda: count(out / "runs") >= 3)
    cluster.scheduler.kill()
    cluster.scheduler.wait()
    stamps = {run.name: (run / "run.json").stat().st_mtime_ns for run in (out / "runs").iterdir()}
    assert len(stamps) < 24
    cluster.start_scheduler()
    cluster.start_worker()
    assert "is lost; trying again for 60 s" in end_of(process)
    assert len(outcomes(out)) == 24
    for name, stamp in stamps.items():
        assert (out / "runs" / name / "run.json").stat().st_mtime_ns == stamp
    end_of(start_sweep("--out", tmp_path / "alone", samples=24, frames=200))
    assert_same_bits(out, tmp_path / "alone")


def test_a_scheduler_that_stays_away_ends_the_sweep_which_resumes_elsewhere(
    cluster, start_sweep, tmp_path
):
    cluster.start_worker()
    out = tmp_path / "out"
    words = ["--out", out, "--scheduler", cluster.address, "--patience", "2"]
    process = start_sweep(*words, samples=12, frames=300)
    wait_for(lambda: count(out / "runs") >= 2)
    cluster.scheduler.kill()
    said = end_of(process, code=5).splitlines()
    assert said[-1] == (
        f"sweep.py: no scheduler answers at {cluster.address}; what is whole is kept, --resume goes on"
    )
    assert 2 <= len(outcomes(out)) < 12
    assert (out / "table.parquet").is_file()
    end_of(start_sweep("--out", out, "--resume", samples=12, frames=300))
    assert len(outcomes(out)) == 12


def test_a_sweep_that_is_killed_or_stopped_leaves_no_worker_busy_and_resumes(
    cluster, start_sweep, tmp_path
):
    cluster.start_worker()
    out = tmp_path / "out"
    words = ["--out", out, "--scheduler", cluster.address, "--resume"]
    for number in (signal.SIGINT, signal.SIGKILL):
        process = start_sweep(*words, samples=3, frames=3000)
        wait_for(lambda: list(out.glob("parts/*/*/sheet.pc2")))
        process.send_signal(number)
        process.communicate(timeout=60)
        assert process.returncode == (130 if number == signal.SIGINT else -number)
    end_of(start_sweep(*words, samples=3, frames=3000))
    assert len(outcomes(out)) == 3
    assert not (out / "parts").exists()


def test_a_bake_whose_session_has_ended_stops_also_in_a_folder_that_came_back(
    tmp_path, small_scene
):
    """A folder that goes while a bake writes into it may stay in part."""
    folder = Folder(tmp_path / "out")
    head = {"boucle": boucle_core.__version__, "digest": "0"}
    folder.prepare(head, resume=False)
    job = {"run": "000", "scene": str(small_scene), "out": str(folder.path), "parameters": {}}
    job |= {"boucle": head["boucle"], "overrides": ["scene.frames=[1, 100000]"], "frames": None}
    job |= {"timeout": 60, "blender": None}
    with ThreadPoolExecutor(1) as worker:
        with folder.session() as session:
            bake = worker.submit(perform, job | {"session": str(session)})
            wait_for(lambda: list(session.glob("*/sheet.pc2")))
            part = next(session.glob("000.*"))
        part.mkdir(parents=True, exist_ok=True)
        (part / "left").touch()
        assert bake.result(timeout=30) is None
    assert not folder.parts.exists()


def test_a_run_that_fails_on_a_worker_is_told_and_the_others_are_whole(
    cluster, tmp_path, small_scene
):
    cluster.start_worker()
    path = small_scene.with_name("grid.toml")
    path.write_text(
        '[sweep]\nscene = "small.toml"\nmethod = "grid"\n'
        '[parameters]\n"cloth.sheet.density" = [0.1, -1, 0.2]\n'
    )
    command = [sys.executable, str(SWEEP), str(path), "--out", "out"]
    command += ["--scheduler", cluster.address]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=100)
    assert done.returncode == 3, done
    assert "run 001 failed: " in done.stderr and "density = -1.0; accepted" in done.stderr
    assert sorted(outcomes(tmp_path / "out")) == ["000", "002"]


def test_a_run_that_kills_every_worker_fails_alone(cluster, start_sweep, tmp_path):
    """Its neighbours, which die with it in a worker's queue, do not fail with it."""
    out = tmp_path / "out"
    words = ["--out", out, "--scheduler", cluster.address]
    process = start_sweep(*words, samples=4, frames=1500)
    seen, deaths = set(), 0

    def is_over():
        return (out / "failed" / "000" / "run.json").is_file()

    def baked_now():
        parts = {path.name for path in out.glob("parts/*/000.*") if (path / "sheet.pc2").exists()}
        return parts - seen

    worker = cluster.start_worker()
    while not is_over():
        wait_for(lambda: baked_now() or is_over())
        if not is_over():
            seen |= baked_now()
            worker.kill()
            worker.wait()
            deaths += 1
            worker = cluster.start_worker()
    said = end_of(process, code=3)
    assert "run 000 failed: workers died over it" in said
    assert deaths >= 4
    assert sorted(outcomes(out)) == ["001", "002", "003"]


def test_without_workers_the_sweep_says_so_and_waits(cluster, start_sweep, tmp_path):
    out = tmp_path / "out"
    process = start_sweep("--out", out, "--scheduler", cluster.address, samples=2)
    line = process.stderr.readline()
    assert line.startswith(f"sweep.py: no worker is at {cluster.address}; waiting for one: dask ")
    cluster.start_worker()
    end_of(process)
    assert len(outcomes(out)) == 2


@pytest.mark.parametrize(
    ("address", "code", "said"),
    [
        ("tcp://127.0.0.1:9", 5, "no scheduler answers at tcp://127.0.0.1:9"),
        ("nothing://x:1", 2, "'nothing://x:1'; accepted: tcp://HOST:PORT"),
        ("tcp://here:99999", 2, "'tcp://here:99999'; accepted: tcp://HOST:PORT"),
    ],
)
def test_a_scheduler_that_is_not_there_is_told_in_one_line(
    start_sweep, tmp_path, address, code, said
):
    errors = end_of(start_sweep("--out", tmp_path / "out", "--scheduler", address), code=code)
    assert said in errors
    assert errors.count("\n") == 1
