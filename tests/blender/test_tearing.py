"""Tearing: from the settings to a file that plays in a Blender without the add-on."""

import os
from pathlib import Path

FRAMES = (1, 6, 12, 20)


def add_torn_cloth(columns=9, rows=7, end=20, **values):
    """A hanging cloth that opens across a row at frame 5, with a UV map, two materials and a group of weights."""
    import bpy
    from cloths import add_cloth

    values = {
        "use_tear": True,
        "tear_stress": 0.0,
        "tear_opening_group": "open",
        "tear_opening_frame": 5,
        **values,
    }
    obj = add_cloth(columns=columns, rows=rows, end=end)
    mesh = obj.data
    heights = sorted({round(vertex.co.z, 5) for vertex in mesh.vertices})
    row = [v.index for v in mesh.vertices if round(v.co.z, 5) == heights[len(heights) // 2]]
    obj.vertex_groups.new(name="open").add(row, 1.0, "REPLACE")
    shade = obj.vertex_groups.new(name="shade")
    for vertex in mesh.vertices:
        shade.add([vertex.index], 0.1 + 0.01 * vertex.index, "REPLACE")
    if not mesh.uv_layers:
        mesh.uv_layers.new(name="UVMap")
    for name in ("one", "two"):
        mesh.materials.append(bpy.data.materials.new(name))
    for face in mesh.polygons:
        face.material_index = face.index % 2
    for name, value in values.items():
        setattr(obj.boucle, name, value)
    return obj


def looks(obj):
    """What is evaluated, as lists: vertices, faces, UVs, materials, weights."""
    import bpy
    from cloths import shown_positions

    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return {
        "positions": shown_positions(obj),
        "faces": [list(face.vertices) for face in mesh.polygons],
        "uvs": [list(one.uv) for one in mesh.uv_layers[0].data],
        "materials": [face.material_index for face in mesh.polygons],
        "weights": [sorted([g.group, g.weight] for g in v.groups) for v in mesh.vertices],
    }


def at_frames(obj, frames=FRAMES):
    import bpy

    found = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        found.append(looks(obj))
    return found


def corners_of(look):
    """Positions of all corners of all faces."""
    at = look["positions"]
    return [at[3 * vertex : 3 * vertex + 3] for face in look["faces"] for vertex in face]


def plain(obj):
    """The artist's mesh: positions, faces, edges and names of its attributes."""
    mesh = obj.data
    return {
        "positions": [list(vertex.co) for vertex in mesh.vertices],
        "faces": [list(face.vertices) for face in mesh.polygons],
        "attributes": sorted(
            name for name in [*mesh.attributes.keys()] if name.startswith("boucle")
        ),
        "modifiers": [modifier.name for modifier in obj.modifiers],
    }


def bake_and_save(folder):
    import bpy

    obj = add_torn_cloth()
    before = plain(obj)
    path = os.path.join(folder, "torn.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    done = bpy.ops.boucle.bake()
    played = at_frames(obj)
    during = plain(obj)
    status = obj.boucle.status
    bpy.ops.wm.save_mainfile()
    files = sorted(
        os.listdir(os.path.dirname(bpy.path.abspath(obj.modifiers["Boucle Cache"].filepath)))
    )
    return {
        "done": list(done), "before": before, "during": during, "status": status, "played": played,
        "files": [name.split(".", 1)[1] for name in files],
    }  # fmt: skip


def open_and_free(path):
    import bpy

    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.context.view_layer.objects.active = bpy.data.objects["Cloth"]
    played = at_frames(obj)
    bpy.ops.boucle.free_bake()
    groups = [group.name for group in bpy.data.node_groups]
    return {"played": played, "after": plain(obj), "groups": groups}


def play_alone(path):
    import bpy

    bpy.ops.wm.open_mainfile(filepath=path)
    assert not hasattr(bpy.types.Object, "boucle")
    return at_frames(bpy.data.objects["Cloth"])


def test_a_row_that_opens_parts_the_mesh_and_leaves_the_artists_alone(blender):
    baked = blender.run(bake_and_save, folder=blender.folder)
    assert baked["done"] == ["FINISHED"], blender.output
    assert baked["status"].startswith("Baked: frames 1 to 20")
    first, _, torn, last = baked["played"]
    count = 3 * 9 * 7
    assert len(first["positions"]) == count
    assert len(last["positions"]) == len(torn["positions"]) == count + 3 * 9, "a row is there twice"
    assert first["faces"] == baked["before"]["faces"], "whole, vertices have their numbers"
    for look in baked["played"]:
        for name in ("uvs", "materials"):
            assert look[name] == first[name]
        assert look["weights"][: 9 * 7] == first["weights"]
        corners = zip(look["faces"], first["faces"], strict=True)
        same = [a == b for one, other in corners for a, b in zip(one, other, strict=True) if a < 63]
        assert all(same), "the first vertices are those of the mesh"
    assert baked["during"]["positions"] == baked["before"]["positions"]
    assert baked["during"]["faces"] == baked["before"]["faces"]
    assert baked["during"]["attributes"] == ["boucle_tear"]
    assert baked["files"] == ["checkpoint", "json", "pc2", "tear"]
    lower = min(last["positions"][2::3])
    assert lower < min(first["positions"][2::3]) - 0.1, "the lower half has fallen"
    alone = blender.run(play_alone, addon=False, path=blender.folder / "torn.blend")
    assert alone == baked["played"]
    freed = blender.run(open_and_free, path=blender.folder / "torn.blend")
    assert freed["played"] == baked["played"]
    assert freed["after"] == baked["before"], "nothing is left on the mesh nor in the stack"
    assert freed["groups"] == ["Boucle Target"]


def stop_and_resume(folder):
    """Corners at some frames: of a whole bake, of a stopped one, resumed, and gone on with after its end."""
    import bpy
    from cloths import addon

    obj = add_torn_cloth(use_force=True)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bpy.ops.boucle.bake()
    out = {"whole": at_frames(obj)}
    path = bpy.path.abspath(obj.modifiers["Boucle Cache"].filepath)
    forces = Path(path.replace(".pc2", ".force")).read_bytes()
    bake = addon("bridge.bake").Bake([obj], bpy.context.scene)
    steps = bake.steps()
    for step in steps:
        step.run()
        if step.frame == 13:
            break
    steps.close()
    out["status"] = obj.boucle.status
    out["group"] = obj.modifiers["Boucle Tear"].node_group.name
    out["marks"] = "boucle_tear" in obj.data.attributes
    out["stopped"] = at_frames(obj, FRAMES[:3])
    bpy.ops.boucle.bake(resume=True)
    out["resumed"] = at_frames(obj)
    out["forces"] = Path(path.replace(".pc2", ".force")).read_bytes() == forces
    obj.boucle.frame_end = 24
    bpy.ops.boucle.bake(resume=True)
    out["longer"] = [at_frames(obj), obj.boucle.status]
    out["last"] = at_frames(obj, (20, 24))
    bpy.ops.boucle.bake()
    out["at once"] = at_frames(obj, (20, 24))
    bpy.ops.boucle.bake(resume=True)
    out["after"] = at_frames(obj, (20, 24))
    return out


def test_a_stopped_bake_plays_and_goes_on_as_if_it_had_never_stopped(blender):
    found = blender.run(stop_and_resume, folder=blender.folder)
    assert found["status"].startswith("Partly baked: frames 1 to 13")
    assert (found["group"], found["marks"]) == ("Boucle Split", False), "split along all edges"
    for one, whole in zip(found["stopped"], found["whole"], strict=False):
        assert corners_of(one) == corners_of(whole)
        assert one["uvs"] == whole["uvs"] and one["materials"] == whole["materials"]
    assert found["resumed"] == found["whole"]
    assert found["forces"]
    assert found["longer"][0] == found["whole"]
    assert found["longer"][1].startswith("Baked: frames 1 to 24")
    assert found["last"][0] != found["last"][1], "it moves between the two frames"
    assert found["at once"] == found["last"] and found["after"] == found["last"]


def bake_by_stress(folder):
    """A cloth whose strength is painted to a twentieth along a column, pulled apart by its pins on both sides."""
    import bpy
    from cloths import addon, farthest

    obj = add_torn_cloth(
        end=16, tear_opening_group="", tear_stress=100.0, tear_noise=0.1, tear_seed=3
    )
    mesh = obj.data
    weak = [v.index for v in mesh.vertices if abs(v.co.x) < 1e-4]
    obj.vertex_groups.new(name="strong").add(weak, 0.05, "REPLACE")
    obj.boucle.tear_strength_group = "strong"
    hook = bpy.data.objects.new("Hook", None)
    bpy.context.collection.objects.link(hook)
    sides = {True: obj.vertex_groups.new(name="right"), False: obj.vertex_groups.new(name="held")}
    for vertex in mesh.vertices:
        if abs(abs(vertex.co.x) - 1.0) < 1e-4:
            sides[vertex.co.x > 0.0].add([vertex.index], 1.0, "REPLACE")
            sides[False].add([vertex.index], 1.0, "REPLACE")
    obj.boucle.pin_group = "held"
    modifier = obj.modifiers.new("Hook", "HOOK")
    modifier.object, modifier.vertex_group = hook, "right"
    obj.modifiers.move(len(obj.modifiers) - 1, 0)
    for frame, x in ((1, 0.0), (10, 0.6)):
        hook.location.x = x
        hook.keyframe_insert("location", frame=frame)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bpy.ops.boucle.bake()
    baked = at_frames(obj, (1, 5, 16))
    marks = [edge.value for edge in mesh.attributes["boucle_tear"].data]
    torn = [
        [mesh.vertices[v].co.x for v in mesh.edges[k].vertices]
        for k, value in enumerate(marks)
        if value
    ]
    bpy.ops.boucle.free_bake()
    play = addon("bridge.live")
    for frame in range(1, 17):
        bpy.context.scene.frame_set(frame)
    live = looks(obj)
    message = play.status(obj)
    live_mesh = plain(obj)
    bpy.ops.boucle.reset()
    gone = plain(obj)
    ends = [corners_of(look) for look in (live, baked[-1])]
    flat = [[x for corner in corners for x in corner] for corners in ends]
    return {"torn": torn, "baked": [len(b["positions"]) // 3 for b in baked], "message": message,
            "apart": farthest(*flat), "live": len(live["positions"]) // 3, "live_mesh": live_mesh, "gone": gone,
            "vertices": len(mesh.vertices)}  # fmt: skip


def test_a_sheet_that_is_pulled_tears_where_it_is_weak_live_as_baked(blender):
    found = blender.run(bake_by_stress, folder=blender.folder)
    # An edge to a weak vertex breaks, and the cloth parts at either of its ends.
    assert found["torn"] and all(abs(x) < 0.26 for edge in found["torn"] for x in edge), found[
        "torn"
    ]
    assert found["baked"][0] == found["vertices"] < found["baked"][2]
    assert found["message"].startswith("Live: frames 1 to 16")
    assert found["live"] == found["baked"][2]
    assert found["apart"] < 1e-5
    assert "boucle_tear" not in found["live_mesh"]["attributes"]
    assert {"Boucle Tear", "Boucle Mend"} <= set(found["live_mesh"]["modifiers"])
    assert not {"Boucle Tear", "Boucle Mend"} & set(found["gone"]["modifiers"])


def keep_and_bring_back(folder):
    import bpy

    obj = add_torn_cloth()
    path = os.path.join(folder, "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.boucle.bake()
    torn = at_frames(obj)
    bpy.ops.boucle.add_take()
    obj.boucle.use_tear = False
    bpy.ops.boucle.bake()
    whole = at_frames(obj)
    out = {"whole": [len(look["positions"]) for look in whole], "left": plain(obj)}
    bpy.ops.boucle.restore_bake()
    out["restored"] = at_frames(obj) == torn
    out["outdated"] = obj.boucle.status
    bpy.ops.boucle.restore_bake()
    out["swapped"] = at_frames(obj) == whole and plain(obj) == out["left"]
    bpy.ops.boucle.restore_take()
    out["take"] = at_frames(obj) == torn
    copy = obj.copy()
    copy.data = obj.data.copy()
    bpy.context.collection.objects.link(copy)
    out["copy"] = at_frames(copy) == torn
    bpy.context.view_layer.objects.active = copy
    bpy.ops.boucle.adopt_bake()
    out["adopted"] = at_frames(copy) == torn and not copy.boucle.is_foreign
    bpy.context.view_layer.objects.active = obj
    bpy.ops.boucle.free_bake()
    out["stays"] = at_frames(copy) == torn
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "b.blend"))
    name = copy.name
    bpy.ops.wm.open_mainfile(filepath=os.path.join(folder, "b.blend"))
    copy = bpy.data.objects[name]
    out["elsewhere"] = at_frames(copy) == torn
    bpy.context.view_layer.objects.active = copy
    bpy.ops.boucle.disable()
    out["disabled"] = plain(copy)
    return out


def test_torn_bakes_are_kept_restored_copied_and_let_go(blender):
    found = blender.run(keep_and_bring_back, folder=blender.folder)
    assert len(set(found["whole"])) == 1
    assert found["left"]["attributes"] == [] and "Boucle Tear" not in found["left"]["modifiers"]
    assert found["restored"] and "outdated, changed since" in found["outdated"]
    assert "tearing" in found["outdated"]
    assert (
        found["swapped"] and found["take"] and found["copy"] and found["adopted"] and found["stays"]
    )
    assert found["elsewhere"]
    assert found["disabled"]["attributes"] == [] and found["disabled"]["modifiers"] == []


def tell_forces(folder):
    """The corner numbers of a torn cloth, live and baked, beside what its edges carry by the solver's own list."""
    from array import array

    import bpy
    from cloths import addon

    obj = add_torn_cloth(
        end=8,
        overlay="force",
        use_strain=True,
        use_force=True,
        overlay_range="tear",
        tear_stress=30.0,
    )
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    scene, view = bpy.context.scene, addon("bridge.overlay_view")

    def told():
        attributes = obj.data.attributes
        out = {}
        for name in ("boucle_force", "boucle_strain"):
            values = [0.0] * len(attributes[name].data)
            attributes[name].data.foreach_get("value", values)
            out[name] = [attributes[name].domain, values]
        found = view.heat_map_of(obj, bpy.context.evaluated_depsgraph_get(), scene)
        out["map"] = [
            found.is_lines,
            len(found.positions) // 3,
            len(found.parts),
            found.low,
            found.high,
        ]
        return out

    for frame in range(1, 9):
        scene.frame_set(frame)
    live = told()
    solver = addon("bridge.live").session_of(obj).solver
    pulls = {frozenset((a, b)): pull for a, b, pull in solver.edge_tension(0)}
    origins = solver.vertex_origins(0)
    count = len(obj.data.loops)
    at = array("d", bytes(24 * count))
    solver.read_corners(0, at)
    places = {tuple(at[3 * k : 3 * k + 3]) for k in range(count)}
    bpy.ops.boucle.bake()
    scene.frame_set(8)
    baked = told()
    scene.frame_set(3)
    before = told()
    torn = len(origins)
    edges = len(pulls)
    limit = addon("bridge.tear_settings").limit(obj, "force")
    bpy.ops.wm.save_mainfile()
    obj.boucle.overlay = "strain"
    obj.boucle.tear_strain = 0.2
    scene.frame_set(3)
    strain = told()["map"]
    return {
        "live": live, "baked": baked, "before": before, "pulls": sorted(pulls.values()), "torn": torn,
        "places": len(places), "corners": count, "edges": edges, "limit": limit, "strain": strain,
    }  # fmt: skip


def test_each_edge_of_each_piece_has_its_own_force_live_and_baked(blender):
    found = blender.run(tell_forces, folder=blender.folder)
    for told in (found["live"], found["baked"], found["before"]):
        assert [told[name][0] for name in ("boucle_force", "boucle_strain")] == ["CORNER", "CORNER"]
        assert len(told["boucle_force"][1]) == found["corners"]
        assert told["map"][0] is True, "edges are drawn"
        assert told["map"][1:3] == [2 * found["corners"], 2 * found["corners"]]
        assert told["map"][3] == 0.0 and abs(told["map"][4] - found["limit"]) < 1e-6
    assert found["places"] == found["torn"] > 63
    shown = {round(value, 5) for value in found["live"]["boucle_force"][1]}
    assert shown == {round(value, 5) for value in found["pulls"]}, (
        "each edge's own tension, and no other"
    )
    assert found["edges"] == 6 * 9 + 7 * 8 + 8, "a row of edges is there twice"
    pairs = zip(found["baked"]["boucle_force"][1], found["live"]["boucle_force"][1], strict=True)
    assert max(abs(one - other) for one, other in pairs) < 1e-5
    mean = (2.0 / 8 * 8 * 7 + 1.0 / 6 * 6 * 9) / (8 * 7 + 6 * 9)
    assert abs(found["limit"] - 30.0 * mean) < 1e-3
    assert found["strain"][0] is False and abs(found["strain"][4] - 0.2) < 1e-6


def share_and_link(folder):
    import bpy
    from cloths import addon, refusal_of

    obj = add_torn_cloth()
    path = os.path.join(folder, "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.boucle.bake()
    torn = at_frames(obj)
    twin = obj.copy()
    twin.name = "Twin"
    bpy.context.collection.objects.link(twin)
    out = {"twin": at_frames(twin) == torn}
    bpy.context.view_layer.objects.active = twin
    twin.select_set(True)
    bpy.ops.boucle.bake()
    out["shared"] = [
        twin.modifiers["Boucle Tear"].node_group.name,
        "boucle_tear" in obj.data.attributes,
    ]
    out["all"] = [
        corners_of(a) == corners_of(b) for a, b in zip(at_frames(twin), torn, strict=True)
    ]
    out["first"] = at_frames(obj) == torn
    bpy.ops.boucle.free_bake()
    out["kept"] = at_frames(obj) == torn
    bpy.data.objects.remove(twin)
    bpy.context.view_layer.objects.active = obj
    scene = bpy.context.scene
    scene.frame_set(12)
    out["refused"] = refusal_of(bpy.ops.boucle.apply_as_rest)
    out["worst"] = addon("bridge.worst").edges(obj, scene)[0].strain
    out["certified"] = addon("bridge.certificate").row_of(obj, scene)["max_strain"]
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)
    with bpy.data.libraries.load(path, link=True) as (_, to):
        to.objects = ["Cloth"]
    bpy.context.scene.collection.objects.link(to.objects[0])
    out["linked"] = at_frames(to.objects[0]) == torn
    return out


def test_a_shared_mesh_is_split_along_all_edges_and_a_linked_one_plays(blender):
    found = blender.run(share_and_link, folder=blender.folder)
    assert found["twin"] and found["first"] and found["kept"]
    assert found["shared"] == ["Boucle Split", True]
    assert all(found["all"])
    assert "is torn at frame 12" in found["refused"]
    assert abs(found["worst"] - found["certified"]) < 1e-4, "of edges, not of gaps"
    assert found["linked"]


def bake_together(folder):
    """Two cloths that are baked together, one of them settled and torn, exported and brought back."""
    import bpy

    torn, whole = add_torn_cloth(end=12, settle_frames=4), None
    from cloths import add_cloth

    whole = add_cloth(end=12, settle_frames=4)
    for obj in (torn, whole):
        obj.boucle.object_collision = True
        obj.modifiers.new("Collision", "COLLISION")
    whole.location.y = 0.05
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    done = bpy.ops.boucle.bake_all()
    frames = (1, 4, 12)
    counts = [
        [len(look["positions"]) // 3 for look in at_frames(obj, frames)] for obj in (torn, whole)
    ]
    torn.boucle.frame_end = whole.boucle.frame_end = 14
    bpy.context.view_layer.objects.active = torn
    bpy.ops.boucle.bake(resume=True)
    counts.append(len(at_frames(torn, (14,))[0]["positions"]) // 3)
    bpy.context.scene.frame_set(14)
    expected = looks(torn)
    paths = {kind: os.path.join(folder, f"cloth.{kind}") for kind in ("usdc", "abc")}
    bpy.ops.boucle.export_usd(filepath=paths["usdc"])
    bpy.ops.boucle.export_alembic(filepath=paths["abc"])
    back = {}
    for kind, load in (("usdc", bpy.ops.wm.usd_import), ("abc", bpy.ops.wm.alembic_import)):
        known = set(bpy.data.objects)
        load(filepath=paths[kind])
        obj = next(o for o in bpy.data.objects if o not in known and o.type == "MESH")
        found = []
        for frame in (4, 14):
            bpy.context.scene.frame_set(frame)
            mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
            found.append([len(mesh.vertices), sorted(round(v.co.z, 3) for v in mesh.vertices)[0]])
        back[kind] = found
    low = round(min(expected["positions"][2::3]), 3)
    return {"done": list(done), "counts": counts, "back": back, "low": low,
            "record": torn.boucle.status}  # fmt: skip


def test_torn_cloths_are_baked_with_others_settle_whole_and_are_exported_torn(blender):
    found = blender.run(bake_together, folder=blender.folder)
    assert found["done"] == ["FINISHED"]
    (first, early, last), others, longer = found["counts"]
    assert first == early == 63 < last == longer
    assert set(others) == {48}
    for kind, ((before, _), (after, low)) in found["back"].items():
        assert (before, after) == (63, longer), kind
        assert abs(low - found["low"]) < 2e-3, kind
    assert found["record"].startswith("Baked: frames 1 to 14")


def bake_in_large_numbers(folder):
    """The same cloth in an object space of centimetres, far from its origin: float32 has no micrometres there."""
    import bpy
    from mathutils import Matrix

    obj = add_torn_cloth(end=8)
    obj.data.transform(Matrix.Translation((3000.0, 0.0, 0.0)) @ Matrix.Scale(100.0, 4))
    obj.scale = (0.01, 0.01, 0.01)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bpy.ops.boucle.bake()
    return [len(look["positions"]) // 3 for look in at_frames(obj, (1, 4, 8))]


def test_what_holds_is_whole_where_coordinates_are_large(new_blender):
    assert new_blender.run(bake_in_large_numbers, folder=new_blender.folder) == [63, 63, 72]


def override_and_undo(folder):
    import bpy
    from cloths import addon

    obj = add_torn_cloth()
    obj.name = "Costume"
    library, shot = (os.path.join(folder, f"{name}.blend") for name in ("library", "shot"))
    bpy.ops.wm.save_as_mainfile(filepath=library)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)
    with bpy.data.libraries.load(library, link=True) as (_, to):
        to.objects = ["Costume"]
    bpy.context.scene.collection.objects.link(to.objects[0])
    own = to.objects[0].override_create(remap_local_usages=True)
    own.override_library.is_system_override = False
    bpy.context.view_layer.objects.active = own
    bpy.ops.wm.save_as_mainfile(filepath=shot)
    done = bpy.ops.boucle.bake()
    torn = at_frames(own)
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=shot)
    own = next(one for one in bpy.data.objects if one.library is None and one.name == "Costume")
    out = {
        "done": list(done), "again": at_frames(own) == torn,
        "counts": [len(look["positions"]) // 3 for look in torn],
        "stack": [modifier.name for modifier in own.modifiers],
    }  # fmt: skip
    bpy.ops.wm.open_mainfile(filepath=library)
    obj = bpy.context.view_layer.objects.active = bpy.data.objects["Costume"]
    bpy.ops.ed.undo_push(message="begin")
    bpy.ops.boucle.bake()
    bpy.ops.ed.undo_push(message="torn")
    first = at_frames(obj)
    obj.vertex_groups["open"].add([4, 13, 22, 31], 1.0, "REPLACE")
    bpy.ops.ed.undo_push(message="group")
    bpy.ops.boucle.bake()
    other = at_frames(obj)
    bpy.ops.ed.undo_push(message="torn otherwise")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Costume"]
    out["differ"] = other != first
    out["undone"] = at_frames(obj) == other, "the files are those of the later bake"
    out["trouble"] = addon("bridge.cache").problem(obj)
    return out


def test_overrides_tear_and_undo_plays_what_is_on_the_disk(blender):
    found = blender.run(override_and_undo, folder=blender.folder)
    assert found["done"] == ["FINISHED"]
    assert found["counts"] == [63, 72, 72, 72] and found["again"]
    assert found["stack"] == ["Boucle Target", "Boucle Tear", "Boucle Cache", "Boucle Mend"]
    assert found["differ"] and found["undone"][0] and found["trouble"] == ""
