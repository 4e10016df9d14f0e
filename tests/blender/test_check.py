"""The check: every problem in a sentence, its culprits selected one problem at a time, and a cure at hand."""


def crossed_scene():
    import json

    import bpy
    from cloths import add_cloth, addon

    scene = bpy.context.scene
    scene.frame_end = 40
    obj = add_cloth(columns=9, rows=9, end=40, thickness=0.01)
    out = {}

    def check():
        bpy.context.view_layer.objects.active = obj
        bpy.ops.object.select_all(action="DESELECT")
        bpy.ops.boucle.check()
        return json.loads(obj.boucle.problems or "[]")

    def selected():
        bpy.ops.object.mode_set(mode="OBJECT")
        return [vertex.index for vertex in obj.data.vertices if vertex.select]

    def drawn_by(name):
        from test_settings import Layout

        drawn = []

        class Panel:
            layout = Layout(drawn)

        getattr(bpy.types, name).draw(Panel(), bpy.context)
        return drawn

    out["drawn before"] = drawn_by("BOUCLE_PT_problems")
    out["clean"] = check()
    out["drawn clean"] = drawn_by("BOUCLE_PT_problems")

    # A flap of the sheet, folded through the rest of it.
    obj.data.vertices[0].co = (0.05, 0.3, 0.1)
    obj.data.vertices[1].co = (0.3, -0.3, 0.05)
    scene.frame_set(20)
    out["folded"] = check()
    out["frame"] = scene.frame_current
    bpy.ops.boucle.select_problem(number=0)
    out["mode"] = obj.mode
    out["culprits"] = selected()
    scene.frame_set(1)
    bpy.ops.ed.undo_push()
    out["kept"] = bool(obj.boucle.problems)

    # Setup: scale, units, support, frames, users, thickness.
    obj.scale = (1.0, 1.0, 1.5)
    obj.vertex_groups["Pin"].remove(list(range(81)))
    scene.unit_settings.scale_length = 0.01
    obj.boucle.thickness = 0.2
    obj.boucle.frame_end = 30
    other = bpy.data.objects.new("Twin", obj.data)
    obj.modifiers.new("Decimate", "DECIMATE")
    bpy.context.view_layer.update()
    out["setup"] = check()
    out["drawn"] = drawn_by("BOUCLE_PT_problems")
    bpy.data.objects.remove(other)
    try:
        bpy.ops.boucle.select_problem(number=99)
    except RuntimeError as error:
        out["beyond"] = str(error)
    out["clear"] = addon("bridge.findings").forget() or obj.boucle.problems
    return out


def test_the_check_finds_each_problem_and_selects_its_culprits_alone(blender):
    found = blender.run(crossed_scene)
    assert found["clean"] == []
    folded = found["folded"]
    assert [row["severity"] for row in folded] == ["WARNING"], folded
    assert "passes through itself at the start frame" in folded[0]["sentence"]
    assert found["frame"] == 20
    assert found["mode"] == "EDIT"
    assert {0, 1} <= set(found["culprits"]) and len(found["culprits"]) < 40
    assert found["kept"]
    text = " ".join(row["sentence"] for row in found["setup"])
    for words in (
        "Unit Scale of the scene is 0.01",
        "its scale is uneven (1, 1, 1.5)",
        'no vertex is in the Pin Group "Pin" and no object with Collision physics is below',
        "stops at frame 30 and the scene plays to 40",
        "shares its mesh",
        'the modifier "Decimate" below',
        "Thickness is 0.2 m, more than half of the edges at",
    ):
        assert words in text, (words, text)
    assert [row["severity"] for row in found["setup"]] == sorted(
        (row["severity"] for row in found["setup"]), key=["ERROR", "WARNING", "HINT"].index
    )
    assert "check again" in found["beyond"]
    assert found["clear"] == ""
    assert found["drawn before"] == ["Not checked yet"]
    assert found["drawn clean"] == ["No problems found"]
    selecting = [row for row in found["setup"] if row["selects"]]
    assert found["drawn"].count("boucle.select_problem") == len(selecting) > 0
    assert len(found["drawn"]) > len(found["setup"])


def fall_through():
    import json

    import bpy
    from cloths import add_cloth, play, world_positions

    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, location=(0.0, 0.1, -0.2))
    ball = bpy.context.object
    bpy.ops.mesh.primitive_cube_add(location=(0.0, 8.0, 0.0))
    bpy.ops.mesh.primitive_cube_add(size=0.2, location=(0.0, 0.5, 0.0))
    near = bpy.context.object.name
    obj = add_cloth(columns=16, rows=12, end=250)
    bpy.context.scene.frame_end = 250
    bpy.ops.boucle.check(select=False)
    before = json.loads(obj.boucle.problems or "[]")
    bpy.ops.boucle.make_collider(object_name=before[0]["passes_through"])
    collision = ball.modifiers[-1].type, ball.collision.thickness_outer
    bpy.ops.boucle.check(select=False)
    after = json.loads(obj.boucle.problems or "[]")
    refusals = []
    for name in (obj.name, "nobody"):
        try:
            bpy.ops.boucle.make_collider(object_name=name)
        except RuntimeError as error:
            refusals.append(str(error))
    obj.data.transform(__import__("mathutils").Matrix.Translation((0.0, -1.0, 0.0)))
    obj.boucle.pin_group = ""
    ball.location = (0.0, -1.0, -1.2)
    play(1, 24)
    bpy.ops.boucle.check(select=False)
    caught = json.loads(obj.boucle.problems or "[]")
    low = min(p.z for p in world_positions(obj))
    return {
        "before": before, "near": near, "ball": ball.name, "collision": collision,
        "after": after, "refusals": refusals, "caught": caught, "low": low,
    }  # fmt: skip


def test_what_the_cloth_passes_through_is_named_and_becomes_a_collider(blender):
    found = blender.run(fall_through)
    assert [row["passes_through"] for row in found["before"]] == [found["ball"]], found["before"]
    assert found["before"][0]["severity"] == "HINT" and found["before"][0]["selects"]
    kind, thickness = found["collision"]
    assert kind == "COLLISION" and abs(thickness - 0.002) < 1e-6
    text = " ".join(row["sentence"] for row in found["after"])
    assert "passes through what it collides with at the start frame" in text
    assert "has no Collision physics" not in text
    assert all("is no other mesh object of the scene" in said for said in found["refusals"])
    assert found["caught"] == [], "it lies on the ball: nothing is crossed, and something is below"
