"""The set-up that every command needs: tools, virtual environments, the compiled module.

Standard library only: this file runs before anything is installed.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCRIPTS = ROOT / "scripts"
OUT = ROOT / "out"
VENV = ROOT / ".venv"
OTHER_BLENDERS = ("4.2", "5.0")
"""Versions of Blender that tests run beside the one in .venv; each has a virtual environment of its own."""
WHEELS = ROOT / "target" / "wheels"
PYTHON_VERSION = (3, 11)


class Missing(Exception):
    """Something that must be there is not. The message is one line: what, and what to do."""


class Failed(Exception):
    """A command ended with an error that it has already shown."""


@contextlib.contextmanager
def heading(title: str) -> Iterator[None]:
    """Print `title`, do the work inside, and print the seconds that it took."""
    print(f"== {title}", flush=True)
    started = time.monotonic()
    yield
    print(f"   {title}: {time.monotonic() - started:.1f} s", flush=True)


def run(command: list[object], *, timeout: float | None = None, **environment: str) -> None:
    """Run `command` in the project's root, with `environment` added to ours.

    Args:
        command: Program and arguments.
        timeout: Seconds after which the program and its children are stopped; none by default.
        environment: Variables to add.

    Raises:
        Failed: The exit code was not 0, or the time was up.
    """
    words = [str(word) for word in command]
    process = subprocess.Popen(
        words, cwd=ROOT, env={**os.environ, **environment}, start_new_session=os.name == "posix"
    )
    try:
        code = process.wait(timeout)
    except subprocess.TimeoutExpired:
        stop(process)
        raise Failed(f"{shorten(words)} took more than {timeout:.0f} s and was stopped") from None
    except BaseException:
        stop(process)
        raise
    if code != 0:
        raise Failed(f"{shorten(words)} ended with exit code {code}")


def stop(process: subprocess.Popen) -> None:
    """Stop a process that `run` started, with everything that it started itself."""
    if os.name == "posix":
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, 9)
    else:
        process.kill()
    process.wait()


def shorten(words: list[str]) -> str:
    """A command as a person would name it: program, first arguments, no folders."""
    return " ".join(Path(word).name or word for word in words[:4])


def venv_program(venv: Path, name: str) -> Path:
    """Path of a program inside a virtual environment."""
    return venv / "Scripts" / f"{name}.exe" if os.name == "nt" else venv / "bin" / name


def blender_venv(version: str) -> Path:
    """The virtual environment that holds a version of Blender other than that of .venv."""
    return ROOT / f".venv-bpy{version.replace('.', '')}"


def rust_version() -> str:
    """The lowest Rust release that the workspace accepts, as Cargo.toml has it."""
    manifest = (ROOT / "Cargo.toml").read_text(encoding="utf-8")
    return re.search(r'^rust-version = "([\d.]+)"', manifest, re.MULTILINE).group(1)


def find_python() -> str:
    """The Python 3.11 that makes the virtual environments.

    Raises:
        Missing: There is none.
    """
    if sys.version_info[:2] == PYTHON_VERSION:
        return sys.executable
    name = "python3.11"
    found = shutil.which(name)
    if found and answers(found, "--version").startswith("Python 3.11."):
        return found
    raise Missing(
        "Python 3.11 is missing (this is {}.{}; Blender's bpy package needs 3.11): "
        "install it so that `python3.11` is on the PATH".format(*sys.version_info[:2])
    )


def require_rust() -> None:
    """Check that Rust is there and new enough.

    Raises:
        Missing: It is not.
    """
    wanted = rust_version()
    advice = f"install Rust {wanted} or later, with rustfmt and clippy, as rust-lang.org says"
    if shutil.which("cargo") is None:
        raise Missing(f"Rust is missing (no `cargo` on the PATH): {advice}")
    answer = answers("cargo", "--version")
    found = re.search(r"cargo (\d+)\.(\d+)", answer)
    if found is None:
        raise Missing(f"`cargo --version` answers {answer!r}, not a version: {advice}")
    if tuple(map(int, found.groups())) < tuple(map(int, wanted.split(".")[:2])):
        raise Missing(f"Rust {'.'.join(found.groups())} is too old: {advice}")


def answers(*command: str) -> str:
    """First line that a command prints, or nothing if it cannot run."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    except OSError:
        return ""
    return (done.stdout or done.stderr).strip().partition("\n")[0]


@contextlib.contextmanager
def exclusive() -> Iterator[None]:
    """Let one set-up at a time change the virtual environments; others wait here."""
    if os.name == "nt":
        yield
        return
    import fcntl

    with (ROOT / ".venv.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def ensure_venv(venv: Path, *requirements: str) -> None:
    """Make a virtual environment and install its pinned requirements; do nothing if it is so."""
    wanted = "".join((SCRIPTS / name).read_text(encoding="utf-8") for name in requirements)
    stamp = venv / "requirements.stamp"
    python = venv_program(venv, "python")
    if python.exists() and stamp.exists() and stamp.read_text(encoding="utf-8").startswith(wanted):
        return
    with heading(f"Install the requirements of {venv.name}"):
        if not answers(str(python), "--version").startswith("Python 3.11."):
            python_here = find_python()
            if answers(python_here, "-c", "import ensurepip, venv"):
                raise Missing(
                    f"{python_here} has no venv module: install Debian's python3-venv or the like"
                )
            run([python_here, "-m", "venv", "--clear", venv])
        stamp.unlink(missing_ok=True)
        install = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        for name in requirements:
            install += ["--requirement", SCRIPTS / name]
        run(install)
        stamp.write_text(wanted, encoding="utf-8")


def sources_digest() -> str:
    """A digest of everything that the compiled module is made of."""
    digest = hashlib.sha256()
    files = [ROOT / "Cargo.toml", ROOT / "Cargo.lock"]
    files += sorted(p for p in (ROOT / "rust").rglob("*") if p.suffix in {".rs", ".toml", ".pyi"})
    for path in files:
        if path.exists():
            content = path.read_bytes()
            digest.update(f"{path.relative_to(ROOT).as_posix()} {len(content)}\n".encode())
            digest.update(content)
    return digest.hexdigest()


def build_wheel(
    folder: Path, *options: str, first_on_path: Path | None = None, **variables: str
) -> Path:
    """Compile the module for release and pack it as the only wheel in `folder`.

    Args:
        folder: Emptied first.
        options: More words for maturin.
        first_on_path: Folder of programs that the compiler must find before others.
        variables: More of the environment.

    Raises:
        Failed: The compiler refused, or the wheel is not for every Python from 3.11 on.
    """
    shutil.rmtree(folder, ignore_errors=True)
    python = venv_program(VENV, "python")
    command = [python, "-m", "maturin", "build", "--release", "--out", folder]
    command += ["--manifest-path", ROOT / "rust" / "python" / "Cargo.toml"]
    path = os.pathsep.join(filter(None, [str(first_on_path or ""), os.environ.get("PATH", "")]))
    run([*command, "--interpreter", python, *options], PATH=path, **variables)
    return only_wheel(folder)


def only_wheel(folder: Path) -> Path:
    """The wheel in a folder, for every Python from 3.11 on.

    Raises:
        Failed: There is another, or none.
    """
    wheels = list(folder.glob("*.whl"))
    if len(wheels) != 1 or "-abi3-" not in wheels[0].name:
        raise Failed(f"expected one abi3 wheel, got {[wheel.name for wheel in wheels]}")
    return wheels[0]


def install_module(venv: Path, digest: str) -> None:
    """Put the compiled module into a virtual environment, unless it holds these sources already."""
    stamp = venv / "module.stamp"
    if stamp.exists() and stamp.read_text(encoding="utf-8") == digest:
        return
    wheel_stamp = WHEELS / "module.stamp"
    wheels = list(WHEELS.glob("*.whl"))
    if not (wheels and wheel_stamp.exists() and wheel_stamp.read_text(encoding="utf-8") == digest):
        with heading("Compile the module"):
            wheels = [build_wheel(WHEELS, "--auditwheel", "skip")]
            wheel_stamp.write_text(digest, encoding="utf-8")
    with heading(f"Install the module into {venv.name}"):
        stamp.unlink(missing_ok=True)
        pip = [venv_program(venv, "python"), "-m", "pip", "--disable-pip-version-check"]
        run([*pip, "install", "--quiet", "--force-reinstall", "--no-deps", "--no-index", wheels[0]])
        stamp.write_text(digest, encoding="utf-8")


def set_up(*, other_blenders: bool = False, sweeps: bool = False) -> None:
    """Bring .venv to the state of the sources.

    Args:
        other_blenders: Those of the other Blender versions, too.
        sweeps: With what `sweep.py` takes for clusters and Parquet tables, which it else installs when it is asked for them.
    """
    require_rust()
    with exclusive():
        digest = sources_digest()
        ensure_venv(VENV, "requirements.txt", *(["requirements-sweep.txt"] if sweeps else []))
        install_module(VENV, digest)
        for version in OTHER_BLENDERS if other_blenders else ():
            venv = blender_venv(version)
            ensure_venv(venv, f"requirements{venv.name.removeprefix('.venv')}.txt")
            install_module(venv, digest)
