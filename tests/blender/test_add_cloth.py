"""Add > Mesh > Boucle Cloth, and what the object is then."""


def default_cloth():
    import bpy

    bpy.ops.boucle.add_cloth()
    obj = bpy.context.object
    group = obj.vertex_groups[obj.boucle.pin_group]
    return {
        "enabled": obj.boucle.enabled,
        "vertices": len(obj.data.vertices),
        "modifiers": [(m.type, m.name) for m in obj.modifiers],
        "uv": len(obj.data.uv_layers["UVMap"].data) if obj.data.uv_layers else 0,
        "pins": [
            v.index for v in obj.data.vertices if any(g.group == group.index for g in v.groups)
        ],
        "range": [obj.boucle.frame_start, obj.boucle.frame_end],
    }


def test_the_default_cloth_hangs_by_two_corners_with_uvs_and_a_slot(blender):
    cloth = blender.run(default_cloth)
    assert cloth["enabled"]
    assert cloth["vertices"] == 32 * 32
    assert cloth["uv"] == 4 * 31 * 31
    assert cloth["pins"] == [31 * 32, 32 * 32 - 1]
    assert cloth["modifiers"] == [["NODES", "Boucle Target"], ["MESH_CACHE", "Boucle Cache"]]
    assert cloth["range"] == [1, 250]


def grid_corners():
    import bpy

    out = {}
    for plane in ("xy", "xz", "yz"):
        bpy.ops.boucle.add_cloth(
            vertices_x=5, vertices_y=3, size_x=4.0, size_y=1.0, plane=plane, pins={"left"}
        )
        vertices = bpy.context.object.data.vertices
        out[plane] = [list(vertices[i].co) for i in (0, 1, 4, 5, 14)]
    return out


def test_rows_and_columns_grow_along_the_axes_of_the_plane(blender):
    corners = blender.run(grid_corners)
    assert corners["xy"] == [[-2, -0.5, 0], [-1, -0.5, 0], [2, -0.5, 0], [-2, 0, 0], [2, 0.5, 0]]
    assert corners["xz"] == [[-2, 0, -0.5], [-1, 0, -0.5], [2, 0, -0.5], [-2, 0, 0], [2, 0, 0.5]]
    assert corners["yz"] == [[0, -2, -0.5], [0, -1, -0.5], [0, 2, -0.5], [0, -2, 0], [0, 2, 0.5]]


def every_pin():
    import bpy

    out = {}
    names = (
        "top_left",
        "top_right",
        "bottom_left",
        "bottom_right",
        "top",
        "bottom",
        "left",
        "right",
    )
    for name in names:
        bpy.ops.boucle.add_cloth(vertices_x=4, vertices_y=3, pins={name})
        obj = bpy.context.object
        out[name] = [v.index for v in obj.data.vertices if len(v.groups)]
    bpy.ops.boucle.add_cloth(vertices_x=4, vertices_y=3, pins=set())
    out["none"] = [len(bpy.context.object.vertex_groups), bpy.context.object.boucle.pin_group]
    return out


def test_pins_are_the_corners_and_edges_of_the_scene_format(blender):
    pins = blender.run(every_pin)
    assert pins == {
        "top_left": [8],
        "top_right": [11],
        "bottom_left": [0],
        "bottom_right": [3],
        "top": [8, 9, 10, 11],
        "bottom": [0, 1, 2, 3],
        "left": [0, 4, 8],
        "right": [3, 7, 11],
        "none": [0, ""],
    }


def redo():
    import bpy

    bpy.ops.boucle.add_cloth("EXEC_DEFAULT", True, vertices_x=4, vertices_y=4)
    first = [obj.name for obj in bpy.data.objects]
    last = bpy.context.window_manager.operators
    names = [operator.bl_idname for operator in last]
    options = type(bpy.context.object).__name__
    too_many = None
    try:
        bpy.ops.boucle.add_cloth(vertices_x=10_000_000, vertices_y=2)
    except (TypeError, ValueError, RuntimeError) as error:
        too_many = str(error)
    count = len(bpy.context.object.data.vertices)
    return {
        "first": first,
        "names": names,
        "options": options,
        "count": count,
        "too_many": too_many,
    }


def test_a_grid_of_ten_million_columns_is_never_made(blender):
    result = blender.run(redo)
    assert result["first"] == ["Cloth"]
    assert result["count"] <= 2048 * 2


def stack_order():
    import bpy

    def names(*types):
        mesh = bpy.data.meshes.new("m")
        mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
        obj = bpy.data.objects.new("o", mesh)
        bpy.context.collection.objects.link(obj)
        for kind in types:
            obj.modifiers.new(kind, kind)
        obj.boucle.enabled = True
        return [m.name for m in obj.modifiers]

    return [
        names("ARMATURE", "SUBSURF"),
        names("ARMATURE", "HOOK"),
        names("SUBSURF", "SOLIDIFY"),
        names("ARMATURE", "SMOOTH", "MIRROR", "ARMATURE"),
    ]


def test_the_slot_stands_after_what_moves_and_before_what_multiplies(blender):
    slot = ["Boucle Target", "Boucle Cache"]
    assert blender.run(stack_order) == [
        ["ARMATURE", *slot, "SUBSURF"],
        ["ARMATURE", "HOOK", *slot],
        [*slot, "SUBSURF", "SOLIDIFY"],
        ["ARMATURE", "SMOOTH", *slot, "MIRROR", "ARMATURE.001"],
    ]


def switch_many_times():
    import bpy
    from cloths import add_cloth, mesh_positions

    obj = add_cloth()
    rest = mesh_positions(obj)
    for _ in range(20):
        bpy.ops.boucle.disable()
        off = [m.name for m in obj.modifiers], len(bpy.data.node_groups)
        bpy.ops.boucle.enable()
        on = [m.name for m in obj.modifiers], len(bpy.data.node_groups)
    return {"off": off, "on": on, "same": rest == mesh_positions(obj)}


def test_enabling_and_disabling_a_cloth_leaves_no_trace(blender):
    result = blender.run(switch_many_times)
    assert result["off"] == [[], 0]
    assert result["on"] == [["Boucle Target", "Boucle Cache"], 1]
    assert result["same"]


def enable_on_a_plain_mesh():
    import bpy

    bpy.ops.mesh.primitive_plane_add()
    before = bpy.ops.boucle.disable.poll(), bpy.ops.boucle.enable.poll()
    bpy.ops.boucle.enable()
    after = bpy.ops.boucle.disable.poll(), bpy.context.object.boucle.enabled
    bpy.ops.object.empty_add()
    return [before, after, bpy.ops.boucle.enable.poll()]


def test_only_meshes_can_become_cloths(blender):
    assert blender.run(enable_on_a_plain_mesh) == [[False, True], [True, True], False]
