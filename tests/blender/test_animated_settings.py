"""Animated settings: followed from frame to frame or taken at the start frame, and no reason to call a result outdated."""


def key(owner, path, *values):
    """Values at frames 1, 4, 7 ..."""
    for number, value in enumerate(values):
        holder, _, name = path.rpartition(".")
        setattr(owner.path_resolve(holder) if holder else owner, name, value)
        owner.keyframe_insert(path, frame=1 + 3 * number)


def strip_of(owner):
    """Move the action of an object into an NLA strip."""
    data = owner.animation_data
    action, slot = data.action, getattr(data, "action_slot", None)
    strip = data.nla_tracks.new().strips.new("All", 1, action)
    if slot is not None:
        strip.action_slot = slot
    data.action = None


def follow_wind():
    import bpy
    from cloths import add_cloth, addon, farthest, play, shown_positions

    scene = bpy.context.scene
    scene.use_gravity = False
    live = addon("bridge.live")
    obj = add_cloth(end=8, use_wind=True, wind_coefficient=0.02)
    key(obj, "boucle.wind_velocity", (0.0, 3.0, 0.0), (0.0, -6.0, 0.0), (0.0, 0.0, 0.0))
    play(1, 8)
    first = shown_positions(obj)
    out = {"live": live.session_of(obj).frames.last}
    bpy.ops.boucle.bake()
    scene.frame_set(8)
    out["alike"] = farthest(shown_positions(obj), first)
    out["status"] = obj.boucle.status
    out["drift"] = addon("bridge.cache").drift_of(obj, scene, in_full=True)

    # Stopped and resumed, to the bit; together with another whose wind is its own.
    other = add_cloth(end=8, use_wind=True, wind_coefficient=0.02, wind_velocity=(0.0, 1.0, 0.0))
    other.location.y = 5.0
    cloths = [obj, other]
    whole = []
    for stopped in (False, True):
        bake = addon("bridge.bake").Bake(cloths, scene)
        steps = bake.steps()
        for step in steps:
            step.run()
            if stopped and step.frame == 4:
                break
        steps.close()
        if stopped:
            resumed = addon("bridge.bake").Bake(
                cloths, scene, addon("bridge.bake").Options(resume=True)
            )
            for step in resumed.steps():
                step.run()
        scene.frame_set(8)
        whole.append([shown_positions(one) for one in cloths])
    out["together"] = farthest(whole[0][0], first)
    out["resumed"] = whole[0] == whole[1]

    # A key that is changed makes the bake outdated; one of a driver or strip is no reason by itself.
    obj.animation_data.action.name = "Gusts"
    key(obj, "boucle.wind_velocity", (0.0, 3.0, 0.0), (0.0, -5.0, 0.0))
    out["changed"] = obj.boucle.status
    return out


def test_animated_wind_is_followed_live_baked_and_resumed(blender):
    found = blender.run(follow_wind)
    assert found["live"] == 8
    assert found["alike"] < 1e-6
    assert "outdated" not in found["status"] and found["drift"] == []
    assert found["together"] < 2e-3 and found["resumed"]
    assert "outdated, changed since: keys of wind velocity" in found["changed"]


def sample_once():
    import bpy
    from cloths import add_cloth, addon, play

    live, cache, scene = addon("bridge.live"), addon("bridge.cache"), bpy.context.scene
    obj = add_cloth(end=6)
    key(obj, "boucle.stretch", 500.0, 900.0, 100.0)
    key(obj, "boucle.friction", 0.1, 0.7)
    driver = obj.driver_add("boucle.bend").driver
    driver.expression = "frame"
    ground = bpy.data.objects.new("Ground", bpy.data.meshes.new("Ground"))
    ground.data.from_pydata([(-1, -1, -9), (1, -1, -9), (0, 1, -9)], [], [(0, 1, 2)])
    scene.collection.objects.link(ground)
    ground.modifiers.new("Collision", "COLLISION")
    key(ground, "collision.cloth_friction", 5.0, 50.0)
    bpy.context.view_layer.update()
    play(1, 6)
    session = live.session_of(obj)
    live.revalidate(scene)
    out = {"undo": live.session_of(obj) is session and session.frames.last == 6}
    bpy.context.view_layer.objects.active = obj
    bpy.ops.boucle.bake()
    for frame in (1, 3, 6):
        scene.frame_set(frame)
        out[f"at {frame}"] = [obj.boucle.status, cache.drift_of(obj, scene, in_full=True)]
    scene.frame_set(5)
    out["resumed"] = list(bpy.ops.boucle.bake(resume=True))
    key(obj, "boucle.stretch", 700.0)
    scene.frame_set(5)
    out["changed"] = obj.boucle.status
    key(obj, "boucle.stretch", 500.0)
    strip_of(obj)
    out["strips"] = addon("bridge.animation").moves(obj, "boucle.stretch")
    obj.animation_data.nla_tracks[0].mute = True
    out["muted"] = addon("bridge.animation").moves(obj, "boucle.stretch")
    return out


def test_settings_that_are_taken_once_do_not_drift_with_the_frame(blender):
    found = blender.run(sample_once)
    assert found["undo"]
    for frame in (1, 3, 6):
        status, drift = found[f"at {frame}"]
        assert "outdated" not in status and drift == [], frame
    assert found["resumed"] == ["FINISHED"]
    assert "changed since: stretch stiffness" in found["changed"]
    assert found["strips"] and not found["muted"]


def follow_gravity():
    import bpy
    from cloths import add_cloth, addon, farthest, play, shown_positions

    live, scene = addon("bridge.live"), bpy.context.scene
    obj = add_cloth(end=8)
    key(scene, "gravity", (0.0, 0.0, -9.81), (4.0, 0.0, -2.0), (0.0, 0.0, 9.81))
    scene.use_gravity = True
    scene.keyframe_insert("use_gravity", frame=1)
    play(1, 8)
    session, first = live.session_of(obj), shown_positions(obj)
    out = {"live": session is not None and session.frames.last}
    bpy.ops.boucle.bake()
    scene.frame_set(8)
    out["alike"] = farthest(shown_positions(obj), first)
    out["status"] = obj.boucle.status
    key(scene, "gravity", (0.0, 0.0, -1.0))
    out["changed"] = obj.boucle.status
    return out


def test_keyed_gravity_is_followed_live(blender):
    found = blender.run(follow_gravity)
    assert found["live"] == 8
    assert found["alike"] < 1e-6
    assert "outdated" not in found["status"]
    assert "changed since: keys of gravity" in found["changed"]
