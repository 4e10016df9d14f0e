"""Water and the finer winds, as an artist sets them up: what floats, drifts, soaks, follows an object, and stays in the lee."""


def lay_cloth(end, **values):
    """A flat cloth of 1 m, free, at z = 0."""
    import bpy

    bpy.ops.boucle.add_cloth(
        vertices_x=8, vertices_y=8, size_x=1.0, size_y=1.0, plane="xy", pins=set()
    )
    obj = bpy.context.object
    obj.boucle.frame_end = end
    for name, value in values.items():
        setattr(obj.boucle, name, value)
    return obj


def float_and_sink():
    import bpy
    from cloths import addon, shown_positions

    def end(frame=48, **values):
        obj = lay_cloth(frame, use_water=True, **values)
        bpy.ops.boucle.bake()
        bpy.context.scene.frame_set(frame)
        out = shown_positions(obj)
        height, way = sum(out[2::3]) / len(out[2::3]), sum(out[0::3]) / len(out[0::3])
        status = obj.boucle.status
        bpy.data.objects.remove(obj)
        return height, way, status

    out = {
        "floats": end(bulk_density=300.0),
        "sinks": end(bulk_density=1500.0),
        "drifts": end(bulk_density=300.0, water_velocity=(2.0, 0.0, 0.0), water_friction=0.1),
        "soaks": end(bulk_density=400.0, absorbency=3.0, soak_time=0.5),
    }
    # The surface is an object that rises: the cloth goes with it, live and baked; and a changed level is said to be one.
    surface = bpy.data.objects.new("Sea", None)
    bpy.context.scene.collection.objects.link(surface)
    for frame, height in ((1, 0.0), (48, 0.1)):
        surface.location.z = height
        surface.keyframe_insert("location", frame=frame)
    out["rises"] = end(bulk_density=300.0, water_object=surface)
    obj = lay_cloth(4, use_water=True)
    bpy.ops.boucle.bake()
    obj.boucle.water_level = 0.25
    out["drift"] = addon("bridge.cache").drift_of(obj, bpy.context.scene, in_full=True)
    return out


def test_cloth_floats_sinks_drifts_soaks_and_rises(blender):
    found = blender.run(float_and_sink)
    assert abs(found["floats"][0]) < 0.01
    assert found["sinks"][0] < -0.05
    assert found["drifts"][1] > found["floats"][1] + 0.5
    assert found["soaks"][0] < -0.02
    assert abs(found["rises"][0] - 0.1) < 0.03
    assert found["drift"] == ["water level"]
    assert all("outdated" not in found[name][2] for name in ("floats", "drifts", "rises"))


def keyed_water():
    import bpy
    from cloths import addon, farthest, play, shown_positions

    scene = bpy.context.scene
    obj = lay_cloth(12, use_water=True)
    for frame, level in ((1, 0.0), (12, 0.2)):
        obj.boucle.water_level = level
        obj.keyframe_insert("boucle.water_level", frame=frame)
    play(1, 12)
    live = shown_positions(obj)
    bpy.ops.boucle.bake()
    scene.frame_set(12)
    baked = shown_positions(obj)
    status = obj.boucle.status
    return (
        farthest(live, baked),
        max(baked[2::3]),
        status,
        addon("bridge.cache").drift_of(obj, scene, in_full=True),
    )


def test_a_keyed_level_is_followed_live_and_baked(blender):
    apart, height, status, drift = blender.run(keyed_water)
    assert apart < 1e-6 and height > 0.02
    assert "outdated" not in status and drift == []


def shelter():
    import bpy
    from cloths import add_cloth, shown_positions

    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(0.0, -4.0, 0.0))
    wall = bpy.context.object
    wall.scale = (6.0, 0.2, 6.0)
    wall.modifiers.new("Collision", "COLLISION")
    out = []
    for is_sheltered in (False, True):
        obj = add_cloth(
            end=12, use_wind=True, wind_law="face", wind_velocity=(0.0, 8.0, 0.0), wind_gusts=0.5, wind_turbulence=0.2,
            use_wind_lift=True, wind_drag=1.2, use_wind_shelter=is_sheltered,
        )  # fmt: skip
        bpy.ops.boucle.bake()
        bpy.context.scene.frame_set(12)
        out.append(max(abs(y) for y in shown_positions(obj)[1::3]))
        bpy.data.objects.remove(obj)
    return out


def test_cloth_behind_a_collision_object_is_in_its_lee(blender):
    open_air, lee = blender.run(shelter)
    assert open_air > 0.1 and lee < 1e-3
