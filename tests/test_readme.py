"""README: commands that the scripts' own parsers take, links that lead somewhere, labels that the panels have."""

import ast
import re
import shlex
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest
from test_house_rules import CRATES, LAYERS

import dev
import gui
import platforms

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
SYMPTOMS = README.partition("### When something looks wrong\n")[2].partition("\n##")[0]
SCRIPT = re.compile(
    r"(?:`|^|^\$ )(?:\.venv/bin/python|python3) (scripts/\w+\.py[^`\n|#]*)", re.MULTILINE
)
DOCUMENTS = [
    ROOT / "README.md",
    *(ROOT / "rust").glob("*/src/**/*.rs"),
    *(ROOT / "rust").glob("*/src/**/*.md"),
    *(ROOT / "scripts").rglob("*.py"),
    *(ROOT / "tests" / "scenes").rglob("*.toml"),
]
"""What tells commands. Those with brackets show a usage, and are no commands."""


def told(pattern):
    """What all documents hold of a pattern."""
    texts = (path.read_text(encoding="utf-8") for path in DOCUMENTS)
    found = {command.strip().rstrip(".;") for text in texts for command in pattern.findall(text)}
    return sorted(command for command in found if not re.search(r"[\[\]{]| COMMAND$", command))


COMMANDS = told(SCRIPT)
PLAYS = told(re.compile(r"blender [^`\n]*--python (?:scripts/)?(play_run\.py -- [^`\n]*)"))

PARSE = """
import argparse, runpy, sys, types

def parse(parser, *words):
    whole(parser, *words)
    print("parsed")
    raise SystemExit(0)

whole, argparse.ArgumentParser.parse_args = argparse.ArgumentParser.parse_args, parse
sys.modules.setdefault("bpy", types.ModuleType("bpy"))
sys.argv = sys.argv[1:]
sys.path.insert(0, "scripts")
runpy.run_path(sys.argv[0], run_name="__main__")
"""
"""Runs a script up to where its own parser has taken the words."""


def parsed(*words):
    """What comes of giving words to the parser of a script: its exit code, what it prints, what it complains of."""
    command = [sys.executable, "-c", PARSE, *words]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)


def test_the_commands_are_found():
    assert len(COMMANDS) > 35
    assert {"scripts/dev.py demo", "scripts/dev.py test"} <= set(COMMANDS)
    assert len(PLAYS) > 2


@pytest.mark.parametrize("command", [c for c in COMMANDS if not c.startswith("scripts/dev.py")])
def test_the_script_s_own_parser_takes_a_command_whose_files_are_there(command):
    words = shlex.split(command)
    done = parsed(*words)
    assert done.stdout.endswith("parsed\n"), done.stderr
    assert [
        word for word in words if word.startswith("tests/") and not (ROOT / word).exists()
    ] == []


@pytest.mark.parametrize("command", [c for c in COMMANDS if c.startswith("scripts/dev.py ")])
def test_a_task_is_one_of_those_of_dev_py(command):
    _script, task, *words = shlex.split(command)
    assert task in dev.COMMANDS
    known = {
        "bench": {"all", *(p.stem[6:] for p in (ROOT / "scripts").glob("bench_*.py"))},
        "gui": {*gui.PARTS, "--readme"},
        "package": {"--here", *(one.name for one in platforms.PLATFORMS)},
    }
    assert set(words) <= known.get(task, set())


@pytest.mark.parametrize("command", PLAYS)
def test_the_player_s_own_parser_takes_a_command(command):
    done = parsed("scripts/play_run.py", *shlex.split(command)[1:])
    assert done.stdout.endswith("parsed\n"), done.stderr


def test_a_command_that_no_parser_takes_is_found():
    assert parsed("scripts/bake.py", "--frame", "1:2", "scene.toml").stdout == ""
    assert parsed("scripts/play_run.py", "--", "run", "--renders").returncode == 2


def test_other_programs_are_told_what_they_know():
    for code in re.findall(r'--python-expr "([^"]+)"', README):
        ast.parse(code)
    for word in re.findall(r"-m pytest (\S+)`", README):
        assert (ROOT / word).exists()
    for name in set(re.findall(r"`[^`]*\b(BOUCLE_[A-Z0-9_]+)\b", README)):
        files = [path for path in DOCUMENTS if path.suffix == ".py"]
        files += [*(ROOT / "tests").rglob("*.py")]
        assert any(
            f'"{name}"' in path.read_text(encoding="utf-8") for path in files
        ) or re.fullmatch(r"BOUCLE_BPY\d+_PYTHON", name), name
    for word in re.findall(r"^\.venv/bin/dask (\w+) (.*?)(?:#.*)?$", README, re.MULTILINE):
        dask = Path(sys.executable).with_name("dask")
        known = subprocess.run(
            [dask, word[0], "--help"], capture_output=True, text=True, timeout=120
        )
        for option in re.findall(r"--[\w-]+", word[1]):
            assert option in known.stdout or not dask.exists(), option


@pytest.mark.parametrize("target", sorted(set(re.findall(r"\]\(([^)\s]+)\)", README))))
def test_a_link_leads_somewhere(target):
    assert not target.startswith("http"), "README is whole without the network"
    path, _, heading = target.partition("#")
    assert not path or (ROOT / path).exists()
    if heading:
        titles = re.findall(r"^#+ (.+)$", README, re.MULTILINE)
        assert heading in {
            re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles
        }


def test_no_row_stands_outside_a_table():
    lines = README.splitlines()
    for number, line in enumerate(lines):
        if re.match(r"\|-", line):
            assert lines[number - 1].startswith("|"), f"line {number + 1}: a table without a head"
        elif line.startswith("|") and not lines[number - 1].startswith("|"):
            assert re.match(r"\|-", lines[number + 1]), f"line {number + 1}: rows without a table"


def test_labels_of_the_symptoms_are_those_of_the_interface():
    labels = re.findall(r"\*([^*]+)\*", SYMPTOMS.partition("|---")[2])
    assert len(labels) > 20
    code = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "addon").rglob("*.py"))
    for label in {part for words in labels for part in words.split(" > ")}:
        known = f'"{label}"' in code or label in BLENDERS
        assert known, f"{label!r} stands nowhere in the interface"


BLENDERS = {"Outer Thickness", "Friction", "Subdivision", "Collision"}
"""What Blender itself calls so."""


def test_the_architecture_page_shows_every_part_and_only_what_may_be_imported():
    picture = (
        README.partition("### Who imports whom\n")[2].partition("```text\n")[2].partition("```")[0]
    )
    table = README.partition("### Who imports whom\n")[2].partition("\n### ")[0]
    for crate in CRATES:
        assert f"`rust/{crate.removeprefix('boucle-')}`" in table
    chain = picture.partition("\n")[0].split("<-")
    crates = [f"boucle-{part.split()[0]}" for part in chain[:4]]
    for below, crate in pairwise(crates):
        assert below in CRATES[crate]
    for line in picture.splitlines()[1:2]:
        parts = line.partition("<-")
        assert {part.strip() for part in parts[2].split(",")} == {
            part for part, allowed in LAYERS.items() if allowed and "core" in allowed
        }
    above = {part.strip() for part in chain[-1].split(",")}
    assert above == {part for part, allowed in LAYERS.items() if allowed and "bridge" in allowed}
    assert "native" in LAYERS["bridge"] and "addon/native.py" in chain[-3]
    assert (
        LAYERS["panels"] == {"_identifiers"}
        and "addon/panels: property values and identifiers" in picture
    )
