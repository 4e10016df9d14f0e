"""Live mode: play, scrub, reset, follow what moves the cloth."""


def play_and_scrub():
    import bpy
    from cloths import add_cloth, farthest, mesh_positions, pinned_vertices, play

    obj = add_cloth()
    rest = mesh_positions(obj)
    frames = []
    for frame in range(1, 13):
        play(frame, frame)
        frames.append(mesh_positions(obj))
    status = obj.boucle.status
    scrubbed = []
    for frame in (12, 3, 7, 1, 12):
        bpy.context.scene.frame_set(frame)
        scrubbed.append(mesh_positions(obj) == frames[frame - 1])
    pins = pinned_vertices(obj)
    held = max(
        farthest(frame[3 * pin : 3 * pin + 3], rest[3 * pin : 3 * pin + 3])
        for frame in frames
        for pin in pins
    )
    fall = [rest[2] - frame[2] for frame in frames]
    bpy.ops.boucle.reset()
    return {
        "first_is_rest": frames[0] == rest,
        "held": held,
        "fall": fall,
        "scrubbed": scrubbed,
        "status": status,
        "reset": mesh_positions(obj) == rest,
        "attributes": "boucle_rest" in obj.data.attributes,
    }


def test_play_lets_the_cloth_fall_and_scrubbing_shows_the_same_frames(blender):
    result = blender.run(play_and_scrub)
    assert result["first_is_rest"]
    assert result["held"] < 1e-6
    assert result["fall"][0] == 0.0 and result["fall"][3] > 1e-4
    assert all(result["scrubbed"])
    assert result["status"].startswith("Live: frames 1 to 12 in memory")
    assert result["reset"] and not result["attributes"]


def count_steps():
    import bpy
    from cloths import add_cloth, addon, play

    obj = add_cloth(end=8)
    live = addon("bridge.live")
    stepped = []
    real = live._step
    live._step = lambda session, *rest: (
        stepped.append(session.frames.last + 1) or real(session, *rest)
    )
    scene = bpy.context.scene
    play(1, 5)
    scene.frame_set(3, subframe=0.5)
    scene.frame_set(5, subframe=0.75)
    play(1, 12)
    play(1, 4)
    scene.frame_set(40)
    far = obj.boucle.status
    return [stepped, far]


def test_every_frame_is_simulated_once_forwards_and_only_in_the_range(blender):
    stepped, far = blender.run(count_steps)
    assert stepped == [2, 3, 4, 5, 6, 7, 8]
    assert far.startswith("Live: frames 1 to 8")


def skip_frames():
    import bpy
    from cloths import add_cloth, mesh_positions, play

    obj = add_cloth()
    play(1, 5)
    last = mesh_positions(obj)
    bpy.context.scene.frame_set(9)
    waiting = [mesh_positions(obj) == last, obj.boucle.status]
    play(6, 9)
    return [*waiting, mesh_positions(obj) == last, obj.boucle.status]


def test_after_a_skipped_frame_the_cloth_waits_and_says_so(blender):
    same, said, still_same, later = blender.run(skip_frames)
    assert same
    assert "frame 6 was skipped" in said and "Play Every Frame" in said
    assert not still_same
    assert later.startswith("Live: frames 1 to 9") and "skipped" not in later


def change_settings():
    import bpy
    from cloths import add_cloth, mesh_positions, play

    obj = add_cloth()
    rest = mesh_positions(obj)
    out = {}
    changes = [
        ("stretch", 700.0), ("damping_law", "axial"), ("density", 0.5), ("integrator", "verlet"),
        ("pin_group", ""), ("substeps", 400), ("use_wind", True), ("frame_start", 2),
    ]  # fmt: skip
    for name, value in changes:
        play(obj.boucle.frame_start, 6)
        moved = mesh_positions(obj) != rest
        setattr(obj.boucle, name, value)
        out[name] = [moved, mesh_positions(obj) == rest, obj.boucle.status.startswith("Not baked")]
    for name, change in {
        "gravity": lambda: setattr(bpy.context.scene, "gravity", (0, 0, -1.62)),
        "fps": lambda: setattr(bpy.context.scene.render, "fps", 60),
        "fps_base": lambda: setattr(bpy.context.scene.render, "fps_base", 1.001),
        "shape key": lambda: (obj.shape_key_add(), None),
    }.items():
        play(2, 6)
        moved = mesh_positions(obj) != rest
        change()
        play(7, 7)
        out[name] = [moved, mesh_positions(obj) == rest, obj.boucle.status.startswith("Not baked")]
    return out


def test_a_changed_setting_ends_the_live_result_and_shows_the_rest_shape(blender):
    for name, row in blender.run(change_settings).items():
        assert row == [True, True, True], name


def other_displays():
    import bpy
    from cloths import add_cloth, farthest, mesh_positions, play, shown_positions

    def shape_key(obj):
        obj.shape_key_add()

    def shared_mesh(obj):
        bpy.context.collection.objects.link(bpy.data.objects.new("other", obj.data))

    def modifier_above(obj):
        obj.modifiers.new("Hook", "HOOK")
        obj.modifiers.move(len(obj.modifiers) - 1, 0)

    out = {}
    direct = add_cloth()
    frames = []
    for frame in range(1, 10):
        play(frame, frame)
        frames.append(shown_positions(direct))
    bpy.data.objects.remove(direct)
    for change in (shape_key, shared_mesh, modifier_above):
        obj = add_cloth()
        change(obj)
        rest = mesh_positions(obj)
        shown = []
        for frame in range(1, 10):
            play(frame, frame)
            shown.append(shown_positions(obj))
        path = obj.modifiers["Boucle Cache"].filepath
        bpy.context.scene.frame_set(4)
        scrubbed = shown_positions(obj)
        bpy.ops.boucle.reset()
        bpy.context.view_layer.update()
        out[change.__name__] = {
            "difference": max(farthest(a, b) for a, b in zip(shown, frames, strict=True)),
            "mesh_untouched": mesh_positions(obj) == rest,
            "temporary": "boucle_live" in path,
            "scrubbed": scrubbed == shown[3],
            "reset": shown_positions(obj) == rest and obj.modifiers["Boucle Cache"].filepath == "",
        }
        for other in list(bpy.data.objects):
            bpy.data.objects.remove(other)
    return out


def test_where_the_mesh_must_not_be_written_a_temporary_file_shows_the_same_frames(blender):
    for name, row in blender.run(other_displays).items():
        assert row["difference"] < 1e-6, name
        assert row["mesh_untouched"] and row["temporary"] and row["scrubbed"] and row["reset"], name


def follow_armature():
    import bpy
    from cloths import add_cloth, pinned_vertices, play, world_positions
    from mathutils import Vector

    bpy.ops.object.armature_add()
    rig = bpy.context.object
    bone = rig.pose.bones[0]
    for frame, x in ((1, 0.0), (11, 1.0)):
        bone.location = (x, 0, 0)
        bone.keyframe_insert("location", frame=frame)
    obj = add_cloth()
    group = obj.vertex_groups.new(name=rig.data.bones[0].name)
    group.add(list(range(len(obj.data.vertices))), 1.0, "REPLACE")
    modifier = obj.modifiers.new("Armature", "ARMATURE")
    modifier.object = rig
    obj.modifiers.move(2, 0)
    obj.modifiers.new("Subdivision", "SUBSURF").subdivision_type = "SIMPLE"
    bpy.context.scene.frame_set(1)
    pins = pinned_vertices(obj)
    start = world_positions(obj)
    play(1, 11)
    end = world_positions(obj)
    moved = [(end[pin] - start[pin] - Vector((1, 0, 0))).length for pin in pins]
    free = end[0] - start[0]
    bpy.ops.boucle.bake()
    bpy.context.scene.frame_set(11)
    baked = world_positions(obj)
    obj.modifiers.new("Mask", "MASK").vertex_group = "Pin"
    bpy.ops.boucle.free_bake()
    play(1, 3)
    hidden = obj.boucle.status
    obj.modifiers["Mask"].show_viewport = False
    play(1, 3)
    return {
        "hidden": hidden,
        "switched": obj.boucle.status,
        "pins": max(moved),
        "free": list(free),
        "baked": max((a - b).length for a, b in zip(baked, end, strict=True)),
    }


def test_pins_follow_an_armature_and_the_bake_is_the_live_result(blender):
    result = blender.run(follow_armature)
    assert result["pins"] < 1e-5
    assert result["free"][2] < -1e-4
    assert result["baked"] < 1e-5
    assert 'the modifier "Mask" below Boucle\'s hides where the pins go' in result["hidden"]
    assert result["switched"].startswith("Live: frames 1 to 3")


def follow_shape_keys():
    import bpy
    from cloths import add_cloth, pinned_vertices, play, world_positions

    obj = add_cloth()
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Lift", from_mix=False)
    for point in key.data:
        point.co.z += 0.5
    for frame, value in ((1, 0.0), (11, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    bpy.context.scene.frame_set(1)
    start = world_positions(obj)
    play(1, 11)
    end = world_positions(obj)
    return [(end[pin] - start[pin]).z for pin in pinned_vertices(obj)]


def test_pins_follow_shape_keys(blender):
    assert all(abs(rise - 0.5) < 1e-5 for rise in blender.run(follow_shape_keys))


def break_down():
    import bpy
    from cloths import add_diverging_cloth, mesh_positions, play

    obj = add_diverging_cloth()
    rest = mesh_positions(obj)
    play(1, 20)
    said = obj.boucle.status
    frames = []
    for frame in range(1, 4):
        bpy.context.scene.frame_set(frame)
        frames.append(mesh_positions(obj))
    bpy.context.scene.frame_set(20)
    finite = all(abs(value) < 1e7 for value in mesh_positions(obj))
    obj.boucle.allow_unstable = False
    play(1, 3)
    refused = obj.boucle.status
    obj.boucle.substeps = 0
    obj.boucle.stretch, obj.boucle.shear = 500.0, 100.0
    play(1, 5)
    return [said, frames[0] == rest, frames[1] != rest, finite, refused, obj.boucle.status]


def test_a_breakdown_is_said_in_words_and_earlier_frames_are_kept(blender):
    said, first, second, finite, refused, later = blender.run(break_down)
    assert "diverged at frame" in said and "vertex" in said and "are kept" in said
    assert first and second and finite
    assert "stab" in refused and "substeps" in refused
    assert later.startswith("Live: frames 1 to 5")


def panic():
    import bpy
    from cloths import add_cloth, addon, play

    obj = add_cloth()
    play(1, 4)
    live, native = addon("bridge.live"), addon("native")

    class Broken:
        def __getattr__(self, _name):
            raise native.InternalError("a fault of Boucle's own: index out of bounds")

    live.session_of(obj).solver = Broken()
    play(5, 8)
    said = obj.boucle.status
    bpy.ops.boucle.reset()
    play(1, 3)
    return [said, obj.boucle.status]


def test_blender_lives_on_after_a_fault_of_the_solver(blender):
    said, later = blender.run(panic)
    assert "index out of bounds" in said and "frames up to 4 are kept" in said
    assert later.startswith("Live: frames 1 to 3")


def fill_the_memory():
    import bpy
    from cloths import add_cloth, play

    preferences = bpy.context.preferences.addons["bl_ext.user_default.boucle"].preferences
    preferences.live_memory = 10
    obj = add_cloth(
        columns=300,
        rows=300,
        end=50,
        integrator="symplectic_euler",
        substeps=1,
        allow_unstable=True,
    )
    obj.boucle.stretch = obj.boucle.shear = obj.boucle.bend = 0.0
    obj.boucle.damping = 0.0
    play(1, 14)
    return obj.boucle.status


def test_live_frames_keep_to_their_memory_and_say_so(blender):
    said = blender.run(fill_the_memory)
    assert said.startswith("Live: frames 1 to 9 in memory, 9.7 MB")
    assert "fill their memory at frame 9" in said


def move_the_object():
    import bpy
    from cloths import add_cloth, play, world_positions

    def animate(mover):
        for frame, x in ((1, 0.0), (11, 0.4)):
            mover.location.x = x
            mover.keyframe_insert("location", frame=frame)

    def farthest_point(one, other):
        return max((a - b).length for a, b in zip(one, other, strict=True))

    bpy.ops.object.empty_add()
    parent = bpy.context.object
    parent.scale = (2.0, 2.0, 0.5)
    parent.rotation_euler = (0.0, 0.0, 0.7)
    obj = add_cloth()
    obj.parent = parent
    obj.location = (0.0, 1.0, 3.0)
    animate(parent)
    bpy.context.scene.frame_set(1)
    start = world_positions(obj)
    plain = add_cloth()
    for vertex, place in zip(plain.data.vertices, start, strict=True):
        vertex.co = place
    animate(plain)
    play(1, 11)
    end, expected = world_positions(obj), world_positions(plain)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.boucle.bake()
    bpy.context.scene.frame_set(11)
    baked = world_positions(obj)
    bpy.context.scene.frame_set(1)
    return {
        "moved": farthest_point(start, end),
        "expected": farthest_point(end, expected),
        "baked": farthest_point(baked, end),
        "first": farthest_point(world_positions(obj), start),
    }


def test_a_parented_and_scaled_cloth_moves_as_the_same_cloth_in_world_space(blender):
    result = blender.run(move_the_object)
    assert result["moved"] > 0.1
    assert result["expected"] < 1e-4
    assert result["baked"] < 1e-5
    assert result["first"] < 1e-5


def hide_while_live():
    from cloths import add_cloth, play

    obj = add_cloth()
    obj.shape_key_add()
    play(1, 4)
    obj.hide_viewport = True
    play(5, 6)
    obj.hide_viewport = False
    hidden = obj.boucle.status
    play(4, 7)
    return [hidden, obj.boucle.status]


def test_a_hidden_cloth_waits_and_goes_on_when_it_is_shown(blender):
    hidden, shown = blender.run(hide_while_live)
    assert hidden.startswith("Live: frames 1 to 4")
    assert shown.startswith("Live: frames 1 to 7")


def check_the_scene():
    import bpy
    from cloths import add_cloth

    obj = add_cloth()
    clean = bpy.ops.boucle.check(), obj.boucle.status
    bpy.ops.object.effector_add(type="TEXTURE")
    bpy.context.view_layer.objects.active = obj
    obj.boucle.keyframe_insert("stretch", frame=1)
    obj.modifiers.new("Cloth", "CLOTH")
    bpy.ops.boucle.check()
    done = list(bpy.ops.boucle.bake())
    obj.data.vertices.add(1)
    bpy.ops.boucle.check()
    selected = [v.index for v in obj.data.vertices if v.select]
    return [list(clean[0]), clean[1], done, selected]


def test_what_is_left_out_is_said_by_the_check(blender):
    done, status, baked, selected = blender.run(check_the_scene)
    assert done == ["FINISHED"] and status.startswith("Not baked")
    assert baked == ["FINISHED"]
    assert selected == [48], "the loose vertex"
    for words in (
        "Texture fields are not supported",
        "has a Cloth modifier, too",
        "stretch is animated",
    ):
        assert words in blender.output, words


def work_without_numpy():
    import sys

    import bpy
    from cloths import add_cloth, addon, farthest, mesh_positions, play, shown_positions

    def results():
        obj = add_cloth(end=8)
        obj.location, obj.scale = (0.5, 1.0, -2.0), (1.0, 2.0, 0.5)
        keyed = add_cloth(end=8)
        keyed.shape_key_add()
        bpy.ops.mesh.primitive_cube_add(location=(0.0, 0.0, -9.0), scale=(0.5, 1.0, 2.0))
        below = bpy.context.object
        below.modifiers.new("Collision", "COLLISION")
        play(1, 8)
        live = [mesh_positions(obj), shown_positions(keyed)]
        bpy.context.view_layer.objects.active = obj
        bpy.ops.boucle.bake()
        bpy.ops.boucle.check()
        bpy.context.scene.frame_set(8)
        shown = shown_positions(obj)
        for other in (obj, keyed, below):
            bpy.data.objects.remove(other)
        bpy.context.scene.frame_set(1)
        return [*live, shown]

    points = addon("core.points")
    with_numpy = results()
    assert points.numpy_module() is not None
    sys.modules["numpy"] = None
    points.numpy_module.cache_clear()
    without = results()
    assert points.numpy_module() is None
    return [farthest(a, b) for a, b in zip(with_numpy, without, strict=True)]


def test_everything_works_without_numpy(blender):
    assert max(blender.run(work_without_numpy)) < 1e-6
