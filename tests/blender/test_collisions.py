"""What cloth collides with in Blender: Collision physics, collections, groups; live and baked."""

OUTER = 0.02
"""Blender's default Outer Thickness (m)."""


def add_sheet(height=0.3, side=9, **values):
    """A free cloth of 1 m x 1 m, lying flat at a height."""
    import bpy

    bpy.ops.boucle.add_cloth(
        vertices_x=side, vertices_y=side, size_x=1.0, size_y=1.0, plane="xy", pins=set()
    )
    obj = bpy.context.object
    obj.location.z = height
    obj.boucle.frame_end = 24
    for name, value in values.items():
        setattr(obj.boucle, name, value)
    return obj


def add_collider(name="Floor", size=4.0, z=0.0, faces=((0, 1, 2, 3),)):
    """A square, low at z, with Collision physics."""
    import bpy

    half = size / 2
    corners = [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    obj = bpy.data.objects.new(name, mesh)
    obj.location.z = z
    bpy.context.scene.collection.objects.link(obj)
    obj.modifiers.new("Collision", "COLLISION")
    return obj


def heights(obj):
    from cloths import world_positions

    return [point.z for point in world_positions(obj)]


def lowest_after(obj, last=24):
    """The lowest point of a cloth that was played live from the start."""
    import bpy
    from cloths import play

    bpy.ops.boucle.reset(every=True)
    play(1, last)
    return min(heights(obj))


def rest_on_a_plane():
    import bpy
    from cloths import addon, play, shown_positions

    sheet, floor = add_sheet(), add_collider()
    play(1, 24)
    live = shown_positions(sheet)
    lowest = [min(heights(sheet))]
    rows = [addon("bridge.live").session_of(sheet).frames.certificate(n) for n in range(1, 25)]
    bpy.ops.boucle.bake()
    lowest.append(min(heights(sheet)))
    same = shown_positions(sheet) == live
    floor.modifiers["Collision"].show_viewport = False
    bpy.ops.boucle.free_bake()
    still_used = floor.collision.use
    return {
        "lowest": lowest,
        "same": same,
        "intersections": [row["intersections"] for row in rows],
        "panel": sheet.boucle.certificate,
        "off": [still_used, lowest_after(sheet)],
        "warnings": [
            p.sentence for p in addon("bridge.preflight").problems(sheet, bpy.context.scene)
        ],
    }


def test_a_collision_modifier_stops_the_cloth_live_and_baked_and_one_that_is_off_does_not(blender):
    result = blender.run(rest_on_a_plane)
    for lowest in result["lowest"]:
        assert 0.0 < lowest <= 0.002 + OUTER + 1e-3
    assert result["same"], "the bake is what was played"
    assert result["intersections"] == [0] * 24
    still_used, lowest = result["off"]
    assert still_used and lowest < -1.0
    assert not any("collision" in sentence for sentence in result["warnings"])
