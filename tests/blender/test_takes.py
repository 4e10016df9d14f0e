"""Takes: a bake kept under a name, brought back to the bit with its settings, compared in words, carried along by saving."""


def drawn(settings):
    import bpy
    from test_settings import Layout

    out = []

    class Panel:
        layout = Layout(out)

    bpy.types.BOUCLE_PT_takes.draw(Panel(), bpy.context)
    row = bpy.types.BOUCLE_UL_takes
    row.draw_item(Panel(), bpy.context, Layout(out), settings, settings.takes[0], 0, settings, "")
    return out


def keep_and_restore(folder):
    import os
    from pathlib import Path

    import bpy
    from cloths import add_cloth, addon, refusal_of

    ops, cache, takes = bpy.ops.boucle, addon("bridge.cache"), addon("bridge.takes")
    out = {}
    obj = add_cloth(end=6)
    settings = obj.boucle
    out["polls"] = [ops.restore_take.poll(), refusal_of(ops.add_take)]
    ops.bake()
    first = Path(cache.played_path(obj)).read_bytes()
    ops.add_take(take_name="Soft: 1/2")
    settings.stretch = 900.0
    settings.integrator = "implicit_euler"
    settings.frame_end = 8
    ops.bake()
    second = Path(cache.played_path(obj)).read_bytes()
    ops.add_take()
    out["names"] = [take.name for take in settings.takes]
    out["notes"] = [take.note for take in settings.takes]
    out["dates"] = [len(take.date) for take in settings.takes]
    ops.compare_take(index=0)
    out["drawn"] = drawn(settings)
    out["comparison"] = settings.take_comparison.split("\n")

    # Restored with settings, then only the cache.
    ops.restore_take(index=0, with_settings=True)
    same = Path(cache.played_path(obj)).read_bytes() == first
    out["restored"] = [
        same,
        settings.stretch,
        settings.integrator,
        settings.frame_end,
        settings.status,
    ]
    out["previous"] = settings.has_previous
    ops.restore_take(index=1, with_settings=False)
    same = Path(cache.played_path(obj)).read_bytes() == second
    out["cache only"] = [same, settings.stretch, settings.status]
    ops.compare_take(index=1)
    out["alike"] = settings.take_comparison.split("\n")

    # Saved, and saved elsewhere: the takes come along or stay in reach.
    before = [takes.files_of(obj, take).pc2 for take in settings.takes]
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    out["paths"] = [take.path for take in settings.takes]
    out["moved"] = [not os.path.exists(path) for path in before]
    os.makedirs(os.path.join(folder, "deep", "er"))
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "deep", "er", "b.blend"), copy=True)
    out["copied"] = [os.path.isfile(takes.files_of(obj, take).pc2) for take in settings.takes]
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "deep", "er", "c.blend"))
    bpy.ops.wm.open_mainfile(filepath=os.path.join(folder, "deep", "er", "b.blend"))
    obj = bpy.data.objects[0]
    bpy.context.view_layer.objects.active = obj
    out["reopened"] = [os.path.isfile(takes.files_of(obj, take).pc2) for take in obj.boucle.takes]
    out["forgotten"] = obj.boucle.take_comparison
    ops.restore_take(index=0)
    out["again"] = Path(cache.played_path(obj)).read_bytes() == first

    # A duplicate shares the files: they go with the last of both.
    twin = obj.copy()
    twin.data = obj.data.copy()
    bpy.context.collection.objects.link(twin)
    path = takes.files_of(obj, obj.boucle.takes[0]).pc2
    ops.remove_take(index=0)
    there = os.path.isfile(path)
    bpy.context.view_layer.objects.active = twin
    ops.remove_take(index=0)
    out["removed"] = [there, os.path.isfile(path), len(obj.boucle.takes), len(twin.boucle.takes)]
    os.remove(takes.files_of(twin, twin.boucle.takes[0]).pc2)
    out["missing"] = refusal_of(ops.restore_take, index=0)
    out["beyond"] = refusal_of(ops.restore_take, index=7)
    return out


def test_takes_are_kept_restored_compared_and_removed(blender):
    found = blender.run(keep_and_restore, folder=blender.folder)
    assert found["polls"][0] is False and "plays no bake that could be kept" in found["polls"][1]
    assert found["names"] == ["Soft: 1/2", "Take 2"]
    assert found["notes"][0].startswith("stretch stiffness 500") and "bdf2" in found["notes"][0]
    assert "stretch stiffness 900" in found["notes"][1] and found["dates"] == [16, 16]
    text = found["comparison"]
    assert {"boucle.add_take", "boucle.restore_take", "name", "note"} <= set(found["drawn"])
    assert any("largest strain" in line for line in found["drawn"])
    assert text[0] == '"Soft: 1/2" against the bake'
    assert "6 against 8 frames" in text
    assert "integrator bdf2 against implicit_euler" in text
    assert "stretch stiffness 500 against 900" in text
    assert len(text) == 7, text
    same, stretch, integrator, end, status = found["restored"]
    assert same and (stretch, integrator, end) == (500.0, "bdf2", 6)
    assert "outdated" not in status and status.startswith("Baked: frames 1 to 6")
    assert found["previous"]
    same, stretch, status = found["cache only"]
    assert (
        same
        and stretch == 500.0
        and "outdated, changed since: stretch stiffness, integrator" in status
    )
    assert found["alike"][-1] == "the same settings"
    assert all(path.startswith("//boucle_cache/a/") for path in found["paths"])
    assert "take-Soft_1_2" in found["paths"][0]
    assert all(found["moved"]) and all(found["copied"]) and all(found["reopened"])
    assert found["forgotten"] == "" and found["again"]
    assert found["removed"] == [True, False, 1, 1]
    assert "is missing" in found["missing"] and "has 1 take," in found["beyond"]


def keep_all_settings():
    import bpy
    from cloths import add_cloth

    obj, ops = add_cloth(end=3), bpy.ops.boucle
    ground, fans = bpy.data.collections.new("Ground"), bpy.data.collections.new("Fans")
    for collection in (ground, fans):
        bpy.context.scene.collection.children.link(collection)
    settings = obj.boucle
    settings.field_weights.gravity = 0.25
    settings.field_weights.collection = fans
    settings.collision_collection = ground
    ops.bake()
    ops.add_take()
    settings.field_weights.gravity = 1.0
    settings.field_weights.collection = None
    settings.collision_collection = None
    ops.bake()
    ops.add_take()
    ops.restore_take(index=0)
    weights = settings.field_weights
    out = [weights.gravity, weights.collection == fans, settings.collision_collection == ground]
    out.append(settings.status)
    ops.restore_take(index=1)
    out.append([weights.gravity, weights.collection is None, settings.collision_collection is None])
    bpy.data.collections.remove(fans)
    from cloths import addon

    return [*out, addon("bridge.takes").restore(obj, 0, True)]


def test_a_take_keeps_field_weights_and_collections(new_blender):
    gravity, fans, ground, status, plain, said = new_blender.run(keep_all_settings)
    assert gravity == 0.25 and fans and ground
    assert "outdated" not in status
    assert plain == [1.0, True, True]
    assert said.endswith('with its settings, but for collections that are gone: "Fans"')


def keep_takes_of_an_override(folder):
    import os

    import bpy
    from cloths import add_cloth, addon, refusal_of

    ops, takes = bpy.ops.boucle, addon("bridge.takes")
    obj = add_cloth(columns=4, rows=4, end=3)
    obj.name = "Costume"
    library, shot = (os.path.join(folder, *name) for name in (("props", "a.blend"), ("b.blend",)))
    os.makedirs(os.path.dirname(library))
    bpy.ops.wm.save_as_mainfile(filepath=library)
    ops.bake()
    ops.add_take(take_name="Theirs")
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)
    with bpy.data.libraries.load(library, link=True) as (_, to):
        to.objects = ["Costume"]
    bpy.context.scene.collection.objects.link(to.objects[0])
    own = to.objects[0].override_create(remap_local_usages=True)
    own.override_library.is_system_override = False
    bpy.ops.wm.save_as_mainfile(filepath=shot)
    bpy.context.view_layer.objects.active = own
    for name, stretch in (("First", 800.0), ("Second", 900.0)):
        own.boucle.stretch = stretch
        ops.bake()
        ops.add_take(take_name=name)
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=shot)
    own = next(one for one in bpy.data.objects if one.library is None and one.name == "Costume")
    bpy.context.view_layer.objects.active = own
    out = {"names": [take.name for take in own.boucle.takes], "played": []}
    for number in range(len(own.boucle.takes)):
        ops.restore_take(index=number)
        out["played"].append([own.boucle.stretch, own.boucle.status])
    out["theirs"] = refusal_of(ops.remove_take, index=0)
    out["kept"] = os.path.isfile(takes.files_of(own, own.boucle.takes[0]).pc2)
    ops.remove_take(index=1)
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=shot)
    own = next(one for one in bpy.data.objects if one.library is None and one.name == "Costume")
    out["left"] = [take.name for take in own.boucle.takes]
    return out


def test_an_override_keeps_takes_of_its_own_beside_those_of_the_linked_file(blender):
    found = blender.run(keep_takes_of_an_override, folder=blender.folder)
    assert found["names"] == ["Theirs", "First", "Second"]
    assert [stretch for stretch, _ in found["played"]] == [500.0, 800.0, 900.0]
    assert all(status.startswith("Baked") for _, status in found["played"])
    assert not any("outdated" in status for _, status in found["played"])
    assert "comes from the linked file" in found["theirs"] and found["kept"]
    assert found["left"] == ["Theirs", "Second"]
