"""The rest shape is never lost, whatever happens to a cloth that shows a live frame."""


def edit_while_live():
    import bmesh
    import bpy
    from cloths import add_cloth, farthest, mesh_positions, play

    obj = add_cloth()
    rest = mesh_positions(obj)
    play(1, 6)
    moved = mesh_positions(obj) != rest
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.view_layer.update()
    edited = bmesh.from_edit_mesh(obj.data)
    in_edit_mode = [value for vertex in edited.verts for value in vertex.co]
    play(7, 8)
    bpy.ops.object.mode_set(mode="OBJECT")
    after = mesh_positions(obj)
    attributes = list(obj.data.attributes.keys())
    play(1, 3)
    bpy.ops.object.mode_set(mode="SCULPT")
    bpy.context.view_layer.update()
    in_sculpt_mode = mesh_positions(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    return {
        "moved": moved,
        "edit": farthest(in_edit_mode, rest),
        "after": farthest(after, rest),
        "attributes": attributes,
        "sculpt": farthest(in_sculpt_mode, rest),
    }


def test_edit_and_sculpt_mode_show_the_rest_shape(blender):
    result = blender.run(edit_while_live)
    assert result["moved"]
    assert result["edit"] == result["after"] == result["sculpt"] == 0.0
    assert "boucle_rest" not in result["attributes"]


def undo_and_redo():
    import bpy
    from cloths import add_cloth, addon, mesh_positions, play

    obj = add_cloth()
    name = obj.name
    rest = mesh_positions(obj)
    bpy.ops.ed.undo_push(message="cloth")
    play(1, 5)
    at_five = mesh_positions(obj)
    obj.location.x = 3.0
    bpy.ops.ed.undo_push(message="moved")
    play(6, 8)
    bpy.ops.ed.undo()
    obj = bpy.data.objects[name]
    frame = bpy.context.scene.frame_current
    undone = mesh_positions(obj)
    session = addon("bridge.live").session_of(obj)
    kept = session is not None and session.frames.last
    shows = session is not None and undone == list(session.frames.nearest(frame).positions)
    bpy.ops.ed.redo()
    obj = bpy.data.objects[name]
    bpy.ops.boucle.reset()
    return {
        "location": obj.location.x,
        "kept": kept,
        "shows": shows or undone == rest,
        "five": at_five != rest,
        "rest": mesh_positions(obj) == rest,
        "attributes": "boucle_rest" in obj.data.attributes,
    }


def test_undo_and_redo_keep_the_rest_shape(blender):
    result = blender.run(undo_and_redo)
    assert result["five"] and result["shows"] and result["rest"]
    assert not result["attributes"]


def undo_a_setting():
    import bpy
    from cloths import add_cloth, mesh_positions, play

    obj = add_cloth()
    rest = mesh_positions(obj)
    bpy.ops.ed.undo_push(message="cloth")
    obj.boucle.stretch = 900.0
    bpy.ops.ed.undo_push(message="stretch")
    play(1, 5)
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Cloth"]
    return [obj.boucle.stretch, obj.boucle.status, mesh_positions(obj) == rest]


def test_a_setting_that_undo_changes_ends_the_live_result(blender):
    stretch, status, is_rest = blender.run(undo_a_setting)
    assert stretch == 500.0
    assert status.startswith("Not baked") and is_rest


def delete_while_live():
    import bpy
    from cloths import add_cloth, addon, play

    obj = add_cloth()
    other = add_cloth()
    play(1, 4)
    bpy.data.objects.remove(obj)
    play(5, 6)
    other.name = "Another name"
    play(7, 8)
    status = other.boucle.status
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    play(9, 10)
    return [status, len(addon("bridge.registry").all_cloths())]


def test_a_deleted_cloth_is_forgotten_and_a_renamed_one_goes_on(blender):
    status, left = blender.run(delete_while_live)
    assert status.startswith("Live: frames 1 to 8")
    assert left == 0


def duplicate_while_live():
    import bpy
    from cloths import add_cloth, mesh_positions, play

    obj = add_cloth()
    rest = mesh_positions(obj)
    play(1, 5)
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    play(6, 6)
    back = mesh_positions(copy) == rest
    play(1, 9)
    both = [obj.boucle.status, copy.boucle.status]
    same = mesh_positions(copy) == mesh_positions(obj)
    return [back, both, same, copy.name]


def test_a_duplicate_of_a_live_cloth_gets_its_rest_shape_and_its_own_session(blender):
    back, both, same, _ = blender.run(duplicate_while_live)
    assert back and same
    assert all(status.startswith("Live: frames 1 to 9") for status in both)


def change_the_mesh_while_live():
    import bpy
    from cloths import add_cloth, farthest, mesh_positions, play

    def live_cloth():
        for other in list(bpy.data.objects):
            bpy.data.objects.remove(other)
        bpy.context.scene.frame_set(1)
        obj = add_cloth()
        rest = mesh_positions(obj)
        obj.scale = (2.0, 1.0, 3.0)
        obj.location = (1.0, 2.0, 3.0)
        bpy.context.view_layer.update()
        play(1, 8)
        assert mesh_positions(obj) != rest
        return obj, rest

    def scaled(values, factors, offset=(0.0, 0.0, 0.0)):
        return [v * factors[k % 3] + offset[k % 3] for k, v in enumerate(values)]

    out = {}
    obj, rest = live_cloth()
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    bpy.context.view_layer.update()
    bpy.ops.boucle.reset()
    out["apply scale"] = farthest(mesh_positions(obj), scaled(rest, (2, 1, 3)))
    obj, rest = live_cloth()
    bpy.ops.object.transform_apply()
    bpy.context.view_layer.update()
    play(1, 2)
    bpy.ops.boucle.reset()
    out["apply all"] = farthest(mesh_positions(obj), scaled(rest, (2, 1, 3), (1, 2, 3)))
    obj, rest = live_cloth()
    bpy.context.scene.cursor.location = (5.0, 0.0, 0.0)
    bpy.ops.object.origin_set(type="ORIGIN_CURSOR")
    bpy.context.view_layer.update()
    bpy.ops.boucle.reset()
    world = [obj.matrix_world @ vertex.co for vertex in obj.data.vertices]
    flat = [value for place in world for value in place]
    out["set origin"] = farthest(flat, scaled(rest, (2, 1, 3), (1, 2, 3)))
    obj, rest = live_cloth()
    obj.location.x += 7.0
    bpy.context.view_layer.update()
    play(9, 10)
    status = obj.boucle.status
    bpy.ops.boucle.reset()
    out["move"] = farthest(mesh_positions(obj), rest)
    obj, rest = live_cloth()
    obj.scale, obj.location = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
    bpy.context.view_layer.update()
    bpy.ops.mesh.primitive_plane_add(location=(0.0, 0.0, 9.0))
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.join()
    bpy.context.view_layer.update()
    play(8, 9)
    joined = mesh_positions(obj)
    out["join"] = farthest(joined[: len(rest)], rest)
    plane = sorted(round(z, 5) for z in joined[len(rest) + 2 :: 3])
    left = [*obj.data.keys(), *obj.data.attributes.keys()]
    return out, status, plane, left


def test_the_rest_shape_survives_applied_transforms_and_joined_meshes(blender):
    found, status, plane, left = blender.run(change_the_mesh_while_live)
    assert status.startswith("Live: frames 1 to 10"), "moving the object is no reset"
    for name, difference in found.items():
        assert difference < 1e-5, name
    assert plane == [9.0] * 4
    assert not [name for name in left if name.startswith("boucle_rest")]


def switch_off_while_live():
    import addon_utils
    from cloths import add_cloth, mesh_positions, play

    obj, keyed = add_cloth(), add_cloth()
    keyed.shape_key_add()
    rest = mesh_positions(obj)
    play(1, 5)
    moved = mesh_positions(obj) != rest
    addon_utils.disable("bl_ext.user_default.boucle")
    modifier = keyed.modifiers["Boucle Cache"]
    off = [mesh_positions(obj) == rest, modifier.filepath, modifier.show_viewport]
    addon_utils.enable("bl_ext.user_default.boucle")
    play(1, 3)
    return [moved, off, obj.boucle.status]


def test_switching_the_add_on_off_gives_the_rest_shape_back(blender):
    moved, off, status = blender.run(switch_off_while_live)
    assert moved
    assert off == [True, "", False]
    assert status.startswith("Live: frames 1 to 3")
