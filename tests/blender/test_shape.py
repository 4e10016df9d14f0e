"""Rest shape, dynamic mesh, shrink, pressure and sewing, as Blender's data ask for them."""


def rest_shape_and_shrink():
    import bpy
    from cloths import add_cloth, addon, play, refusal_of, world_positions

    def width(obj, row=0, columns=8):
        points = world_positions(obj)
        return (points[row * columns + columns - 1] - points[row * columns]).length

    def free_cloth(**values):
        obj = add_cloth(end=60, air_damping=1.0, self_collision=False, limiter="none", **values)
        obj.boucle.pin_group = ""
        bpy.context.scene.frame_set(1)
        return obj

    bpy.context.scene.use_gravity = False
    out = {}
    # A key half as wide is the rest shape; the cloth starts from the shape that is shown.
    obj = free_cloth()
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Narrow")
    key.value = 0.0  # 1 by default from Blender 5.0 on
    for point in key.data:
        point.co.x *= 0.5
    obj.boucle.rest_shape_key = "Narrow"
    play(1, 1)
    start = width(obj)
    play(2, 40)
    out["key"] = [start, width(obj)]
    obj.boucle.rest_shape_key = "Nowhere"
    out["no key"] = refusal_of(bpy.ops.boucle.bake)
    out["status"] = obj.boucle.status
    # Shrink keyed from nothing to a half in 20 frames: live and baked alike.
    obj = free_cloth()
    settings = obj.boucle
    for frame, value in ((1, 0.0), (20, 0.5)):
        settings.shrink_min = value
        settings.keyframe_insert("shrink_min", frame=frame)
    play(1, 40)
    out["live"] = width(obj)
    solver = addon("bridge.live").session_of(obj).solver
    out["rest"] = memoryview(solver.read_springs(0)[2]).cast("d")[0]
    bpy.ops.boucle.bake()
    play(1, 40)
    out["baked"] = width(obj)
    out["drift"] = obj.boucle.status
    # A group: the left half shrinks.
    obj = free_cloth(shrink_max=0.5)
    group = obj.vertex_groups.new(name="Left")
    group.add([v.index for v in obj.data.vertices if v.co.x < 0.0], 1.0, "REPLACE")
    settings = obj.boucle
    settings.shrink_group = "Left"
    play(1, 40)
    points = world_positions(obj)
    out["group"] = [(points[3] - points[0]).length, (points[7] - points[4]).length]
    # Dynamic mesh: rest lengths follow a key that is animated, above the slot.
    obj = free_cloth(use_dynamic_mesh=True)
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Wide")
    for point in key.data:
        point.co.x *= 1.5
    for frame, value in ((1, 0.0), (20, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    play(1, 40)
    out["dynamic"] = width(obj)
    out["dynamic status"] = obj.boucle.status
    return out


def test_rest_lengths_are_those_of_a_key_a_shrunk_or_a_moving_mesh(blender):
    found = blender.run(rest_shape_and_shrink)
    start, end = found["key"]
    assert abs(start - 2.0) < 1e-5 and abs(end - 1.0) < 0.03
    assert 'Rest Shape Key "Nowhere" is not a shape key' in found["no key"]
    assert '"Basis", "Narrow"' in found["no key"]
    assert abs(found["live"] - 1.0) < 0.03
    assert abs(found["rest"] - 1.0 / 7.0) < 1e-6
    assert abs(found["live"] - found["baked"]) < 1e-5
    assert "outdated" not in found["drift"]
    left, right = found["group"]
    assert abs(left - 0.5 * 6.0 / 7.0) < 0.04 and abs(right - 6.0 / 7.0) < 0.04
    assert abs(found["dynamic"] - 3.0) < 0.06, found["dynamic status"]


def pressure():
    import bpy
    from cloths import addon, play

    def balloon(**values):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, radius=0.5)
        obj = bpy.context.object
        obj.boucle.enabled = True
        for name, value in {
            "self_collision": False,
            "limiter": "none",
            "frame_end": 40,
            **values,
        }.items():
            setattr(obj.boucle, name, value)
        bpy.context.scene.frame_set(1)
        return obj

    def volume(obj):
        import bmesh

        evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
        mesh = bmesh.new()
        mesh.from_mesh(evaluated.data)
        return mesh.calc_volume()

    bpy.context.scene.use_gravity = False
    out = {}
    obj = balloon(
        use_pressure=True,
        use_pressure_volume=True,
        target_volume=0.8,
        pressure_factor=2e4,
        air_damping=0.05,
    )
    play(1, 1)
    start = volume(obj)
    play(2, 40)
    out["target"] = [start, volume(obj)]
    out["status"] = obj.boucle.status
    obj = balloon(use_pressure=True, pressure_factor=0.0, air_damping=0.05)
    for frame, value in ((1, 0.0), (10, 0.0), (20, 150.0)):
        obj.boucle.uniform_pressure_force = value
        obj.boucle.keyframe_insert("uniform_pressure_force", frame=frame)
    play(1, 10)
    rest = volume(obj)
    play(11, 30)
    live = volume(obj)
    bpy.ops.boucle.bake()
    play(1, 30)
    out["keyed"] = [rest, live, volume(obj)]
    out["names"] = list(
        addon("core.drift").differences(
            {"settings": {"cloth.pressure.uniform": 1.0}, "vertices": 1},
            {"settings": {}, "vertices": 1, "topology": ""},
        )
    )
    return out


def test_pressure_inflates_to_the_target_and_follows_its_keyframes(new_blender):
    found = new_blender.run(pressure)
    start, end = found["target"]
    assert 0.4 < start < 0.52 and abs(end - 0.8) < 0.05, found
    rest, live, baked = found["keyed"]
    assert abs(rest - start) < 1e-3 and live > 1.1 * rest
    assert abs(live - baked) < 1e-4 * live
    assert found["names"] == ["pressure"]


def sewing():
    import bmesh
    import bpy
    from cloths import addon, play

    def panels(**values):
        mesh = bpy.data.meshes.new("Panels")
        made = bmesh.new()
        for side in (0, 1):
            bmesh.ops.create_grid(made, x_segments=6, y_segments=6, size=0.5)
            new = made.verts[-49:] if side else list(made.verts)
            for vertex in new:
                vertex.co.x += 0.65 * (1 if side else -1)
        made.verts.ensure_lookup_table()
        made.verts.index_update()
        inner = sorted(
            (v for v in made.verts if abs(abs(v.co.x) - 0.15) < 1e-4),
            key=lambda v: (v.co.x, v.co.y),
        )
        for one, other in zip(inner[:7], inner[7:], strict=True):
            made.edges.new((one, other))
        made.to_mesh(mesh)
        obj = bpy.data.objects.new("Panels", mesh)
        bpy.context.collection.objects.link(obj)
        bpy.context.view_layer.objects.active = obj
        obj.boucle.enabled = True
        for name, value in {"frame_end": 60, "air_damping": 0.005, **values}.items():
            setattr(obj.boucle, name, value)
        bpy.context.scene.frame_set(1)
        return obj

    def sentences(obj):
        problems = addon("bridge.preflight").problems(obj, bpy.context.scene)
        return [problem.sentence for problem in problems]

    def gap(obj):
        evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
        loose = addon("bridge.shape").loose_edges(obj.data)
        points = [vertex.co for vertex in evaluated.data.vertices]
        return len(loose), max((points[a] - points[b]).length for a, b in loose)

    bpy.context.scene.use_gravity = False
    out = {}
    obj = panels()
    out["off"] = [text for text in sentences(obj) if "loose edges" in text]
    play(1, 10)
    out["open"] = gap(obj)
    bpy.ops.boucle.reset()
    bpy.context.scene.frame_set(1)
    obj.boucle.use_sewing_springs = True
    obj.boucle.sewing_force_max = 0.5
    obj.boucle.weld_distance = 0.002
    out["on"] = [text for text in sentences(obj) if "loose" in text or "length" in text]
    play(1, 50)
    out["closed"] = gap(obj)
    bpy.ops.boucle.add_weld()
    bpy.ops.boucle.add_weld()
    names = [modifier.name for modifier in obj.modifiers]
    weld = obj.modifiers["Boucle Weld"]
    out["weld"] = [names[-2:], weld.show_viewport, weld.show_render, round(weld.merge_threshold, 6)]
    out["strain"] = (
        addon("bridge.live").session_of(obj).frames.nearest(50).certificate["max_strain"]
    )
    return out


def test_loose_edges_sew_two_panels_together(new_blender):
    found = new_blender.run(sewing)
    assert len(found["off"]) == 1 and "7 loose edges have no effect" in found["off"][0]
    count, gap = found["open"]
    assert count == 7 and abs(gap - 0.3) < 1e-3
    assert found["on"] == []
    assert found["closed"][1] < 0.002
    assert found["weld"] == [["Boucle Cache", "Boucle Weld"], False, True, 0.002]
    assert found["strain"] < 0.11
