"""Worst frame and worst edges: the same numbers as in the certificates, live and baked."""


def stretch_softly():
    import math

    import bpy
    from cloths import add_cloth, addon, play, refusal_of, world_positions

    scene = bpy.context.scene
    obj = add_cloth(
        columns=7, rows=6, end=12, limiter="none", stretch=30.0, density=1.0, deformation_rate=0.05
    )
    obj.scale = (1.0, 1.0, 1.2)
    refused = refusal_of(bpy.ops.boucle.go_to_worst_frame)
    bpy.context.view_layer.update()
    rest = {e.index: tuple(e.vertices) for e in obj.data.edges}
    lengths = {
        k: math.dist(
            obj.matrix_world @ obj.data.vertices[i].co, obj.matrix_world @ obj.data.vertices[j].co
        )
        for k, (i, j) in rest.items()
    }

    def look(rows):
        out = {"rows": {frame: rows[frame]["max_strain"] for frame in rows}}
        scene.frame_set(3)
        bpy.ops.boucle.go_to_worst_frame(by="strain")
        out["worst"] = scene.frame_current
        bpy.ops.boucle.go_to_worst_frame(by="intersections")
        out["still"] = scene.frame_current
        bpy.context.view_layer.update()
        places = world_positions(obj)
        strains = {
            k: (places[i] - places[j]).length / lengths[k] - 1.0 for k, (i, j) in rest.items()
        }
        bpy.ops.boucle.select_worst_edges(which="rate")
        over = {k for k, value in strains.items() if value > obj.boucle.deformation_rate + 1e-3}
        out["rate"] = len(over), {e.index for e in obj.data.edges if e.select} == over
        bpy.ops.boucle.select_worst_edges(which="most", count=3)
        chosen = [e.index for e in obj.data.edges if e.select]
        most = sorted(strains, key=strains.get)[-3:]
        out["most"] = len(chosen), min(strains[k] for k in chosen) - min(strains[k] for k in most)
        found = addon("bridge.worst").edges(obj, scene)
        out["largest"] = found[0].strain, len(found)
        return out

    play(1, 12)
    live = look(addon("bridge.certificate").rows(obj))
    bpy.ops.boucle.bake()
    scene.frame_set(5)
    baked = look(addon("bridge.certificate").rows(obj))
    bpy.ops.object.mode_set(mode="EDIT")
    scene.frame_set(live["worst"])
    bpy.ops.boucle.select_worst_edges(which="most", count=3)
    mode = list(bpy.context.tool_settings.mesh_select_mode)
    bpy.ops.object.mode_set(mode="OBJECT")
    edited = sum(e.select for e in obj.data.edges)
    return {
        "refused": refused,
        "live": live,
        "baked": baked,
        "edit": [mode, edited],
        "edges": len(rest),
    }


def test_the_worst_frame_and_edges_are_those_of_the_certificates(blender):
    found = blender.run(stretch_softly)
    assert "has no result" in found["refused"]
    for name in ("live", "baked"):
        one = found[name]
        rows = {int(frame): value for frame, value in one["rows"].items()}
        assert sorted(rows) == list(range(1, 13))
        assert one["worst"] == one["still"] == max(rows, key=rows.get)
        count, same = one["rate"]
        assert same and 0 < count < found["edges"]
        assert one["most"][0] == 3 and abs(one["most"][1]) < 1e-5
        largest, known = one["largest"]
        assert known == found["edges"]
        assert abs(largest - max(rows.values())) < 1e-5
    assert found["edit"] == [[False, True, False], 3]
