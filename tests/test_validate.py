"""scripts/validate.py: its table, its page, what a wrong reference does, and that its rows name tests that exist."""

import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from validation import overview, reference
from validation.chapters import CHAPTERS, not_measured, rows_of
from validation.row import Finding, Range, Row, Tolerance

ROOT = Path(__file__).resolve().parents[1]
PICTURE = ROOT / "scripts" / "pictures" / "validation.png"
MOST_BYTES = 200_000


def validate(*words):
    command = [sys.executable, str(ROOT / "scripts" / "validate.py"), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


@pytest.fixture(scope="module")
def integrators(tmp_path_factory):
    """A run of one quick chapter, and its folder."""
    out = tmp_path_factory.mktemp("validation")
    return validate("--only", "integrators", "--out", out), out


def test_a_chapter_that_holds_is_told_row_by_row_and_ends_with_0(integrators):
    done, out = integrators
    assert done.returncode == 0, done.stdout + done.stderr
    head, *lines = done.stdout.splitlines()
    for word in ("row", "quantity", "result", "reference", "error", "tolerance"):
        assert word in head
    rows = rows_of("integrators")
    for row, line in zip(rows, lines, strict=False):
        assert line.startswith(row.name)
        assert line.endswith("pass")
    assert f"{len(rows)} of {len(rows)} rows hold" in lines[len(rows)]
    assert (out / "overview.png").read_bytes().startswith(b"\x89PNG")


def test_the_page_needs_nothing_but_itself(integrators):
    page = (integrators[1] / "report.html").read_text(encoding="utf-8")
    for outside in ("http", "src=", "@import", "<script", "<link", "file:"):
        assert outside not in page, outside
    assert all(address.startswith("#") for address in re.findall(r'href="([^"]*)"', page))
    assert all(address.startswith("#") for address in re.findall(r"url\(([^)]*)\)", page))


def test_the_page_shows_of_every_row_a_plot_numbers_source_and_test(integrators):
    page = (integrators[1] / "report.html").read_text(encoding="utf-8")
    cards = re.findall(r"<article.*?</article>", page, re.DOTALL)
    rows = rows_of("integrators")
    assert len(cards) == len(rows)
    for row, card in zip(rows, cards, strict=True):
        assert row.name in card
        assert "<svg" in card
        for word in ("result", "reference", "error", "source", "test"):
            assert f"<dt>{word}</dt>" in card
        assert row.test in card
    ids = re.findall(r' id="([^"]*)"', page)
    assert len(ids) == len(set(ids))


def test_what_is_not_measured_is_said(integrators):
    page = (integrators[1] / "report.html").read_text(encoding="utf-8")
    assert "Hessian" in page


def test_a_wrong_reference_makes_a_red_row_and_exit_code_1(tmp_path):
    tables = tmp_path / "tables"
    shutil.copytree(reference.TABLES, tables)
    path = tables / reference.INTEGRATORS
    text = path.read_text(encoding="utf-8")
    wrong = re.sub(r"^rk4,0\.5,[^,]*", "rk4,0.5,1.5", text, flags=re.MULTILINE)
    assert wrong != text
    path.write_text(wrong, encoding="utf-8")
    out = tmp_path / "out"
    done = validate("--only", "integrators", "--tables", tables, "--out", out)
    assert done.returncode == 1, done.stderr
    failed = [line for line in done.stdout.splitlines() if line.endswith("FAIL")]
    assert [line.split("  ")[0] for line in failed] == ["Runge-Kutta 4: energy factor a step"]
    page = (out / "report.html").read_text(encoding="utf-8")
    assert page.count('<article class="card failed"') == 1
    assert page.count('<tr class="failed">') == 1
    assert 'class="bad"><strong>34 of 35 rows hold' in page


def test_a_table_that_is_missing_is_told_in_a_row_and_the_other_chapters_run(tmp_path):
    tables = tmp_path / "tables"
    shutil.copytree(reference.TABLES, tables)
    (tables / reference.LATTICES).unlink()
    words = ["--only", "lattice", "statics", "--tables", tables, "--out", tmp_path / "out"]
    done = validate(*words)
    assert done.returncode == 1
    (failed,) = [line for line in done.stdout.splitlines() if "FAIL" in line]
    assert failed.startswith("the rows of chapter lattice")
    assert "lattice_stability.csv" in failed
    assert "7 of 8 rows hold" in done.stdout


@pytest.mark.parametrize("words", [["--only", "weather"], ["--tables", "nowhere"]])
def test_wrong_use_ends_with_2(words, tmp_path):
    done = validate(*words, "--out", tmp_path)
    assert done.returncode == 2
    assert words[1] in done.stderr


def test_a_row_that_breaks_down_fails_with_the_message():
    def burst():
        raise RuntimeError("the strip burst")

    result = Row("statics", "a strip", "drop", "m", "closed form", "", burst).run()
    assert not result.has_passed
    assert "the strip burst" in result.message


@pytest.mark.parametrize(
    ("result", "reference_value", "tolerance", "passes"),
    [
        (1.01, 1.0, Tolerance(0.02), True),
        (1.03, 1.0, Tolerance(0.02), False),
        (-1.0, 1.0, Tolerance(0.02), False),
        (float("nan"), 1.0, Tolerance(0.02), False),
        (0.1, 0.0, Tolerance(0.2, is_relative=False), True),
        (0.0, Range(0, 0), None, True),
        (1.0, Range(0, 0), None, False),
        (float("nan"), Range(0, 1), None, False),
    ],
)
def test_a_row_holds_only_within_its_tolerance(result, reference_value, tolerance, passes):
    finding = Finding(result, reference_value)
    row = Row("statics", "a row", "drop", "m", "closed form", "", lambda: finding, tolerance)
    assert row.run().has_passed is passes


def test_rows_have_names_of_their_own_sources_and_tests_that_exist():
    texts = [path.read_text(encoding="utf-8") for path in (ROOT / "rust").rglob("*.rs")]
    texts += [path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("*.py")]
    known = set(re.findall(r"(?:fn|def) (\w+)\(", "\n".join(texts)))
    rows = [row for chapter in CHAPTERS for row in rows_of(chapter)]
    assert len({row.name for row in rows}) == len(rows)
    for row in rows:
        assert row.source, row.name
        # Those of the instruments' own tests are not told.
        tests = [] if row.chapter == "drape" else row.test.split(", ")
        assert [test for test in tests if test not in known] == [], row.name
    for _what, why in not_measured():
        for test in re.findall(r"\bthe_matrix_\w+", why):
            assert test in known, test
    shown = set(overview.SHOWN) - {row.name for row in rows}
    assert all(name.startswith(("Cusick", "cantilever of ASTM")) for name in shown), shown
    assert (find_spec("instruments") is None) is bool(shown)


def test_the_readme_shows_the_picture_and_tells_the_command():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "scripts/pictures/validation.png" in text
    assert "scripts/validate.py" in text
    assert PICTURE.stat().st_size < MOST_BYTES
