"""scripts/soak.py: a short one, and that it sees what is not held."""

import subprocess
import sys
from pathlib import Path

import pytest

from soaking.watch import Watch, resident_bytes

SOAK = Path(__file__).resolve().parents[2] / "scripts" / "soak.py"


def row(frame, intersections=0, mark="a"):
    return {"frame": frame, "hash": f"{mark}{frame}", "intersections": intersections}


def watched(seconds, memory):
    watch = Watch()
    for each in seconds:
        watch.add("scene", [row(1), row(2)], each, 0.5)
    watch.memory += memory
    return watch


def soak(*words):
    command = [sys.executable, SOAK, *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=240)


def test_a_short_soak_of_two_scenes_holds():
    done = soak("--frames", "60", "--only", "incline", "24 cloths")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "100 frames; memory" in done.stdout and done.stdout.endswith("all held\n")
    assert "24 cloths                2       50" in done.stdout


def test_a_scene_that_is_not_known_is_refused():
    done = soak("--only", "somewhere")
    assert done.returncode == 2 and "no scene 'somewhere'; accepted: 24 cloths" in done.stderr


def test_an_even_run_holds_though_its_times_waver():
    watch = watched([1.0 + 0.01 * (k * 7 % 5) for k in range(60)], [100_000_000] * 60)
    assert watch.verdicts() == []
    assert "120 frames; memory 100.0 to 100.0 MB" in watch.table()


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda w: w.memory.extend([101_500_000] * 5), "memory changed by 1.50%"),
        (lambda w: w.add("scene", [row(1), row(2, mark="b")], 1.0, 0.5), "other hashes"),
        (lambda w: w.add("scene", [row(1), row(2, 3)], 1.0, 0.5), "run 61: 3 intersections"),
        (lambda w: [w.add("scene", [row(1), row(2)], 1.1, 0.5) for _ in range(9)], "slower by 8"),
    ],
)
def test_what_is_not_held_is_told(change, told):
    watch = watched([1.0 + 0.01 * (k * 7 % 5) for k in range(60)], [100_000_000] * 60)
    change(watch)
    assert len(watch.verdicts()) == 1 and told in watch.verdicts()[0], watch.verdicts()


def test_memory_that_is_taken_is_seen():
    before = resident_bytes()
    kept = bytearray(b"x" * 50_000_000)
    assert resident_bytes() - before > 0.9 * len(kept)
