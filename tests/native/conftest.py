"""What the tests of the compiled module and of bake.py share."""

import json
import subprocess
import sys
from array import array
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "tests" / "scenes"


class Sheet:
    """A grid of n x n vertices in the plane y = 0, row over row, as arrays for the module."""

    def __init__(self, n=6, size=1.0):
        self.n = n
        self.positions = array("d")
        for row in range(n):
            for column in range(n):
                self.positions.extend([size * column / (n - 1), 0.0, size * row / (n - 1)])
        corners = array("i")
        for row in range(n - 1):
            for column in range(n - 1):
                vertex = row * n + column
                corners.extend([vertex, vertex + 1, vertex + n + 1, vertex + n])
        self.corners = corners
        self.starts = array("i", range(0, len(corners), 4))

    @property
    def top_corners(self):
        return [self.n * (self.n - 1), self.n * self.n - 1]

    def mesh(self):
        return (self.positions, self.starts, self.corners)

    def scene(self, **cloth):
        """The scene as JSON, with changes to its cloth; it touches nothing unless they say so."""
        pins = {"vertices": self.top_corners}
        keys = {"name": "sheet", "density": 0.2, "pins": pins, **cloth}
        touching = {"enabled": False}
        return json.dumps({"scene": {"fps": 24}, "cloth": [keys], "collision": touching})


@pytest.fixture
def sheet():
    return Sheet()


@pytest.fixture
def make_sheet():
    return Sheet


@pytest.fixture
def simulation(sheet):
    import boucle_core

    return boucle_core.Simulation(sheet.scene(), [sheet.mesh()], threads=1)


@pytest.fixture
def scenes():
    return SCENES


def bake_command(*words):
    return [sys.executable, str(ROOT / "scripts" / "bake.py"), *map(str, words)]


@pytest.fixture
def start_command(tmp_path):
    """Start a command in a folder of its own and return the process."""
    processes = []

    def start(command, **options):
        process = subprocess.Popen(
            command,
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            **options,
        )
        processes.append(process)
        return process

    yield start
    for process in processes:
        if process.poll() is None:
            process.kill()
        process.communicate()


@pytest.fixture
def start_bake(start_command):
    """Start bake.py in a folder of its own and return the process."""
    return lambda *words, **options: start_command(bake_command(*words), **options)


@pytest.fixture
def run_bake(tmp_path):
    """Run bake.py to its end and return it, with its exit code, output and complaint."""

    def run(*words, **options):
        return subprocess.run(
            bake_command(*words),
            cwd=tmp_path,
            capture_output=True,
            text=True,
            errors="backslashreplace",
            timeout=120,
            **options,
        )

    return run


SMALL_SCENE = """
[scene]
frames = [1, 12]

[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], vertices = [12, 12], plane = "xz" }
density = 0.2
pins = ["top_left", "top_right"]

[cloth.springs]
damping = 0.01

[collision]
enabled = false
"""


@pytest.fixture
def small_scene(tmp_path):
    """The path of a scene that bakes in no time."""
    path = tmp_path / "small.toml"
    path.write_text(SMALL_SCENE)
    return path


@pytest.fixture
def read_report():
    """Read a report as strict JSON."""

    def refuse(word):
        raise ValueError(f"{word} is no strict JSON")

    def read(folder):
        return json.loads((Path(folder) / "report.json").read_text(), parse_constant=refuse)

    return read
