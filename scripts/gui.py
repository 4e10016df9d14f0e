"""The add-on in a real Blender's window: `python3 scripts/dev.py gui [WORD...]`.

Numbered: a Debian 13 folder with Blender and an X server; the zip of this machine; that zip installed in a fresh Blender;
a scenario (gui_scenario.py) that runs inside the window; a table of its steps. Blender asks for what it cannot do itself,
key strokes, mouse moves and photographs of the screen, by lines in a file (gui_inside.py); this script does them.
Standard library only.
"""

from __future__ import annotations

import contextlib
import json
import shutil
import subprocess
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import debian
from environment import OUT, ROOT, SCRIPTS, Failed, heading, run, stop

PACKAGES = ("blender", "xvfb", "xdotool", "imagemagick", "libgl1-mesa-dri")
FOLDER = OUT / "gui"
README_PICTURES = SCRIPTS / "pictures" / "path"
SCREEN = (1920, 3700)
"""Tall enough for every panel of the Physics tab at once."""
WINDOW = (1280, 960)
SECONDS = 900
"""The whole scenario takes about five minutes; a window that hangs must not hold us up."""
LONG_SECONDS = 2400
PARTS = {"path": 1, "long": 3}
"""Scenarios of their own and how many Blenders they take, one after another."""
KILLED = -9
ACTION_SECONDS = 30
RING = 16
"""Radius (pixels) of what marks the place of a click in a picture."""
HARMLESS = ("ALSA", "AL lib")


def require() -> None:
    """Make the folder with Blender in it, before anything is built.

    Raises:
        Missing: This system cannot.
    """
    debian.ensure(*PACKAGES)


def gui(zip_file: Path, words: Sequence[str] = ()) -> None:
    """Install `zip_file` in a fresh Blender and play the scenario in its window.

    Args:
        zip_file: The extension.
        words: Only steps whose names hold one of these; all of them if there are none. Or the name of a scenario of its own,
            first: "path", the way of a new user, whose pictures --readme puts into scripts/pictures/path; "long", a bake of
            minutes that is stopped, resumed and killed (--frames=N: of fewer than 250).

    Raises:
        Failed: A step failed; the table says which.
    """
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    if words[:1] == ["path"]:
        shutil.copy2(zip_file, FOLDER)  # it is installed in the window
    else:
        install(zip_file)
    steps = []
    for part in range(PARTS.get(words[0], 1) if words else 1):
        own = [words[0], part, *words[1:]] if words and words[0] in PARTS else words
        with heading("Play the scenario in Blender's window"), x_server() as display:
            code = play(display, own)
        steps += json.loads((FOLDER / "talk" / "steps.json").read_text(encoding="utf-8"))
        steps += closing_steps(code)
    print(table(steps))
    print(f"pictures: {FOLDER.relative_to(ROOT)}/*.png")
    if "--readme" in words:
        renew_readme()
    bad = [step["name"] for step in steps if step["state"] not in {"ok", "skipped", "killed"}]
    if bad:
        raise Failed(f"in the window: {', '.join(bad)}")


def install(zip_file: Path) -> None:
    """Install the extension by Blender's command line."""
    with heading(f"Install {zip_file.name} in Blender"):
        command = ["blender", "--command", "extension", "install-file", "-r", "user_default", "-e"]
        run(blender([*command, zip_file]), timeout=180)


def blender(words: list[object], **variables: str) -> list[str]:
    """The command that runs Blender in the folder, with a profile of our own."""
    for name in ("profile", "home"):
        (FOLDER / name).mkdir(exist_ok=True)
    own = {"BLENDER_USER_RESOURCES": str(FOLDER / "profile"), "HOME": str(FOLDER / "home")}
    return debian.inside(words, shared=[ROOT], **own, **variables)


@contextlib.contextmanager
def x_server() -> Iterator[str]:
    """A virtual screen; yields the name of its display."""
    size = "x".join(map(str, SCREEN))
    command = ["Xvfb", "-displayfd", "1", "-screen", "0", f"{size}x24", "-nolisten", "tcp"]
    process = subprocess.Popen(
        debian.inside(command), stdout=subprocess.PIPE, text=True, start_new_session=True
    )
    try:
        number = process.stdout.readline().strip()
        if not number:
            raise Failed("the X server did not start")
        yield f":{number}"
    finally:
        stop(process)


def play(display: str, chosen: Sequence[str]) -> int | None:
    """Run Blender with the scenario, do what it asks; its exit code, or None if it had to be stopped."""
    from_below = SCREEN[1] - WINDOW[1]  # as Blender counts
    geometry = ["--window-geometry", 0, from_below, *WINDOW]
    talk = FOLDER / "talk"
    shutil.rmtree(talk, ignore_errors=True)
    talk.mkdir()
    seconds = LONG_SECONDS if chosen[:1] == ["long"] else SECONDS
    words = ["blender", *geometry, "--python", SCRIPTS / "gui_inside.py", "--", talk, *chosen]
    with (FOLDER / "blender.log").open("w") as log:
        process = subprocess.Popen(
            blender(words, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1"),
            stdout=log,
            stderr=subprocess.STDOUT,
            cwd=ROOT,
            start_new_session=True,
        )
        try:
            return serve(process, display, time.monotonic() + seconds)
        finally:
            stop(process)


def serve(process: subprocess.Popen, display: str, until: float) -> int | None:
    """Do what Blender asks for, in order, until it ends or the time is up."""
    requests = FOLDER / "talk" / "requests.jsonl"
    done = 0
    while time.monotonic() < until:
        code = process.poll()
        text = requests.read_text(encoding="utf-8") if requests.exists() else ""
        for line in text.split("\n")[done:-1]:
            request = json.loads(line)
            if request["do"] == "kill":
                stop(process)
                steps = requests.parent / "steps.json"
                steps.write_text(steps.read_text().replace("not run", "killed"), encoding="utf-8")
                return KILLED
            act(request, display)
            done += 1
            (requests.parent / f"done-{done}").touch()
        if code is not None:
            return code
        time.sleep(0.05)
    return None


def renew_readme() -> None:
    """Put small copies of the path's pictures into scripts/pictures/path."""
    README_PICTURES.mkdir(parents=True, exist_ok=True)
    for picture in sorted(FOLDER.glob("path_*.png")):
        target = README_PICTURES / f"{picture.stem.removeprefix('path_')}.jpg"
        command = ["convert", picture, "-quality", 84, "-strip", target]
        run(debian.inside(command, shared=[ROOT]), timeout=ACTION_SECONDS)
        print(f"{target.relative_to(ROOT)}: {target.stat().st_size / 1000:.0f} kB")


def act(request: dict, display: str) -> None:
    """Do one thing that Blender asked for: a key, a text, a move of the mouse, a photograph."""
    for command in commands(request):
        words = debian.inside(command, shared=[FOLDER], DISPLAY=display)
        run(words, timeout=ACTION_SECONDS)


def commands(request: dict) -> list[list[object]]:
    """The programs that do what a request asks for."""
    kind = request["do"]
    if kind == "key":
        return [["xdotool", "key", "--clearmodifiers", request["key"]]]
    if kind == "type":
        return [["xdotool", "type", "--delay", 40, request["text"]]]
    if kind == "move":
        return [["xdotool", "mousemove", *request["to"]]]
    if kind in {"press", "release"}:
        return [["xdotool", "mousedown" if kind == "press" else "mouseup", request["button"]]]
    if kind == "resize":
        search = ["xdotool", "search", "--onlyvisible", "--class", "Blender"]
        return [[*search, "windowsize", *(request["size"] or WINDOW)]]
    if kind == "photo":
        left, top, width, height = request["part"] or (0, 0, *WINDOW)
        part = ["-crop", f"{width}x{height}+{left}+{top}", "+repage"]
        picture = FOLDER / f"{request['name']}.png"
        taken = [["import", "-window", "root", *part, picture]]
        if request.get("mark"):
            x, y = request["mark"][0] - left, request["mark"][1] - top
            ring = ["-fill", "none", "-stroke", "#ff9900", "-strokewidth", 3]
            taken.append(["mogrify", *ring, "-draw", f"circle {x},{y} {x + RING},{y}", picture])
        return taken
    raise ValueError(f"{kind!r} is nothing that can be done")


def closing_steps(code: int | None) -> list[dict]:
    """What is judged from outside: how Blender ended, and what its console says."""
    ends = {
        0: ("ok", "exit code 0"),
        KILLED: ("ok", "killed, as asked"),
        None: ("failed", "stopped: the time was up"),
    }
    state, detail = ends.get(code, ("failed", f"exit code {code}"))
    text = (FOLDER / "blender.log").read_text(encoding="utf-8", errors="replace")
    told = [line for line in text.splitlines() if is_complaint(line)]
    return [
        {"name": "quit", "state": state, "detail": detail, "seconds": 0.0},
        {
            "name": "console",
            "state": "failed" if told else "ok",
            "detail": told[0] if told else "no error",
            "seconds": 0.0,
        },
    ]


def is_complaint(line: str) -> bool:
    """Whether a line of Blender's console tells of something wrong."""
    words = ("Traceback", "Error", "error:", "Boucle:")
    return any(word in line for word in words) and not any(word in line for word in HARMLESS)


def table(steps: list[dict]) -> str:
    """The steps as lines of text: name, state, seconds, detail."""
    wide = max(len(step["name"]) for step in steps)
    return "\n".join(
        f"  {step['name']:{wide}}  {step['state']:7}  {step['seconds']:5.1f} s  {step['detail']}"
        for step in steps
    )
