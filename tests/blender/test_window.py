"""Bake in a window: the modal operator's own code, with stand-ins for the window that the bpy package has not."""


class Manager:
    """Takes the place of a window manager."""

    def __init__(self):
        self.timers = 0
        self.handlers = []
        self.parts = []

    def progress_begin(self, first, last):
        assert (first, last) == (0.0, 1.0)

    def progress_update(self, part):
        self.parts.append(part)

    def progress_end(self):
        self.parts.append(None)

    def event_timer_add(self, _seconds, window):
        del window
        self.timers += 1
        return "timer"

    def event_timer_remove(self, timer):
        assert timer == "timer"
        self.timers -= 1

    def modal_handler_add(self, operator):
        self.handlers.append(operator)


class Workspace:
    """Takes the place of a workspace with its status bar."""

    def __init__(self):
        self.texts = []

    def status_text_set(self, text):
        self.texts.append(text)


def window(cloths):
    import bpy

    class Context:
        window_manager = Manager()
        workspace = Workspace()
        window = None
        screen = None
        scene = bpy.context.scene
        object = cloths[0]

    return Context()


def operator(context, cloths, resume=False):
    """The operator's code without Blender's instance of it."""
    from cloths import addon

    kind = addon("operators.bake")._Baking

    class Baking(kind):
        def __init__(self):
            self.said = []
            self.resume = resume

        def groups(self, _context):
            return [[cloth] for cloth in cloths], []

        def report(self, kinds, text):
            self.said.append([*kinds, text])

    baking = Baking()
    baking._begin(context)
    return baking


class Event:
    """A timer's tick or a key."""

    def __init__(self, kind, value="PRESS"):
        self.type = kind
        self.value = value


def run_to_the_end(baking, context):
    ticks = 0
    while True:
        ticks += 1
        state = baking.modal(context, Event("TIMER"))
        if state != {"RUNNING_MODAL"}:
            return state, ticks
        assert baking.modal(context, Event("MOUSEMOVE")) == {"RUNNING_MODAL"}
        assert ticks < 10_000


def press_esc(baking, context):
    """Press Esc and wait for the end of the bake."""
    state = baking.modal(context, Event("ESC"))
    return state if state != {"RUNNING_MODAL"} else run_to_the_end(baking, context)[0]


def bake_in_a_window():
    import threading

    import bpy
    from cloths import add_cloth, addon, shown_positions

    one, two = add_cloth(end=40, columns=20, rows=20), add_cloth(end=9)
    context = window([one])
    runtime = addon("bridge.runtime")
    threads = set()
    core = addon("core.bake")
    real = core.Step.run
    polled = threading.Event()

    def run(step):
        if step.frame > 1:  # the rest pose is only read
            threads.add(threading.current_thread().name)
            polled.wait(30.0)  # else the bake could end before the first event
        real(step)

    core.Step.run = run
    baking = operator(context, [one, two])
    polls = []
    first = baking.modal(context, Event("TIMER"))
    if first == {"RUNNING_MODAL"}:
        polls.append(bpy.ops.boucle.bake.poll() or "bake" not in runtime.busy)
    polled.set()
    state, _ = run_to_the_end(baking, context)
    core.Step.run = real
    bpy.context.scene.frame_set(40)
    windowed = shown_positions(one)
    bpy.context.view_layer.objects.active = one
    bpy.ops.boucle.bake()
    bpy.context.scene.frame_set(40)
    return {
        "state": list(state),
        "said": baking.said,
        "texts": context.workspace.texts,
        "parts": context.window_manager.parts,
        "timers": context.window_manager.timers,
        "same": windowed == shown_positions(one),
        "status": [one.boucle.status, two.boucle.status],
        "threads": sorted(threads),
        "polls": polls,
        "busy": list(runtime.busy),
    }


def test_a_window_bakes_beside_its_events_and_the_result_is_that_of_a_script(blender):
    result = blender.run(bake_in_a_window)
    assert result["state"] == ["FINISHED"]
    assert [kind for kind, _ in result["said"]] == ["INFO", "INFO"]
    assert result["same"]
    assert result["status"][0].startswith("Baked: frames 1 to 40")
    assert result["status"][1].startswith("Baked: frames 1 to 9")
    assert all(name.startswith("boucle") for name in result["threads"])
    assert not any(result["polls"])
    assert result["timers"] == 0 and result["busy"] == []
    assert result["texts"][-1] is None
    parts = result["parts"]
    assert parts[-1] is None and parts[:-1] == sorted(parts[:-1])
    assert parts[0] < 0.1 and 0.9 < parts[-2] <= 1.0
    assert any(
        "frame 30/40" in text and "Esc stops and keeps" in text for text in result["texts"][:-1]
    )


def stop_in_a_window():
    import bpy
    from cloths import add_cloth, addon, mesh_positions

    obj, never = add_cloth(end=2000, columns=30, rows=30), add_cloth(end=9)
    rest = mesh_positions(obj)
    context = window([obj])
    baking = operator(context, [obj, never])
    while baking._current is None or (baking._current.last_frame or 0) < 5:
        assert baking.modal(context, Event("TIMER")) == {"RUNNING_MODAL"}
    assert baking.modal(context, Event("ESC", "RELEASE")) == {"RUNNING_MODAL"}
    state = press_esc(baking, context)
    stopped = obj.boucle.status
    again = operator(context, [obj], resume=True)
    while again._current is None or (again._current.last_frame or 0) < 14:
        assert again.modal(context, Event("TIMER")) == {"RUNNING_MODAL"}
    again.cancel(context)
    return {
        "state": list(state),
        "said": baking.said,
        "stopped": stopped,
        "cancelled": obj.boucle.status,
        "never": never.boucle.status,
        "timers": context.window_manager.timers,
        "busy": list(addon("bridge.runtime").busy),
        "rest": mesh_positions(obj) == rest,
        "frame": bpy.context.scene.frame_current,
    }


def test_esc_stops_keeps_and_resume_goes_on(blender):
    result = blender.run(stop_in_a_window)
    assert result["state"] == ["FINISHED"]
    assert [kind for kind, _ in result["said"]] == ["WARNING"]
    assert "was stopped" in result["said"][0][1] and "Resume goes on" in result["said"][0][1]
    assert result["stopped"].startswith("Partly baked: frames 1 to ")
    assert result["cancelled"].startswith("Partly baked: frames 1 to ")

    def last(status):
        return int(status.split(" to ")[1].split(" ")[0])

    assert last(result["stopped"]) >= 5
    assert last(result["cancelled"]) >= max(14, last(result["stopped"]))
    assert result["never"].startswith("Not baked")
    assert result["timers"] == 0 and result["busy"] == []
    assert result["rest"] and result["frame"] == 1


def stop_a_long_frame(folder):
    import os
    import time
    from pathlib import Path

    import bpy
    from cloths import add_cloth

    obj = add_cloth(end=6, columns=30, rows=30, integrator="symplectic_euler")
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    context = window([obj])
    baking = operator(context, [obj])
    state, _ = run_to_the_end(baking, context)
    whole = Path(bpy.path.abspath(obj.modifiers["Boucle Cache"].filepath)).read_bytes()
    obj.boucle.substeps = 200_000  # a frame takes minutes
    baking = operator(context, [obj])
    longest, begun = 0.0, time.perf_counter()
    while baking._current is None or baking._current._interrupter is None or not baking._steps:
        baking.modal(context, Event("TIMER"))
    for _ in range(10):
        begin = time.perf_counter()
        assert baking.modal(context, Event("TIMER")) == {"RUNNING_MODAL"}
        longest = max(longest, time.perf_counter() - begin)
    begun = time.perf_counter()
    state = baking.modal(context, Event("ESC"))
    answered, told = time.perf_counter() - begun, context.workspace.texts[-2:]
    if state == {"RUNNING_MODAL"}:
        state, _ = run_to_the_end(baking, context)
    ended = time.perf_counter() - begun
    status = obj.boucle.status
    bpy.ops.boucle.restore_bake()
    again = Path(bpy.path.abspath(obj.modifiers["Boucle Cache"].filepath)).read_bytes()
    return {
        "state": list(state), "answered": answered, "ended": ended, "longest": longest,
        "told": told, "status": status, "said": baking.said, "kept": again == whole,
    }  # fmt: skip


def test_esc_is_answered_at_once_even_in_a_frame_of_minutes(new_blender):
    result = new_blender.run(stop_a_long_frame, folder=new_blender.folder)
    assert result["state"] == ["FINISHED"]
    assert result["longest"] < 0.3 and result["answered"] < 0.3, "0.1 s where nothing else runs"
    assert result["ended"] < 2.0
    assert any("stopping" in (text or "") for text in result["told"])
    assert result["status"].startswith("Partly baked: frames 1 to 1 of 6")
    assert '"Cloth" was stopped; frames up to 1 are kept, Resume goes on' in result["said"][-1][1]
    assert result["kept"]


def lose_the_cloth():
    import bpy
    from cloths import add_cloth, addon

    bad, good = add_cloth(end=2000), add_cloth(end=9)
    bad_name = bad.name
    context = window([bad])
    baking = operator(context, [bad, good])
    assert baking.modal(context, Event("TIMER")) == {"RUNNING_MODAL"}
    bpy.data.objects.remove(bad)
    state, _ = run_to_the_end(baking, context)
    return [
        list(state),
        baking.said,
        good.boucle.status,
        bad_name,
        list(addon("bridge.runtime").busy),
    ]


def test_a_cloth_that_is_deleted_during_its_bake_ends_it_in_one_sentence(blender):
    state, said, other, name, busy = blender.run(lose_the_cloth)
    assert state == ["CANCELLED"]
    assert [kind for kind, _ in said] == ["ERROR", "INFO"]
    assert f'"{name}" is no Boucle cloth any more' in said[0][1]
    assert other.startswith("Baked: frames 1 to 9")
    assert busy == []


def watch_a_bake(folder):
    import bpy
    from cloths import add_cloth, addon

    view, obj = addon("bridge.bake_view"), add_cloth(end=4)
    bpy.ops.wm.save_as_mainfile(filepath=f"{folder}/a.blend")
    begun, seen = [], []
    begin = view.begin

    def watch(paths):
        begun.append(dict(paths))
        begin(paths)

    view.begin = watch
    scene = bpy.context.scene
    scene.frame_set(1)
    known = 0
    bake = addon("bridge.bake").Bake([obj], scene)
    for step in bake.steps():
        if begun:
            count, positions = view.last_frame(begun[0][obj.session_uid].path, known)
            seen.append([step.frame, count, None if positions is None else len(positions)])
            known = count
        step.run()
    path = begun[0][obj.session_uid].path
    again = view.last_frame(path, 4)
    return {
        "seen": seen,
        "vertices": len(obj.data.vertices),
        "again": [again[0], again[1] is None],
        "missing": view.last_frame(path + ".gone", 0),
        "left": [view._handle is None, view._growing],
        "is_last": list(view.last_frame(path, 3)[1]) == [c for v in shown(obj, 4) for c in v],
    }


def shown(obj, frame):
    import bpy

    bpy.context.scene.frame_set(frame)
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return [tuple(vertex.co) for vertex in evaluated.data.vertices]


def test_the_frame_just_baked_can_be_drawn_while_the_bake_goes_on(new_blender, tmp_path):
    found = new_blender.run(watch_a_bake, folder=str(tmp_path))
    size = 3 * found["vertices"]
    assert found["seen"] == [[2, 1, size], [3, 2, size], [4, 3, size]]
    assert found["again"] == [4, True], "nothing new is nothing to draw anew"
    assert found["missing"] == [0, None]
    assert found["left"] == [True, {}]
    assert found["is_last"]
