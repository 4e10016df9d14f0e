"""Which lines the tests reach: `python3 scripts/line_coverage.py [rust|python]`; both, if none is named.

Of the crates geometry, solver and scene by their own tests (cargo-tarpaulin), and of addon/core by the tests that need no
Blender (coverage). Prints the share of lines of each part and the files in which most are missed, and leaves the numbers of the
missed lines in out/coverage/missed.json. The exit code is 1 where a part is under 90 %.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from bench import table
from environment import OUT, ROOT, VENV, require_rust, set_up, venv_program

LEAST = 0.9
CRATES = ("geometry", "solver", "scene")
TARPAULIN = "0.37.5"
FOLDER = OUT / "coverage"
WORST = 8
"""How many of the files that are least reached are named."""


@dataclass(frozen=True)
class File:
    """Lines of a source file that can be reached, and those that are not."""

    path: Path
    lines: int
    missed: list[int]

    def row(self) -> list[object]:
        """A row of the table."""
        return [self.path.as_posix(), self.lines, share([self])]


def share(files: list[File]) -> str:
    """The part of lines that are reached, in words."""
    return f"{100 * reached(files):.1f} %"


def reached(files: list[File]) -> float:
    """The part of lines that are reached."""
    lines = sum(file.lines for file in files)
    return 1.0 - sum(len(file.missed) for file in files) / max(1, lines)


def rust() -> dict[str, list[File]]:
    """The files of each crate, by its own tests and those of the crates above it."""
    if shutil.which("cargo-tarpaulin") is None:
        sys.exit(
            f"line_coverage.py: no cargo-tarpaulin: `cargo install cargo-tarpaulin --version {TARPAULIN} --locked`"
        )
    command = ["cargo", "tarpaulin", "--engine", "llvm", "--skip-clean", "--timeout", "1800"]
    for crate in CRATES:
        command += ["--packages", f"boucle-{crate}"]
    command += ["--exclude-files", "*/tests.rs", "*/tests/*", "*/benches/*", "*/examples/*"]
    command += ["--target-dir", ROOT / "target" / "coverage"]
    command += ["--out", "Json", "--output-dir", FOLDER]
    subprocess.run(command, cwd=ROOT, check=True)
    report = json.loads((FOLDER / "tarpaulin-report.json").read_text(encoding="utf-8"))
    parts: dict[str, list[File]] = {f"rust/{crate}": [] for crate in CRATES}
    for entry in report["files"]:
        path = Path(*entry["path"]).relative_to(ROOT)
        part = path.parent.as_posix().partition("/src")[0]
        if part in parts:
            missed = [trace["line"] for trace in entry["traces"] if not hits(trace)]
            parts[part].append(File(path, len(entry["traces"]), missed))
    return parts


def hits(trace: dict) -> int:
    """How often a line was reached."""
    return trace["stats"].get("Line", 0)


def python() -> dict[str, list[File]]:
    """The files of addon/core, by the tests that need no Blender."""
    set_up()
    program = [venv_program(VENV, "python"), "-m", "coverage"]
    data = f"--data-file={FOLDER / 'python.data'}"
    tests = ["-m", "pytest", "--quiet", "tests/core", "tests/properties"]
    command = [*program, "run", data, "--source=addon/core", *tests]
    subprocess.run(command, cwd=ROOT, check=True)
    told = FOLDER / "python.json"
    subprocess.run([*program, "json", data, "--quiet", "-o", told], cwd=ROOT, check=True)
    report = json.loads(told.read_text(encoding="utf-8"))
    files = [
        File(Path(name), found["summary"]["num_statements"], found["missing_lines"])
        for name, found in report["files"].items()
    ]
    return {"addon/core": files}


def main() -> int:
    """Read the command and do it."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("languages", nargs="*", metavar="LANGUAGE", help="rust, python")
    words = parser.parse_args()
    ways = {"rust": rust, "python": python}
    unknown = [name for name in words.languages if name not in ways]
    if unknown:
        parser.error(f"no language {unknown[0]!r}: one of {', '.join(ways)}")
    require_rust()
    FOLDER.mkdir(parents=True, exist_ok=True)
    parts = {}
    for name in words.languages or ways:
        parts |= ways[name]()
    files = [file for part in parts.values() for file in part]
    missed = {file.path.as_posix(): file.missed for file in files if file.missed}
    (FOLDER / "missed.json").write_text(json.dumps(missed, indent=1), encoding="utf-8")
    worst = sorted(files, key=lambda file: len(file.missed), reverse=True)[:WORST]
    print(table(["file", "lines", "reached"], [file.row() for file in worst]))
    rows = [[name, sum(f.lines for f in part), share(part)] for name, part in parts.items()]
    print(table(["part", "lines", "reached"], rows))
    return 1 if any(reached(part) < LEAST for part in parts.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
