"""Speed Multiplier: how much time passes for the cloth in each frame."""


def fall():
    import bpy
    from cloths import add_cloth, addon, play, world_positions

    scene = bpy.context.scene
    settings_module = addon("bridge.settings")

    def sheet(name, **values):
        obj = add_cloth(columns=3, rows=3, end=10, pin_group="", self_collision=False, **values)
        obj.name = name
        return obj

    def lowest(obj):
        return min(place.z for place in world_positions(obj))

    one, fast = sheet("One"), sheet("Fast", speed=2.0)
    begin = lowest(one)
    play(1, 10)
    out = {"live": [begin - lowest(obj) for obj in (one, fast)]}
    groups, apart = addon("bridge.together").groups([fast, one], scene)
    out["groups"], out["apart"] = [[obj.name for obj in group] for group in groups], apart
    for obj in (one, fast):
        bpy.context.view_layer.objects.active = obj
        bpy.ops.boucle.bake()
    scene.frame_set(10)
    out["baked"] = [begin - lowest(obj) for obj in (one, fast)]
    out["status"] = fast.boucle.status
    fast.boucle.speed = 1.0
    out["changed"] = fast.boucle.status
    one.boucle.speed = 0.5
    bpy.context.view_layer.objects.active = one
    bpy.ops.boucle.bake()
    scene.frame_set(10)
    out["slow"] = begin - lowest(one)
    presets = addon("bridge.presets")
    presets.save(one, "Slow")
    presets.apply(fast, "Slow")
    out["preset"] = fast.boucle.speed
    out["scene"] = settings_module.describe(fast, scene, with_groups=False)["scene"]
    out["animatable"] = one.boucle.bl_rna.properties["speed"].is_animatable
    return out


def test_a_cloth_of_twice_the_speed_falls_four_times_as_far(blender):
    found = blender.run(fall)
    seconds = 9 / 24
    one, fast = found["live"]
    # Implicit steps: within 2 % of the closed form.
    assert abs(one / (0.5 * 9.81 * seconds**2) - 1.0) < 0.02, one
    assert abs(fast / (0.5 * 9.81 * (2.0 * seconds) ** 2) - 1.0) < 0.02, fast
    assert found["baked"] == found["live"]
    assert abs(found["slow"] / one - 0.25) < 0.01
    assert found["groups"] == [["Fast"], ["One"]]
    assert "their speed multipliers differ" in found["apart"][0]
    assert "outdated" not in found["status"]
    assert "changed since: speed multiplier" in found["changed"]
    assert found["preset"] == 0.5
    assert found["scene"]["fps"] == 24.0 and found["scene"]["speed"] == 0.5
    assert not found["animatable"]
