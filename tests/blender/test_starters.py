"""The starters in the Add menu: each plays at once, whole and within its rate."""


def play_starters():
    import math

    import bpy
    from cloths import addon, pinned_vertices, play, world_positions

    scene = bpy.context.scene
    scene.frame_end = 30
    bpy.ops.boucle.add_flag(resolution=0.06, location=(10.0, 0.0, 3.0), rotation=(0.0, 0.0, 0.7))
    bpy.ops.boucle.add_curtain(resolution=0.06, location=(20.0, 0.0, 3.0))
    bpy.ops.boucle.add_cape(resolution=0.05, location=(30.0, 0.0, 3.0))
    bpy.ops.boucle.add_tablecloth(resolution=0.06, location=(40.0, 0.0, 3.0))
    bpy.ops.boucle.add_tablecloth(resolution=0.06, table="square", location=(50.0, 0.0, 3.0))
    cloths = [obj for obj in bpy.data.objects if obj.boucle.enabled]
    bpy.context.view_layer.update()
    rest = {obj.name: world_positions(obj) for obj in cloths}
    problems = {
        obj.name: [p.sentence for p in addon("bridge.preflight").problems(obj, scene)]
        for obj in cloths
    }
    play(1, 10)
    out = {}
    for obj in cloths:
        rows = addon("bridge.certificate").rows(obj)
        places = world_positions(obj)
        out[obj.name] = {
            "frames": sorted(rows),
            "strain": max(row["max_strain"] for row in rows.values()),
            "intersections": [row["intersections"] for row in rows.values()],
            "finite": all(math.isfinite(value) for place in places for value in place),
            "moved": max((a - b).length for a, b in zip(places, rest[obj.name], strict=True)),
            "pins": len(pinned_vertices(obj)) if obj.boucle.pin_group else 0,
            "lowest": min(place.z for place in places),
            "vertices": len(places),
            "wind": obj.boucle.use_wind,
            "lies": sum(abs(place.z - 3.0) < 0.03 for place in places),
            "problems": problems[obj.name],
        }
    tables = [
        obj.name for obj in bpy.data.objects if obj.modifiers and obj.name.startswith("Table.")
    ]
    table = bpy.data.objects["Table"]
    out["tables"] = (
        table.modifiers[0].type,
        max(corner[2] for corner in table.bound_box),
        len(tables),
    )
    return out


def test_each_starter_plays_at_once_whole_and_within_its_rate(blender):
    found = blender.run(play_starters)
    tables = found.pop("tables")
    assert tables[0] == "COLLISION" and abs(tables[1]) < 1e-6 and tables[2] == 1
    assert set(found) == {"Flag", "Curtain", "Cape", "Tablecloth", "Tablecloth.001"}
    for name, one in found.items():
        assert one["frames"] == list(range(1, 11)), name
        assert one["finite"], name
        assert one["strain"] <= 0.1011, (name, one["strain"])
        assert set(one["intersections"]) == {0}, (name, one["intersections"])
        assert one["problems"] == [], (name, one["problems"])
        assert one["vertices"] > 200, name
    assert found["Flag"]["pins"] > 10 and found["Flag"]["wind"] and found["Flag"]["moved"] > 0.1
    assert found["Curtain"]["pins"] > 40 and found["Cape"]["pins"] > 20
    assert found["Cape"]["moved"] > 0.02
    for name in ("Tablecloth", "Tablecloth.001"):
        assert found[name]["lies"] > 0.3 * found[name]["vertices"], "it lies on the table"
        assert found[name]["lowest"] < 2.9, "and hangs at its sides"
