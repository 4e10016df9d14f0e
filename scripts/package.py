"""The extension as zips that Blender installs, one per platform.

Numbered: compile the module for each platform (platforms.py), check what it needs (wheel_check.py), run the tests of the one
for Linux on ARM (arm64.py), stage addon/ with the wheels named in the manifest, let Blender's own tool build and validate
the zips, install that of this machine in Blender and use it once.
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import blender52
import platforms
from environment import (
    OTHER_BLENDERS,
    OUT,
    ROOT,
    SCRIPTS,
    VENV,
    Failed,
    Missing,
    blender_venv,
    ensure_venv,
    exclusive,
    heading,
    require_rust,
    run,
    venv_program,
)
from platforms import Platform

FOLDER = OUT / "package"
ZIP_MAX_BYTES = 8_000_000


def package(names: Sequence[str] = ()) -> Path | None:
    """Make and check out/package/*.zip; this machine's zip, if it is among them.

    Args:
        names: Platforms, "--here" for this machine's; all of them if there are none.

    Raises:
        Failed: A platform could not be done, or its zip is not as it must be; the others are made all the same.
    """
    wanted = platforms.chosen(names)
    require_rust()
    with exclusive():
        ensure_venv(VENV, "requirements.txt", "requirements-package.txt")
    wheels, faults = make_wheels(wanted)
    staging = FOLDER / "staging"
    stage(wheels, staging)
    with heading("Build and validate the zips with Blender's tool"):
        zips = build_zips(staging, FOLDER, [*wheels])
    mine = zips.get(platforms.here().name)
    if mine is not None:
        try_everywhere(mine)
    for file in zips.values():
        print(f"{file.relative_to(ROOT)}: {file.stat().st_size / 1e6:.2f} MB")
    if faults:
        raise Failed("not packaged:\n  " + "\n  ".join(faults))
    return mine


def make_wheels(wanted: list[Platform]) -> tuple[dict[str, Path], list[str]]:
    """A checked wheel for each platform, by its name, and a sentence for each that could not be had."""
    check = [venv_program(VENV, "python"), SCRIPTS / "wheel_check.py"]
    wheels, faults = {}, []
    for platform in wanted:
        try:
            with heading(f"Compile the module for {platform.name}"):
                wheel = platforms.wheel_for(platform)
                run([*check, wheel, platform.name, platform.tag])
            if platform.name == "linux-arm64" != platforms.here().name:
                import arm64

                arm64.test(wheel)
        except (Missing, Failed) as fault:
            print(f"   {platform.name}: {fault}", file=sys.stderr, flush=True)
            faults.append(f"{platform.name}: {fault}")
        else:
            wheels[platform.name] = wheel
    if not wheels:
        raise Failed("not packaged:\n  " + "\n  ".join(faults))
    return wheels, faults


def try_everywhere(file: Path) -> None:
    """Install a zip in every Blender that the tests have made ready."""
    for venv in (VENV, *map(blender_venv, OTHER_BLENDERS)):
        if venv_program(venv, "python").exists():
            with heading(f"Install {file.name} in the Blender of {venv.name}"):
                try_install(file, venv)
    if blender52.is_ready():
        with heading(f"Install {file.name} in Blender 5.2"):
            try_in(SCRIPTS / "blender52.py", file)


def stage(wheels: dict[str, Path], staging: Path) -> None:
    """Copy addon/ and put the wheels into the copy, named with their platforms in its manifest."""
    shutil.rmtree(staging, ignore_errors=True)
    ignored = shutil.ignore_patterns("__pycache__", "*.pyc", ".*")
    shutil.copytree(ROOT / "addon", staging, ignore=ignored)
    (staging / "wheels").mkdir()
    for wheel in wheels.values():
        shutil.copy2(wheel, staging / "wheels" / wheel.name)
    shutil.copy2(ROOT / "LICENSE", staging / "LICENSE")
    manifest = staging / "blender_manifest.toml"
    head, table, tables = manifest.read_text(encoding="utf-8").partition("\n[")
    files = [f"./wheels/{wheel.name}" for wheel in wheels.values()]
    lines = f"platforms = {json.dumps([*wheels])}\nwheels = {json.dumps(files)}\n"
    manifest.write_text(f"{head}\n{lines}{table}{tables}", encoding="utf-8")


def extension_tool(venv: Path) -> Path:
    """Blender's command-line tool for extensions, which is plain Python."""
    found = sorted(venv.glob("**/bl_pkg/cli/blender_ext.py"))
    if not found:
        raise Failed(f"{venv.name} holds no Blender with an extension tool")
    return found[-1]


def build_zips(staging: Path, folder: Path, names: list[str]) -> dict[str, Path]:
    """Let Blender's tool build one zip for each named platform, and validate each.

    Raises:
        Failed: A zip is missing, refused or too large.
    """
    for old in folder.glob("*.zip"):
        old.unlink()
    tool = [venv_program(VENV, "python"), extension_tool(VENV)]
    run([*tool, "build", "--split-platforms", "--source-dir", staging, "--output-dir", folder])
    zips = {}
    for name in names:
        found = [*folder.glob(f"*-{name.replace('-', '_')}.zip")]
        if len(found) != 1:
            raise Failed(f"Blender's tool left {len(found)} zips for {name}")
        run([*tool, "validate", found[0]])
        size = found[0].stat().st_size
        if size >= ZIP_MAX_BYTES:
            raise Failed(f"{found[0].name} has {size} bytes, {ZIP_MAX_BYTES} are allowed")
        zips[name] = found[0]
    return zips


def try_install(file: Path, venv: Path) -> None:
    """Install the zip into a fresh Blender that has no other copy of the module, and simulate with it."""
    packages = venv_program(venv, "python").parent.parent.glob("lib/python3.*/site-packages/*")
    with tempfile.TemporaryDirectory(prefix="boucle-library-") as library:
        for entry in packages:
            if not entry.name.startswith("boucle_core"):
                Path(library, entry.name).symlink_to(entry)
        try_in(venv_program(venv, "python"), file, PYTHONPATH=library)


def try_in(python: Path, file: Path, **variables: str) -> None:
    """Run try_extension.py in a Python without packages of its own, with a user folder of its own."""
    with tempfile.TemporaryDirectory(prefix="boucle-install-") as user:
        words = [python, "-S", SCRIPTS / "try_extension.py", file]
        run(words, timeout=300, BLENDER_USER_RESOURCES=user, **variables)
