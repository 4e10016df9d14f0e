"""Tearing: from the settings to a file that plays in a Blender without the add-on."""

import os

FRAMES = (1, 6, 12, 20)


def add_torn_cloth(columns=9, rows=7, end=20, **values):
    """A hanging cloth that opens across a row of its vertices at frame 5, with a UV map, two materials and a group of weights."""
    import bpy
    from cloths import add_cloth

    values = {"use_tear": True, "tear_stress": 0.0, "tear_opening_group": "open", "tear_opening_frame": 5, **values}
    obj = add_cloth(columns=columns, rows=rows, end=end)
    mesh = obj.data
    heights = sorted({round(vertex.co.z, 5) for vertex in mesh.vertices})
    row = [v.index for v in mesh.vertices if round(v.co.z, 5) == heights[len(heights) // 2]]
    obj.vertex_groups.new(name="open").add(row, 1.0, "REPLACE")
    shade = obj.vertex_groups.new(name="shade")
    for vertex in mesh.vertices:
        shade.add([vertex.index], 0.1 + 0.01 * vertex.index, "REPLACE")
    if not mesh.uv_layers:
        mesh.uv_layers.new(name="UVMap")
    for name in ("one", "two"):
        mesh.materials.append(bpy.data.materials.new(name))
    for face in mesh.polygons:
        face.material_index = face.index % 2
    for name, value in values.items():
        setattr(obj.boucle, name, value)
    return obj


def looks(obj, with_groups=True):
    """What is evaluated, as lists: vertices, faces, UVs, materials, weights."""
    import bpy
    from cloths import shown_positions

    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return {
        "positions": shown_positions(obj),
        "faces": [list(face.vertices) for face in mesh.polygons],
        "uvs": [list(one.uv) for one in mesh.uv_layers[0].data],
        "materials": [face.material_index for face in mesh.polygons],
        "weights": [sorted([g.group, g.weight] for g in v.groups) for v in mesh.vertices],
    }


def at_frames(obj, frames=FRAMES):
    import bpy

    found = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        found.append(looks(obj))
    return found


def corners_of(look):
    """Positions of all corners of all faces."""
    at = look["positions"]
    return [at[3 * vertex : 3 * vertex + 3] for face in look["faces"] for vertex in face]


def plain(obj):
    """The artist's mesh: positions, faces, edges and names of its attributes."""
    mesh = obj.data
    return {
        "positions": [list(vertex.co) for vertex in mesh.vertices],
        "faces": [list(face.vertices) for face in mesh.polygons],
        "attributes": sorted(name for name in mesh.attributes.keys() if name.startswith("boucle")),
        "modifiers": [modifier.name for modifier in obj.modifiers],
    }


def bake_and_save(folder):
    import bpy

    obj = add_torn_cloth()
    before = plain(obj)
    path = os.path.join(folder, "torn.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    done = bpy.ops.boucle.bake()
    played = at_frames(obj)
    during = plain(obj)
    status = obj.boucle.status
    bpy.ops.wm.save_mainfile()
    files = sorted(os.listdir(os.path.dirname(bpy.path.abspath(obj.modifiers["Boucle Cache"].filepath))))
    return {
        "done": list(done), "before": before, "during": during, "status": status, "played": played,
        "files": [name.split(".", 1)[1] for name in files],
    }  # fmt: skip


def open_and_free(path):
    import bpy

    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.context.view_layer.objects.active = bpy.data.objects["Cloth"]
    played = at_frames(obj)
    bpy.ops.boucle.free_bake()
    groups = [group.name for group in bpy.data.node_groups]
    return {"played": played, "after": plain(obj), "groups": groups}


def play_alone(path):
    import bpy

    bpy.ops.wm.open_mainfile(filepath=path)
    assert not hasattr(bpy.types.Object, "boucle")
    return at_frames(bpy.data.objects["Cloth"])


def test_a_row_that_opens_parts_the_mesh_and_leaves_the_artists_alone(blender):
    baked = blender.run(bake_and_save, folder=blender.folder)
    assert baked["done"] == ["FINISHED"], blender.output
    assert baked["status"].startswith("Baked: frames 1 to 20")
    first, _, torn, last = baked["played"]
    count = 3 * 9 * 7
    assert len(first["positions"]) == count
    assert len(last["positions"]) == len(torn["positions"]) == count + 3 * 9, "a row is there twice"
    assert first["faces"] == baked["before"]["faces"], "whole, vertices have their numbers"
    for look in baked["played"]:
        for name in ("uvs", "materials"):
            assert look[name] == first[name]
        assert look["weights"][: 9 * 7] == first["weights"]
        corners = zip(look["faces"], first["faces"], strict=True)
        same = [a == b for one, other in corners for a, b in zip(one, other, strict=True) if a < 63]
        assert all(same), "the first vertices are those of the mesh"
    assert baked["during"]["positions"] == baked["before"]["positions"]
    assert baked["during"]["faces"] == baked["before"]["faces"]
    assert baked["during"]["attributes"] == ["boucle_tear"]
    assert baked["files"] == ["checkpoint", "json", "pc2", "tear"]
    lower = min(last["positions"][2::3])
    assert lower < min(first["positions"][2::3]) - 0.1, "the lower half has fallen"
    alone = blender.run(play_alone, addon=False, path=blender.folder / "torn.blend")
    assert alone == baked["played"]
    freed = blender.run(open_and_free, path=blender.folder / "torn.blend")
    assert freed["played"] == baked["played"]
    assert freed["after"] == baked["before"], "nothing is left on the mesh nor in the stack"
    assert freed["groups"] == ["Boucle Target"]
