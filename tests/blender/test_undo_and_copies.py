"""Undo, duplicates and deletion: what the add-on knows stays true."""


def undo_a_bake(folder):
    import os

    import bpy
    from cloths import add_cloth, addon

    cache = addon("bridge.cache")
    obj = add_cloth(columns=4, rows=4, end=4)
    path = os.path.join(folder, "a.blend")
    bpy.ops.boucle.bake()
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.ed.undo_push(message="baked")
    obj.boucle.frame_start = -3
    obj.boucle.stretch = 900.0
    bpy.ops.ed.undo_push(message="changed")
    bpy.ops.boucle.bake()
    bpy.ops.ed.undo_push(message="baked anew")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Cloth"]
    out = {
        "undone": [
            obj.boucle.status,
            cache.frame_range(obj),
            obj.modifiers["Boucle Cache"].frame_start,
        ]
    }
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Cloth"]
    out["twice"] = [obj.boucle.stretch, obj.boucle.status]
    bpy.ops.ed.redo()
    bpy.ops.ed.redo()
    obj = bpy.data.objects["Cloth"]
    out["redone"] = obj.boucle.status
    # The file was saved with the first bake and is opened with the second beside it.
    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.data.objects["Cloth"]
    out["reopened"] = [obj.boucle.stretch, obj.boucle.status, cache.frame_range(obj)]
    return out


def test_what_is_known_of_a_bake_is_that_of_its_files_after_undo_and_reopening(blender):
    found = blender.run(undo_a_bake, folder=blender.folder)
    status, frames, start = found["undone"]
    assert "outdated" not in status and frames == [-3, 4] and start == -3.0
    stretch, status = found["twice"]
    assert stretch == 500.0 and "changed since: stretch stiffness, start frame" in status
    assert "outdated" not in found["redone"]
    stretch, status, frames = found["reopened"]
    assert stretch == 500.0 and frames == [-3, 4]
    assert "changed since: stretch stiffness, start frame" in status


def undo_an_edit():
    import bpy
    from cloths import add_cloth, addon, mesh_positions, pinned_vertices, play

    live = addon("bridge.live")
    obj = add_cloth(columns=4, rows=4, end=30)
    bpy.ops.ed.undo_push(message="cloth")
    rest = mesh_positions(obj)
    scale = [0.5 * part for part in rest]
    obj.data.vertices.foreach_set("co", scale)
    obj.data.update()
    bpy.ops.ed.undo_push(message="smaller")
    play(1, 5)
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Cloth"]
    out = {"shape": live.session_of(obj) is None, "rest": mesh_positions(obj) == rest}
    bpy.ops.ed.undo_push(message="cloth")
    obj.vertex_groups[obj.boucle.pin_group].remove(pinned_vertices(obj)[:1])
    bpy.ops.ed.undo_push(message="fewer pins")
    play(1, 5)
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Cloth"]
    out["pins"] = live.session_of(obj) is None
    play(1, 5)
    bpy.ops.ed.undo_push(message="played")
    bpy.context.scene.render.resolution_x += 2
    bpy.ops.ed.undo_push(message="something else")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Cloth"]
    out["other"] = live.session_of(obj) is not None
    return out


def test_undoing_an_edit_of_shape_or_pins_ends_the_live_result_and_nothing_else_does(blender):
    found = blender.run(undo_an_edit)
    assert found == {"shape": True, "rest": True, "pins": True, "other": True}


def leave_temporary_files():
    import bpy
    from cloths import add_cloth, addon, play

    live, registry = addon("bridge.live"), addon("bridge.registry")
    obj = add_cloth(columns=4, rows=4, end=30)
    obj.shape_key_add(name="Basis")
    bpy.ops.ed.undo_push(message="cloth")
    play(1, 3)
    named = obj.modifiers["Boucle Cache"].filepath
    bpy.ops.ed.undo_push(message="played")
    bpy.ops.boucle.reset()
    bpy.ops.ed.undo_push(message="reset")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Cloth"]
    out = {"named": named, "after": obj.modifiers["Boucle Cache"].filepath}
    # A deleted cloth's frames go with it.
    play(1, 3)
    uid = obj.session_uid
    bpy.data.objects.remove(obj)
    bpy.context.scene.frame_set(4)
    other = add_cloth(columns=4, rows=4, end=30)
    play(1, 2)
    out["forgotten"] = uid not in live._sessions and len(live._sessions) == 1
    # One object comes as another goes: the new cloth is noticed.
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    registry.all_cloths()
    twin = other.copy()
    twin.data = other.data.copy()
    bpy.context.scene.collection.objects.link(twin)
    bpy.data.objects.remove(cube)
    out["noticed"] = twin in registry.all_cloths()
    return out


def test_nothing_is_left_of_live_frames_and_a_new_cloth_is_noticed(blender):
    found = blender.run(leave_temporary_files)
    assert "boucle_live" in found["named"] and found["after"] == ""
    assert found["forgotten"] and found["noticed"]


def edit_a_copy():
    import bpy
    from cloths import add_cloth, addon, mesh_positions, play

    live = addon("bridge.live")
    obj = add_cloth(columns=4, rows=4, end=30)
    rest = mesh_positions(obj)
    out = []
    for reset in (False, True):
        play(1, 8)
        twin = obj.copy()
        twin.data = obj.data.copy()
        bpy.context.scene.collection.objects.link(twin)
        if reset:
            live.drop(obj)
        for one in bpy.context.selected_objects:
            one.select_set(False)
        twin.select_set(True)
        bpy.context.view_layer.objects.active = twin
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.context.view_layer.update()
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.transform.translate(value=(0.0, 0.0, 0.5))
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.context.scene.frame_set(1)
        moved = [a - b for a, b in zip(mesh_positions(twin), rest, strict=True)]
        out.append([min(moved[2::3]), max(moved[2::3]), "boucle_rest" in twin.data.attributes])
        bpy.data.objects.remove(twin)
    return out


def test_a_copy_of_a_live_cloth_is_edited_in_its_rest_shape(blender):
    for lowest, highest, _ in blender.run(edit_a_copy):
        assert abs(lowest - 0.5) < 1e-6 and abs(highest - 0.5) < 1e-6


def undo_elsewhere():
    import bpy
    from cloths import add_cloth, addon, play

    live = addon("bridge.live")
    obj = add_cloth(columns=4, rows=4, end=30)
    play(1, 5)
    session = live.session_of(obj)
    other = bpy.data.scenes.new("Moon")
    other.gravity.z = -1.6
    live.revalidate(other)
    return live.session_of(obj) is session


def test_an_undo_in_another_scene_keeps_live_frames(new_blender):
    assert new_blender.run(undo_elsewhere)
