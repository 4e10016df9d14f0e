"""The frame that is shown, applied: as rest shape, as start pose, as shape key."""


def apply_all():
    import bpy
    from cloths import add_cloth, addon, farthest, mesh_positions, play, refusal_of, shown_positions

    scene, ops = bpy.context.scene, bpy.ops.boucle
    cache, live = addon("bridge.cache"), addon("bridge.live")
    out = {}
    obj = add_cloth(end=8)
    rest = mesh_positions(obj)
    out["refusals"] = [refusal_of(ops.apply_as_rest), refusal_of(ops.apply_as_shape_key)]

    # As a shape key, live: the rest stays, and so do the frames.
    play(1, 6)
    shown = shown_positions(obj)
    ops.apply_as_shape_key()
    keys = obj.data.shape_keys.key_blocks
    out["keys"] = [key.name for key in keys], keys[1].value
    co = [0.0] * len(rest)
    keys[1].data.foreach_get("co", co)
    out["key"] = farthest(co, shown)
    out["base"] = farthest(mesh_positions(obj), rest)
    bpy.context.view_layer.update()
    out["still shown"] = farthest(shown_positions(obj), shown), live.session_of(obj).frames.last
    play(7, 8)
    out["goes on"] = live.session_of(obj).frames.last
    out["refusals"].append(refusal_of(ops.apply_as_rest))

    # As the rest shape, baked.
    obj = add_cloth(end=8)
    bpy.ops.boucle.bake()
    scene.frame_set(8)
    shown = shown_positions(obj)
    twin = bpy.data.objects.new("Twin", obj.data)
    out["refusals"].append(refusal_of(ops.apply_as_rest))
    bpy.data.objects.remove(twin)
    ops.apply_as_rest()
    out["rest"] = farthest(mesh_positions(obj), shown), cache.is_baked(obj), cache.has_previous(obj)
    scene.frame_set(1)
    play(1, 2)
    rows = addon("bridge.certificate").rows(obj)
    out["at rest"] = rows[1]["max_strain"]
    # As the rest shape, live.
    play(3, 8)
    shown = shown_positions(obj)
    ops.apply_as_rest()
    out["live"] = farthest(mesh_positions(obj), shown), live.session_of(obj) is None
    hook = obj.modifiers.new("Cast", "CAST")
    obj.modifiers.move(obj.modifiers.find("Cast"), 0)
    play(1, 3)
    out["refusals"].append(refusal_of(ops.apply_as_rest))
    obj.modifiers.remove(hook)

    # As the start pose: the lengths at rest stay.
    out["can start"] = hasattr(obj.boucle, "rest_shape_key"), ops.apply_as_start.poll()
    if out["can start"][0]:
        obj = add_cloth(end=8)
        play(1, 8)
        shown, strain = shown_positions(obj), addon("bridge.certificate").rows(obj)[8]["max_strain"]
        ops.apply_as_start()
        scene.frame_set(1)
        play(1, 2)
        began = addon("bridge.certificate").rows(obj)[1]["max_strain"]
        out["start"] = farthest(shown_positions(obj), shown), began - strain, strain
        play(3, 5)
        obj.boucle.use_dynamic_mesh = True
        play(1, 4)
        before = live.session_of(obj)
        out["dynamic"] = refusal_of(ops.apply_as_start), live.session_of(obj) is before
    return out


def test_a_frame_becomes_rest_shape_start_pose_or_shape_key(blender):
    found = blender.run(apply_all)
    nothing, nothing_too, keyed, shared, moved = found["refusals"]
    assert "has no result" in nothing and "has no result" in nothing_too
    assert "has shape keys" in keyed and "shares its mesh" in shared and '"Cast" above' in moved
    assert found["keys"] == [["Basis", "Frame 6"], 0.0]
    assert found["key"] < 1e-6 and found["base"] == 0.0
    assert found["still shown"][0] < 1e-6 and found["still shown"][1] == 6
    assert found["goes on"] == 8
    assert found["rest"] == [0.0, False, True]
    assert abs(found["at rest"]) < 1e-6
    assert found["live"] == [0.0, True]
    has_setting, polls = found["can start"]
    assert has_setting == polls
    if has_setting:
        distance, difference, strain = found["start"]
        refused, is_kept = found["dynamic"]
        assert "has Dynamic Mesh on" in refused and is_kept
        assert distance < 0.2 and strain > 0.002 and abs(difference) < 1e-3
