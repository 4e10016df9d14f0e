"""What the panel tells of a frame: its certificate, edges that are too long, the strain attribute."""

import json
import re
import shutil


def certificates():
    import bpy
    from cloths import add_cloth, addon, play

    obj = add_cloth(end=8)
    settings, scene = obj.boucle, bpy.context.scene
    out = {"before": settings.certificate}
    play(1, 5)
    live = addon("bridge.live")
    out["rows"] = [dict(live.session_of(obj).frames.certificate(frame)) for frame in range(1, 6)]
    lines = []
    for frame in range(6):
        scene.frame_set(frame)
        lines.append(settings.certificate)
    scene.frame_set(12)
    out["lines"], out["beyond"] = lines, settings.certificate
    scene.frame_set(3)
    settings.stretch = 400.0
    out["changed"] = settings.certificate
    play(1, 3)
    out["again"] = settings.certificate
    bpy.ops.boucle.reset()
    out["reset"] = settings.certificate
    scene.frame_set(4)
    bpy.ops.boucle.bake()
    out["baked"] = settings.certificate
    settings.stretch = 500.0
    scene.frame_set(6)
    out["first bake"] = settings.certificate
    bpy.ops.boucle.bake()
    out["second bake"] = settings.certificate
    bpy.ops.boucle.restore_bake()
    out["restored"] = settings.certificate
    bpy.ops.boucle.free_bake()
    out["freed"] = [settings.certificate, settings.warning]
    settings.integrator = "symplectic_euler"
    play(1, 2)
    out["explicit"] = settings.certificate
    return out


def test_the_certificate_of_the_present_frame_is_told_and_never_a_stale_one(blender):
    out = blender.run(certificates)
    assert out["before"] == out["beyond"] == out["changed"] == out["reset"] == ""
    assert out["freed"] == ["", ""]
    before, *lines = out["lines"]
    assert before == "" and len(lines) == 5
    pattern = (
        r"Frame (\d+): stretch ([\d.]+) % \(99 % of edges below ([\d.]+) %\), (?:(\d+) iterations, )?"
        r"(\d+) substeps, no intersections, energy -?[\d.e-]+ J, hash ([0-9a-f]{8})…"
    )
    for line, row in zip(lines, out["rows"], strict=True):
        found = re.fullmatch(pattern, line)
        assert found, line
        assert int(found[1]) == row["frame"] and int(found[5]) == row["substeps"]
        assert abs(float(found[2]) - 100 * row["max_strain"]) <= 0.051
        assert int(found[4] or 0) == row["iterations"]
        assert row["hash"].startswith(found[6])
    assert all(row["iterations"] > 0 for row in out["rows"][1:])
    assert out["again"].startswith("Frame 3: ") and out["again"] != lines[2]
    assert out["baked"].startswith("Frame 4: ") and out["baked"] != lines[3]
    assert out["first bake"].startswith("Frame 6: ")
    assert out["second bake"] != out["first bake"] == out["restored"]
    assert "iteration" not in out["explicit"] and out["explicit"].startswith("Frame 2: ")


def pull_pins_apart(folder):
    import bpy
    from cloths import add_cloth, pinned_vertices, play

    obj = add_cloth(columns=6, rows=5, end=6)
    obj.shape_key_add()
    key = obj.shape_key_add()
    for pin in pinned_vertices(obj):
        key.data[pin].co.x *= 1.5
    for frame, value in ((1, 0.0), (4, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    warnings = []
    for frame in range(1, 7):
        play(frame, frame)
        warnings.append(obj.boucle.warning)
    bpy.context.scene.frame_set(1)
    warnings.append(obj.boucle.warning)
    bpy.context.scene.frame_set(6)
    live = obj.boucle.warning
    bpy.ops.wm.save_as_mainfile(filepath=f"{folder}/shot.blend")
    bpy.ops.boucle.bake()
    baked = obj.boucle.warning
    report = bpy.path.abspath(obj.modifiers["Boucle Cache"].filepath)[:-4] + ".json"
    with open(report) as file:
        rows = json.load(file)["frames"]
    bpy.ops.boucle.free_bake()
    return [warnings, live, baked, rows, obj.boucle.warning, pinned_vertices(obj)]


def test_edges_that_pins_pull_too_far_are_counted_and_the_worst_is_named(blender):
    warnings, live, baked, rows, freed, pins = blender.run(pull_pins_apart, folder=blender.folder)
    assert warnings[0] == warnings[6] == freed == ""
    found = re.match(
        r"(\d+) edges exceed the deformation rate: the worst stretches ([\d.]+) %, "
        r"from vertex (\d+) to (\d+); pins",
        warnings[5],
    )
    assert found, warnings
    assert live == baked == warnings[5]
    row = rows[5]
    assert int(found[1]) == row["overstretched_count"] >= 5
    assert float(found[2]) >= 49.9
    worst = row["overstretched"]
    assert 1 <= len(worst) <= 8 and worst[0]["cloth"] == "Cloth"
    assert [int(found[3]), int(found[4])] == worst[0]["vertices"]
    assert set(worst[0]["vertices"]) <= set(pins)
    assert abs(worst[0]["strain"] - row["max_strain"]) < 1e-9
    assert "overstretched" not in rows[0]


def strain_of(obj):
    """The attribute of what Blender shows; None without one."""
    from array import array

    import bpy

    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    attribute = evaluated.data.attributes.get("boucle_strain")
    if attribute is None:
        return None
    assert (attribute.domain, attribute.data_type) == ("POINT", "FLOAT")
    out = array("f", bytes(4 * len(attribute.data)))
    attribute.data.foreach_get("value", out)
    return out.tolist()


def strains(folder, display):
    from array import array

    import bpy
    from cloths import add_cloth, addon, play

    obj = add_cloth(end=6)
    settings, scene = obj.boucle, bpy.context.scene
    if display == "file":
        obj.shape_key_add()
    live = addon("bridge.live")
    out = {}
    play(1, 2)
    out["off"] = strain_of(obj)
    settings.use_strain = True
    out["unknown"] = strain_of(obj)
    bpy.ops.boucle.reset()
    solver, shown = [], []
    for frame in range(1, 7):
        play(frame, frame)
        values = array("f", bytes(4 * len(obj.data.vertices)))
        live.session_of(obj).solver.read_strain(0, values)
        solver.append(values.tolist())
        shown.append(strain_of(obj))
    out["live"] = [solver == shown, max(shown[5]) > 1e-4, max(map(abs, shown[0])) < 1e-6]
    scene.frame_set(3)
    out["scrubbed"] = strain_of(obj) == solver[2]
    path = f"{folder}/{display}.blend"
    bpy.ops.wm.save_as_mainfile(filepath=path)
    out["saved"] = strain_of(obj) == solver[2]
    copy = shutil.copy(
        path, f"{folder}/copy.blend"
    )  # Blender reads no data from the file that is open
    with bpy.data.libraries.load(copy) as (inside, there):
        there.meshes = list(inside.meshes)
    out["in the file"] = "boucle_strain" in there.meshes[0].attributes
    settings.use_strain = False
    out["switched off"] = strain_of(obj)
    settings.use_strain = True
    out["switched on"] = strain_of(obj) == solver[2]
    bpy.ops.boucle.reset()
    out["reset"] = strain_of(obj)
    bpy.ops.boucle.bake()
    out["after the bake"] = strain_of(obj) == solver[2]
    baked = []
    for frame in range(9):
        scene.frame_set(frame)
        baked.append(strain_of(obj))
    out["baked"] = baked == [solver[0], *solver, solver[5], solver[5]]
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.data.objects["Cloth"]
    bpy.context.view_layer.objects.active = obj
    out["loaded"] = strain_of(obj) == solver[5]
    bpy.context.scene.frame_set(2)
    obj.boucle.use_strain = False
    bpy.ops.boucle.bake()
    out["baked without"] = strain_of(obj)
    bpy.ops.boucle.restore_bake()
    obj.boucle.use_strain = True
    out["restored"] = strain_of(obj) == solver[1]
    bpy.ops.boucle.free_bake()
    out["freed"] = strain_of(obj)
    return out


def check_strains(out):
    assert out.pop("live") == [True, True, True]
    for name in ("off", "unknown", "switched off", "reset", "baked without", "freed"):
        assert out.pop(name) is None, name
    assert out.pop("in the file") is False
    assert all(out.values()), out


def test_the_strain_attribute_has_the_solvers_values_live_and_baked(blender):
    check_strains(blender.run(strains, folder=blender.folder, display="mesh"))


def test_the_strain_attribute_works_where_frames_are_shown_from_a_file(blender):
    check_strains(blender.run(strains, folder=blender.folder, display="file"))


def strain_of_others():
    import bpy
    from cloths import add_cloth, play

    obj = add_cloth(end=6, use_strain=True)
    other = bpy.data.objects.new("Twin", obj.data)
    bpy.context.scene.collection.objects.link(other)
    play(1, 3)
    shared = strain_of(obj)
    bpy.data.objects.remove(other)
    play(1, 3)
    own = strain_of(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.object.mode_set(mode="OBJECT")
    edited = strain_of(obj)
    play(1, 3)
    obj.boucle.enabled = False
    disabled = strain_of(obj)
    return [shared, own is not None, edited, disabled]


def test_a_shared_or_edited_mesh_and_one_that_is_no_cloth_has_no_strain_attribute(blender):
    assert blender.run(strain_of_others) == [None, True, None, None]


def describe_solver():
    import bpy
    from cloths import add_cloth, addon

    obj = add_cloth()
    settings = addon("bridge.settings")
    out = []

    def note(**values):
        for name, value in values.items():
            setattr(obj.boucle, name, value)
        described = settings.describe(obj, bpy.context.scene, with_groups=False)
        springs = described["cloth"][0]["springs"]
        out.append([described["solver"], springs["stiffness_from"], obj.boucle.safe_step])

    note()
    note(quality="draft", stiffness_from="continuum")
    note(quality="final", linear_solver="ldlt")
    note(quality="custom", tolerance=0.0125, integrator="implicit_euler")
    note(substeps=3)
    note(substeps=0, integrator="verlet")
    return out


def test_quality_presets_are_tolerances_and_only_implicit_integrators_have_them(blender):
    default, draft, final, custom, fixed, explicit = blender.run(describe_solver)
    base = {"integrator": "bdf2", "allow_unstable": False, "substeps": "auto"}
    assert default[0] == {**base, "linear_solver": "auto", "tolerance": 5e-3}
    assert default[1:] == ["springs", "Any time step is stable with this integrator"]
    assert draft[0] == {**base, "linear_solver": "auto", "tolerance": 2e-2}
    assert draft[1] == "continuum"
    assert final[0] == {**base, "linear_solver": "ldlt", "tolerance": 1e-3}
    assert custom[0]["tolerance"] == 0.0125 and custom[0]["integrator"] == "implicit_euler"
    assert fixed[0]["substeps"] == 3 and "tolerance" not in fixed[0]
    assert explicit[0] == {**base, "integrator": "verlet"}
    assert re.match(r"Safe time step: [\d.]+ ms, \d+ substeps a frame", explicit[2])
