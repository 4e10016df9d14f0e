"""README: commands that can be started with the words told, links that lead somewhere, labels that the panels have."""

import re
import shlex
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

import dev

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
SCRIPT = re.compile(r"(?:\.venv/bin/python|python3) (scripts/\w+\.py[^`\n|#]*)")
COMMANDS = sorted({found.strip() for found in SCRIPT.findall(README)})
SYMPTOMS = README.partition("### When something looks wrong\n")[2].partition("\n\nThe paper")[0]


@cache
def usage(script):
    """What a script tells of itself."""
    words = [sys.executable, ROOT / script, "--help"]
    told = subprocess.run(words, capture_output=True, text=True, check=True, timeout=120)
    return told.stdout


def test_the_commands_are_found():
    assert len(COMMANDS) > 25
    assert {"scripts/dev.py demo", "scripts/dev.py test"} <= set(COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_is_there_and_takes_its_options_and_files(command):
    script, *words = shlex.split(command)
    assert (ROOT / script).is_file()
    if script == "scripts/dev.py":
        assert not words or words[0] in dev.COMMANDS
        return
    for word in words:
        if word.startswith("--"):
            assert re.search(rf"{word}\b", usage(script)), f"{script} has no {word}"
        elif word.startswith("tests/"):
            assert (ROOT / word).is_file()


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
