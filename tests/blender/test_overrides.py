"""Every setting in a library override keeps what it was given, and every one that may be animated takes keys."""

import os


def others(settings, prefix=""):
    """Each property that can be set, with a value that it has not: (path, owner, property, value)."""
    import uuid

    import bpy

    for prop in settings.bl_rna.properties:
        name = prop.identifier
        if name in {"rna_type", "name"} or (prop.is_readonly and prop.type != "POINTER"):
            continue
        value = getattr(settings, name)
        if prop.type == "POINTER" and isinstance(value, bpy.types.PropertyGroup):
            yield from others(value, f"{prefix}{name}.")
        elif prop.type == "POINTER" or prop.type == "COLLECTION":
            continue  # those to data are set by hand
        elif prop.type == "STRING":
            # An identity that is not one of ours is given anew when the file opens.
            yield prefix + name, settings, prop, uuid.uuid4().hex if name == "uuid" else value + "x"
        elif prop.type == "BOOLEAN":
            yield prefix + name, settings, prop, not value
        elif prop.type == "ENUM":
            items = [item.identifier for item in prop.enum_items]
            yield prefix + name, settings, prop, next(item for item in items if item != value)
        elif prop.is_array:
            yield prefix + name, settings, prop, [one + 1.0 for one in value]
        elif prop.type == "INT":
            yield prefix + name, settings, prop, value + 1 if value < prop.hard_max else value - 1
        else:
            high = min(prop.hard_max, 2.0 * abs(value) + 0.25)
            yield prefix + name, settings, prop, high if high != value else prop.hard_min


def plain(value):
    return value if isinstance(value, (str, bool, int, float)) else list(value)


def override_everything(folder):
    import bpy
    from cloths import add_cloth

    obj = add_cloth(columns=4, rows=4)
    obj.name = "Costume"
    library, shot = (os.path.join(folder, name) for name in ("library.blend", "shot.blend"))
    bpy.ops.wm.save_as_mainfile(filepath=library)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)
    with bpy.data.libraries.load(library, link=True) as (_, to):
        to.objects = ["Costume"]
    linked = to.objects[0]
    bpy.context.scene.collection.objects.link(linked)
    own = linked.override_create(remap_local_usages=True)
    own.override_library.is_system_override = False
    ground = bpy.data.collections.new("Ground")
    bpy.context.scene.collection.children.link(ground)
    pointers = [p.identifier for p in own.boucle.bl_rna.properties
                if p.type == "POINTER" and p.fixed_type.identifier == "Collection"]  # fmt: skip
    for name in pointers:
        setattr(own.boucle, name, ground)
    paths = []
    for path, settings, prop, value in others(own.boucle):
        if path != "enabled":  # ends the cloth
            setattr(settings, prop.identifier, value)
            paths.append(path)
    # Only now: some stand for another setting, in other units.
    given = {path: plain(own.boucle.path_resolve(path)) for path in paths}
    bpy.ops.wm.save_as_mainfile(filepath=shot)
    bpy.ops.wm.open_mainfile(filepath=shot)
    own = next(one for one in bpy.data.objects if one.library is None and one.name == "Costume")
    found = {path: plain(own.boucle.path_resolve(path)) for path in given}
    return {
        "is_override": own.override_library is not None,
        "lost": {path: [given[path], found[path]] for path in given if given[path] != found[path]},
        "count": len(given),
        "pointers": [[name, getattr(own.boucle, name) == bpy.data.collections["Ground"]] for name in pointers],
        "keys": key_everything(),
    }  # fmt: skip


def key_everything():
    import bpy
    from cloths import add_cloth, addon

    obj = add_cloth(columns=4, rows=4)
    out = {"refused": [], "still": [], "animatable": []}
    rows = [row for row in others(obj.boucle) if row[2].type != "STRING" and row[0] != "enabled"]
    for path, settings, prop, value in rows:
        if not prop.is_animatable:
            continue
        out["animatable"].append(path)
        first = plain(getattr(settings, prop.identifier))
        try:
            obj.keyframe_insert(f"boucle.{path}", frame=1)
            setattr(settings, prop.identifier, value)
            obj.keyframe_insert(f"boucle.{path}", frame=11)
        except (TypeError, RuntimeError) as error:
            out["refused"].append([path, str(error)])
            continue
        bpy.context.scene.frame_set(1)
        if plain(obj.boucle.path_resolve(path)) != first:
            out["still"].append(path)
    out["expected"] = list(addon("bridge.preflight").SAMPLED_ONCE)
    return out


def test_overrides_keep_every_setting_and_keys_move_those_that_may_be_animated(blender):
    result = blender.run(override_everything, folder=blender.folder)
    assert result["is_override"] and result["count"] > 40
    assert result["lost"] == {}
    assert ["collision_collection", True] in result["pointers"]
    assert all(kept for _, kept in result["pointers"])
    keys = result["keys"]
    assert keys["refused"] == [] and keys["still"] == []
    assert set(keys["animatable"]) >= set(keys["expected"])
