"""dev.py and what stands beside it: what is missing is said in one line, counts add up, yardsticks agree."""

import os
import subprocess
import sys
import time
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import boucle_core
import pytest

import environment
import package
import verify
from bench_explicit import STEPS_PER_FRAME, difference_after_a_frame
from numpy_cloth import ALL_STEPS, Sheet
from shared_library import needed_libraries

ROOT = Path(__file__).resolve().parents[1]
SECONDS = 60


def dev(*words, **environment_changes):
    """Run dev.py as a person does."""
    return subprocess.run(
        [sys.executable, str(ROOT / "scripts" / "dev.py"), *words],
        capture_output=True,
        text=True,
        timeout=SECONDS,
        env={**os.environ, **environment_changes},
        check=False,
    )


def test_without_a_command_all_commands_are_listed():
    done = dev()
    assert done.returncode == 2
    for name in ("demo", "test", "build", "check", "bench", "package"):
        assert f"\n  {name} " in done.stdout


def test_an_unknown_command_is_refused_in_one_line():
    done = dev("bild")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "bild" in done.stderr
    assert "build" in done.stderr


@pytest.mark.skipif(os.name == "nt", reason="the stand-in for cargo is a shell script")
@pytest.mark.parametrize(
    ("answer", "complaint"),
    [(None, "Rust is missing"), ("cargo 1.60.0 (abc)", "1.60 is too old"), ("what?", "'what?'")],
)
def test_missing_or_old_rust_is_said_in_one_line(tmp_path, answer, complaint):
    if answer is not None:
        stand_in = tmp_path / "cargo"
        stand_in.write_text(f"#!/bin/sh\necho '{answer}'\n")
        stand_in.chmod(0o755)
    done = dev("build", PATH=str(tmp_path))
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert complaint in done.stderr
    assert environment.rust_version() in done.stderr


def test_a_wrong_python_is_said_and_what_to_do(monkeypatch):
    monkeypatch.setattr(environment.sys, "version_info", (3, 13, 1))
    monkeypatch.setattr(environment.shutil, "which", lambda _name: None)
    with pytest.raises(environment.Missing, match=r"Python 3\.11 is missing \(this is 3\.13;"):
        environment.find_python()


def test_a_command_that_takes_too_long_is_stopped_with_its_children(tmp_path):
    mark = tmp_path / "mark"
    script = f"import subprocess, sys; subprocess.run(['sh', '-c', 'sleep 3; touch {mark}'])"
    with pytest.raises(environment.Failed, match="more than 1 s"):
        environment.run([sys.executable, "-c", script], timeout=1.0)
    time.sleep(3.0)
    assert not mark.exists()


def test_counts_of_both_test_runs_add_up_to_one_line():
    count = verify.Count(passed=3, failed=0, skipped=1)
    report = '<testsuites><testsuite tests="9" failures="2" errors="1" skipped="2"/></testsuites>'
    verify.add_report(count, ElementTree.fromstring(report))
    assert count.closing_line() == "7 passed, 3 failed, 3 skipped"
    assert verify.CARGO_RESULT.match("test result: ok. 12 passed; 0 failed; 1 ignored; 0 measured")


def test_a_run_that_ends_badly_without_a_failed_test_counts_as_failed():
    assert verify.Count(passed=3, faults=["cargo test did not build"]).closing_line() == (
        "3 passed, 1 failed"
    )


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads Linux libraries")
def test_the_compiled_module_needs_no_python_library():
    library = next(Path(boucle_core.__file__).parent.glob("*.so"))
    needed = needed_libraries(library.read_bytes())
    assert "libc.so.6" in needed
    assert [name for name in needed if "python" in name] == []


def test_what_is_no_library_is_refused():
    with pytest.raises(ValueError, match="not a 64-bit"):
        needed_libraries(b"MZ")


def test_the_staged_manifest_names_its_wheel_and_keeps_the_rest(tmp_path):
    wheel = tmp_path / "boucle_core-9.9.9-cp311-abi3-any.whl"
    wheel.write_bytes(b"")
    package.stage(wheel, tmp_path / "staging")
    staged = tmp_path / "staging" / "blender_manifest.toml"
    staged = tomllib.loads(staged.read_text(encoding="utf-8"))
    assert staged.pop("wheels") == [f"./wheels/{wheel.name}"]
    assert staged.pop("platforms") == ["linux-x64"]
    plain = (ROOT / "addon" / "blender_manifest.toml").read_text(encoding="utf-8")
    assert staged == tomllib.loads(plain)
    assert (tmp_path / "staging" / "wheels" / wheel.name).exists()


@pytest.mark.parametrize("make", ALL_STEPS)
def test_the_benchmarks_yardsticks_move_as_the_simulation_does(make):
    sheet = Sheet(vertices=12, size=0.11, time_step=1.0 / 24.0 / STEPS_PER_FRAME)
    assert difference_after_a_frame(sheet, make) < 1e-11
