"""Every task of a developer, by name: `python3 scripts/dev.py COMMAND`.

Each command first makes what it needs (.venv with pinned requirements, the compiled module) and skips what is
already there. Standard library only.
"""

from __future__ import annotations

import sys

if sys.version_info < (3, 9):  # noqa: UP036 - the message is for those who start it with an old Python
    sys.exit("dev.py: Python 3.11 is missing (this is {}.{})".format(*sys.version_info[:2]))

import environment
import verify
from environment import SCRIPTS, VENV, Failed, Missing, heading, run, venv_program


def build(_arguments: list[str]) -> None:
    """the set-up alone: .venv with the release module and everything that the scripts need"""
    environment.set_up(sweeps=True)


def test(arguments: list[str]) -> None:
    """every test, Rust and Python; ends with one line `N passed, N failed` (arguments go to pytest)"""
    if not verify.test(arguments):
        raise SystemExit(1)


def check(_arguments: list[str]) -> None:
    """formatters, linters, documentation build, all with warnings as errors"""
    verify.check()


def demo(arguments: list[str]) -> None:
    """bakes the paper's hanging cloth in embedded Blender: out/demo/ with .blend, cache, picture, video"""
    environment.set_up()
    with heading("Demo"):
        run([venv_program(VENV, "python"), SCRIPTS / "demo.py", *arguments])


def bench(arguments: list[str]) -> None:
    """benchmarks by name, or all: a table and out/bench/NAME.json (BOUCLE_BENCH=quick for less of them)"""
    environment.set_up()
    run([venv_program(VENV, "python"), SCRIPTS / "bench.py", *arguments])


def package(arguments: list[str]) -> None:
    """the extension as out/package/*.zip, one per platform, checked (--here or names: only these; others need root)"""
    import package as packaging

    packaging.package(arguments)


def gui(arguments: list[str]) -> None:
    """the packaged extension in a real Blender's window: pictures in out/gui/ (needs root and the network)"""
    import gui as window
    import package as packaging

    window.require()
    window.gui(packaging.package(["--here"]), arguments)


def blender52(arguments: list[str]) -> None:
    """the tests of the add-on in Blender 5.2 with Python 3.13 (needs root and the network; arguments go to pytest)"""
    environment.set_up(
        other_blenders=True
    )  # some files are made in one version and opened in another
    import blender52 as newest

    newest.test(arguments)


COMMANDS = {
    task.__name__: task for task in (demo, test, build, check, bench, package, gui, blender52)
}


def usage() -> str:
    """The list of commands, a line each."""
    lines = [f"  {name:9} {task.__doc__}" for name, task in COMMANDS.items()]
    return "\n".join(["usage: python3 scripts/dev.py COMMAND", *lines])


def main(words: list[str]) -> int:
    """Run the command that `words` names and return the exit code."""
    if not words or words[0] in {"-h", "--help", "help"}:
        print(usage())
        return 0 if words else 2
    if words[0] not in COMMANDS:
        print(f"dev.py: no command {words[0]!r}: one of {', '.join(COMMANDS)}", file=sys.stderr)
        return 2
    try:
        COMMANDS[words[0]](words[1:])
    except Missing as missing:
        print(f"dev.py: {missing}", file=sys.stderr)
        return 2
    except Failed as failed:
        print(f"dev.py: {failed}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("dev.py: stopped", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
