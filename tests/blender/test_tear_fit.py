"""Torn bakes that do not fit what plays them: copies follow, and what cannot says so, each for itself."""

import os
from pathlib import Path


def open_further(obj):
    """Let a column open as well as the row."""
    column = [vertex.index for vertex in obj.data.vertices if abs(vertex.co.x) < 1e-4]
    obj.vertex_groups["open"].add(column, 1.0, "REPLACE")


def at(obj, *frames):
    """What is shown in frames, but for the groups, which are other ones after `open_further`."""
    from test_tearing import at_frames

    return [{**look, "weights": None} for look in at_frames(obj, frames)]


def bake(obj):
    import bpy

    bpy.context.view_layer.objects.active = obj
    bpy.ops.boucle.bake()


def copy_and_bake_anew(folder):
    import bpy
    from test_tearing import add_torn_cloth

    obj = add_torn_cloth(end=12)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bake(obj)
    copy = obj.copy()
    copy.data = obj.data.copy()
    bpy.context.collection.objects.link(copy)
    first = at(copy, 12)
    open_further(obj)
    bake(obj)
    out = {"differs": at(obj, 12) != first}
    out["follows"] = at(copy, 1, 12) == at(obj, 1, 12)
    out["status"] = copy.boucle.status
    copy.data.attributes.remove(copy.data.attributes["boucle_tear"])
    bpy.context.view_layer.update()
    out["unmarked"] = copy.boucle.status
    bpy.context.view_layer.objects.active = copy
    bpy.ops.boucle.adopt_bake()
    out["adopted"] = at(copy, 12) == at(obj, 12)
    obj.boucle.use_tear = False
    bake(obj)
    out["whole"] = [modifier.name for modifier in obj.modifiers]
    out["kept"] = copy.boucle.status
    return out


def test_a_copy_follows_when_its_original_is_baked_anew(blender):
    found = blender.run(copy_and_bake_anew, folder=blender.folder)
    assert found["differs"] and found["follows"] and found["adopted"]
    assert found["status"].startswith("Baked: frames 1 to 12")
    assert found["unmarked"] == (
        '"Cloth.001": the edges that its mesh marks as torn are not those of its bake: bake again'
    )
    assert found["whole"] == ["Boucle Target", "Boucle Cache"]
    assert found["kept"].startswith("Baked: frames 1 to 12")


def link_and_bake_anew(folder):
    import bpy
    from test_tearing import add_torn_cloth

    library, shot = (os.path.join(folder, f"{name}.blend") for name in ("library", "shot"))
    obj = add_torn_cloth(end=12)
    bpy.ops.wm.save_as_mainfile(filepath=library)
    bake(obj)
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)
    with bpy.data.libraries.load(library, link=True) as (_, to):
        to.objects = ["Cloth"]
    bpy.context.scene.collection.objects.link(to.objects[0])
    bpy.ops.wm.save_as_mainfile(filepath=shot)
    out = {"linked": bpy.data.objects["Cloth"].boucle.status}
    bpy.ops.wm.open_mainfile(filepath=library)
    obj = bpy.data.objects["Cloth"]
    open_further(obj)
    bake(obj)
    torn = at(obj, 12)
    bpy.ops.wm.open_mainfile(filepath=shot)
    out["outdated"] = bpy.data.objects["Cloth"].boucle.status
    bpy.ops.wm.open_mainfile(filepath=library)
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=shot)
    out["reloaded"] = bpy.data.objects["Cloth"].boucle.status
    out["plays"] = at(bpy.data.objects["Cloth"], 12) == torn
    return out


def test_a_linked_cloth_whose_library_was_baked_and_not_saved_says_so(blender):
    found = blender.run(link_and_bake_anew, folder=blender.folder)
    assert found["linked"].startswith("Baked: frames 1 to 12")
    assert found["outdated"].startswith('"Cloth": the edges that its mesh marks as torn are not')
    assert found["outdated"].endswith("after its bake, and reload the library")
    assert found["reloaded"].startswith("Baked: frames 1 to 12") and found["plays"]


def edit(obj, *steps):
    """Do this to the mesh in edit mode, with everything chosen first."""
    import bpy

    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    for step in steps:
        step()
    bpy.ops.object.mode_set(mode="OBJECT")


def draw_an_edge_again():
    """Dissolve an edge and draw it again: as many vertices, edges and faces as before."""
    import bmesh
    import bpy

    mesh = bpy.context.object.data
    made = bmesh.from_edit_mesh(mesh)
    made.edges.ensure_lookup_table()
    edge = next(edge for edge in made.edges if len(edge.link_faces) == 2)
    ends = list(edge.verts)
    bmesh.ops.dissolve_edges(made, edges=[edge], use_verts=False)
    bmesh.ops.connect_verts(made, verts=ends)
    bmesh.update_edit_mesh(mesh)


def spoil(folder):
    """The status after each thing that keeps a bake from playing, and whether what is shown is the bake again after it."""
    import bpy
    from test_tearing import add_torn_cloth

    obj = add_torn_cloth(end=12)
    path = os.path.join(folder, "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bake(obj)
    torn = at(obj, 12)
    bpy.ops.wm.save_mainfile()
    said, mended = {}, {}

    def spoiled(name, act):
        bpy.ops.wm.open_mainfile(filepath=path)
        obj = bpy.context.view_layer.objects.active = bpy.data.objects["Cloth"]
        act(obj)
        bpy.context.view_layer.update()
        said[name] = obj.boucle.status
        bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "b.blend"), copy=True)
        bpy.ops.wm.open_mainfile(filepath=os.path.join(folder, "b.blend"))
        obj = bpy.data.objects["Cloth"]
        mended[name] = [obj.boucle.status.startswith("Baked"), at(obj, 12) == torn]

    def mute(obj):
        nodes = obj.modifiers["Boucle Mend"].node_group.nodes
        next(node for node in nodes if "Merge" in node.bl_idname).mute = True

    spoiled("nothing", lambda _: None)
    spoiled(
        "sorted",
        lambda obj: edit(
            obj, lambda: bpy.ops.mesh.sort_elements(type="REVERSE", elements={"FACE"})
        ),
    )
    spoiled("drawn", lambda obj: edit(obj, draw_an_edge_again))
    spoiled(
        "marks", lambda obj: obj.data.attributes["boucle_tear"].data[0].__setattr__("value", True)
    )
    spoiled("moved", lambda obj: obj.modifiers.move(3, 1))
    spoiled("gone", lambda obj: obj.modifiers.remove(obj.modifiers["Boucle Mend"]))
    spoiled("muted", mute)
    spoiled("off", lambda obj: setattr(obj.modifiers["Boucle Tear"], "show_viewport", False))
    return {"said": said, "mended": mended}


def test_what_no_longer_fits_is_said_in_one_sentence_and_mended_where_it_can_be(blender):
    found = blender.run(spoil, folder=blender.folder)
    said, mended = found["said"], found["mended"]
    assert said["nothing"].startswith("Baked: frames 1 to 12")
    for name in ("sorted", "drawn"):
        assert said[name] == (
            '"Cloth": its faces or edges are not numbered as when it was baked torn (some were added, removed or '
            "sorted): restore the mesh, or bake again"
        )
        assert mended[name][0] is False, "it is not passed off as baked"
    assert said["marks"].startswith('"Cloth": the edges that its mesh marks as torn are not')
    for name in ("moved", "gone", "muted", "off"):
        assert said[name].startswith('"Cloth": the modifiers that split and mend it'), name
        assert said[name].endswith("were moved, changed or switched off: bake again")
    for name in ("nothing", "marks", "moved", "gone", "muted", "off"):
        assert mended[name] == [True, True], name


def damage_one(folder):
    """Two torn cloths are baked twice, the file saved after the first time; then the .tear of one is damaged."""
    import contextlib
    import io

    import bpy
    from test_tearing import add_torn_cloth

    cloths = [add_torn_cloth(end=12), add_torn_cloth(end=12)]
    cloths[1].location.y = 3.0
    path = os.path.join(folder, "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    for obj in cloths:
        bake(obj)
    bpy.ops.wm.save_mainfile()
    for obj in cloths:
        open_further(obj)
        bake(obj)
    torn = at(cloths[1], 12)
    cache = Path(bpy.path.abspath(cloths[0].modifiers["Boucle Cache"].filepath))
    cache.with_suffix(".tear").write_bytes(b"nothing of use")
    said = io.StringIO()
    with contextlib.redirect_stderr(said):
        bpy.ops.wm.open_mainfile(filepath=path)
    first, second = bpy.data.objects["Cloth"], bpy.data.objects["Cloth.001"]
    return {"said": said.getvalue().strip(), "first": first.boucle.status,
            "second": second.boucle.status, "plays": at(second, 12) == torn}  # fmt: skip


def test_one_damaged_file_holds_up_no_other_cloth(blender):
    found = blender.run(damage_one, folder=blender.folder)
    assert found["plays"] and found["second"].startswith("Baked: frames 1 to 12")
    assert found["first"].startswith('"Cloth": ') and found["first"].endswith(
        "is damaged: bake again"
    )
    assert found["said"].count("\n") == 0 and found["said"].startswith('Boucle: "Cloth": "')


def among_others(folder):
    """The artist's own modifiers and groups of our names, the active modifier, and what applying by hand leaves."""
    import bpy
    from test_tearing import add_torn_cloth, plain

    obj = add_torn_cloth(end=12)
    stranger = bpy.data.node_groups.new("Boucle Mend", "GeometryNodeTree")
    stranger.use_fake_user = True
    obj.modifiers.new("Boucle Mend", "WELD")
    obj.modifiers.new("Mine", "SUBSURF")
    obj.modifiers.active = obj.modifiers["Boucle Mend"]
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bake(obj)
    out = {"active": obj.modifiers.active.name, "stack": [m.name for m in obj.modifiers]}
    out["group"] = obj.modifiers["Boucle Mend.001"].node_group != stranger
    bpy.ops.boucle.free_bake()
    out["freed"] = [obj.modifiers.active.name, [m.name for m in obj.modifiers]]
    out["groups"] = sorted(group.name for group in bpy.data.node_groups)
    bake(obj)
    bpy.context.scene.frame_set(12)
    obj.select_set(True)
    for name in [m.name for m in obj.modifiers][:4]:
        bpy.ops.object.modifier_apply(modifier=name)
    out["applied"] = plain(obj)["attributes"]
    bpy.ops.wm.save_mainfile()
    out["saved"] = plain(obj)["attributes"]
    out["vertices"] = len(obj.data.vertices)
    return out


def test_the_artists_own_modifiers_are_left_alone_and_nothing_of_ours_is_left(blender):
    found = blender.run(among_others, folder=blender.folder)
    ours = ["Boucle Target", "Boucle Tear", "Boucle Cache", "Boucle Mend.001"]
    assert found["stack"] == [*ours, "Boucle Mend", "Mine"] and found["group"]
    assert found["active"] == "Boucle Mend"
    assert found["freed"] == [
        "Boucle Mend",
        ["Boucle Target", "Boucle Cache", "Boucle Mend", "Mine"],
    ]
    assert found["groups"] == ["Boucle Mend", "Boucle Target"]
    assert found["applied"] == ["boucle_target"] and found["saved"] == []
    assert found["vertices"] == 72
