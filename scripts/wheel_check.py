"""Whether a wheel may go into the extension: `wheel_check.py WHEEL PLATFORM TAG`, exit code 1 and a sentence if not.

It must be small, for every Python from 3.11 on, and need nothing that Blender's machine may lack. The compiled library
inside is read with lief, whatever platform it is for.
"""

from __future__ import annotations

import io
import sys
import zipfile
from dataclasses import dataclass
from pathlib import Path

import lief

WHEEL_MAX_BYTES = 8_000_000
OLDEST_GLIBC = (2, 28)
"""Blender's own builds ask for this C library."""
OLDEST_MACOS = (11, 0)
LINUX_LIBRARIES = ("libc.so.", "libm.so.", "libpthread.so.", "libdl.so.", "librt.so.", "ld-linux")
"""The C library's own family; every Linux that Blender runs on has it."""
MACOS_LIBRARIES = ("/usr/lib/", "/System/Library/")
WINDOWS_LIBRARIES = (
    "python3.dll", "kernel32.dll", "ntdll.dll", "advapi32.dll", "bcryptprimitives.dll", "bcrypt.dll", "userenv.dll",
    "ws2_32.dll", "psapi.dll", "msvcrt.dll", "ucrtbase.dll", "api-ms-win-",
)  # fmt: skip
"""What Windows has, and the one Python library that is the same in every version."""
ALLOWED = {"linux": LINUX_LIBRARIES, "macos": MACOS_LIBRARIES, "windows": WINDOWS_LIBRARIES}
# Tables that zig leaves empty are no complaint.
lief.logging.disable()
ENTRY = "PyInit_boucle_core"


@dataclass(frozen=True)
class Library:
    """What a compiled library says of itself."""

    platform: str
    """As Blender names it: linux-x64, macos-arm64, ..."""
    needs: tuple[str, ...]
    """The libraries that it is linked to."""
    oldest: tuple[int, ...]
    """The version of the C library (Linux) or of macOS that it asks for."""
    exports: frozenset[str]
    is_signed: bool = True
    """False where a signature, if only the linker's own, is missing; only macOS has them."""


def read(data: bytes) -> Library:
    """Read an ELF, PE or Mach-O library.

    Raises:
        ValueError: It is none of those.
    """
    binary = lief.parse(io.BytesIO(data))
    if isinstance(binary, lief.ELF.Binary):
        bits = {lief.ELF.ARCH.X86_64: "x64", lief.ELF.ARCH.AARCH64: "arm64"}
        return Library(
            f"linux-{bits.get(binary.header.machine_type)}",
            tuple(map(str, binary.libraries)),
            max(glibc_versions(binary), default=(0,)),
            frozenset(symbol.name for symbol in binary.exported_symbols),
        )
    if isinstance(binary, lief.PE.Binary):
        bits = {lief.PE.Header.MACHINE_TYPES.AMD64: "x64"}
        exported = binary.get_export().entries if binary.has_exports else ()
        return Library(
            f"windows-{bits.get(binary.header.machine)}",
            tuple(imported.name for imported in binary.imports),
            (0,),
            frozenset(entry.name for entry in exported),
        )
    if isinstance(binary, lief.MachO.Binary):
        kinds = lief.MachO.Header.CPU_TYPE
        bits = {kinds.X86_64: "x64", kinds.ARM64: "arm64"}
        version = binary.build_version.minos if binary.has_build_version else (0,)
        return Library(
            f"macos-{bits.get(binary.header.cpu_type)}",
            tuple(library.name for library in binary.libraries if is_linked(library)),
            tuple(version[:2]),
            frozenset(symbol.name.removeprefix("_") for symbol in binary.exported_symbols),
            binary.has_code_signature,
        )
    raise ValueError("neither an ELF nor a PE nor a Mach-O library")


def is_linked(library: lief.MachO.DylibCommand) -> bool:
    """Whether an entry of a Mach-O file names another library; one names the file itself."""
    return library.command != lief.MachO.LoadCommand.TYPE.ID_DYLIB


def glibc_versions(binary: lief.ELF.Binary) -> list[tuple[int, ...]]:
    """The versions of the C library whose symbols an ELF library asks for."""
    names = [
        str(needed.name)
        for requirement in binary.symbols_version_requirement
        for needed in requirement.get_auxiliary_symbols()
    ]
    numbers = [name.removeprefix("GLIBC_") for name in names if name.startswith("GLIBC_2")]
    return [tuple(map(int, number.split("."))) for number in numbers]


def complaints(library: Library, platform: str) -> list[str]:
    """What is wrong with a library that shall run on a platform, as words that follow its name."""
    wrong = []
    if library.platform != platform:
        wrong.append(f"is for {library.platform}, not for {platform}")
    system = platform.partition("-")[0]
    fold = str.lower if system == "windows" else str
    foreign = [name for name in library.needs if not fold(name).startswith(ALLOWED[system])]
    if foreign:
        wrong.append(f"needs {', '.join(foreign)}, which Blender's machine may not have")
    if system == "windows" and "python3.dll" not in map(fold, library.needs):
        wrong.append("does not import python3.dll")
    limit = {"linux": OLDEST_GLIBC, "macos": OLDEST_MACOS}.get(system)
    if limit is not None and library.oldest > limit:
        name = {"linux": "the C library", "macos": "macOS"}[system]
        wrong.append(f"asks for {name} {dotted(library.oldest)}, {dotted(limit)} is allowed")
    if platform == "macos-arm64" and not library.is_signed:
        wrong.append("is not signed: a Mac with Apple's processor refuses it")
    if ENTRY not in library.exports:
        wrong.append(f"has no {ENTRY}")
    return wrong


def dotted(version: tuple[int, ...]) -> str:
    """A version as people write it."""
    return ".".join(map(str, version))


def check_wheel(wheel: Path, platform: str, tag: str) -> str:
    """Check a wheel that shall run on a platform; what it is, in words.

    Raises:
        ValueError: It is not as it must be; the message says all that is wrong.
    """
    wrong = []
    size = wheel.stat().st_size
    if size >= WHEEL_MAX_BYTES:
        wrong.append(f"has {size} bytes, {WHEEL_MAX_BYTES} are allowed")
    if not wheel.name.endswith(f"-cp311-abi3-{tag}.whl"):
        wrong.append(f"is not named for cp311-abi3-{tag}")
    with zipfile.ZipFile(wheel) as archive:
        names = [name for name in archive.namelist() if name.endswith((".so", ".pyd"))]
        if len(names) != 1:
            raise ValueError(f"{wheel.name} holds {names}, one compiled module is expected")
        library = read(archive.read(names[0]))
    wrong += complaints(library, platform)
    if wrong:
        raise ValueError(f"{wheel.name} {'; '.join(wrong)}")
    asks = f", version {dotted(library.oldest)} or later" if any(library.oldest) else ""
    return f"{wheel.name}: {size / 1e6:.2f} MB, needs {', '.join(library.needs)}{asks}"


def main(wheel: str, platform: str, tag: str) -> int:
    """Check one wheel and return the exit code."""
    try:
        print(f"   {check_wheel(Path(wheel), platform, tag)}")
    except ValueError as wrong:
        print(f"   {wrong}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
