"""README's section "The literature": every scene of the literature is there, can be run, has a picture and a test."""

import re
import shlex
import tomllib

import boucle_core
import pytest

from gallery import ROOT, SCENES
from literature import README_PICTURES
from literature_scenes import SYSTEMS

MOST_BYTES = 120_000
"""Of one picture."""
README = (ROOT / "README.md").read_text(encoding="utf-8")
SECTION = README.partition("### The literature\n")[2].partition("\n##")[0]
COMMANDS = re.findall(r"`\.venv/bin/python (scripts/(?:bake|sweep)\.py [^`]+)`", SECTION)
TEST_FILES = [*ROOT.glob("tests/native/*.py"), *ROOT.glob("rust/solver/tests/validation/*.rs")]


def scenes_of(command):
    """The scene that a command of the page runs, from tests/scenes on, and its overrides."""
    script, file, *words = shlex.split(command)
    path = ROOT / file
    if script.endswith("sweep.py"):
        sweep = tomllib.loads(path.read_text(encoding="utf-8"))["sweep"]
        path = path.parent / sweep["scene"]
    assert words[::2] == ["--set"] * len(words[::2])
    return path.resolve().relative_to(SCENES).as_posix(), words[1::2]


def test_every_scene_of_the_literature_is_on_the_page_and_in_the_list():
    files = {f"literature/{path.name}" for path in (SCENES / "literature").iterdir()}
    listed = set().union(*(system.scenes for system in SYSTEMS))
    assert files <= listed
    assert files <= {scenes_of(command)[0] for command in COMMANDS}


def test_every_scene_of_the_literature_says_in_its_head_what_is_its_source_s_and_what_is_ours():
    for path in (SCENES / "literature").iterdir():
        lines = path.read_text(encoding="utf-8").splitlines()
        head = " ".join(line for line in lines if line.startswith("#"))
        assert re.search(r"\b(19|20)\d\d\b", head), f"{path.name}: no year"
        assert "Ours" in head or "ours" in head, path.name


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_of_the_page_can_be_run(command, tmp_path):
    scene, overrides = scenes_of(command)
    overrides = [*overrides, "scene.frames=[1, 2]"]
    report = boucle_core.bake(str(SCENES / scene), str(tmp_path), overrides=overrides)
    assert [row["frame"] for row in report["frames"]] == [1, 2]


def test_every_system_has_a_row_a_small_picture_and_a_test():
    code = "\n".join(path.read_text(encoding="utf-8") for path in TEST_FILES)
    for system in SYSTEMS:
        assert f"(scripts/pictures/literature/{system.name}.jpg)" in SECTION
        assert (README_PICTURES / f"{system.name}.jpg").stat().st_size < MOST_BYTES
        names = re.findall(r"[A-Z]\w+|\d{4}", system.source)
        assert all(name in SECTION for name in names), system.source
        assert system.holds
        for test in system.holds:
            assert re.search(rf"\b(def|fn) {test}\(", code), test
    rows = [line for line in SECTION.splitlines() if line.startswith("| ![")]
    assert len(rows) == len(SYSTEMS) == len(list(README_PICTURES.iterdir()))
    for row in rows:
        assert "scripts/bake.py" in row
