"""Each test runs in real Blender (the bpy package), in a process of its own with a time limit, for every supported version."""

import importlib.util
import inspect
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
VERSIONS = ("4.5", "4.2", "5.0", *(["5.2"] if "BOUCLE_BPY52_PYTHON" in os.environ else []))
"""5.2 needs Python 3.13: it is tested where the environment names one that has it."""
SECONDS = 120
"""A scenario takes seconds; Blender that hangs must not hold up the tests."""


def python_of(version):
    """The Python that has this bpy: for 4.5 our own; for others a venv of its own, because one Python holds one bpy."""
    if version == VERSIONS[0]:
        return sys.executable
    number = version.replace(".", "")
    named = os.environ.get(f"BOUCLE_BPY{number}_PYTHON")
    if named:
        return named
    venv = ROOT / f".venv-bpy{number}"
    python = venv / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if not python.is_file():
        subprocess.run([sys.executable, "-m", "venv", str(venv)], check=True)
        requirements = ROOT / "scripts" / f"requirements-bpy{number}.txt"
        install = [str(python), "-m", "pip", "install", "--quiet", "--requirement"]
        subprocess.run([*install, str(requirements)], check=True)
    return str(python)


@pytest.fixture(scope="session")
def module_folder(tmp_path_factory):
    """A folder with the compiled module alone, for a Python that has not installed it."""
    spec = importlib.util.find_spec("boucle_core")
    assert spec is not None, "boucle_core is not installed: run `python3 scripts/dev.py build`"
    folder = tmp_path_factory.mktemp("module")
    origin = Path(spec.origin)
    if origin.name == "__init__.py":
        shutil.copytree(origin.parent, folder / "boucle_core")
    else:
        shutil.copy(origin, folder)
    return folder


class Blender:
    """One Blender version with a user folder of its own, in which the add-on is an extension."""

    def __init__(self, version, folder, module_folder):
        self.version = version
        self.folder = folder
        self.output = ""
        self.python = python_of(version)
        resources = folder / "user"
        extensions = resources / "extensions" / "user_default"
        extensions.mkdir(parents=True)
        shutil.copytree(
            ROOT / "addon",
            extensions / "boucle",
            ignore=shutil.ignore_patterns("__pycache__"),
        )
        self._environment = {
            **os.environ,
            "BLENDER_USER_RESOURCES": str(resources),
            "PYTHONPATH": str(module_folder),
            "PYTHONDONTWRITEBYTECODE": "1",
            "TMPDIR": str(folder),
        }

    def run(self, function, addon=True, **arguments):
        """Call a function of the test's file inside Blender and return its result (JSON)."""
        result = self.folder / "result.json"
        result.unlink(missing_ok=True)
        done = subprocess.run(
            self._command(function, addon, arguments, result),
            env=self._environment,
            cwd=self.folder,
            capture_output=True,
            text=True,
            timeout=SECONDS,
            check=False,
        )
        lines = (done.stdout + done.stderr).splitlines()
        self.output = "\n".join(line for line in lines if not line.startswith("Fra:"))
        assert done.returncode == 0, f"exit {done.returncode}\n{self.output[-4000:]}"
        return json.loads(result.read_text())

    def start(self, function, **arguments):
        """Begin to call a function inside Blender, and return the process."""
        return subprocess.Popen(
            self._command(function, True, arguments, self.folder / "result.json"),
            env=self._environment,
            cwd=self.folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def _command(self, function, addon, arguments, result):
        return [
            self.python,
            str(Path(__file__).with_name("child.py")),
            inspect.getfile(function),
            function.__name__,
            "1" if addon else "0",
            json.dumps({key: str(value) for key, value in arguments.items()}),
            str(result),
        ]


@pytest.fixture
def new_blender(tmp_path, module_folder):
    """The Blender of the main environment, for what does not depend on the version."""
    return Blender(VERSIONS[0], tmp_path, module_folder)


@pytest.fixture(params=VERSIONS)
def blender(request, tmp_path, module_folder):
    """Real Blender; the test's functions run inside it."""
    return Blender(request.param, tmp_path, module_folder)
