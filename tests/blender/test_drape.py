"""Drape over Selected: a sheet above what is selected, which becomes a collider and carries it."""

import pytest


def drape():
    import bpy
    from cloths import addon, play, world_positions
    from mathutils import Vector

    for one in [*bpy.data.objects]:
        bpy.data.objects.remove(one)
    scene = bpy.context.scene
    scene.frame_end = 24
    nothing = bpy.ops.boucle.drape.poll()
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.4, location=(4.2, 1.0, 2.0))
    ball = bpy.context.object
    bpy.ops.mesh.primitive_cube_add(size=2.0, location=(3.0, 1.0, 1.0), scale=(0.5, 0.5, 0.5))
    box = bpy.context.object
    bpy.ops.object.light_add()
    bpy.context.object.select_set(True)
    ball.select_set(True)
    box.select_set(True)
    bpy.ops.boucle.drape(vertices=32)
    obj = bpy.context.object
    bpy.context.view_layer.update()
    rest = world_positions(obj)
    edges = lengths(obj)
    problems = [p.sentence for p in addon("bridge.preflight").problems(obj, scene)]
    play(1, 24)
    now = world_positions(obj)
    rows = addon("bridge.certificate").rows(obj)
    obj.select_set(True)
    again = bpy.ops.boucle.drape.poll()
    return {
        "polls": [nothing, again],
        "enabled": obj.boucle.enabled,
        "range": [obj.boucle.frame_start, obj.boucle.frame_end],
        "uv": len(obj.data.uv_layers),
        "colliders": [o.name for o in (ball, box) if o.modifiers and o.collision.use],
        "low": list(map(min, zip(*rest, strict=True))),
        "high": list(map(max, zip(*rest, strict=True))),
        "edges": [min(edges), max(edges)],
        "problems": problems,
        "crossings": sum(row["intersections"] for row in rows.values()),
        "frames": len(rows),
        "top": max(p.z for p in now),
        "hem": min(p.z for p in now),
        "in the box": sum(all(abs(c) < 0.5 for c in p - Vector((3.0, 1.0, 1.0))) for p in now),
        "in the ball": sum((p - Vector((4.2, 1.0, 2.0))).length < 0.39 for p in now),
    }


def lengths(obj):
    places = [vertex.co for vertex in obj.data.vertices]
    return [(places[a] - places[b]).length for a, b in (e.vertices for e in obj.data.edges)]


def test_a_sheet_falls_on_all_that_is_selected(blender):
    found = blender.run(drape)
    assert found["polls"] == [False, False], "neither over nothing nor over a cloth"
    assert found["enabled"] and found["range"] == [1, 24] and found["uv"] == 1
    assert sorted(found["colliders"]) == ["Cube", "Sphere"]
    # From x = 2.5 to 4.6, y = 0.5 to 1.5 and z = 0.5 to 2.4: 1.9 m high, of which 60 % may hang down.
    assert found["low"][:2] == pytest.approx([2.5 - 1.14, 0.5 - 1.14], abs=1e-3)
    assert found["high"][:2] == pytest.approx([4.6 + 1.14, 1.5 + 1.14], abs=1e-3)
    assert 2.4 < found["low"][2] == found["high"][2] < 2.45, "just above the highest"
    assert found["edges"][1] < 1.03 * found["edges"][0], "nearly square"
    assert found["problems"] == [] and found["crossings"] == 0 and found["frames"] == 24
    assert found["in the box"] == found["in the ball"] == 0
    assert 2.35 < found["top"] < 2.45, "the ball carries it"
    assert found["hem"] < 2.0
