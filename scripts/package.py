"""The extension as zips that Blender installs, one per platform that can be built here.

Numbered: build the wheel against an old C library, check what it needs, stage addon/ with the wheel named in the
manifest, let Blender's own tool build and validate the zip, install that zip in Blender and use it once.
Standard library only.
"""

from __future__ import annotations

import shutil
import tempfile
import zipfile
from pathlib import Path

from environment import (
    OTHER_BLENDERS,
    OUT,
    ROOT,
    SCRIPTS,
    VENV,
    Failed,
    blender_venv,
    build_wheel,
    ensure_venv,
    exclusive,
    heading,
    run,
    venv_program,
)
from shared_library import needed_libraries

PLATFORM = "linux-x64"
WHEEL_MAX_BYTES = 5_000_000
SYSTEM_LIBRARIES = ("libc.so.", "libm.so.", "libpthread.so.", "libdl.so.", "librt.so.", "ld-linux")
"""The C library's own family; every Linux that Blender runs on has it."""


def package() -> None:
    """Make and check out/package/*.zip."""
    folder = OUT / "package"
    with exclusive():
        ensure_venv(VENV, "requirements.txt", "requirements-package.txt")
        with heading("Compile the module for old systems too"):
            programs = venv_program(VENV, "python").parent
            wheel = build_wheel(
                folder / "wheels",
                "--zig",
                "--compatibility",
                "manylinux_2_28",
                first_on_path=programs,
            )
    check_wheel(wheel)
    staging = folder / "staging"
    stage(wheel, staging)
    with heading("Build and validate the zip with Blender's tool"):
        zips = build_zips(staging, folder)
    for file in zips:
        for venv in (VENV, *map(blender_venv, OTHER_BLENDERS)):
            if venv_program(venv, "python").exists():
                with heading(f"Install {file.name} in the Blender of {venv.name}"):
                    try_install(file, venv)
    for file in zips:
        print(f"{file.relative_to(ROOT)}: {file.stat().st_size / 1e6:.2f} MB")


def check_wheel(wheel: Path) -> None:
    """Check that the wheel is small and needs the C library alone.

    Raises:
        Failed: It does not; the message names what is too much.
    """
    size = wheel.stat().st_size
    if size >= WHEEL_MAX_BYTES:
        raise Failed(f"{wheel.name} has {size} bytes, {WHEEL_MAX_BYTES} are allowed")
    with zipfile.ZipFile(wheel) as archive:
        libraries = [name for name in archive.namelist() if name.endswith(".so")]
        if len(libraries) != 1:
            raise Failed(f"{wheel.name} holds {libraries}, one compiled module is expected")
        needed = needed_libraries(archive.read(libraries[0]))
    foreign = [name for name in needed if not name.startswith(SYSTEM_LIBRARIES)]
    if foreign:
        raise Failed(f"{wheel.name} needs {foreign}, which Blender may not have")
    print(f"   {wheel.name}: {size / 1e6:.2f} MB, needs {', '.join(needed)}")


def stage(wheel: Path, staging: Path) -> None:
    """Copy addon/ and put the wheel into the copy, named in its manifest."""
    shutil.rmtree(staging, ignore_errors=True)
    ignored = shutil.ignore_patterns("__pycache__", "*.pyc", ".*")
    shutil.copytree(ROOT / "addon", staging, ignore=ignored)
    (staging / "wheels").mkdir()
    shutil.copy2(wheel, staging / "wheels" / wheel.name)
    shutil.copy2(ROOT / "LICENSE", staging / "LICENSE")
    manifest = staging / "blender_manifest.toml"
    head, table, tables = manifest.read_text(encoding="utf-8").partition("\n[")
    lines = f'platforms = ["{PLATFORM}"]\nwheels = ["./wheels/{wheel.name}"]\n'
    manifest.write_text(f"{head}\n{lines}{table}{tables}", encoding="utf-8")


def extension_tool(venv: Path) -> Path:
    """Blender's command-line tool for extensions, which is plain Python."""
    found = sorted(venv.glob("**/bl_pkg/cli/blender_ext.py"))
    if not found:
        raise Failed(f"{venv.name} holds no Blender with an extension tool")
    return found[-1]


def build_zips(staging: Path, folder: Path) -> list[Path]:
    """Let Blender's tool build one zip per platform and validate each."""
    for old in folder.glob("*.zip"):
        old.unlink()
    tool = [venv_program(VENV, "python"), extension_tool(VENV)]
    run([*tool, "build", "--split-platforms", "--source-dir", staging, "--output-dir", folder])
    zips = sorted(folder.glob("*.zip"))
    if not zips:
        raise Failed("Blender's tool left no zip")
    for file in zips:
        run([*tool, "validate", file])
    return zips


def try_install(file: Path, venv: Path) -> None:
    """Install the zip into a fresh Blender that has no other copy of the module, and simulate with it."""
    packages = venv_program(venv, "python").parent.parent.glob("lib/python3.*/site-packages/*")
    with tempfile.TemporaryDirectory(prefix="boucle-install-") as folder:
        library = Path(folder, "library")
        library.mkdir()
        for entry in packages:
            if not entry.name.startswith("boucle_core"):
                (library / entry.name).symlink_to(entry)
        run(
            [venv_program(venv, "python"), "-S", SCRIPTS / "try_extension.py", file],
            timeout=300,
            PYTHONPATH=str(library),
            BLENDER_USER_RESOURCES=str(Path(folder, "blender")),
        )
