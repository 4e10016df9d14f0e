"""A torn bake as it plays: only what one vertex was is joined, what does not fit is said, and every Blender shows the same."""

import os

END = 14
EVERY = tuple(range(1, END + 1))


def add_two_sheets():
    """Two sheets of 7 x 7 vertices in one mesh and in one place, pinned at the top; the first opens across at frame 5."""
    import bmesh
    import bpy

    made = bmesh.new()
    for _ in range(2):
        bmesh.ops.create_grid(made, x_segments=6, y_segments=6, size=0.5)
    mesh = bpy.data.meshes.new("Sheets")
    made.to_mesh(mesh)
    obj = bpy.data.objects.new("Sheets", mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.boucle.enabled = True
    top, opens = obj.vertex_groups.new(name="top"), obj.vertex_groups.new(name="open")
    top.add([v.index for v in mesh.vertices if v.co.y > 0.49], 1.0, "REPLACE")
    opens.add([v.index for v in mesh.vertices[:49] if abs(v.co.y) < 1e-4], 1.0, "REPLACE")
    values = {
        "pin_group": "top", "self_collision": False, "frame_end": END, "use_tear": True, "tear_stress": 0.0,
        "tear_opening_group": "open", "tear_opening_frame": 5,
    }  # fmt: skip
    for name, value in values.items():
        setattr(obj.boucle, name, value)
    return obj


def add_seamed_panels():
    """Two panels of 7 x 7 vertices, sewn by loose edges that close; the first opens along a column at frame 9."""
    import bmesh
    import bpy

    made = bmesh.new()
    for side in (-1.0, 1.0):
        known = set(made.verts)
        bmesh.ops.create_grid(made, x_segments=6, y_segments=6, size=0.5)
        for vertex in set(made.verts) - known:
            vertex.co.x += 0.55 * side
    inner = [v for v in made.verts if abs(abs(v.co.x) - 0.05) < 1e-4]
    inner.sort(key=lambda v: (v.co.x, v.co.y))
    for one, other in zip(inner[:7], inner[7:], strict=True):
        made.edges.new((one, other))
    mesh = bpy.data.meshes.new("Panels")
    made.to_mesh(mesh)
    obj = bpy.data.objects.new("Panels", mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.boucle.enabled = True
    opens = obj.vertex_groups.new(name="open")
    opens.add([v.index for v in mesh.vertices if abs(v.co.x + 0.55) < 1e-4], 1.0, "REPLACE")
    values = {
        "use_sewing_springs": True, "weld_distance": 0.01, "frame_end": 30, "use_tear": True, "tear_stress": 0.0,
        "tear_opening_group": "open", "tear_opening_frame": 9, "air_damping": 0.005,
    }  # fmt: skip
    for name, value in values.items():
        setattr(obj.boucle, name, value)
    bpy.context.scene.use_gravity = False
    return obj


def counts_of(looks):
    return [len(look["positions"]) // 3 for look in looks]


def touching(obj, look):
    """How many of the mesh's own vertices have another nearer than 1e-6 m in a frame."""
    import mathutils

    count = len(obj.data.vertices)
    tree = mathutils.kdtree.KDTree(count)
    places = [look["positions"][3 * vertex : 3 * vertex + 3] for vertex in range(count)]
    for vertex, place in enumerate(places):
        tree.insert(place, vertex)
    tree.balance()
    return sum(len(tree.find_range(place, 1e-6)) > 1 for place in places)


def touch(folder):
    """Of both cloths: what is shown in every frame, live and baked, and how many vertices touch others."""
    import bpy
    from test_tearing import at_frames

    out = {}
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    for name, add in (("sheets", add_two_sheets), ("panels", add_seamed_panels)):
        obj = add()
        obj.data.uv_layers.new(name="UVMap")
        frames = tuple(range(1, obj.boucle.frame_end + 1))
        live = counts_of(at_frames(obj, frames))
        bpy.ops.boucle.bake()
        baked = at_frames(obj, frames)
        mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        out[name] = {
            "live": live, "baked": counts_of(baked), "vertices": len(obj.data.vertices),
            "touching": [touching(obj, look) for look in baked],
            "first": list(baked[0]["positions"]) == [x for v in obj.data.vertices for x in v.co],
            "faces": baked[0]["faces"] == [list(face.vertices) for face in obj.data.polygons],
            "names": sorted(a.name for a in mesh.attributes if a.name.startswith("boucle")),
            "group": obj.modifiers["Boucle Mend"].node_group.name,
        }  # fmt: skip
        bpy.data.objects.remove(obj)
    return out


def test_sheets_that_coincide_and_seams_that_close_keep_their_vertices_in_every_frame(blender):
    found = blender.run(touch, folder=blender.folder)
    sheets, panels = found["sheets"], found["panels"]
    assert sheets["touching"][:4] == [98] * 4, "one sheet lies in the other"
    assert panels["touching"][-1] == 14 and panels["touching"][0] == 0, "the seams have closed"
    for one, opened in ((sheets, 5), (panels, 9)):
        count = one["vertices"]
        for counts in (one["live"], one["baked"]):
            assert counts[: opened - 1] == [count] * (opened - 1)
            assert counts[opened:] == [count + 7] * (len(counts) - opened)
        assert one["first"] and one["faces"]
        assert one["names"] == ["boucle_target"], "no other helper is left"
        assert one["group"] == "Boucle Mend"


def bake_three_corners(folder):
    """A cloth of triangles: vertices of 1 to 6 corners, of which none may be moved by the last bit."""
    import bmesh
    import bpy
    from cloths import addon
    from test_tearing import add_torn_cloth, looks

    obj = add_torn_cloth(columns=15, rows=11, end=8)
    made = bmesh.new()
    made.from_mesh(obj.data)
    bmesh.ops.triangulate(made, faces=made.faces)
    made.to_mesh(obj.data)
    cache, torn = addon("bridge.cache"), addon("core.torn")
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bpy.ops.boucle.bake()
    path = cache.played_path(obj)
    out = []
    twin = obj.copy()  # its mesh has two users: split along all edges
    bpy.context.collection.objects.link(twin)
    for _ in range(2):
        layout = torn.read(path.replace(".pc2", ".tear"))
        for frame in (1, 4, 8):
            bpy.context.scene.frame_set(frame)
            sample = addon("core.pc2").read_sample(path, frame - 1)
            look = looks(obj)
            shown = [look["positions"][3 * v : 3 * v + 3] for f in look["faces"] for v in f]
            spread = list(layout.spread(sample))
            exact = shown == [spread[3 * k : 3 * k + 3] for k in range(len(shown))]
            out.append([layout.edges is None, exact])
        bpy.context.view_layer.objects.active = obj
        bpy.ops.boucle.bake()
    return out


def test_what_is_mended_lies_where_the_bake_has_it_to_the_last_bit(blender):
    found = blender.run(bake_three_corners, folder=blender.folder)
    assert found == [[False, True]] * 3 + [[True, True]] * 3


def prepare_pictures(folder):
    """Bake a cloth that opens, with camera and light, and save it; frames and a picture as the add-on has them."""
    import bpy
    from test_render import make_it_dark
    from test_tearing import add_torn_cloth, at_frames

    obj = add_torn_cloth(end=END)
    make_it_dark()
    bpy.ops.object.camera_add(location=(0, -4, 0), rotation=(1.5708, 0, 0))
    bpy.context.scene.camera = bpy.context.object
    bpy.ops.object.light_add(type="SUN", rotation=(1.5708, 0, 0))
    bpy.context.object.data.energy = 5.0
    bpy.context.view_layer.objects.active = obj
    path = os.path.join(folder, "torn.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.boucle.bake()
    bpy.ops.wm.save_mainfile()
    return {"frames": at_frames(obj, EVERY), "picture": picture_of(END, folder)}


def picture_of(frame, folder):
    """Brightness of each pixel of a small picture, row by row from the bottom."""
    import bpy

    scene = bpy.context.scene
    scene.frame_set(frame)
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.device, scene.cycles.use_denoising = 4, "CPU", False
    scene.render.resolution_x = scene.render.resolution_y = 48
    scene.render.filepath = os.path.join(folder, "picture.png")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    values = [round(value, 4) for value in list(image.pixels)[::4]]
    bpy.data.images.remove(image)
    return values


def open_alone(path, folder):
    """Without the add-on: frames, the torn picture, and that of the mesh at rest."""
    import bpy
    from test_tearing import at_frames

    bpy.ops.wm.open_mainfile(filepath=path)
    assert not hasattr(bpy.types.Object, "boucle")
    obj = bpy.data.objects["Cloth"]
    out = {"frames": at_frames(obj, EVERY), "picture": picture_of(END, folder)}
    for name in ("Boucle Tear", "Boucle Cache", "Boucle Mend"):
        obj.modifiers[name].show_render = False
    out["rest"] = picture_of(END, folder)
    return out


def bands(picture):
    """How many bands of lit rows a picture has, from its middle column."""
    lit = [picture[48 * row + 24] > 0.06 for row in range(48)]
    return sum(one and not other for one, other in zip(lit, [False, *lit], strict=False))


def test_a_blender_without_the_add_on_plays_and_renders_the_torn_cloth(blender):
    ours = blender.run(prepare_pictures, folder=blender.folder)
    path = blender.folder / "torn.blend"
    alone = blender.run(open_alone, addon=False, path=path, folder=blender.folder)
    assert counts_of(alone["frames"])[0] == 63 < counts_of(alone["frames"])[-1]
    assert alone["frames"] == ours["frames"]
    assert alone["picture"] == ours["picture"]
    assert alone["rest"] != alone["picture"]
    assert bands(alone["rest"]) == 1 and bands(alone["picture"]) == 2, "a gap between two pieces"
