"""Checks and tests of the whole project, and their one-line count.

Standard library only.
"""

from __future__ import annotations

import contextlib
import os
import re
import subprocess
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from environment import (
    OTHER_BLENDERS,
    OUT,
    ROOT,
    VENV,
    Failed,
    blender_venv,
    ensure_venv,
    exclusive,
    heading,
    require_rust,
    run,
    set_up,
    stop,
    venv_program,
)

CARGO_RESULT = re.compile(r"^test result: \w+\. (\d+) passed; (\d+) failed; (\d+) ignored")
PYTHON_SOURCES = ("addon", "scripts", "tests", "rust/python/boucle_core.pyi")
RUST_TIMEOUT = 1500.0
PYTHON_TIMEOUT = 2100.0


@dataclass
class Count:
    """How many tests went which way, and what went wrong besides."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    faults: list[str] = field(default_factory=list)

    def closing_line(self) -> str:
        """The count as one plain line; a fault without a failed test counts as one."""
        failed = max(self.failed, len(self.faults))
        skipped = f", {self.skipped} skipped" if self.skipped else ""
        return f"{self.passed} passed, {failed} failed{skipped}"


def check() -> None:
    """Formatters, linters and the documentation build; all are run, then any complaint is an error."""
    require_rust()
    with exclusive():
        ensure_venv(VENV, "requirements.txt")
    ruff = venv_program(VENV, "ruff")
    strict = {"RUSTDOCFLAGS": "-D warnings"}
    lint = ["cargo", "clippy", "--workspace", "--all-targets", "--quiet", "--", "-D", "warnings"]
    document = ["cargo", "doc", "--workspace", "--no-deps", "--document-private-items", "--quiet"]
    tasks: list[tuple[str, Callable[[], None]]] = [
        ("Rust format", lambda: run(["cargo", "fmt", "--all", "--check"])),
        ("Rust lints", lambda: run(lint)),
        ("Rust documentation", lambda: run(document, **strict)),
        ("Python format", lambda: run([ruff, "format", "--check", *PYTHON_SOURCES])),
        ("Python lints", lambda: run([ruff, "check", *PYTHON_SOURCES])),
    ]
    faults = []
    for title, task in tasks:
        try:
            with heading(title):
                task()
        except Failed as failed:
            faults.append(f"{title}: {failed}")
    if faults:
        raise Failed("check failed:\n  " + "\n  ".join(faults))
    print(f"check: all {len(tasks)} in order")


def test(arguments: list[str]) -> bool:
    """Run the Rust tests and pytest with `arguments` beside each other; print the closing line; True if all is well."""
    set_up(other_blenders=True, sweeps=True)
    count = Count()
    with heading("Tests"), cargo_tests(count):
        run_pytest(count, arguments)
    for fault in count.faults:
        print(f"fault: {fault}")
    print(count.closing_line(), flush=True)
    return not (count.failed or count.faults)


@contextlib.contextmanager
def cargo_tests(count: Count) -> Iterator[None]:
    """Run the workspace's tests beside what is done inside; then show their output and add their numbers."""
    command = ["cargo", "test", "--workspace", "--no-fail-fast"]
    try:
        with heading("Rust tests built"):
            run([*command, "--no-run", "--quiet"])
    except Failed as failed:
        count.faults.append(str(failed))
        yield
        return
    told = OUT / "test" / "rust.txt"
    told.parent.mkdir(parents=True, exist_ok=True)
    with told.open("wb") as file:
        process = subprocess.Popen(
            command, cwd=ROOT, stdout=file, stderr=file, start_new_session=os.name == "posix"
        )
    try:
        yield
        code = process.wait(RUST_TIMEOUT)
    except subprocess.TimeoutExpired:
        code = f"none within {RUST_TIMEOUT:.0f} s"
    finally:
        stop(process)
    text = told.read_text(encoding="utf-8", errors="replace")
    print(text, flush=True)
    if not count_cargo(count, text) and code != 0:
        count.faults.append(f"cargo test ended with exit code {code}")


def count_cargo(count: Count, text: str) -> int:
    """Add the numbers of cargo's output, and return how many tests have failed in it."""
    failed = 0
    for line in text.splitlines():
        if found := CARGO_RESULT.match(line):
            count.passed += int(found[1])
            failed += int(found[2])
            count.skipped += int(found[3])
    count.failed += failed
    return failed


def run_pytest(count: Count, arguments: list[str]) -> None:
    """Run the Python tests and add the numbers of their XML report."""
    report = OUT / "test" / "pytest.xml"
    report.parent.mkdir(parents=True, exist_ok=True)
    report.unlink(missing_ok=True)
    python = venv_program(VENV, "python")
    command = [python, "-m", "pytest", f"--junitxml={report}", *(arguments or ["tests"])]
    pythons = {}
    for version in OTHER_BLENDERS:
        name = f"BOUCLE_BPY{version.replace('.', '')}_PYTHON"
        own = venv_program(blender_venv(version), "python")
        pythons[name] = os.environ.get(name, str(own))
    try:
        run(command, timeout=PYTHON_TIMEOUT, **pythons)
    except Failed as failed:
        failure = str(failed)
    else:
        failure = ""
    failed_before = count.failed
    if report.exists():
        add_report(count, ElementTree.parse(report).getroot())
    elif not failure:
        failure = "pytest left no report"
    if failure and count.failed == failed_before:
        count.faults.append(failure)


def add_report(count: Count, root: ElementTree.Element) -> None:
    """Add the numbers of a JUnit report; an error in a fixture is a failure."""
    for suite in root.iter("testsuite"):
        numbers = {
            key: int(suite.get(key, "0")) for key in ("tests", "failures", "errors", "skipped")
        }
        bad = numbers["failures"] + numbers["errors"]
        count.failed += bad
        count.skipped += numbers["skipped"]
        count.passed += max(0, numbers["tests"] - bad - numbers["skipped"])
