"""Plays the scenario inside a Blender with a window: `blender --python gui_inside.py -- FOLDER [WORD...]`, from gui.py.

Words choose the steps whose names hold one of them.

A step of the scenario is a generator that Blender's own timer pulls, so that the window lives between two pulls. It yields
seconds to wait, or a request to the script outside, which is written as a line to requests.jsonl and answered by a file
done-N. What became of each step stands in steps.json from the first moment on.
"""

from __future__ import annotations

import importlib
import json
import sys
import time
import traceback
from collections.abc import Callable, Generator, Iterable, Sequence
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))  # Blender runs this file from its text alone

from gui_scenario import Skipped

Step = Generator[Any, None, str | None]
OWN_WORDS = ("path", "long")
"""Scenarios that are played only if asked for by name: gui_NAME.py; a number after it is the part for this Blender."""
USUAL = ("gui_scenario", "gui_labels", "gui_overlay", "gui_live")
"""What is played otherwise, in this order."""
PAUSE = 0.05
"""Seconds between two looks for an answer."""


class Player:
    """Pulls one step after another; a step that fails ends the play."""

    def __init__(self, folder: Path, steps: Iterable[Callable[[], Step]]) -> None:
        """Begin with nothing done."""
        self._folder = folder
        self._steps = [*steps]
        self._told = [
            {"name": name_of(step), "state": "not run", "detail": "", "seconds": 0.0}
            for step in self._steps
        ]
        self._requests = 0
        self._at = 0
        self._running: Step | None = None
        self._began = 0.0
        self._write()

    def tick(self) -> float | None:
        """What the timer calls: go on, and say after how many seconds to come back."""
        if self._requests and not (self._folder / f"done-{self._requests}").exists():
            return PAUSE
        if self._at == len(self._steps):
            bpy.ops.wm.quit_blender()
            return None
        if self._running is None:
            self._running, self._began = self._steps[self._at](), time.monotonic()
        try:
            wanted = next(self._running)
        except StopIteration as end:
            self._tell("ok", end.value or "")
        except Skipped as skipped:
            self._tell("skipped", str(skipped))
        except Exception as error:  # noqa: BLE001 (whatever it is, the table tells it)
            traceback.print_exc()
            where = traceback.extract_tb(error.__traceback__)[-1]
            self._tell(
                "failed", f"{error or type(error).__name__} (line {where.lineno}: {where.line})"
            )
            self._at = len(self._steps)
        else:
            return self._do(wanted)
        return PAUSE

    def _do(self, wanted: float | dict[str, Any]) -> float:
        if not isinstance(wanted, dict):
            return float(wanted)
        with (self._folder / "requests.jsonl").open("a", encoding="utf-8") as file:
            file.write(json.dumps(wanted) + "\n")
        self._requests += 1
        return PAUSE

    def _tell(self, state: str, detail: str) -> None:
        seconds = time.monotonic() - self._began
        self._told[self._at].update(state=state, detail=detail, seconds=seconds)
        print(f"step {self._told[self._at]['name']}: {state} {detail}", flush=True)
        self._at += 1
        self._running = None
        self._write()

    def _write(self) -> None:
        text = json.dumps(self._told, indent=1)
        (self._folder / "steps.json").write_text(text, encoding="utf-8")


def name_of(step: Callable[[], Step]) -> str:
    """A step's name in words."""
    return step.__name__.replace("_", " ")


def chosen_steps(words: Sequence[str]) -> list[Callable[[], Step]]:
    """The steps of the named scenario, or those of the usual one whose names hold one of the words."""
    if words and words[0] in OWN_WORDS:
        return [*importlib.import_module(f"gui_{words[0]}").PHASES[int(words[1])]]
    steps = [step for name in USUAL for step in importlib.import_module(name).STEPS]
    return [step for step in steps if not words or any(word in name_of(step) for word in words)]


def main(folder: str, *words: str) -> None:
    """Start the play as soon as the window stands."""
    bpy.context.preferences.view.show_splash = False
    player = Player(Path(folder), chosen_steps(words))
    bpy.app.timers.register(player.tick, first_interval=2.0, persistent=True)


if __name__ == "__main__":
    main(*sys.argv[sys.argv.index("--") + 1 :])
