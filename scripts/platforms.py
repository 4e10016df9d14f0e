"""The platforms that the extension is for, and how the compiled module for each is made.

This machine's own is built by its own Rust. All others are built in the Debian 13 folder, where the standard library is
compiled from its source for the target; zig or MinGW links. Standard library only.
"""

from __future__ import annotations

import os
import platform as machine
import shutil
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import debian
from environment import (
    OUT,
    ROOT,
    VENV,
    Failed,
    build_wheel,
    only_wheel,
    run,
    sources_digest,
    venv_program,
)

PACKAGES = ("rustc-web", "cargo-web", "rust-web-src", "gcc", "libc6-dev", "python3")
RUST_SOURCE = Path("usr", "lib", "rustlib", "src", "rust", "library", "Cargo.toml")
TARGET_FOLDER = ROOT / "target" / "platforms"
BUILD_SECONDS = 3600


@dataclass(frozen=True)
class Platform:
    """A kind of machine, by Blender's name for it."""

    name: str
    target: str
    """Rust's name for it."""
    tag: str
    """Python's name for it, in the name of the wheel."""
    options: tuple[str, ...] = ("--zig",)
    """More words for maturin."""
    packages: tuple[str, ...] = ()
    """More Debian packages."""
    variables: dict[str, str] = field(default_factory=dict)


OLD_LINUX = ("--zig", "--compatibility", "manylinux_2_28")
OLD_MACOS = {"MACOSX_DEPLOYMENT_TARGET": "11.0"}
MINGW = {"CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER": "x86_64-w64-mingw32-gcc"}

PLATFORMS = (
    Platform("linux-x64", "x86_64-unknown-linux-gnu", "manylinux_2_28_x86_64", OLD_LINUX),
    Platform("linux-arm64", "aarch64-unknown-linux-gnu", "manylinux_2_28_aarch64", OLD_LINUX),
    Platform(
        "windows-x64",
        "x86_64-pc-windows-gnu",
        "win_amd64",
        options=(),
        packages=("gcc-mingw-w64-x86-64-win32",),
        variables=MINGW,
    ),
    Platform("macos-arm64", "aarch64-apple-darwin", "macosx_11_0_arm64", variables=OLD_MACOS),
    Platform("macos-x64", "x86_64-apple-darwin", "macosx_11_0_x86_64", variables=OLD_MACOS),
)


def here() -> Platform:
    """The platform of this machine.

    Raises:
        Failed: The extension is not made for it.
    """
    system = {"linux": "linux", "darwin": "macos", "win32": "windows"}.get(sys.platform, "")
    bits = {"x86_64": "x64", "amd64": "x64", "aarch64": "arm64", "arm64": "arm64"}
    name = f"{system}-{bits.get(machine.machine().lower(), '')}"
    found = [platform for platform in PLATFORMS if platform.name == name]
    if not found:
        raise Failed(f"the extension is not made for {sys.platform} on {machine.machine()}")
    return found[0]


def chosen(names: Sequence[str]) -> list[Platform]:
    """The named platforms, or all of them.

    Raises:
        Failed: A name is none of ours.
    """
    known = {platform.name: platform for platform in PLATFORMS}
    names = [here().name if name == "--here" else name for name in names]
    strange = [name for name in names if name not in known]
    if strange:
        raise Failed(f"no platform {strange[0]!r}: accepted are --here, {', '.join(known)}")
    return [known[name] for name in names or known]


def wheel_for(platform: Platform) -> Path:
    """The wheel of a platform, compiled unless these sources have been.

    Raises:
        Missing: This system has not what that takes.
        Failed: The compiler refused.
    """
    folder = OUT / "package" / "wheels" / platform.name
    stamp = folder / "sources.stamp"
    digest = sources_digest()
    if not (stamp.exists() and stamp.read_text(encoding="utf-8") == digest):
        if platform == here():
            build_here(platform, folder)
        else:
            build_in_debian(platform, folder)
        stamp.write_text(digest, encoding="utf-8")
    return only_wheel(folder)


def build_here(platform: Platform, folder: Path) -> None:
    """Compile for this machine with its own Rust; on Linux zig links, against an old C library."""
    options = platform.options if platform.name.startswith("linux") else ()
    programs = venv_program(VENV, "python").parent
    build_wheel(folder, *options, first_on_path=programs, **platform.variables)


def build_in_debian(platform: Platform, folder: Path) -> None:
    """Compile for another machine, the standard library with it."""
    debian.ensure(*PACKAGES, *platform.packages)
    home = Path(os.environ.get("CARGO_HOME") or Path.home() / ".cargo")
    # The folder has no network settings: what cargo needs is fetched here and shared.
    unstable = {"RUSTC_BOOTSTRAP": "1"}
    run(["cargo", "fetch", "--locked", "--quiet"])
    source = debian.folder() / RUST_SOURCE
    run(["cargo", "fetch", "--locked", "--quiet", "--manifest-path", source], **unstable)
    shutil.rmtree(folder, ignore_errors=True)
    zig = next(VENV.glob("lib/python3.*/site-packages/ziglang"))
    words = [venv_program(VENV, "maturin"), "build", "--release", "--locked", "--out", folder]
    words += ["--manifest-path", ROOT / "rust" / "python" / "Cargo.toml"]
    words += ["--target", platform.target, "--interpreter", "python3", *platform.options]
    command = debian.inside(
        words,
        shared=[ROOT, VENV, home / "registry"],
        CARGO_HOME=str(home),
        CARGO_NET_OFFLINE="true",
        CARGO_TARGET_DIR=str(TARGET_FOLDER),
        CARGO_UNSTABLE_BUILD_STD="std,panic_unwind",
        CARGO_PROFILE_RELEASE_STRIP="none",  # the folder's own strip knows one machine only
        PATH=f"{zig}:/usr/sbin:/usr/bin:/sbin:/bin",
        **unstable,
        **platform.variables,
    )
    run(command, timeout=BUILD_SECONDS)
    only_wheel(folder)
