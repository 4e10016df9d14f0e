"""A bake to which faults are done: how it is started, what it leaves undisturbed, and whether that is what it left."""

from __future__ import annotations

import json
import re
import struct
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

SCRIPTS = Path(__file__).resolve().parents[1]
LIMIT = 300.0
"""Seconds that no small bake takes."""
HEAD = 32
"""Bytes before the samples of a cache."""
CURES = re.compile(
    r"accepted: |free disk space|bake again|bake (?:them )?from the start|bring the file back|go on with"
)
TIMED = {"seconds", "total_seconds", "peak_memory_bytes", "bake"}
"""What differs from bake to bake: times, memory, and the add-on's name for each."""

CONTACT = """
[scene]
frames = [1, FRAMES]
[collision]
thickness = 0.02
[[cloth]]
name = "lower"
grid = { size = [1, 1], vertices = [9, 9], plane = "xy" }
[[cloth]]
name = "upper"
grid = { size = [0.8, 0.8], vertices = [7, 7], plane = "xy", center = [0, 0, 0.06] }
[[collider]]
name = "ball"
sphere = { center = [0, 0, -0.55], radius = 0.5 }
"""
TEARING = """
[scene]
frames = [1, FRAMES]
[collision]
thickness = 0.02
[tear]
enabled = true
strain = 0.3
[[cloth]]
name = "sheet"
grid = { size = [1, 1], vertices = [7, 9], plane = "xz" }
pins = ["top"]
springs = { stretch = 20, shear = 5, bend = 0.1, limiter = "none" }
[cloth.tear]
openings = [{ frame = 6, pairs = [[28, 29], [29, 30], [30, 31], [31, 32], [32, 33], [33, 34]] }]
"""


@dataclass(frozen=True)
class Subject:
    """One kind of bake, and what it leaves when nothing happens."""

    name: str
    command: tuple[str, ...]
    """But for the folder and `--resume`."""
    folder_option: tuple[str, ...] = ()
    undisturbed: Path = Path()

    def words(self, out: Path, resume: bool) -> list[str]:
        """The command line of a bake into a folder."""
        return [*self.command, *self.folder_option, str(out), *(["--resume"] if resume else [])]

    def start(self, out: Path, resume: bool = False, **options: Any) -> subprocess.Popen:
        """Start a bake into a folder."""
        pipe = subprocess.PIPE
        return subprocess.Popen(
            self.words(out, resume), stdout=pipe, stderr=pipe, text=True, **options
        )

    def run(self, out: Path, resume: bool = False, **options: Any) -> subprocess.CompletedProcess:
        """Bake into a folder, to the end or to what ends it."""
        words = self.words(out, resume)
        return subprocess.run(words, capture_output=True, text=True, timeout=LIMIT, **options)


def headless(name: str, scene: Path, *more: str) -> Subject:
    """A scene file that bake.py bakes."""
    words = (sys.executable, str(SCRIPTS / "bake.py"), str(scene), "--quiet", "--threads", "1")
    return Subject(name, (*words, *more), ("--out",))


def addon(name: str, kind: str, *more: str) -> Subject:
    """The add-on's own bake."""
    words = (sys.executable, str(SCRIPTS / "faulting" / "addon_bake.py"), kind)
    return Subject(name, (*words, *more))


def subjects(folder: Path, frames: int) -> list[Subject]:
    """Scenes with contact and with tears, by bake.py and by the add-on, each baked once without a fault."""
    made = []
    for name, text in (("contact", CONTACT), ("tearing", TEARING)):
        scene = folder / f"{name}.toml"
        scene.write_text(text.replace("FRAMES", str(frames)), encoding="utf-8")
        made.append(headless(f"bake.py, {name}", scene))
        made.append(addon(f"add-on, {name}", name))
    out = []
    for number, subject in enumerate(made):
        whole = folder / f"undisturbed{number}"
        done = subject.run(whole)
        if done.returncode != 0:
            raise RuntimeError(f"{subject.name} cannot be baked: {done.stderr}")
        out.append(Subject(subject.name, subject.command, subject.folder_option, whole))
    return out


def left(folder: Path) -> dict[str, Any]:
    """What a finished bake has left, without what differs from bake to bake."""
    return {path.name: _content(path) for path in sorted(folder.iterdir())}


def _content(path: Path) -> Any:
    data = path.read_bytes()
    if path.suffix == ".json":
        return untimed(json.loads(data))
    if path.name == "boucle.checkpoint":
        rows = struct.unpack_from("<Q", data, 40)[0]
        told = [untimed(json.loads(row)) for row in data[48 : 48 + rows].splitlines()]
        return data[:32], told, data[48 + rows : -8]
    if path.suffix == ".checkpoint":
        magic, head, state = data[:-16].split(b"\n", 2)
        return magic, untimed(json.loads(head)), state
    return data


def untimed(value: Any) -> Any:
    """JSON without what differs from bake to bake."""
    if isinstance(value, Mapping):
        return {key: untimed(of) for key, of in value.items() if key not in TIMED}
    return [untimed(one) for one in value] if isinstance(value, list) else value


def lost(subject: Subject, out: Path) -> str:
    """What of the frames so far is not as in the undisturbed bake; empty if all is."""
    for path in out.glob("*.pc2") if out.is_dir() else ():
        data, whole = path.read_bytes(), (subject.undisturbed / path.name).read_bytes()
        if len(data) < HEAD:
            continue  # it was just begun, and holds no frame
        if data[16:20] != whole[16:20]:
            continue  # of a torn cloth, gathered before its last tears
        size = 12 * struct.unpack_from("<i", data, 16)[0]
        end = HEAD + size * struct.unpack_from("<i", data, 28)[0]
        if len(data) < end or data[HEAD:end] != whole[HEAD:end]:
            return f"{path.name} holds other frames than were baked"
    for path in out.glob("*.json") if out.is_dir() else ():
        rows = untimed(json.loads(path.read_bytes()))["frames"]
        whole = untimed(json.loads((subject.undisturbed / path.name).read_bytes()))["frames"]
        if rows != whole[: len(rows)]:
            return f"{path.name} has other rows than were baked"
    return ""


def refused(done: subprocess.CompletedProcess, *codes: int) -> str:
    """What is wrong with how a bake refused; empty if it is one sentence with a cure."""
    said = done.stderr.strip()
    if done.returncode not in codes:
        return f"exit code {done.returncode}, not {codes}: {said[-200:]}"
    if said.count("\n") or "Traceback" in said or not CURES.search(said):
        return f"no sentence with a cure: {said[-200:]}"
    return ""


def differs(subject: Subject, out: Path) -> str:
    """In what a finished bake differs from the undisturbed one; empty if in nothing."""
    mine, whole = left(out), left(subject.undisturbed)
    if mine.keys() != whole.keys():
        return f"other files: {sorted(mine.keys() ^ whole.keys())}"
    return ", ".join(f"{name} differs" for name in mine if mine[name] != whole[name])


def resumed(subject: Subject, out: Path, **options: Any) -> str:
    """Go on to the end; in what that differs from the undisturbed bake, or why it ended."""
    done = subject.run(out, resume=True, **options)
    if done.returncode != 0:
        return f"cannot go on: exit code {done.returncode}: {done.stderr.strip()[-300:]}"
    return differs(subject, out)


@dataclass
class Row:
    """A line of the table: a fault, how often it was done, what broke."""

    fault: str
    subject: str
    tried: int = 0
    broke: list[str] = field(default_factory=list)
    said: str = ""
    """What the user is told, once."""

    def note(self, trouble: str, where: str) -> None:
        """Count a try, and keep what broke in it."""
        self.tried += 1
        if trouble:
            self.broke.append(f"{where}: {trouble}")
