"""A long bake in Blender's window: what the window answers and what memory does meanwhile, Esc, Resume, and a kill.

Three Blenders, one after another. The first bakes, is stopped by Esc at a random frame, plays what is there and resumes.
The second bakes the same file anew and is killed at a random moment. The third opens the file, looks at what is left and
resumes: the bytes must be those of the first. Runs inside Blender, pulled by gui_inside.py.
"""

from __future__ import annotations

import hashlib
import json
import os
import random
import shutil
import struct
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy

from gui_scenario import (
    ANSWER_SECONDS,
    Answers,
    answers,
    area,
    begin_bake,
    in_view,
    is_baking,
    key,
    over_view,
)

COLUMNS = 128
END = next((int(word[9:]) for word in sys.argv if word.startswith("--frames=")), 250)
STOPPED_AMONG, KILLED_AMONG = (0.08, 0.24), (0.1, 0.6)
"""Parts of the bake between which Esc is pressed, and between which Blender is killed."""
WAIT = 1500.0
MOST_GROWTH = 0.1
"""Of the memory, from the bake's second quarter to its last."""

Step = Iterator[Any]


def cloth_of_scene() -> bpy.types.Object:
    """The only cloth."""
    return next(obj for obj in bpy.context.scene.objects if obj.boucle.enabled)


def folder() -> Path:
    """Where the scene lies, for all three."""
    found = Path(bpy.utils.resource_path("USER")).parent / "long"
    found.mkdir(exist_ok=True)
    return found


def memory() -> float:
    """What this Blender holds of the machine's memory (MB)."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def cache() -> Path:
    """The cloth's only PC2."""
    found = [*folder().glob("boucle_cache/**/*.pc2")]
    assert len(found) == 1, found
    return found[0]


def count_of(path: Path) -> int:
    """Samples in a PC2, by its header; all of them must be there."""
    head = path.read_bytes()[:32]
    vertices, samples = struct.unpack_from("<i", head, 16)[0], struct.unpack_from("<i", head, 28)[0]
    assert path.stat().st_size >= 32 + 12 * vertices * samples, "the file is shorter than it says"
    return samples


def digest() -> str:
    """Of the PC2's bytes."""
    return hashlib.sha256(cache().read_bytes()).hexdigest()


def some_frame(among: tuple[float, float]) -> int:
    """A frame between two parts of the bake, another one every time."""
    return 1 + round(END * random.SystemRandom().uniform(*among))


def quiet() -> None:
    """No viewport: here software draws, on the cores that simulate."""
    area("VIEW_3D").type = "CONSOLE"


def until_done(watch: Any = lambda: None) -> Step:
    """Wait for the bake's end."""
    until = time.monotonic() + WAIT
    while is_baking():
        assert time.monotonic() < until, f"the bake takes more than {WAIT:.0f} s"
        watch()
        yield 0.25


def a_sheet_and_a_ball_that_moves_through_it() -> Step:
    """The scene, saved before anything is baked."""
    for obj in [*bpy.data.objects]:
        bpy.data.objects.remove(obj)
    scene = bpy.context.scene
    scene.frame_set(1)
    scene.frame_start, scene.frame_end = 1, END
    with in_view():
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.4, segments=32, ring_count=16)
        ball = bpy.context.object
        ball.modifiers.new("Collision", "COLLISION")
        for frame, y in ((1, -1.5), (60, 0.6), (120, -0.6), (180, 0.8), (250, -1.0)):
            ball.location = (0.2, y, -0.3)
            ball.keyframe_insert("location", frame=frame)
        bpy.ops.boucle.add_cloth(vertices_x=COLUMNS, vertices_y=COLUMNS)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder() / "long.blend"))
    yield 0.5
    return f"{COLUMNS} x {COLUMNS}, {END} frames"


def bake_until_escape() -> Step:
    """Esc at a random frame; what is there plays."""
    yield over_view()
    at = some_frame(STOPPED_AMONG)
    yield from begin_bake(resume=False)
    quiet()
    until = time.monotonic() + WAIT
    while bpy.context.scene.frame_current < at:
        assert time.monotonic() < until
        yield 0.05
    pressed = time.monotonic()
    yield key("Escape")
    while is_baking():
        assert time.monotonic() - pressed < 30.0, "the bake goes on 30 s after Esc"
        yield 0.02
    took = time.monotonic() - pressed
    area("CONSOLE").type = "VIEW_3D"
    last = count_of(cache())
    status = cloth_of_scene().boucle.status
    assert status.startswith(f"Partly baked: frames 1 to {last} of {END}"), status
    assert lowest(last) < lowest(1) - 1e-3, "the partial cache does not play"
    return f"Esc at frame {at}, answered in {took:.2f} s; {status}"


def lowest(frame: int) -> float:
    """The lowest vertex (m) of the cloth at a frame."""
    bpy.context.scene.frame_set(frame)
    seen = cloth_of_scene().evaluated_get(bpy.context.evaluated_depsgraph_get())
    return min(vertex.co.z for vertex in seen.data.vertices)


def resume_and_measure() -> Step:
    """To the end, with the window's answers and the memory."""
    at_rest, said_at_rest = yield from answers()
    first = count_of(cache())
    held: list[float] = []
    yield from begin_bake(resume=True)
    quiet()
    measured, began = Answers(), time.monotonic()
    yield from until_done(lambda: held.append(memory()))
    seconds = time.monotonic() - began
    most, said = measured.end()
    assert count_of(cache()) == END, cloth_of_scene().boucle.status
    (folder() / "told.json").write_text(json.dumps({"digest": digest()}), encoding="utf-8")
    quarter = len(held) // 4
    before, after = max(held[quarter : 2 * quarter]), max(held[-quarter:])
    told = (
        f"{seconds / (END - first):.2f} s a frame; {said}; at rest {said_at_rest}; memory {held[0]:.0f} MB at the "
        f"start, {before:.0f} in the second quarter, {after:.0f} in the last; load {os.getloadavg()[0]:.1f}"
    )
    assert most <= 2.0 * at_rest + ANSWER_SECONDS, told
    assert after <= before * (1.0 + MOST_GROWTH), told
    return told


def bake_until_killed() -> Step:
    """The same anew; this step has no end."""
    shutil.rmtree(folder() / "boucle_cache")
    bpy.ops.wm.open_mainfile(filepath=str(folder() / "long.blend"))
    yield 1.0
    yield from begin_bake(resume=False)
    quiet()
    at, log = some_frame(KILLED_AMONG), folder() / "frame.txt"
    until = time.monotonic() + WAIT
    while bpy.context.scene.frame_current < at:
        assert time.monotonic() < until
        # The scene comes to a frame when the one before it is written.
        log.write_text(str(bpy.context.scene.frame_current - 1), encoding="ascii")
        yield 0.0
    yield random.SystemRandom().uniform(0.0, 0.5)
    yield {"do": "kill"}
    yield 60.0
    raise AssertionError("nobody killed this Blender")


def open_what_is_left_and_resume() -> Step:
    """At most the frame under way is lost, and the end has the same bytes."""
    told = int((folder() / "frame.txt").read_text(encoding="ascii"))
    kept = count_of(cache())
    assert kept >= told, f"{told} frames were written, {kept} are there"
    bpy.ops.wm.open_mainfile(filepath=str(folder() / "long.blend"))
    yield 1.0
    status = cloth_of_scene().boucle.status
    assert status.startswith(f"Partly baked: frames 1 to {kept} of {END}"), status
    yield from begin_bake(resume=True)
    quiet()
    yield from until_done()
    wanted = json.loads((folder() / "told.json").read_text(encoding="utf-8"))["digest"]
    assert count_of(cache()) == END
    assert digest() == wanted, "the resumed bake has other bytes"
    return f"killed with {kept} frames written ({told} when last seen), all are there; resumed: the same bytes"


PHASES = (
    (a_sheet_and_a_ball_that_moves_through_it, bake_until_escape, resume_and_measure),
    (bake_until_killed,),
    (open_what_is_left_and_resume,),
)
"""Steps of each Blender."""
