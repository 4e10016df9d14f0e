"""Blend files: save, load, other names, duplicates, libraries. The cache follows and the rest shape stays."""

import os


def save_while_live(folder):
    import bpy
    from cloths import add_cloth, mesh_positions, play

    obj = add_cloth()
    rest = mesh_positions(obj)
    with_keys = add_cloth()
    with_keys.shape_key_add()
    play(1, 6)
    before = mesh_positions(obj)
    path = with_keys.modifiers["Boucle Cache"].filepath
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    return {
        "moved": before != rest,
        "shown_again": mesh_positions(obj) == before,
        "path_again": with_keys.modifiers["Boucle Cache"].filepath == path != "",
        "rest": rest,
        "status": obj.boucle.status,
    }


def look_without_the_add_on(path):
    import bpy
    from cloths import mesh_positions

    bpy.ops.wm.open_mainfile(filepath=path)
    return [
        [
            mesh_positions(obj),
            list(obj.data.attributes.keys()),
            obj.modifiers[1].filepath,
            obj.modifiers[1].show_viewport or obj.modifiers[1].show_render,
        ]
        for obj in bpy.data.objects
    ]


def test_a_saved_file_holds_the_rest_shape_and_no_temporary_path(blender):
    result = blender.run(save_while_live, folder=blender.folder)
    assert result["moved"] and result["shown_again"] and result["path_again"]
    assert result["status"].startswith("Live: frames 1 to 6")
    for positions, attributes, path, plays in blender.run(
        look_without_the_add_on, addon=False, path=blender.folder / "a.blend"
    ):
        assert positions == result["rest"]
        assert "boucle_rest" not in attributes
        assert "boucle_live" not in path and not plays
    assert "Missing header" not in blender.output


def reload_after_a_crash(folder):
    import bpy
    from cloths import add_cloth, addon, mesh_positions, play

    obj = add_cloth()
    rest = mesh_positions(obj)
    with_keys = add_cloth()
    with_keys.shape_key_add()
    play(1, 6)
    handlers = bpy.app.handlers
    kept = list(handlers.save_pre)
    handlers.save_pre.clear()  # as an automatic save does it
    path = os.path.join(folder, "auto.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    handlers.save_pre.extend(kept)
    bpy.ops.wm.open_mainfile(filepath=path)
    obj, with_keys = bpy.data.objects["Cloth"], bpy.data.objects["Cloth.001"]
    session = addon("bridge.live").session_of(obj)
    return {
        "rest": mesh_positions(obj) == rest,
        "attributes": "boucle_rest" in obj.data.attributes,
        "path": with_keys.modifiers["Boucle Cache"].filepath,
        "session": session is None,
    }


def test_a_file_that_a_crash_left_gets_its_rest_shape_back(blender):
    assert blender.run(reload_after_a_crash, folder=blender.folder) == {
        "rest": True,
        "attributes": False,
        "path": "",
        "session": True,
    }


def bake_before_saving(folder):
    import bpy
    from cloths import add_cloth, addon, shown_positions

    obj = add_cloth(end=6)
    bpy.ops.boucle.bake()
    modifier = obj.modifiers["Boucle Cache"]
    temporary = modifier.filepath
    bpy.context.scene.frame_set(6)
    baked = shown_positions(obj)
    copy = os.path.join(folder, "other", "copy.blend")
    os.makedirs(os.path.dirname(copy))
    bpy.ops.wm.save_as_mainfile(filepath=copy, copy=True)
    bpy.context.scene.frame_set(5)
    bpy.context.scene.frame_set(6)
    after_copy = [shown_positions(obj) == baked, modifier.filepath.startswith("//")]
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bpy.context.scene.frame_set(5)
    bpy.context.scene.frame_set(6)
    status = obj.boucle.status
    adopted = None
    if obj.boucle.is_foreign:
        bpy.ops.boucle.adopt_bake()
        adopted = obj.boucle.status
        bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=os.path.join(folder, "a.blend"))
    obj = bpy.data.objects["Cloth"]
    bpy.context.scene.frame_set(6)
    reopened = shown_positions(obj) == baked
    own = addon("bridge.cache").own_folder()
    bpy.ops.wm.open_mainfile(filepath=copy)
    obj = bpy.data.objects["Cloth"]
    bpy.context.scene.frame_set(6)
    return {
        "temporary": os.path.isabs(temporary) and "boucle_cache" in temporary,
        "after_copy": after_copy,
        "status": status,
        "adopted": adopted,
        "reopened": reopened,
        "copy": [shown_positions(obj) == baked, obj.boucle.status],
        "own": os.listdir(own),
    }


def test_a_bake_made_before_the_first_save_comes_along_with_the_file_and_its_copies(blender):
    result = blender.run(bake_before_saving, folder=blender.folder)
    assert result["temporary"]
    assert result["after_copy"] == [True, False]
    assert result["status"].startswith("Baked: frames 1 to 6")
    assert result["reopened"]
    assert len(result["own"]) == 3
    assert result["copy"][0] and result["copy"][1].startswith("Baked: frames 1 to 6")


def save_as(folder):
    import bpy
    from cloths import add_cloth, shown_positions

    obj = add_cloth(end=6)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bpy.ops.boucle.bake()
    bpy.context.scene.frame_set(6)
    baked = shown_positions(obj)
    bpy.ops.wm.save_mainfile()
    os.makedirs(os.path.join(folder, "sub"))
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "sub", "b.blend"))
    bpy.context.scene.frame_set(5)
    bpy.context.scene.frame_set(6)
    moved = [shown_positions(obj) == baked, obj.boucle.status, obj.boucle.is_foreign]
    obj.boucle.stretch = 50.0
    bpy.ops.boucle.bake()
    own = [obj.boucle.status, obj.boucle.is_foreign, obj.modifiers["Boucle Cache"].filepath]
    bpy.context.scene.frame_set(6)
    different = shown_positions(obj) != baked
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=os.path.join(folder, "a.blend"))
    obj = bpy.data.objects["Cloth"]
    bpy.context.scene.frame_set(6)
    first_kept = shown_positions(obj) == baked
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "c.blend"))
    bpy.ops.boucle.adopt_bake()
    adopted = [obj.boucle.is_foreign, obj.modifiers["Boucle Cache"].filepath]
    bpy.ops.boucle.free_bake()
    bpy.ops.wm.open_mainfile(filepath=os.path.join(folder, "a.blend"))
    obj = bpy.data.objects["Cloth"]
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "d.blend"))
    bpy.ops.boucle.free_bake()  # another file's bake is let go, not removed
    bpy.ops.wm.open_mainfile(filepath=os.path.join(folder, "a.blend"))
    obj = bpy.data.objects["Cloth"]
    bpy.context.scene.frame_set(6)
    return {
        "moved": moved,
        "own": own,
        "different": different,
        "first_kept": first_kept,
        "adopted": adopted,
        "never_lost": shown_positions(obj) == baked,
    }


def test_under_another_name_the_bake_still_plays_and_a_new_one_is_the_new_files_own(blender):
    result = blender.run(save_as, folder=blender.folder)
    assert result["moved"][0] and result["moved"][2]
    assert "Copy makes it this one's own" in result["moved"][1]
    assert result["own"][0].startswith("Baked") and not result["own"][1]
    assert result["own"][2].startswith("//boucle_cache/b/")
    assert result["different"] and result["first_kept"] and result["never_lost"]
    assert result["adopted"][0] is False
    assert result["adopted"][1].startswith("//boucle_cache/c/")


def duplicate(folder):
    import bpy
    from cloths import add_cloth, shown_positions

    obj = add_cloth(end=6)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bpy.ops.boucle.bake()
    bpy.context.scene.frame_set(6)
    first = shown_positions(obj)
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    same_play = shown_positions(copy) == first
    copy.boucle.stretch = 40.0
    bpy.ops.boucle.bake()
    bpy.context.scene.frame_set(6)
    names = [obj.modifiers[1].filepath, copy.modifiers[1].filepath]
    result = [shown_positions(obj) == first, shown_positions(copy) != first]
    obj.name = "Renamed"
    bpy.context.scene.frame_set(5)
    bpy.context.scene.frame_set(6)
    renamed = shown_positions(obj) == first, obj.boucle.status
    bpy.ops.object.duplicate()
    third = bpy.context.object
    bpy.ops.boucle.free_bake()
    kept = copy.boucle.status, third.boucle.status
    return {
        "same_play": same_play,
        "own": names[0] != names[1] and obj.boucle.uuid != copy.boucle.uuid,
        "result": result,
        "renamed": renamed,
        "kept": kept,
    }


def test_a_duplicate_bakes_into_its_own_cache(blender):
    result = blender.run(duplicate, folder=blender.folder)
    assert result["same_play"] and result["own"]
    assert result["result"] == [True, True]
    assert result["renamed"][0] and result["renamed"][1].startswith("Baked")
    assert result["kept"][0].startswith("Baked"), "freeing the copy's bake keeps the original's"
    assert result["kept"][1].startswith("Not baked")


def undo_a_bake():
    import bpy
    from cloths import add_cloth, shown_positions

    obj = add_cloth(end=5)
    name = obj.name
    bpy.ops.ed.undo_push(message="cloth")
    bpy.ops.boucle.bake("EXEC_DEFAULT", True)
    baked = obj.boucle.status
    bpy.ops.ed.undo()
    undone = bpy.data.objects[name].boucle.status
    bpy.ops.ed.redo()
    obj = bpy.data.objects[name]
    bpy.context.scene.frame_set(5)
    return [baked, undone, obj.boucle.status, len(shown_positions(obj)) == 144]


def test_a_bake_can_be_undone_and_redone(blender):
    baked, undone, redone, whole = blender.run(undo_a_bake)
    assert baked.startswith("Baked") and redone.startswith("Baked") and whole
    assert undone.startswith("Not baked")


def make_library(folder):
    import bpy
    from cloths import add_cloth, shown_positions

    os.makedirs(os.path.join(folder, "library"))
    obj = add_cloth(end=6)
    collection = bpy.data.collections.new("Costume")
    bpy.context.scene.collection.children.link(collection)
    for owner in list(obj.users_collection):
        owner.objects.unlink(obj)
    collection.objects.link(obj)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "library", "costume.blend"))
    bpy.ops.boucle.bake()
    bpy.ops.wm.save_mainfile()
    bpy.context.scene.frame_set(6)
    return shown_positions(obj)


def link_library(folder):
    import bpy
    from cloths import farthest, mesh_positions, play, shown_positions

    path = os.path.join(folder, "library", "costume.blend")
    with bpy.data.libraries.load(path, link=True) as (_, to):
        to.collections = ["Costume"]
    collection = to.collections[0]
    bpy.context.scene.collection.children.link(collection)
    linked = collection.objects[0]
    bpy.context.view_layer.objects.active = linked
    bpy.context.scene.frame_set(6)
    out = {"linked": shown_positions(linked), "linked_status": linked.boucle.status}
    out["linked_polls"] = [bpy.ops.boucle.bake.poll(), bpy.ops.boucle.disable.poll()]
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "shot.blend"))
    hierarchy = collection.override_hierarchy_create(
        bpy.context.scene, bpy.context.view_layer, do_fully_editable=True
    )
    obj = hierarchy.objects[0]
    for child in list(bpy.context.scene.collection.children):
        if child.library is not None:
            bpy.context.scene.collection.children.unlink(child)
    bpy.context.view_layer.objects.active = obj
    bpy.context.scene.frame_set(5)
    bpy.context.scene.frame_set(6)
    out["override"] = shown_positions(obj)
    out["override_path"] = obj.modifiers["Boucle Cache"].filepath
    out["override_status"] = obj.boucle.status
    obj.boucle.stretch = 60.0
    out["bake"] = list(bpy.ops.boucle.bake())
    bpy.context.scene.frame_set(6)
    out["own"] = farthest(shown_positions(obj), out["override"])
    out["own_path"] = obj.modifiers["Boucle Cache"].filepath
    own = shown_positions(obj)
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=os.path.join(folder, "shot.blend"))
    obj = next(o for o in bpy.data.objects if o.library is None)
    bpy.context.scene.frame_set(6)
    out["reloaded"] = [obj.boucle.stretch, shown_positions(obj) == own, obj.boucle.status]
    bpy.context.view_layer.objects.active = obj
    bpy.ops.boucle.free_bake()
    rest = mesh_positions(obj)
    play(1, 6)
    out["live"] = [
        obj.boucle.status,
        farthest(shown_positions(obj), own),
        mesh_positions(obj) == rest,
    ]
    return out


def test_linked_cloths_play_their_bake_and_overrides_bake_their_own(blender):
    baked = blender.run(make_library, folder=blender.folder)
    result = blender.run(link_library, folder=blender.folder)
    assert result["linked"] == baked
    assert result["linked_status"].startswith("Baked: frames 1 to 6")
    assert result["linked_polls"] == [False, False]
    assert result["override"] == baked
    assert result["override_status"].startswith("Baked: frames 1 to 6")
    assert result["bake"] == ["FINISHED"]
    assert result["own"] > 1e-4
    assert result["own_path"].startswith("//boucle_cache/shot/")
    assert result["reloaded"][:2] == [60.0, True]
    assert result["reloaded"][2].startswith("Baked")
    assert result["live"][0].startswith("Live: frames 1 to 6")
    assert result["live"][1] < 1e-6 and result["live"][2]
