"""Renders in background: every frame once, no sub-frames, and a missing cache is said."""

import os


def small_render(folder, last=4):
    import bpy

    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.cycles.device = "CPU"
    scene.cycles.use_denoising = False
    scene.render.resolution_x = scene.render.resolution_y = 24
    scene.render.use_motion_blur = True
    scene.render.filepath = os.path.join(folder, "image_")
    scene.render.use_lock_interface = False
    scene.frame_start, scene.frame_end = 1, last
    bpy.ops.object.camera_add(location=(0, -4, 0), rotation=(1.5708, 0, 0))
    scene.camera = bpy.context.object
    bpy.ops.object.light_add(type="SUN", rotation=(1.5708, 0, 0))
    bpy.context.object.data.energy = 5.0


def make_it_dark():
    import bpy

    world = bpy.data.worlds.new("Dark")
    bpy.context.scene.world = world
    world.color = (0, 0, 0)
    for node in world.node_tree.nodes if world.node_tree else ():  # from Blender 5.0 on
        if node.type == "BACKGROUND":
            node.inputs["Strength"].default_value = 0.0


def image_rows(folder, frame):
    """The lowest and highest lit row of an image, from the bottom."""
    import bpy

    image = bpy.data.images.load(os.path.join(folder, f"image_{frame:04d}.png"))
    pixels = list(image.pixels)
    lit = [k // 24 for k in range(24 * 24) if pixels[4 * k] > 0.06]
    bpy.data.images.remove(image)
    return [min(lit), max(lit)]


def render_live(folder, played):
    import bpy
    from cloths import add_cloth, addon, mesh_positions, play, shown_positions

    reference = add_cloth(pin_group="", end=8)
    frames = []
    for frame in range(1, 5):
        play(frame, frame)
        frames.append(mesh_positions(reference))
    bpy.data.objects.remove(reference)
    bpy.context.scene.frame_set(1)
    obj = add_cloth(pin_group="", end=8, use_strain=True)
    make_it_dark()
    small_render(folder)
    if played == "True":
        play(1, 1)
    before = list(obj.data.attributes.keys())
    stepped, calls, shown = [], [], []
    live = addon("bridge.live")
    real = live._step
    live._step = lambda session, *rest: (
        stepped.append(session.frames.last + 1) or real(session, *rest)
    )

    def note(scene, _depsgraph):
        calls.append([scene.frame_current, scene.frame_subframe])
        inside = set(obj.data.attributes.keys())
        if addon("bridge.runtime").rendering:  # the last call comes when the render is over
            shown.append(inside == set(before))

    bpy.app.handlers.frame_change_post.append(note)
    bpy.ops.render.render(animation=True)
    bpy.app.handlers.frame_change_post.remove(note)
    session = live.session_of(obj)
    kept = [list(session.frames.nearest(frame).positions) for frame in range(1, 5)]
    return {
        "calls": calls,
        "stepped": stepped,
        "same": kept == frames,
        "never_added": len(shown) > 4 and all(shown),
        "frame": bpy.context.scene.frame_current,
        "status": obj.boucle.status,
        "rows": [image_rows(folder, frame) for frame in (1, 4)],
        "rendering": bool(addon("bridge.runtime").rendering),
        "after": len(shown_positions(obj)),
    }


def test_an_animation_render_steps_every_frame_once_and_adds_no_data(blender):
    for played in (False, True):
        result = blender.run(render_live, folder=blender.folder, played=played)
        assert any(subframe != 0.0 for _, subframe in result["calls"]), "motion blur samples"
        assert result["stepped"] == [2, 3, 4]
        assert result["same"] and result["never_added"] and not result["rendering"]
        assert result["status"].startswith("Live: frames 1 to 4")
        first, last = result["rows"]
        assert last[0] < first[0] and last[1] <= first[1], "the cloth falls in the picture"
        assert "has no deformation blur" in blender.output


def render_baked(folder):
    import bpy
    from cloths import add_cloth

    obj = add_cloth(pin_group="", end=6)
    make_it_dark()
    small_render(folder)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.boucle.bake()
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bpy.ops.render.render(animation=True)
    rows = [image_rows(folder, frame) for frame in (1, 4)]
    status = obj.boucle.status
    path = bpy.path.abspath(obj.modifiers["Boucle Cache"].filepath)
    os.rename(path, path + ".away")
    bpy.context.scene.frame_set(4)
    bpy.ops.render.render(write_still=True)
    return [rows, status, obj.boucle.status]


def test_a_baked_cloth_renders_and_a_missing_cache_is_said(blender):
    rows, status, missing = blender.run(render_baked, folder=blender.folder)
    assert rows[1][0] < rows[0][0]
    assert status.startswith("Baked: frames 1 to 6")
    assert "is missing" in missing
    assert "is missing" in blender.output and "rest shape is rendered" in blender.output
    assert "has no deformation blur" not in blender.output


def render_still():
    import bpy
    from cloths import add_cloth, addon, mesh_positions, play

    obj = add_cloth(end=10)
    folder = bpy.app.tempdir
    play(1, 6)
    before = mesh_positions(obj)
    small_render(folder, last=10)
    bpy.ops.render.render()
    session = addon("bridge.live").session_of(obj)
    return [mesh_positions(obj) == before, session.frames.last, bpy.context.scene.frame_current]


def test_a_still_render_changes_nothing(blender):
    assert blender.run(render_still) == [True, 6, 6]
