"""The model Fabric in Blender: live and baked, its warp, what the check says, and with everything that shapes cloth."""

import os

STIFF = {"stretch_warp": 20_000.0, "stretch_weft": 200.0, "shear": 50.0, "limiter": "none"}


def live_and_baked(folder):
    import bpy
    from cloths import add_cloth, addon, farthest, play, shown_positions

    scene = bpy.context.scene
    obj = add_cloth(columns=7, rows=5, end=6, model="fabric", bend_warp=1e-4)
    obj.location.y, scene.gravity = 0.3, (0.0, -5.0, -8.0)
    settings = obj.boucle
    settings.use_tension = settings.use_strain = True
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    play(1, 6)
    out, live = {"status": settings.status}, shown_positions(obj)
    tension = [0.0] * 35
    obj.data.attributes["boucle_tension"].data.foreach_get("value", tension)
    out["tension"] = max(tension)
    bpy.ops.boucle.go_to_worst_frame(by="strain")
    out["edges"] = len(addon("bridge.worst").edges(obj, scene))
    bpy.ops.boucle.bake()
    scene.frame_set(6)
    baked = shown_positions(obj)
    out["off"] = farthest(baked, live)
    scene.frame_set(1)
    out["moves"] = farthest(baked, shown_positions(obj))
    out["words"] = []

    def outdated():
        bpy.ops.boucle.check(select=False)
        out["words"].append(addon("bridge.cache").drift_of(obj, scene, in_full=True))

    outdated()
    bpy.ops.boucle.add_take(take_name="First")
    settings.bend_warp = 3e-4
    settings.warp = "x"
    outdated()
    settings.model = "springs"
    outdated()
    bpy.ops.boucle.restore_take(index=0, with_settings=True)
    out["restored"] = [settings.model, settings.warp, round(settings.bend_warp, 9), settings.status]
    outdated()
    settings.warp = "uv"
    bpy.ops.boucle.bake()
    outdated()
    obj.data.uv_layers.active.uv[3].vector.x += 0.25
    outdated()
    paths = [os.path.join(folder, f"cloth.{kind}") for kind in ("usdc", "abc")]
    bpy.ops.boucle.export_usd(filepath=paths[0])
    bpy.ops.boucle.export_alembic(filepath=paths[1])
    out["exported"] = [os.path.getsize(path) > 0 for path in paths]
    return out


def test_fabric_plays_bakes_and_keeps_takes_as_springs_do(blender):
    result = blender.run(live_and_baked, folder=blender.folder)
    assert result["status"].startswith("Live") and result["moves"] > 1e-3
    assert result["off"] < 1e-6
    assert result["tension"] > 0.0 and result["edges"] == 58
    assert result["words"][0] == []
    assert result["words"][1] == ["bend stiffness along the warp", "warp"]
    assert "model" in result["words"][2] and "stretch stiffness" in result["words"][2]
    assert result["restored"][:3] == ["fabric", "z", 1e-4]
    assert result["words"][3] == result["words"][4] == []
    assert result["words"][5] == ["UV map"]
    assert result["exported"] == [True, True]


def turn_the_mesh(obj):
    """The same sheet, modelled lying in an object that stands."""
    import bpy
    from mathutils import Matrix

    quarter = 1.5707963267948966
    obj.data.transform(Matrix.Rotation(-quarter, 4, "X"))
    obj.matrix_world = Matrix.Rotation(quarter, 4, "X")
    bpy.context.view_layer.update()


def turn_the_map(obj):
    """A second map whose V grows along the rows."""
    layers = obj.data.uv_layers
    places = [tuple(corner.vector) for corner in layers["UVMap"].uv]
    second = layers.new(name="Across")
    layers.active = layers["UVMap"]
    for corner, (u, v) in zip(second.uv, places, strict=True):
        corner.vector = (v, -u)


def hang():
    import bpy
    from cloths import add_cloth, play, world_positions

    def length(prepare=None, **values):
        """How long a sheet of 1 m is under its own weight."""
        obj = add_cloth(columns=5, rows=9, end=60, model="fabric", self_collision=False, **STIFF)
        settings = obj.boucle
        settings.density, settings.air_damping, settings.integrator = 2.0, 0.2, "implicit_euler"
        for name, value in values.items():
            setattr(settings, name, value)
        if prepare is not None:
            prepare(obj)
        play(1, 40)
        assert settings.status.startswith("Live"), settings.status
        points = world_positions(obj)
        found = (points[2] - points[42]).length
        bpy.data.objects.remove(obj)
        return found

    return {
        "up": [
            length(warp="z"),
            length(warp="uv"),
            length(turn_the_mesh, warp="y"),
            length(turn_the_map, warp="uv", warp_uv_map="UVMap"),
        ],
        "across": [
            length(warp="x"),
            length(turn_the_mesh, warp="x"),
            length(turn_the_map, warp="uv", warp_uv_map="Across"),
        ],
    }


def test_the_warp_runs_along_an_axis_of_the_object_or_a_uv_map(blender):
    result = blender.run(hang)
    assert all(length < 1.002 for length in result["up"]), result
    # 2 kg/m² on 200 N/m: 5 % in the mean, by the linear law
    assert all(1.035 < length < 1.06 for length in result["across"]), result


def check():
    import json

    import bpy
    from cloths import add_cloth, refusal_of

    bpy.context.scene.frame_end = 20
    obj = add_cloth(columns=4, rows=4, model="fabric", warp="uv")
    settings = obj.boucle
    out = {}

    def said():
        bpy.ops.boucle.check(select=False)
        rows = json.loads(settings.problems or "[]")
        return [[row["severity"], row["sentence"], row["selects"]] for row in rows]

    out["clean"] = said()
    settings.warp_uv_map = "Nowhere"
    out["other"] = said()
    settings.warp_uv_map = ""
    obj.data.uv_layers.remove(obj.data.uv_layers[0])
    out["none"] = said()
    out["refused"] = refusal_of(bpy.ops.boucle.bake)
    bpy.context.scene.frame_set(1)
    out["status"] = settings.status
    settings.warp = "z"
    settings.limiter = "stiffen"
    out["limiter"] = said()
    settings.limiter = "project"
    settings.integrator = "verlet"
    out["explicit"] = said()
    out["safe"] = settings.safe_step
    settings.integrator = "bdf2"
    settings.bend_warp = 1e-4
    settings.keyframe_insert("bend_warp", frame=1)
    settings.bend_warp = 2e-4
    settings.keyframe_insert("bend_warp", frame=9)
    out["animated"] = said()
    obj.animation_data_clear()
    mesh = bpy.data.meshes.new("Fan")
    points = [(0, 0, 0), (1, 0, 0), (1.2, 0, 1), (0.5, 0, 1.5), (-0.2, 0, 1)]
    mesh.from_pydata(points, [], [range(5)])
    fan = bpy.data.objects.new("Fan", mesh)
    bpy.context.collection.objects.link(fan)
    bpy.context.view_layer.objects.active = fan
    bpy.ops.boucle.enable()
    settings = fan.boucle
    out["springs"] = said()
    settings.model = "fabric"
    out["corners"] = said()
    return out


def test_the_check_says_what_is_unusual_about_a_fabric(blender):
    result = blender.run(check)
    assert result["clean"] == []
    errors = [rows for rows in result.values() if rows and rows[0][0] == "ERROR"]
    assert len(errors) == 3 and all(len(rows) == 1 for rows in errors)
    assert (
        'the UV map "Nowhere", which the mesh does not have (it has "UVMap")'
        in result["other"][0][1]
    )
    for said in (result["none"][0][1], result["refused"], result["status"]):
        assert '"Cloth": the warp follows a UV map, but the mesh has none: unwrap it' in said
    assert "the limiter Stiffen is for springs" in result["limiter"][0][1]
    assert result["explicit"][0][0] == "WARNING"
    assert "its integrator is explicit" in result["explicit"][0][1]
    assert "Safe time step" in result["safe"]
    assert "bend_warp is animated" in result["animated"][0][1]
    assert not any("corners" in row[1] for row in result["springs"])
    hint = next(row for row in result["corners"] if "more than four corners" in row[1])
    assert hint[0] == "HINT" and hint[2]


def shape():
    import bpy
    from cloths import add_cloth, play, world_positions

    scene = bpy.context.scene
    scene.use_gravity = False

    def free_cloth(**values):
        obj = add_cloth(columns=7, rows=5, end=60, model="fabric", air_damping=5.0, **values)
        obj.boucle.pin_group, obj.boucle.self_collision = "", False
        scene.frame_set(1)
        return obj

    def width(obj):
        points = world_positions(obj)
        return (points[6] - points[0]).length

    out = {}
    obj = free_cloth(shrink_min=0.25)
    play(1, 30)
    out["shrunk"] = width(obj)
    obj = free_cloth(limiter="none")
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Narrow")
    key.value = 0.0
    for point in key.data:
        point.co.x *= 0.5
    obj.boucle.rest_shape_key = "Narrow"
    play(1, 40)
    out["key"] = width(obj)
    obj = free_cloth(use_dynamic_mesh=True, limiter="none")
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Narrow")
    for point in key.data:
        point.co.x *= 0.5
    for frame, value in ((1, 0.0), (10, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    scene.frame_set(1)
    play(1, 40)
    out["dynamic"] = width(obj)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=10, ring_count=6, radius=0.5)
    ball = bpy.context.object
    ball.boucle.model, ball.boucle.air_damping, ball.boucle.limiter = "fabric", 0.05, "none"
    ball.boucle.use_pressure, ball.boucle.self_collision = True, False
    ball.boucle.uniform_pressure_force = 300.0
    ball.boucle.enabled = True
    scene.frame_set(1)
    play(1, 20)
    out["ball"] = max(point.length for point in world_positions(ball))
    out["statuses"] = [o.boucle.status for o in bpy.data.objects if o.boucle.enabled]
    return out


def test_rest_shapes_shrink_and_pressure_move_fabric(blender):
    result = blender.run(shape)
    assert abs(result["shrunk"] - 1.5) < 0.05, result
    assert abs(result["key"] - 1.0) < 0.05 and abs(result["dynamic"] - 1.0) < 0.05, result
    # Laplace: the strain of a ball is p R/(2 Y).
    assert abs(result["ball"] / (0.5 * (1.0 + 300.0 * 0.5 / (2.0 * 2000.0))) - 1.0) < 0.01, result
    assert all(status.startswith("Live") for status in result["statuses"])


def tailor(folder):
    from pathlib import Path

    import bpy
    from cloths import add_cloth, addon, play, shown_positions, world_positions

    cache, scene = addon("bridge.cache"), bpy.context.scene
    out = {}
    # Two panels whose loose edges draw them together.
    mesh = bpy.data.meshes.new("Panels")
    points = [(x + side, 0, z) for side in (0, 1.3) for z in (0, 0.5, 1) for x in (0, 0.5, 1)]
    quads = [(k, k + 1, k + 4, k + 3) for k in (0, 1, 3, 4, 9, 10, 12, 13)]
    mesh.from_pydata(points, [(2 + k, 9 + k) for k in (0, 3, 6)], quads)
    panels = bpy.data.objects.new("Panels", mesh)
    scene.collection.objects.link(panels)
    bpy.context.view_layer.objects.active = panels
    bpy.ops.boucle.enable()
    settings = panels.boucle
    settings.model, settings.use_sewing_springs, settings.self_collision = "fabric", True, False
    settings.sewing_force_max, settings.air_damping = 5.0, 0.05
    scene.use_gravity = False
    play(1, 30)
    shown = world_positions(panels)
    out["seam"] = max((shown[2 + k] - shown[9 + k]).length for k in (0, 3, 6))
    scene.use_gravity = True
    bpy.data.objects.remove(panels)

    # Settled, baked, stopped and resumed; its start pose and a shape key of a frame.
    obj = add_cloth(columns=7, rows=5, end=8, model="fabric", settle_frames=10, bend_warp=1e-4)
    settings = obj.boucle
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    scene.frame_set(1)
    out["settled"] = min(shown_positions(obj)[2::3])
    bpy.ops.boucle.bake()
    pc2 = Path(cache.own_files(obj).pc2)
    whole = pc2.read_bytes()
    bake = addon("bridge.bake").Bake([obj], scene)
    steps = bake.steps()
    for number, step in enumerate(steps):
        step.run()
        if number == 15:
            break
    steps.close()
    out["stopped"] = pc2.read_bytes() == whole
    bpy.ops.boucle.bake(resume=True)
    out["resumed"] = pc2.read_bytes() == whole
    settings.settle_frames = 0
    bpy.ops.boucle.free_bake()
    play(1, 6)
    bpy.ops.boucle.apply_as_start()
    play(1, 2)
    bpy.ops.boucle.apply_as_shape_key()
    out["keys"] = len(obj.data.shape_keys.key_blocks)
    out["status"] = settings.status

    # From Blender's own cloth: springs again.
    obj.modifiers.new("Cloth", "CLOTH")
    bpy.ops.boucle.copy_from_cloth()
    out["copied"] = settings.model
    return out


def test_fabric_is_sewn_settled_resumed_and_applied(blender):
    result = blender.run(tailor, folder=blender.folder)
    assert result["seam"] < 0.05, result
    assert result["settled"] < -0.5, result
    assert not result["stopped"] and result["resumed"], "not a bit is lost"
    assert result["keys"] >= 3 and result["status"].startswith("Live")
    assert result["copied"] == "springs"


def together(folder):
    import bpy
    from cloths import addon
    from test_together import add_sheet, lowest

    lower = add_sheet("Lower", 0.0, held=True, model="fabric", bend_warp=2e-4, bend_weft=2e-4)
    upper = add_sheet("Upper", 0.12)
    upper.boucle.stretch = 800.0
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bpy.ops.boucle.bake_all()
    record = addon("bridge.cache").record_of(upper)
    return {
        "with": list(record.get("together", {}).values()),
        "gap": lowest(upper, 14) - lowest(lower, 14),
        "fell": lowest(upper, 14),
        "statuses": [lower.boucle.status, upper.boucle.status],
    }


def test_fabric_and_springs_are_baked_together_and_collide(blender):
    result = blender.run(together, folder=blender.folder)
    assert result["with"] == ["Lower"]
    assert result["fell"] < 0.1 and result["gap"] > 0.02, result
    assert all(status.startswith("Baked") for status in result["statuses"])


def creased():
    import bpy
    from cloths import add_cloth, addon, farthest, play, shown_positions

    scene = bpy.context.scene
    scene.gravity = (0.0, -5.0, -8.0)
    out, shown = {"words": []}, {}
    for name, values in {
        "elastic": {},
        "creased": {"yield_curvature": 0.3},
        "rubbing": {"bend_hysteresis": 0.2},
    }.items():
        obj = add_cloth(columns=7, rows=5, end=8, model="fabric", bend_warp=1e-2, bend_weft=1e-2)
        for key, value in values.items():
            setattr(obj.boucle, key, value)
        play(1, 8)
        out[name] = obj.boucle.status
        shown[name] = shown_positions(obj)
        bpy.ops.boucle.bake()
        scene.frame_set(8)
        out[name + " baked"] = farthest(shown_positions(obj), shown[name])
        obj.boucle.yield_curvature, obj.boucle.hardening = 30.0, 0.1
        obj.boucle.bend_hysteresis = 1e-3
        out["words"].append(addon("bridge.cache").drift_of(obj, scene, in_full=True))
        obj.boucle.keyframe_insert("yield_curvature", frame=1)
        obj.boucle.yield_curvature = 40.0
        obj.boucle.keyframe_insert("yield_curvature", frame=5)
        bpy.ops.boucle.check(select=False)
        out["animated"] = obj.boucle.problems
        bpy.data.objects.remove(obj)
    for name in ("creased", "rubbing"):
        out[name + " apart"] = farthest(shown[name], shown["elastic"])
    return out


def test_fabric_creases_and_rubs_live_and_baked_and_changes_are_told(blender):
    result = blender.run(creased)
    for name in ("elastic", "creased", "rubbing"):
        assert result[name].startswith("Live")
        assert result[name + " baked"] < 1e-6
    assert result["creased apart"] > 1e-4 and result["rubbing apart"] > 1e-4
    words = ["bend hysteresis", "crease hardening", "curvature beyond which it creases"]
    assert [sorted(found) for found in result["words"]] == [words] * 3
    assert "yield_curvature is animated" in result["animated"]
