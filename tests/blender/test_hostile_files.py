"""A .blend from elsewhere: what it holds where ours should be raises nothing and touches no files that are not ours."""

GARBAGE = (
    "x" * 100_000, "[", "[]", "null", "1e999", '{"first": "one"}', '{"first": 1e300}', '{"first": 1, "together": [1]}',
    '{"first": 1, "together": {"a": 1}, "order": 3}', '{"first": 1, "settings": [], "vertices": "many"}',
    "[" * 50_000, '{"first": 1, "end": {}, "is_part": true}', '{"stretch": "soft"}', '{"pin_group": {"a": 1}}',
    '{"stretch": NaN, "frame_end": 1e40}', '{"collision_collection": 7}', '{"takes": [], "overlay_quantity": 3}',
)  # fmt: skip


def attempt(operator, **arguments):
    """The sentence with which an operator refuses; empty if it does not. A traceback is no sentence."""
    try:
        operator(**arguments)
    except RuntimeError as error:
        assert "Traceback" not in str(error), error
        return str(error)
    return ""


def spoiled(blend, text):
    """A cloth of the file, with text where a record, an identity and takes should be."""
    import bpy

    bpy.ops.wm.open_mainfile(filepath=blend)
    obj = next(obj for obj in bpy.context.scene.objects if obj.boucle.enabled)
    bpy.context.view_layer.objects.active = obj
    obj.boucle.bake_record = text
    obj.boucle.uuid = "../strangers/work"
    obj.boucle.takes[0].settings = text
    stolen = obj.boucle.takes.add()
    stolen.name, stolen.settings, stolen.path = "stolen", text, "//strangers/work.pc2"
    return obj


def use(obj, path):
    """Saves, plays, asks and presses what there is; what was said, and whether a refused take left the settings alone."""
    import bpy
    from cloths import addon, play

    cache, settings, ops = addon("bridge.cache"), obj.boucle, bpy.ops.boucle
    scene = bpy.context.scene
    kept = settings.stretch, settings.frame_end
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    said = [cache.status(obj, scene), *cache.drift_of(obj, scene, in_full=True)]
    play(1, 4)
    refused = attempt(ops.restore_take, index=0, with_settings=True)
    is_left = not refused or kept == (settings.stretch, settings.frame_end)
    said += [refused, attempt(ops.restore_take, index=1, with_settings=True)]
    said += [attempt(ops.compare_take, index=1), attempt(ops.remove_take, index=1)]
    said += [attempt(ops.free_bake)]
    bpy.ops.wm.open_mainfile(filepath=path)
    play(1, 2)
    again = next(obj for obj in bpy.context.scene.objects if obj.boucle.enabled)
    return [*said, cache.status(again, bpy.context.scene)], is_left


def spoil(folder):
    """Of each piece of garbage what `use` says, and whether strangers' files are as they were."""
    import os
    from pathlib import Path

    import bpy
    from cloths import add_cloth

    blend = os.path.join(folder, "spoiled.blend")
    add_cloth(end=4)
    bpy.ops.wm.save_as_mainfile(filepath=blend)
    bpy.ops.boucle.bake()
    bpy.ops.boucle.add_take(take_name="good")
    bpy.ops.wm.save_mainfile()
    strangers = Path(folder, "strangers")
    strangers.mkdir()
    for ending in ("pc2", "json", "checkpoint", "strain", "tear"):
        (strangers / f"work.{ending}").write_text("mine")
    out = []
    for text in GARBAGE:
        said, is_left = use(spoiled(blend, text), os.path.join(folder, "again.blend"))
        theirs = {path.name: path.read_text() for path in strangers.iterdir()}
        out.append([said, is_left, theirs])
    return out


def test_what_others_wrote_into_a_file_raises_nothing_and_removes_nothing(blender):
    found = blender.run(spoil, folder=blender.folder)
    assert len(found) == len(GARBAGE)
    for _said, is_left, theirs in found:
        assert is_left, "a take that is refused changes no setting"
        assert len(theirs) == 5 and set(theirs.values()) == {"mine"}
    refused = [said for said, _, _ in found if any("are damaged" in one for one in said)]
    assert len(refused) >= 10
