"""What an artist does with a cloth in Blender's window, step by step; each step says what it saw or fails.

Runs inside Blender, pulled by gui_inside.py: a step yields seconds to wait, or what the script outside shall do with keys,
mouse and camera.
"""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d

MODULE = "bl_ext.user_default.boucle"
ANSWER_SECONDS = 0.1
"""A window that takes longer to answer feels stuck. What drawing takes comes on top, twice of what it takes at rest: here
software draws, on the cores that simulate."""
TALL = (1920, 3600)
BAKE_COLUMNS, BAKE_END = 64, 5000
"""A bake that no machine ends before Esc."""
FRAMES_MORE, FRAMES_MORE_SECONDS = 10, 240
PLAY_FRAMES, PLAY_SECONDS = 12, 60

Step = Iterator[Any]


class Skipped(Exception):
    """A step that cannot be done here; the message says why."""


class Answers:
    """How long the window took to answer: the gaps between the ticks of a timer that wants to tick always."""

    def __init__(self) -> None:
        """Begin to measure."""
        self._last = time.monotonic()
        self._gaps: list[float] = []
        self._timer = self._tick  # Blender knows a timer by its identity
        bpy.app.timers.register(self._timer, first_interval=0.0)

    def _tick(self) -> float:
        now = time.monotonic()
        self._gaps.append(now - self._last)
        self._last = now
        return 0.0

    def end(self) -> tuple[float, str]:
        """Stop; seconds that 95 % of the answers keep to, and the whole in words."""
        bpy.app.timers.unregister(self._timer)
        gaps = sorted([*self._gaps, time.monotonic() - self._last])
        usual, most = gaps[len(gaps) // 2], gaps[int(len(gaps) * 0.95)]
        return most, (
            f"{len(gaps)} answers: half in {usual:.3f} s, 95 % in {most:.3f} s, all in {gaps[-1]:.3f} s"
        )


def window() -> bpy.types.Window:
    """The only window."""
    return bpy.context.window_manager.windows[0]


def area(kind: str) -> bpy.types.Area:
    """The window's area of a kind."""
    return next(area for area in window().screen.areas if area.type == kind)


def in_view() -> bpy.types.bpy_struct:
    """The context of a mouse over the viewport."""
    view = area("VIEW_3D")
    region = next(region for region in view.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=window(), area=view, region=region)


def cloth() -> bpy.types.Object:
    """The cloth that the scenario added."""
    return next(obj for obj in bpy.context.scene.objects if obj.type == "MESH")


def on_screen(x: float, y: float) -> tuple[int, int]:
    """A place in the window, counted from its top as the X server does."""
    return round(x), round(window().height - y)


def over_view() -> dict:
    """Move the mouse over the viewport, which then gets the keys."""
    view = area("VIEW_3D")
    to = on_screen(view.x + view.width / 2, view.y + view.height * 0.3)
    return {"do": "move", "to": to}


def key(name: str) -> dict:
    """Press a key, by its X name."""
    return {"do": "key", "key": name}


def draw(kind: type = bpy.types.SpaceView3D, seconds: float = 20.0) -> Step:
    """Wait until the window was drawn anew, as an editor of this kind tells, and a moment more for the screen to show it."""
    drawn: list[bool] = []
    handler = kind.draw_handler_add(drawn.append, (True,), "WINDOW", "POST_PIXEL")
    until = time.monotonic() + seconds
    try:
        while len(drawn) < 2:
            assert time.monotonic() < until, f"the window was not drawn within {seconds} s"
            for each in window().screen.areas:
                each.tag_redraw()
            yield 0.1
    finally:
        kind.draw_handler_remove(handler, "WINDOW")
    yield 0.5


def answers(seconds: float = 5.0) -> Step:
    """Measure for a while how a window that is always drawn anew answers; without the viewport, which software draws slowly."""
    view = area("VIEW_3D")
    view.type = "CONSOLE"
    yield 1.0
    measured = Answers()
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        for each in window().screen.areas:
            each.tag_redraw()
        yield 0.0
    result = measured.end()
    view.type = "VIEW_3D"
    yield 0.1
    return result


def photo(name: str, part: bpy.types.Area | None = None) -> Step:
    """Photograph the window or one area, after it was drawn anew."""
    yield from draw() if part is None else draw(type(part.spaces.active))
    box = None
    if part is not None:
        left, top = on_screen(part.x, part.y + part.height)
        box = (left, top, part.width, part.height)
    yield {"do": "photo", "name": name, "part": box}


def sag(obj: bpy.types.Object) -> float:
    """How far (m) the lowest vertex hangs below the lowest one of the rest shape, which ends at -1 m."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return -1.0 - min(vertex.co.z for vertex in evaluated.data.vertices)


def is_baking() -> bool:
    """Whether a bake runs."""
    return not bpy.ops.boucle.bake.poll()


def the_installed_extension() -> Step:
    """The zip's own module is loaded, not one that lies about."""
    import boucle_core

    yield from draw(seconds=120.0)  # software compiles the shaders first
    assert MODULE in bpy.context.preferences.addons, "the extension is not enabled"
    profile = Path(bpy.utils.resource_path("USER"))
    assert profile in Path(boucle_core.__file__).parents, boucle_core.__file__
    return f"Blender {bpy.app.version_string}, boucle_core {boucle_core.__version__}"


def add_from_the_menu() -> Step:
    """Shift A, type the name, Enter."""
    for obj in [*bpy.data.objects]:
        bpy.data.objects.remove(obj)
    yield over_view()
    with in_view():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_mesh_add")
    yield from photo("add_menu")
    yield key("Escape")
    yield 0.5
    yield key("shift+a")
    yield 1.0
    yield {"do": "type", "text": "sheet"}
    yield 1.0
    yield key("Return")
    yield 1.5
    found = [obj.name for obj in bpy.data.objects]
    assert found == ["Cloth"], f"after Shift A, the name and Enter the scene holds {found}"
    assert cloth().boucle.enabled
    with in_view():
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_all(center=True)
    yield 1.0
    yield from photo("added")
    return f"{len(cloth().data.vertices)} vertices"


def open_every_panel() -> Step:
    """The Physics tab with each panel open."""
    panels = panel_classes()
    for kind in reversed(panels):
        bpy.utils.unregister_class(kind)
    for kind in panels:  # all of them, so that their order stays
        kind.bl_options = set(getattr(kind, "bl_options", ())) - {"DEFAULT_CLOSED"}
        bpy.utils.register_class(kind)
    yield from photo_of_panels("panels")
    yield from photo("physics_tab")
    return f"{len(panels)} panels"


def photo_of_panels(name: str) -> Step:
    """Photograph the whole Physics tab, in a window that is tall enough for the moment."""
    view, properties = area("VIEW_3D"), area("PROPERTIES")
    properties.spaces.active.context = "PHYSICS"
    view.type = "CONSOLE"  # software draws a large viewport slowly
    yield {"do": "resize", "size": TALL}
    yield 2.0
    assert window().height == TALL[1], f"the window has a height of {window().height}"
    yield from photo(name, properties)
    yield {"do": "resize", "size": None}
    view.type = "VIEW_3D"
    yield 1.0


def panel_classes() -> list[type]:
    """Every panel of ours, in the order of registration."""
    return [kind for kind in sys.modules[MODULE]._CLASSES if issubclass(kind, bpy.types.Panel)]


def play_live() -> Step:
    """Space plays, Space stops."""
    yield over_view()
    yield key("space")
    yield 1.0
    assert window().screen.is_animation_playing, "Space does not play"
    until = time.monotonic() + PLAY_SECONDS
    while bpy.context.scene.frame_current < PLAY_FRAMES:
        assert time.monotonic() < until, f"{PLAY_FRAMES} frames take more than {PLAY_SECONDS} s"
        yield 0.1
    yield key("space")
    yield 1.0
    assert not window().screen.is_animation_playing
    assert sag(cloth()) > 0.005, f"the cloth hangs {sag(cloth())} m lower than at rest"
    yield from photo("live")
    return cloth().boucle.status


def bake_and_stop_with_escape() -> Step:
    """The modal bake; Esc keeps what is done."""
    for obj in [*bpy.data.objects]:
        bpy.data.objects.remove(obj)
    with in_view():
        bpy.ops.boucle.add_cloth(vertices_x=BAKE_COLUMNS, vertices_y=BAKE_COLUMNS)
    cloth().boucle.frame_end = BAKE_END
    bpy.context.scene.frame_set(1)
    with in_view():
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_all(center=True)
    yield over_view()
    at_rest, said_at_rest = yield from answers()
    yield from begin_bake(resume=False)
    seconds, said = yield from answers()
    said = f"{said}; at rest {said_at_rest}"
    assert seconds <= 2.0 * at_rest + ANSWER_SECONDS, said
    assert is_baking(), f"the bake had ended before Esc: {cloth().boucle.status}"
    yield from photo("baking")
    pressed = time.monotonic()
    yield key("Escape")
    while is_baking():
        assert time.monotonic() - pressed < 10.0, "the bake goes on 10 s after Esc"
        yield 0.05
    status = cloth().boucle.status
    assert status.startswith("Partly baked: frames 1 to"), status
    yield from photo("stopped")
    return f"{status}; {said}"


def begin_bake(resume: bool) -> Step:
    """Start the modal operator as the panel's button does."""
    with in_view():
        begun = bpy.ops.boucle.bake("INVOKE_DEFAULT", resume=resume)
    assert begun == {"RUNNING_MODAL"}, begun
    yield 0.5


def resume_to_the_end() -> Step:
    """Resume goes on where Esc stopped, to an end that is nearer now."""
    end = int(re.search(r"frames 1 to (\d+)", cloth().boucle.status)[1]) + FRAMES_MORE
    cloth().boucle.frame_end = end
    yield from begin_bake(resume=True)
    began = time.monotonic()
    while is_baking():
        assert time.monotonic() - began < FRAMES_MORE_SECONDS, "the bake does not end"
        yield 0.2
    status = cloth().boucle.status
    assert status.startswith(f"Baked: frames 1 to {end}"), status
    bpy.context.scene.frame_set(end)
    yield 0.5
    assert sag(cloth()) > 0.005, f"the baked cloth hangs {sag(cloth())} m lower than at rest"
    yield from photo("baked")
    yield from photo_of_panels("panels_baked")
    return status


def undo_and_redo() -> Step:
    """Ctrl Z and Ctrl Shift Z with a bake."""
    yield over_view()
    bpy.ops.ed.undo_push(message="before")
    cloth().location.x = 0.25
    bpy.ops.ed.undo_push(message="moved")
    yield key("ctrl+z")
    yield 1.0
    assert cloth().location.x == 0.0, "Ctrl Z does not undo"
    yield key("ctrl+shift+z")
    yield 1.0
    assert cloth().location.x == 0.25, "Ctrl Shift Z does not redo"
    status = cloth().boucle.status
    assert status.startswith("Baked"), status
    return status


def grab_with_the_mouse() -> Step:
    """Take a free vertex and drag it."""
    if "grab" not in dir(bpy.ops.boucle):
        raise Skipped("there is no operator boucle.grab")
    with in_view():
        bpy.ops.boucle.free_bake()
        bpy.context.scene.frame_set(1)
    yield 1.0
    start = seen_at(len(cloth().data.vertices) // 2 + BAKE_COLUMNS // 2)
    yield {"do": "move", "to": start}
    with in_view():
        begun = bpy.ops.boucle.grab("INVOKE_DEFAULT")
    assert begun == {"RUNNING_MODAL"}, begun
    yield {"do": "press", "button": 1}
    for way in range(1, 16):
        yield {"do": "move", "to": (start[0] + 8 * way, start[1] - 6 * way)}
    yield from photo("grabbed")
    yield {"do": "release", "button": 1}
    yield 0.5
    yield key("Escape")
    yield 0.5
    assert sag(cloth()) != 0.0, "nothing moved"
    return cloth().boucle.status


def seen_at(vertex: int) -> tuple[int, int]:
    """Where in the window a vertex of the cloth is seen."""
    evaluated = cloth().evaluated_get(bpy.context.evaluated_depsgraph_get())
    place = evaluated.matrix_world @ evaluated.data.vertices[vertex].co
    view = area("VIEW_3D")
    region = next(region for region in view.regions if region.type == "WINDOW")
    x, y = location_3d_to_region_2d(region, view.spaces[0].region_3d, place)
    return on_screen(region.x + x, region.y + y)


def save_and_open_again() -> Step:
    """The bake belongs to the saved file."""
    if not cloth().boucle.is_baked:
        yield from begin_bake(resume=False)
        while is_baking():
            yield 0.2
    path = Path(bpy.utils.resource_path("USER")).parent / "saved" / "cloth.blend"
    path.parent.mkdir(exist_ok=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    yield 2.0
    status = cloth().boucle.status
    assert status.startswith("Baked"), status
    bpy.context.scene.frame_set(cloth().boucle.frame_end)
    assert sag(cloth()) > 0.005, f"the baked cloth hangs {sag(cloth())} m lower than at rest"
    yield from photo("opened_again")
    return status


STEPS = (
    the_installed_extension,
    add_from_the_menu,
    open_every_panel,
    play_live,
    bake_and_stop_with_escape,
    resume_to_the_end,
    undo_and_redo,
    grab_with_the_mouse,
    save_and_open_again,
)
