"""A dense mesh that a coarse cloth moves."""


def drive_a_dense_mesh():
    import bpy
    from cloths import add_cloth, addon, pinned_vertices, play, refusal_of, world_positions

    scene, ops = bpy.context.scene, bpy.ops.boucle
    out = {}
    dense = add_cloth(columns=60, rows=50, end=20, stretch=321.0)
    dense.location = (1.0, 2.0, 3.0)
    bpy.context.view_layer.update()
    play(1, 3)
    rest = [dense.matrix_world @ v.co for v in dense.data.vertices]
    out["few"] = refusal_of(ops.add_proxy, vertex_count=5000)
    scene.frame_set(1)
    subdivision = dense.modifiers.new("Subdivision", "SUBSURF")
    subdivision.show_viewport = False
    ops.add_proxy(vertex_count=300)
    proxy = bpy.context.object
    out["names"] = [dense.name, proxy.name, proxy.data.name]
    out["counts"] = [len(dense.data.vertices), len(proxy.data.vertices)]
    out["cloth"] = [
        dense.boucle.enabled,
        proxy.boucle.enabled,
        proxy.boucle.stretch,
        proxy.boucle.frame_end,
    ]
    out["stack"] = [[m.type for m in obj.modifiers] for obj in (dense, proxy)]
    out["pins"] = len(pinned_vertices(proxy))
    lengths = sorted(
        (proxy.data.vertices[e.vertices[0]].co - proxy.data.vertices[e.vertices[1]].co).length
        for e in proxy.data.edges
    )
    out["edges"] = lengths[-1] / lengths[len(lengths) // 2], lengths[0]
    dense.modifiers["Subdivision"].show_viewport = False
    bpy.context.view_layer.update()
    rest = world_positions(dense)
    out["strangers"] = [
        p.sentence for p in addon("bridge.preflight").problems(proxy, scene) if p.passes_through
    ]

    def far():
        """How far the dense mesh has gone, and how far it is from the proxy."""
        from mathutils.bvhtree import BVHTree

        places = world_positions(dense)
        coarse = BVHTree.FromPolygons(
            world_positions(proxy), [tuple(p.vertices) for p in proxy.data.polygons]
        )
        moved = max((a - b).length for a, b in zip(places, rest, strict=True))
        return [moved, max(coarse.find_nearest(place)[3] for place in places)]

    proxy.boucle.use_wind, proxy.boucle.wind_velocity = True, (0.0, 8.0, 0.0)
    proxy.boucle.wind_coefficient = 0.01
    play(1, 16)
    out["live"] = far()
    bpy.context.view_layer.objects.active = proxy
    ops.bake()
    scene.frame_set(16)
    out["baked"] = far()
    out["bound"] = dense.modifiers[0].is_bound

    # A given proxy: another one, bound in place of the first.
    given = add_cloth(columns=8, rows=6, end=20)
    given.location = dense.location
    bpy.context.view_layer.update()
    given.select_set(True)
    dense.select_set(True)
    proxy.select_set(False)
    bpy.context.view_layer.objects.active = dense
    ops.drive_with_proxy()
    out["given"] = [
        dense.modifiers[0].target.name, dense.modifiers[0].is_bound, len(dense.modifiers),
        bpy.context.object.name == given.name,
    ]  # fmt: skip
    return out


def test_a_dense_mesh_follows_its_coarse_proxy_live_and_baked(blender):
    found = blender.run(drive_a_dense_mesh)
    assert "needs more of them" in found["few"]
    assert found["names"] == ["Cloth", "Cloth Proxy", "Cloth Proxy"]
    assert found["counts"][0] == 3000 and 200 < found["counts"][1] < 450
    assert found["cloth"] == [False, True, 321.0, 20]
    assert found["stack"] == [["SURFACE_DEFORM", "SUBSURF"], ["NODES", "MESH_CACHE"]]
    assert found["pins"] >= 4
    longest, shortest = found["edges"]
    assert longest < 6.0 and shortest > 0.01
    assert found["strangers"] == [], "what follows the cloth is no stranger"
    for name in ("live", "baked"):
        moved, away = found[name]
        assert moved > 0.05, "the wind moves it"
        assert away < 0.02, "the dense mesh stays on the proxy"
    assert found["live"][0] == found["baked"][0] and found["bound"]
    assert found["given"] == ["Cloth.001", True, 2, True]
