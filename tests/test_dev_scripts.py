"""dev.py and what stands beside it: what is missing is said in one line, counts add up, yardsticks agree."""

import dataclasses
import os
import shutil
import struct
import subprocess
import sys
import time
import tomllib
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

import boucle_core
import pip
import pytest

import debian
import environment
import gui
import package
import platforms
import verify
import wheel_check
from bench_explicit import STEPS_PER_FRAME, difference_after_a_frame
from numpy_cloth import ALL_STEPS, Sheet

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
    for name in ("demo", "test", "build", "check", "bench", "package", "gui", "blender52"):
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
    told = "running\ntest result: FAILED. 12 passed; 4 failed; 1 ignored; 0 measured\n"
    assert verify.count_cargo(count, told) == 4
    assert count.closing_line() == "19 passed, 7 failed, 4 skipped"


def test_a_run_that_ends_badly_without_a_failed_test_counts_as_failed():
    assert verify.Count(passed=3, faults=["cargo test did not build"]).closing_line() == (
        "3 passed, 1 failed"
    )


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads Linux libraries")
def test_the_compiled_module_needs_no_python_library():
    library = next(Path(boucle_core.__file__).parent.glob("*.so"))
    read = wheel_check.read(library.read_bytes())
    assert "libc.so.6" in read.needs
    assert [name for name in read.needs if "python" in name] == []
    assert read.oldest > (2, 2)
    assert wheel_check.ENTRY in read.exports


def test_a_windows_program_is_read():
    launcher = next(Path(pip.__file__).parent.glob("_vendor/distlib/t64.exe"))
    read = wheel_check.read(launcher.read_bytes())
    assert read.platform == "windows-x64"
    assert "KERNEL32.dll" in read.needs


def macos_library(minimum, needs):
    """A Mach-O library for ARM that has nothing but its head."""
    path = needs.encode().ljust(len(needs) // 8 * 8 + 8, b"\0")
    version = struct.pack("<6I", 0x32, 24, 1, minimum[0] << 16 | minimum[1] << 8, 0, 0)
    load = struct.pack("<6I", 0xC, 24 + len(path), 24, 0, 0, 0) + path
    segment = struct.pack("<2I16s4Q4I", 0x19, 72, b"__TEXT", 0, 0x4000, 0, 0x4000, 5, 5, 0, 0)
    commands = segment + version + load
    head = struct.pack("<8I", 0xFEEDFACF, 0x100000C, 0, 6, 3, len(commands), 0x85, 0)
    return (head + commands).ljust(0x4000, b"\0")


def test_a_macos_library_is_read():
    read = wheel_check.read(macos_library((12, 3), "/opt/libpython3.11.dylib"))
    assert (read.platform, read.oldest) == ("macos-arm64", (12, 3))
    assert read.needs == ("/opt/libpython3.11.dylib",)
    unsigned = dataclasses.replace(library("macos-arm64"), is_signed=read.is_signed)
    assert "is not signed" in wheel_check.complaints(unsigned, "macos-arm64")[0]


def test_what_is_no_library_is_refused():
    with pytest.raises(ValueError, match="neither an ELF"):
        wheel_check.read(b"no library")


GOOD = {
    "linux-x64": (("libc.so.6", "ld-linux-x86-64.so.2"), (2, 28)),
    "linux-arm64": (("libc.so.6", "ld-linux-aarch64.so.1"), (2, 17)),
    "windows-x64": (("python3.dll", "KERNEL32.dll", "api-ms-win-core-synch-l1-2-0.dll"), (0,)),
    "macos-arm64": (("/usr/lib/libSystem.B.dylib",), (11, 0)),
    "macos-x64": (("/usr/lib/libSystem.B.dylib",), (10, 13)),
}


def library(platform, needs=None, oldest=None, exports=(wheel_check.ENTRY,)):
    """A library that is as it must be, but for what is told."""
    good_needs, good_oldest = GOOD[platform]
    return wheel_check.Library(
        platform, needs or good_needs, oldest or good_oldest, frozenset(exports)
    )


def test_platforms_are_chosen_by_name():
    assert platforms.chosen(()) == [*platforms.PLATFORMS]
    assert [p.name for p in platforms.chosen(["macos-x64", "--here"])] == [
        "macos-x64",
        platforms.here().name,
    ]
    with pytest.raises(environment.Failed, match="no platform 'amiga': accepted are --here, linux"):
        platforms.chosen(["amiga"])


@pytest.mark.parametrize("platform", GOOD)
def test_a_good_library_is_accepted_on_its_own_platform_only(platform):
    assert [p.name for p in platforms.PLATFORMS if p.name == platform] == [platform]
    assert wheel_check.complaints(library(platform), platform) == []
    for other in GOOD.keys() - {platform}:
        wrong = wheel_check.complaints(library(platform), other)
        assert wrong[0] == f"is for {platform}, not for {other}"


@pytest.mark.parametrize(
    ("wrong", "complaint"),
    [
        (library("linux-x64", needs=("libc.so.6", "libpython3.11.so.1.0")), "needs libpython3.11"),
        (library("linux-x64", oldest=(2, 35)), "asks for the C library 2.35, 2.28 is allowed"),
        (library("windows-x64", needs=("python311.dll",)), "needs python311.dll"),
        (library("windows-x64", needs=("KERNEL32.dll",)), "does not import python3.dll"),
        (library("macos-arm64", needs=("@rpath/libpython3.11.dylib",)), "needs @rpath/libpython"),
        (library("macos-x64", oldest=(14, 0)), "asks for macOS 14.0, 11.0 is allowed"),
        (library("macos-x64", exports=("PyInit_other",)), "has no PyInit_boucle_core"),
    ],
)
def test_what_blender_has_not_is_told(wrong, complaint):
    assert wheel_check.complaints(wrong, wrong.platform)[0].startswith(complaint)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads Linux libraries")
def test_a_wheel_of_another_name_is_refused(tmp_path):
    compiled = next(Path(boucle_core.__file__).parent.glob("*.so"))
    wheel = tmp_path / "boucle_core-9.9.9-cp311-cp311-linux_x86_64.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.write(compiled, "boucle_core/boucle_core.abi3.so")
    with pytest.raises(ValueError, match="is not named for cp311-abi3-linux_x86_64"):
        wheel_check.check_wheel(wheel, platforms.here().name, "linux_x86_64")


def test_the_staged_manifest_names_its_wheels_and_keeps_the_rest(tmp_path):
    wheels = {}
    for name, tag in (("linux-x64", "manylinux_2_28_x86_64"), ("windows-x64", "win_amd64")):
        wheels[name] = tmp_path / f"boucle_core-9.9.9-cp311-abi3-{tag}.whl"
        wheels[name].write_bytes(b"")
    package.stage(wheels, tmp_path / "staging")
    staged = tmp_path / "staging" / "blender_manifest.toml"
    staged = tomllib.loads(staged.read_text(encoding="utf-8"))
    assert staged.pop("wheels") == [f"./wheels/{wheel.name}" for wheel in wheels.values()]
    assert staged.pop("platforms") == ["linux-x64", "windows-x64"]
    plain = (ROOT / "addon" / "blender_manifest.toml").read_text(encoding="utf-8")
    assert staged == tomllib.loads(plain)
    assert all((tmp_path / "staging" / "wheels" / file.name).exists() for file in wheels.values())


@pytest.mark.parametrize("program", ["debootstrap", "unshare"])
def test_a_system_without_a_debian_folder_says_what_it_lacks(monkeypatch, program):
    there = shutil.which
    monkeypatch.setattr(
        debian.shutil, "which", lambda name: None if name == program else there(name) or name
    )
    with pytest.raises(environment.Missing, match=rf"a Debian 13 folder needs.*{program}"):
        debian.require()


def test_a_command_in_the_folder_gets_only_the_environment_that_it_is_given(tmp_path):
    words = debian.inside(["true"], shared=[tmp_path], root=Path("/folder"), LETTER="a b")
    tail = words[words.index("--") + 1 :]
    assert tail[:2] == ["env", "-i"]
    assert "LETTER=a b" in tail
    assert tail[-3:] == ["chroot", "/folder", "true"]
    assert str(tmp_path) in words[: words.index("--")]


def test_a_command_in_the_folder_takes_its_children_along_unless_it_hears_signals_itself():
    assert "--kill-child" in debian.inside(["true"], root=Path("/folder"))
    assert "--fork" not in debian.inside(["true"], root=Path("/folder"), hears_signals=True)


def test_every_request_of_the_window_has_a_program():
    crop = gui.commands({"do": "photo", "name": "live", "part": (1, 2, 30, 40)})[0]
    assert crop[:3] == ["import", "-window", "root"]
    assert "30x40+1+2" in crop
    assert gui.commands({"do": "move", "to": (3, 4)}) == [["xdotool", "mousemove", 3, 4]]
    with pytest.raises(ValueError, match="'sing'"):
        gui.commands({"do": "sing"})


def test_only_complaints_of_the_console_count():
    assert gui.is_complaint("Traceback (most recent call last):")
    assert gui.is_complaint("RuntimeError: Error: no cloth")
    assert not gui.is_complaint("Info: Saved cloth.blend")


@pytest.mark.parametrize("make", ALL_STEPS)
def test_the_benchmarks_yardsticks_move_as_the_simulation_does(make):
    sheet = Sheet(vertices=12, size=0.11, time_step=1.0 / 24.0 / STEPS_PER_FRAME)
    assert difference_after_a_frame(sheet, make) < 1e-11
