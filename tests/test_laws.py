"""The table of the laws: every file that it names is there, every setting is one of the scene's, no law is left out."""

import json
import re
import tomllib
from pathlib import Path

import boucle_core
import pytest

SOLVER = Path(__file__).resolve().parent.parent / "rust" / "solver" / "src"
TABLE = (SOLVER / "laws.md").read_text(encoding="utf-8")
ROWS = [
    [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
    for line in TABLE.splitlines()
    if line.startswith("| ") and not line.startswith("| law ")
]
LAWS = [row for row in ROWS if row[4]]
SCENE = {
    "scene": {"frames": [1, 1]},
    "cloth": [{"name": "sheet", "grid": {"size": [1.0, 1.0], "vertices": [3, 3]}}],
}


def keys():
    """Every setting that the table names: (law, section, key, value or None)."""
    for law, _formula, settings, *_rest in LAWS:
        section = None
        for word in re.findall(r"`([^`]+)`", settings):
            found = re.fullmatch(r"(?:\[\[?([\w.]+)\]\]? )?(\w+)(?: = (.+))?", word)
            assert found, f"{law}: {word} is no setting"
            section = found[1] or section
            yield law, section, found[2], found[3]


def with_key(section, key, value):
    """A scene in which a key is set, as JSON."""
    scene = json.loads(json.dumps(SCENE))
    if section == "force":
        scene["force"] = [{"kind": "wind", key: value}]
    elif section == "cloth":
        scene["cloth"][0][key] = value
    elif section.startswith("cloth."):
        scene["cloth"][0][section.removeprefix("cloth.")] = {key: value}
    else:
        scene.setdefault(section, {})[key] = value
    return json.dumps(scene)


def complaint(section, key, value):
    """What the module says against a key, nothing if it takes it."""
    return boucle_core.run_batch([with_key(section, key, value)])[0]["error"] or ""


def test_the_table_is_whole():
    assert len(LAWS) > 55
    for row in ROWS:
        assert len(row) == 5, row
    for law, formula, settings, source, file in LAWS:
        assert formula and settings and source, law
        assert re.fullmatch(r"\[[\w/]+\.rs\]", file), law


def test_every_file_is_there_and_has_a_page():
    named = {row[4].strip("[]") for row in LAWS}
    links = dict(re.findall(r"^\[([\w/.]+)\]: (\S+)$", TABLE, re.MULTILINE))
    assert links == {name: name for name in named}
    assert [name for name in named if not (SOLVER / name).is_file()] == []
    crate = (SOLVER / "lib.rs").read_text(encoding="utf-8")
    pages = dict(re.findall(r"^//! \[([\w/.]+)\]: (\S+)$", crate, re.MULTILINE))
    assert pages == {
        name: name.removesuffix(".rs").removesuffix("/mod") + "/index.html" for name in named
    }


@pytest.mark.parametrize(("section", "key", "value"), [named[1:] for named in keys()])
def test_a_setting_is_one_of_the_scene(section, key, value):
    if value is None:
        told = complaint(section, key, {"no": "such value"})
        assert re.search(rf"\b{key}\b", told) and f"{key} is an unknown key" not in told, told
    else:
        told = complaint(section, key, tomllib.loads(f"value = {value}")["value"])
        assert f"{key} =" not in told and "unknown key" not in told, told


def test_a_setting_that_is_none_is_found():
    told = complaint("cloth.springs", "elasticity", {"no": "such value"})
    assert "elasticity is an unknown key" in told
    assert "integrator =" in complaint("solver", "integrator", "rk5")


@pytest.mark.parametrize(
    ("section", "key"),
    [("cloth.springs", "limiter"), ("solver", "integrator"), ("force", "kind")],
)
def test_no_choice_is_left_out(section, key):
    told = complaint(section, key, "no such word").partition("accepted: ")[2]
    words = set(re.findall(r'"(\w+)"', told)) - {"none"}
    assert len(words) > 2, told
    named = {value.strip('"') for _law, _section, name, value in keys() if name == key and value}
    assert words == named
