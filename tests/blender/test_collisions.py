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


def push_by_moving_meshes():
    import bpy
    from cloths import addon, play

    def key(thing, name, *pairs):
        for frame, value in pairs:
            setattr(thing, name, value)
            thing.keyframe_insert(name, frame=frame)

    def by_object(obj):
        key(obj, "location", (1, (0, 0, 0)), (12, (0, 0, 0.5)))

    def by_shape_key(obj):
        obj.shape_key_add()
        raised = obj.shape_key_add()
        for point in raised.data:
            point.co.z += 0.5
        key(raised, "value", (1, 0.0), (12, 1.0))

    def by_armature(obj):
        bpy.ops.object.armature_add()
        bones = bpy.context.object
        obj.vertex_groups.new(name="Bone").add(range(4), 1.0, "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = bones
        obj.modifiers.move(1, 0)
        # A bone's own axis y is up here.
        key(bones.pose.bones["Bone"], "location", (1, (0, 0, 0)), (12, (0, 0.5, 0)))

    out = {}
    for move in (by_object, by_shape_key, by_armature):
        sheet, floor = add_sheet(height=0.1), add_collider()
        move(floor)
        bpy.context.view_layer.objects.active = sheet
        play(1, 12)
        live = [min(heights(sheet)), max(heights(sheet))]
        rows = addon("bridge.live").session_of(sheet).frames
        crossed = [rows.certificate(n)["intersections"] for n in range(1, 13)]
        bpy.ops.boucle.bake()
        bpy.context.scene.frame_set(12)
        out[move.__name__] = [live, [min(heights(sheet)), max(heights(sheet))], crossed]
        bpy.data.objects.remove(sheet)
        bpy.data.objects.remove(floor)
    return out


def test_a_collider_moved_by_keys_a_shape_key_or_an_armature_lifts_the_cloth(blender):
    for name, (live, baked, crossed) in blender.run(push_by_moving_meshes).items():
        assert live[0] > 0.5, name
        assert live[1] < 0.8, name
        assert baked == live, name
        assert crossed == [0] * 12, name


def stop_on_a_moving_collider():
    import bpy
    from cloths import addon, refusal_of

    sheet, floor = add_sheet(height=0.1), add_collider()
    for frame, height in ((1, 0.0), (12, 0.4), (24, -0.2)):
        floor.location.z = height
        floor.keyframe_insert("location", frame=frame)
    bake = addon("bridge.bake").Bake([sheet], bpy.context.scene)
    steps = bake.steps()
    for step in steps:
        step.run()
        if step.frame == 9:
            break
    steps.close()
    bpy.context.view_layer.objects.active = sheet

    def baked():
        with open(bake.stores.each[0].files.pc2, "rb") as file:
            return file.read()

    part = len(baked())
    bpy.ops.boucle.bake(resume=True)
    resumed = baked()
    status = sheet.boucle.status
    floor.collision.cloth_friction = 30.0
    outdated = sheet.boucle.status
    refusal = refusal_of(bpy.ops.boucle.bake, resume=True)
    floor.collision.cloth_friction = 5.0
    bpy.ops.boucle.bake()
    return [part < len(resumed), resumed == baked(), status, outdated, refusal]


def test_a_bake_on_a_moving_collider_resumes_bit_equal(blender):
    is_part, same, status, outdated, refusal = blender.run(stop_on_a_moving_collider)
    assert is_part and same
    assert status.startswith("Baked: frames 1 to 24") and "outdated" not in status
    assert outdated.endswith('outdated, changed since: collider "Floor"')
    assert "is of other settings or another mesh" in refusal


def lie_on_a_baked_cloth():
    import bpy

    under, over = add_sheet(height=0.1), add_sheet(height=0.2)
    add_collider()
    under.modifiers.new("Collision", "COLLISION")
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = under
    bpy.ops.boucle.bake()
    bpy.context.view_layer.objects.active = over
    bpy.ops.boucle.bake()
    bpy.context.scene.frame_set(24)
    pairs = list(zip(heights(under), heights(over), strict=True))
    return [over.boucle.certificate, min(low for low, _ in pairs), min(b - a for a, b in pairs)]


def test_a_baked_cloth_with_a_collision_modifier_carries_another(blender):
    line, lowest, gap = blender.run(lie_on_a_baked_cloth)
    assert line.startswith("Frame 24: ") and "no intersections" in line
    assert lowest > 0.0
    assert 0.002 < gap < 0.002 + OUTER + 0.005


def who_collides():
    import bpy
    from cloths import addon

    colliders, scene = addon("bridge.colliders"), bpy.context.scene
    sheet = add_sheet()
    for name in ("Alone", "In", "Inner", "Eye", "Monitor", "Off", "Excluded", "Darkened"):
        add_collider(name)
    bpy.data.objects["Off"].modifiers["Collision"].show_viewport = False
    bpy.data.objects["Monitor"].hide_viewport = True
    bpy.data.objects["Eye"].hide_set(True)
    bpy.ops.mesh.primitive_cube_add()
    sheet.modifiers.new("Collision", "COLLISION")

    def collection(name, inside, parent=scene.collection):
        made = bpy.data.collections.new(name)
        parent.children.link(made)
        obj = bpy.data.objects[inside]
        made.objects.link(obj)
        scene.collection.objects.unlink(obj)
        return made

    outer = collection("Outer", "In")
    collection("Deep", "Inner", outer)
    collection("Unseen", "Excluded")
    collection("Dark", "Darkened").hide_viewport = True
    bpy.context.view_layer.layer_collection.children["Unseen"].exclude = True
    bpy.context.view_layer.update()

    def names():
        return [obj.name for obj in colliders.find(sheet, scene)]

    out = [names()]
    sheet.boucle.collision_collection = outer
    out.append(names())
    sheet.boucle.object_collision = False
    out.append(names())
    sheet.boucle.object_collision, sheet.boucle.collision_collection = True, None
    depsgraph = bpy.context.evaluated_depsgraph_get()
    known = addon("bridge.colliders").Colliders([sheet], scene, depsgraph)
    return [*out, len(known.targets(depsgraph))]


def test_colliders_are_those_that_blender_takes_within_the_collection(blender):
    everything, inside, none, known = blender.run(who_collides)
    assert everything == ["Alone", "Eye", "In", "Inner"]
    assert inside == ["In", "Inner"]
    assert none == []
    assert known == 4


def filter_by_collection():
    import bpy

    sheet = add_sheet()
    add_collider()
    out = [lowest_after(sheet)]
    sheet.boucle.collision_collection = bpy.data.collections.new("Empty")
    out.append(lowest_after(sheet))
    sheet.boucle.collision_collection = None
    sheet.boucle.object_collision = False
    out.append(lowest_after(sheet))
    return out


def test_the_collection_and_the_switch_let_cloth_pass_through_other_objects(blender):
    met, filtered, off = blender.run(filter_by_collection)
    assert met > 0.0
    assert filtered < -1.0 and off < -1.0


def leave_out_groups():
    import bpy
    from cloths import addon

    sheet = add_sheet()
    add_collider()
    sheet.vertex_groups.new(name="All").add(range(81), 1.0, "REPLACE")
    half = sheet.vertex_groups.new(name="Half")
    half.add(range(40), 0.001, "REPLACE")
    half.add(range(40, 81), 0.0, "REPLACE")
    settings = addon("bridge.settings")

    def collision():
        found = settings.describe(sheet, bpy.context.scene, with_groups=True)
        return found["cloth"][0]["collision"]

    bpy.context.view_layer.update()
    sheet.boucle.collision_group = "Half"
    sheet.boucle.self_collision_group = "All"
    described = collision()
    sheet.boucle.self_collision = False
    bare = collision()
    sheet.boucle.collision_group = "All"
    passed = lowest_after(sheet)
    sheet.boucle.collision_group = "Al"
    errors = [p.sentence for p in addon("bridge.preflight").problems(sheet, bpy.context.scene)]
    return [described, bare, passed, errors[0]]


def test_vertices_of_the_groups_do_not_collide(blender):
    described, bare, passed, error = blender.run(leave_out_groups)
    assert described["excluded_from_colliders"] == list(range(40)), "any weight above 0 excludes"
    assert described["excluded_from_self"] == list(range(81))
    assert bare["self"] is False and "excluded_from_self" not in bare
    assert passed < -1.0
    assert 'Object Collision Vertex Group "Al" is not a vertex group' in error


def describe_friction():
    import bpy
    from cloths import addon

    sheet, floor = add_sheet(friction=0.5), add_collider()
    bpy.ops.boucle.add_cloth(vertices_x=3, vertices_y=3)
    alone = bpy.context.object
    settings, out = addon("bridge.settings"), []
    for friction, thickness in ((5.0, 0.02), (80.0, 0.1), (0.0, 0.001)):
        floor.collision.cloth_friction, floor.collision.thickness_outer = friction, thickness
        scene = settings.describe(sheet, bpy.context.scene, with_groups=False)
        out.append([scene["collider"], scene["cloth"][0]["collision"]])
    alone.boucle.object_collision = alone.boucle.self_collision = False
    scene = settings.describe(alone, bpy.context.scene, with_groups=False)
    return [out, "collider" in scene, scene["cloth"][0]["collision"]]


def test_friction_and_thickness_of_an_object_are_those_of_its_collision_physics(blender):
    rows, has_colliders, collision = blender.run(describe_friction)
    for (colliders, cloth), (mu, thickness) in zip(
        rows, ((0.05, 0.02), (0.8, 0.1), (0.0, 0.001)), strict=True
    ):
        assert colliders == [{"name": "Floor", "friction": mu, "thickness": thickness}]
        assert cloth == {"self": True, "thickness": 0.002, "friction": 0.5}
    assert not has_colliders and collision == {"enabled": False}


def slide_down():
    import bpy
    from cloths import play, world_positions

    out = []
    for friction in (0.0, 80.0):
        sheet, floor = add_sheet(height=0.03, friction=1.0), add_collider(size=20.0)
        for obj in (sheet, floor):
            obj.rotation_euler.y = 0.3
        floor.collision.cloth_friction = friction
        play(1, 24)
        points = world_positions(sheet)
        out.append(sum(point.x for point in points) / len(points))
        bpy.data.objects.remove(sheet)
        bpy.data.objects.remove(floor)
    return out


def test_cloth_slides_down_a_smooth_slope_and_stays_on_a_rough_one(blender):
    smooth, rough = blender.run(slide_down)
    # 9.81 m/s² · sin 0.3 · cos 0.3 · (23/24 s)² / 2 along x; at sqrt(1.0 · 0.8) against tan 0.3 = 0.31 it sticks.
    assert abs(smooth - 1.27) < 0.1
    assert abs(rough) < 0.02


def change_vertex_count():
    import bpy
    from cloths import play, refusal_of

    sheet, floor = add_sheet(), add_collider()
    subdivided = floor.modifiers.new("Subdivision", "SUBSURF")
    subdivided.subdivision_type = "SIMPLE"
    for frame, level in ((1, 1), (5, 1), (6, 2)):
        subdivided.levels = level
        subdivided.keyframe_insert("levels", frame=frame)
    play(1, 8)
    live = sheet.boucle.status
    baked = refusal_of(bpy.ops.boucle.bake)
    after = sheet.boucle.status
    bpy.context.scene.frame_set(1)
    bpy.data.objects.remove(floor)
    return [live, baked, after]


def test_a_collider_whose_vertex_count_changes_is_refused_by_name(blender):
    live, baked, after = blender.run(change_vertex_count)
    sentence = (
        'the collider "Floor" of "Cloth" has 25 vertices at frame 6 and 9 at the start: switch off'
    )
    assert sentence in live and live.startswith("Live: frames 1 to 5")
    assert sentence in baked and "frames up to 5 are kept" in baked
    assert sentence in after or "Partly baked: frames 1 to 5" in after


def change_while_live():
    import bpy
    from cloths import addon, mesh_positions, play

    sheet, floor = add_sheet(), add_collider()
    rest, out = mesh_positions(sheet), {}
    live = addon("bridge.live")
    changes = {
        "modifier off": lambda: setattr(floor.modifiers[0], "show_viewport", False),
        "modifier on": lambda: setattr(floor.modifiers[0], "show_viewport", True),
        "friction": lambda: setattr(floor.collision, "cloth_friction", 40.0),
        "another": lambda: add_collider("Other", z=-1.0),
        "renamed": lambda: setattr(floor, "name", "Ground"),
        "removed": lambda: bpy.data.objects.remove(floor),
        "thickness": lambda: setattr(sheet.boucle, "thickness", 0.01),
        "switch": lambda: setattr(sheet.boucle, "object_collision", False),
    }
    for name, change in changes.items():
        play(1, 3)
        assert live.session_of(sheet) is not None
        change()
        play(4, 4)
        out[name] = mesh_positions(sheet) == rest
    play(1, 2)
    floor = add_collider("Animated")
    for frame, value in ((1, 5.0), (9, 50.0)):
        floor.collision.cloth_friction = value
        floor.keyframe_insert("collision.cloth_friction", frame=frame)
    sheet.boucle.object_collision = True
    play(1, 5)
    out["keyed friction"] = live.session_of(sheet).frames.last == 5
    return out


def test_a_changed_collider_ends_the_live_result(blender):
    for name, is_so in blender.run(change_while_live).items():
        assert is_so, name


def lose_a_collider():
    import bpy
    from cloths import addon

    sheet, floor = add_sheet(), add_collider()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    known = addon("bridge.colliders").Colliders([sheet], bpy.context.scene, depsgraph)
    said = []

    def note():
        try:
            known.targets(bpy.context.evaluated_depsgraph_get())
        except addon("core.refusal").Refusal as refusal:
            said.append(str(refusal))

    floor.hide_viewport = True
    note()
    bpy.data.objects.remove(floor)
    note()
    return said


def test_a_collider_that_is_gone_or_not_evaluated_is_named(blender):
    hidden, gone = blender.run(lose_a_collider)
    assert 'the collider "Floor" of "Cloth" is not evaluated at frame 1: enable it' in hidden
    assert gone.startswith('the collider "Floor" of "Cloth" is gone: ')


def keep_settings(folder):
    import bpy
    from cloths import addon

    values = {
        "self_collision": False, "thickness": 0.0125, "friction": 0.75, "object_collision": False,
        "self_collision_group": "A", "collision_group": "B", "show_thickness": True,
        "use_contact": False, "use_intersection": False,
    }  # fmt: skip
    sheet = add_sheet(**values)
    collection = bpy.data.collections.new("Met")
    bpy.context.scene.collection.children.link(collection)
    sheet.boucle.collision_collection = collection
    path = f"{folder}/cloth.blend"
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    loaded = bpy.data.objects["Cloth"].boucle

    def read(settings):
        found = {name: getattr(settings, name) for name in values}
        return {
            **found,
            "thickness": round(settings.thickness, 7),
            "where": settings.collision_collection.name,
        }

    kept = read(loaded) == {**values, "where": "Met"}
    plain = addon("bridge.settings").values(loaded.id_data)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = ["Cloth"]
    own = into.objects[0].override_create()
    bpy.context.scene.collection.objects.link(own)
    own.boucle.thickness = 0.5
    own.boucle.self_collision = True
    mine = bpy.data.collections.new("Mine")
    bpy.context.scene.collection.children.link(mine)
    own.boucle.collision_collection = mine
    bpy.ops.wm.save_as_mainfile(filepath=f"{folder}/shot.blend")
    bpy.ops.wm.open_mainfile(filepath=f"{folder}/shot.blend")
    own = next(obj for obj in bpy.data.objects if obj.override_library)
    settings = own.boucle
    override = [settings.thickness, settings.self_collision, settings.collision_collection.name]
    return [kept, "collision_collection" in plain, override]


def test_collision_settings_are_saved_and_overridden(blender):
    kept, is_plain, override = blender.run(keep_settings, folder=blender.folder)
    assert kept and not is_plain
    assert override == [0.5, True, "Mine"]


def thickness_wires():
    import bpy
    from cloths import addon

    view = addon("bridge.thickness_view")
    sheet = add_sheet(height=1.0, thickness=0.125, side=3)
    sheet.scale = (2.0, 1.0, 3.0)
    sheet.boucle.show_thickness = True
    in_background = view._handle is None
    (above, below), ends = view.wires(sheet, bpy.context.evaluated_depsgraph_get())
    rows = view._rows(above, 3)
    shape = [list(rows.shape), list(view._rows(ends, 2).shape)]
    sheet.boucle.show_thickness = False
    above, below = above.tolist(), below.tolist()
    return [in_background, above[2::3], below[2::3], above[:2], shape]


def test_the_thickness_is_drawn_in_metres_and_only_where_there_is_a_window(blender):
    in_background, above, below, corner, shape = blender.run(thickness_wires)
    assert in_background
    assert above == [1.125] * 9 and below == [0.875] * 9
    assert corner == [-1.0, -0.5]
    assert shape == [[9, 3], [12, 2]]


class Gpu:
    """Takes the place of Blender's gpu module, which needs a graphics card: it knows what was drawn."""

    def __init__(self):
        self.drawn, self.made = [], 0
        self.shader = self.types = self.state = self

    def from_builtin(self, name):
        assert name == "UNIFORM_COLOR"
        return self

    def format_calc(self):
        return "format"

    def uniform_float(self, name, color):
        assert name == "color" and len(color) == 4

    def blend_set(self, _mode):
        """Nothing to blend."""

    depth_test_set = blend_set

    def GPUIndexBuf(self, type, seq):  # noqa: N802 (Blender's word)
        assert type == "LINES" and seq.format == "i"
        return seq.tolist()

    def GPUVertBuf(self, _format, count):  # noqa: N802 (Blender's word)
        gpu = self

        class Buffer:
            def attr_fill(self, name, rows):
                assert name == "pos" and rows.format == "f" and rows.shape == (count, 3)
                self.top = max(row[2] for row in rows.tolist())
                gpu.made += 1

        return Buffer()

    def GPUBatch(self, type, buf, elem):  # noqa: N802 (Blender's word)
        assert type == "LINES"
        gpu = self

        class Batch:
            def draw(self, _shader):
                gpu.drawn.append([buf.top, len(elem)])

        return Batch()


def draw_the_thickness():
    import sys

    import addon_utils
    import bpy
    from cloths import addon

    gpu = sys.modules["gpu"] = Gpu()
    view = addon("bridge.thickness_view")
    view._has_window = lambda: True
    sheet = add_sheet(height=1.0, thickness=0.125, side=3)
    out = [view._handle is None]
    sheet.boucle.show_thickness = True
    out.append(view._handle is not None)
    bpy.context.view_layer.update()
    view._draw()
    out += [list(gpu.drawn), gpu.made]
    view._draw()
    out += [len(gpu.drawn), gpu.made]
    sheet.location.z = 2.0
    bpy.context.view_layer.update()
    view._draw()
    out.append(gpu.drawn[4:])
    sheet.boucle.show_thickness = False
    out.append(view._handle is None)
    view._draw()
    out.append(len(gpu.drawn))
    sheet.boucle.show_thickness = True
    addon_utils.disable("bl_ext.user_default.boucle")
    return [*out, view._handle is None]


def test_the_thickness_is_computed_once_and_drawn_only_while_it_is_wanted(blender):
    assert blender.run(draw_the_thickness) == [
        True, True, [[1.125, 12], [0.875, 12]], 2, 4, 2, [[2.125, 12], [1.875, 12]], True, 6, True,
    ]  # fmt: skip


def meet_many_objects():
    import time

    import bpy
    from cloths import addon

    sheet = add_sheet()
    for number in range(2000):
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(f"Empty {number}", None))
    find = addon("bridge.colliders").find
    seconds = []
    for _ in range(5):
        begin = time.perf_counter()
        assert find(sheet, bpy.context.scene) == []
        seconds.append(time.perf_counter() - begin)
    return min(seconds)


def test_a_scene_without_colliders_is_looked_through_at_once(blender):
    assert blender.run(meet_many_objects) < 5e-3
