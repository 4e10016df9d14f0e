"""USD and Alembic: what is exported comes back as the same motion."""

import os


def export(folder, version):
    import bpy
    from cloths import add_cloth, farthest, shown_positions

    del version
    gale = {"use_wind": True, "wind_velocity": (0.0, 8.0, 0.0), "wind_coefficient": 0.01}
    cloth, other = add_cloth(end=6, **gale), add_cloth(end=9)
    cloth.boucle.use_strain = True
    out = {"poll": bpy.ops.boucle.export_usd.poll()}
    other.location.y = 3.0
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bpy.ops.boucle.bake_all()
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    bpy.context.view_layer.objects.active = cloth
    scene.frame_start, scene.frame_end = 40, 50
    scene.frame_set(45)
    before = [scene.frame_start, scene.frame_end, scene.frame_current, cube.select_get()]
    paths = {kind: os.path.join(folder, f"cloth.{kind}") for kind in ("usdc", "abc")}
    bpy.ops.boucle.export_usd(filepath=paths["usdc"])
    bpy.ops.boucle.export_alembic(filepath=paths["abc"])
    both = os.path.join(folder, "both.abc")
    bpy.ops.boucle.export_alembic(filepath=both, all_cloths=True)
    after = [scene.frame_start, scene.frame_end, scene.frame_current, cube.select_get()]
    out["restored"] = before == after and bpy.context.view_layer.objects.active == cloth
    expected = {}
    for frame in (1, 3, 6):
        scene.frame_set(frame)
        expected[frame] = shown_positions(cloth)
    scene.frame_set(6)
    strain = [0.0] * 48
    cloth.data.attributes["boucle_strain"].data.foreach_get("value", strain)
    out["moves"] = farthest(expected[1], expected[6])

    def come_back(path, importer):
        known = set(bpy.data.objects)
        importer(filepath=path)
        found = [o for o in bpy.data.objects if o not in known and o.type == "MESH"]
        obj = next(
            o for o in found if "001" not in o.name.split("Cloth")[-1][:4] or len(found) == 1
        )
        errors = []
        for frame, positions in expected.items():
            scene.frame_set(frame)
            errors.append(farthest(shown_positions(obj), positions))
        evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        attribute = evaluated.attributes.get("boucle_strain")
        values = [0.0] * 48
        if attribute is not None:
            attribute.data.foreach_get("value", values)
        return [len(found), max(errors), attribute is not None, farthest(values, strain)]

    scene.frame_set(6)
    out["usd"] = come_back(paths["usdc"], bpy.ops.wm.usd_import)
    out["abc"] = come_back(paths["abc"], bpy.ops.wm.alembic_import)
    known = set(bpy.data.objects)
    bpy.ops.wm.alembic_import(filepath=both)
    out["both"] = len([o for o in bpy.data.objects if o not in known and o.type == "MESH"])
    out["strain"] = max(strain)
    return out


def test_what_is_exported_comes_back_with_its_motion_and_its_strain(blender):
    result = blender.run(export, folder=blender.folder, version=blender.version)
    assert result["poll"] is False, "an unbaked cloth has nothing to export"
    assert result["restored"]
    assert result["moves"] > 0.1 and result["strain"] > 1e-3
    for kind in ("usd", "abc"):
        count, error, _, _ = result[kind]
        assert count == 1, kind
        assert error < 1e-5, kind
    assert result["usd"][2] and result["usd"][3] < 1e-5
    assert result["both"] == 2


def export_beside_live(folder):
    import bpy
    from cloths import add_cloth, addon, farthest, mesh_positions, play, refusal_of, shown_positions

    live, scene = addon("bridge.live"), bpy.context.scene
    cloth, other = add_cloth(end=2, frame_start=-4), add_cloth(end=30)
    other.location.y = 3.0
    bpy.context.view_layer.objects.active = cloth
    bpy.ops.boucle.bake()
    play(1, 1)  # the export walks through frame 2
    session = live.session_of(other)
    before = [session.frames.last, mesh_positions(other)]
    path = os.path.join(folder, "early.abc")
    said = refusal_of(bpy.ops.boucle.export_usd, filepath=os.path.join(folder, "early.usdc"))
    bpy.ops.boucle.export_alembic(filepath=path)
    same = live.session_of(other) is session
    out = {"live": same and [session.frames.last, mesh_positions(other)] == before, "usd": said}
    out["goes on"] = [play(2, 4), live.session_of(other).frames.last][1]
    expected = {}
    for frame in (-4, -1, 0, 2):
        scene.frame_set(frame)
        expected[frame] = shown_positions(cloth)
    out["moves"] = farthest(expected[-4], expected[-1])
    known = set(bpy.data.objects)
    bpy.ops.wm.alembic_import(filepath=path)
    found = next(o for o in bpy.data.objects if o not in known and o.type == "MESH")
    out["errors"] = []
    for frame, positions in expected.items():
        scene.frame_set(frame)
        out["errors"].append(farthest(shown_positions(found), positions))
    return out


def test_an_export_leaves_live_cloths_alone_and_takes_negative_frames(blender):
    result = blender.run(export_beside_live, folder=blender.folder)
    assert result["live"] and result["goes on"] == 4
    assert "begin at frame -4, and Blender writes USD from frame 0 on" in result["usd"]
    assert result["moves"] > 1e-3
    assert max(result["errors"]) < 1e-5, result["errors"]


def refuse_export(folder):
    import bpy
    from cloths import add_cloth, refusal_of

    cloth = add_cloth(end=4)
    bpy.ops.boucle.bake()
    path = os.path.join(folder, "file")
    with open(path, "w") as file:
        file.write("in the way")
    said = [refusal_of(bpy.ops.boucle.export_usd, filepath=os.path.join(path, "a.usdc"))]
    cache = bpy.path.abspath(cloth.modifiers["Boucle Cache"].filepath)
    os.rename(cache, cache + ".away")
    said.append(refusal_of(bpy.ops.boucle.export_alembic, filepath=os.path.join(folder, "a.abc")))
    return said


def test_an_export_that_cannot_be_made_says_why(new_blender):
    unwritable, missing = new_blender.run(refuse_export, folder=new_blender.folder)
    assert "is not exported" in unwritable
    assert "is missing" in missing
