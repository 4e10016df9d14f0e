"""Grabbing without a window: the logic behind the operator, and the operator with stand-ins for mouse and viewport."""

import pytest


def hand(obj):
    """A grab, and a function that takes steps of it."""
    import bpy
    from cloths import addon

    def depsgraph():
        return bpy.context.evaluated_depsgraph_get()

    grab = addon("bridge.grab").Grab(obj, bpy.context.scene, depsgraph())

    def move_on(count):
        for _ in range(count):
            step = grab.step(depsgraph())
            step.run()
            grab.show(step)

    return grab, move_on, depsgraph


def grab_and_let_go(shown_by):
    import bpy
    from cloths import add_cloth, addon, farthest, mesh_positions, play, world_positions
    from mathutils import Vector

    obj = add_cloth(columns=17, rows=9, end=60)
    obj.location.z = 0.5
    if shown_by == "cache":
        obj.shape_key_add()
        obj.modifiers.new("Subdivision", "SUBSURF")
    play(1, 4)
    rest = mesh_positions(obj) if shown_by == "cache" else None
    session = addon("bridge.live").session_of(obj)
    grab, move_on, depsgraph = hand(obj)
    direction = Vector((1.0, 0.3, 0.0)).normalized()
    # 0.3 m across the view, and no farther from the pins than the cloth is long.
    aside = Vector((-0.3, 1.0, 0.37)).normalized() * 0.3
    begin = world_positions(obj)[8]
    origin = begin + Vector((0.0, 0.0, 0.03)) - 5.0 * direction
    out = {"misses": grab.pick(origin + Vector((0.0, 0.0, 9.0)), direction, depsgraph())}
    out["hits"] = grab.pick(origin, direction, depsgraph())
    out["picked"] = [grab.grip.vertex, len(grab.grip.vertices)]
    strain = 0.0
    for part in range(1, 25):
        grab.drag(origin + aside * min(1.0, part / 12), direction, direction)
        move_on(1)
        strain = max(strain, session.frames.nearest(4).certificate["max_strain"])
    held = world_positions(obj)[8]
    grab.let_go()
    move_on(14)
    back = world_positions(obj)[8]
    out |= {
        "off": (held - begin - aside).length,
        "strain": strain,
        "back": (back - begin).dot(aside) / aside.length,
        "frame": bpy.context.scene.frame_current,
        "poll": bpy.ops.boucle.bake.poll(),
    }
    grab.end()
    out["poll after"] = bpy.ops.boucle.bake.poll()
    out["kept"] = (world_positions(obj)[8] - back).length
    play(5, 6)
    out["status"] = obj.boucle.status
    out["goes on"] = (world_positions(obj)[8] - back).length
    bpy.ops.boucle.reset()
    if rest:
        out["rest"] = farthest(mesh_positions(obj), rest)
    else:
        out["rest"] = abs(min(mesh_positions(obj)[2::3]) + 0.5)
    return out


@pytest.mark.parametrize("shown_by", ["mesh", "cache"])
def test_a_vertex_that_a_ray_finds_is_dragged_and_swings_back(blender, shown_by):
    out = blender.run(grab_and_let_go, shown_by=shown_by)
    assert (out["misses"], out["hits"]) == (False, True)
    vertex, count = out["picked"]
    assert vertex == 8 and 3 <= count <= 12
    assert out["off"] < 0.005
    assert out["strain"] < 0.101
    assert out["back"] < 0.2
    assert out["frame"] == 4 and not out["poll"] and out["poll after"]
    assert out["kept"] < 1e-6 and out["goes on"] > 1e-4
    assert out["status"].startswith("Live: frames 4 to 6")
    assert out["rest"] < 1e-6


def drive_the_operator():
    import time
    from contextlib import nullcontext

    import bpy
    from cloths import add_cloth, addon, farthest, mesh_positions, play
    from mathutils import Matrix, Quaternion

    obj = add_cloth(columns=9, rows=9, end=60)
    module = addon("operators.grab")

    class Any:
        def __init__(self, **values):
            self.__dict__.update(values)

    calls = []
    view = Any(
        view_rotation=Quaternion((0.7071068, 0.7071068, 0.0, 0.0)),
        view_matrix=Matrix(),
        is_perspective=False,
    )
    region = Any(type="WINDOW", x=100, y=50, width=400, height=400)
    side = Any(type="UI", x=450, y=50, width=50, height=400)
    overlay = Any(show_wireframes=False)
    area = Any(
        type="VIEW_3D", width=400, height=400, regions=[side, region],
        spaces=Any(active=Any(overlay=overlay, region_3d=view)),
        header_text_set=calls.append, tag_redraw=lambda: None,
    )  # fmt: skip
    manager = Any(
        event_timer_add=lambda _seconds, **_: "timer",
        event_timer_remove=calls.append,
        modal_handler_add=lambda _operator: None,
    )
    context = Any(
        window=Any(screen=Any(areas=[area])), area=area, object=obj, scene=bpy.context.scene,
        window_manager=manager, temp_override=lambda **_: nullcontext(),
        evaluated_depsgraph_get=bpy.context.evaluated_depsgraph_get,
    )  # fmt: skip
    module.view3d_utils = Any(
        region_2d_to_origin_3d=lambda _r, _v, at: ((at[0] - 200) / 200, -5.0, (at[1] - 200) / 400),
        region_2d_to_vector_3d=lambda _r, _v, _at: (0.0, 1.0, 0.0),
    )
    said = []

    class Grabbing(module._Grabbing):
        def report(self, _kinds, text):
            said.append(text)

    def event(kind, value="PRESS", x=300, y=60, alt=False):
        return Any(type=kind, value=value, mouse_x=x, mouse_y=y, alt=alt)

    operator = Grabbing()
    out = {"begun": list(operator.invoke(context, event("NONE")))}

    def move_on(count):
        for _ in range(count):
            operator._next = 0.0
            operator.modal(context, event("TIMER"))
            while not operator._worker.is_done(1.0):
                time.sleep(0.01)

    move_on(4)
    answers = {}
    for name, what in {
        "wheel": event("WHEELUPMOUSE"), "middle": event("MIDDLEMOUSE"), "walk": event("ACCENT_GRAVE"),
        "swipe": event("TRACKPADPAN"), "undo": event("Z"), "sidebar": event("LEFTMOUSE", x=470),
        "elsewhere": event("Z", x=20), "wires": event("O"), "picture": event("P"),
    }.items():  # fmt: skip
        answers[name] = list(operator.modal(context, what))
    operator.modal(context, event("LEFTMOUSE"))
    out["picked"] = operator._grab.grip.vertex
    operator.modal(context, event("MOUSEMOVE", "NOTHING", x=340))
    move_on(20)
    out["dragged"] = mesh_positions(obj)[3 * out["picked"]]
    operator.modal(context, event("LEFTMOUSE", "RELEASE"))
    out["open"] = operator._grab.grip is None
    out["wires"] = overlay.show_wireframes
    out["ended"] = list(operator.modal(context, event("RIGHTMOUSE")))
    shape = mesh_positions(obj)
    bpy.ops.ed.undo_push(message="after the grab")
    play(1, 1)
    out["kept"] = farthest(mesh_positions(obj), shape)
    out["calls"] = [bool(calls[0]), *calls[1:]]
    again = Grabbing()
    again.invoke(context, event("NONE"))
    obj.boucle.stretch = 700.0
    out["changed"] = list(again.modal(context, event("TIMER")))
    out["rest"] = abs(min(mesh_positions(obj)[2::3]) + 0.5)
    out["script"] = bpy.ops.boucle.grab.poll()
    return {**out, "answers": answers, "said": said}


def test_the_operator_grabs_with_the_mouse_and_leaves_the_rest_to_blender(blender):
    out = blender.run(drive_the_operator)
    assert out["begun"] == ["RUNNING_MODAL"]
    passed = ["PASS_THROUGH"]
    answers = out["answers"]
    for name in ("wheel", "middle", "walk", "swipe", "sidebar", "elsewhere"):
        assert answers[name] == passed, name
    for name in ("undo", "wires", "picture"):
        assert answers[name] == ["RUNNING_MODAL"], name
    assert out["wires"] and "cannot be drawn into a picture" in out["said"][0]
    assert out["picked"] == 4 and out["dragged"] == pytest.approx(0.2, abs=0.03)
    assert out["open"] and out["ended"] == ["FINISHED"] and out["kept"] < 1e-7
    assert out["calls"] == [True, "timer", None]
    assert out["changed"] == ["CANCELLED"] and "grab anew" in out["said"][-1]
    assert out["rest"] < 1e-6 and out["script"]
