"""Copy from Cloth Modifier: the numbers, what is lost, and that the cloth then hangs as Blender's does."""

import pytest


def copy_everything():
    import bpy
    from cloths import refusal_of

    bpy.ops.mesh.primitive_grid_add(x_subdivisions=20, y_subdivisions=20, size=1.0)
    obj = bpy.context.object
    obj.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    none = refusal_of(bpy.ops.boucle.copy_from_cloth)
    obj.vertex_groups.new(name="Held")
    obj.vertex_groups.new(name="Free")
    armature = obj.modifiers.new("Smooth", "SMOOTH")
    modifier = obj.modifiers.new("Cloth", "CLOTH")
    obj.modifiers.new("Subdivision", "SUBSURF")
    settings, contact = modifier.settings, modifier.collision_settings
    settings.vertex_group_mass = "Held"
    settings.quality = 12
    settings.time_scale = 0.5
    settings.compression_stiffness = 3.0
    settings.use_internal_springs = True
    settings.vertex_group_bending = "Free"
    contact.use_self_collision = True
    contact.self_distance_min = 0.02
    contact.self_friction = 20.0
    contact.vertex_group_self_collisions = "Free"
    contact.collection = bpy.data.collections.new("Ground")
    settings.effector_weights.gravity = 0.5
    settings.effector_weights.wind = -2.0
    settings.effector_weights.boid = 0.0
    modifier.point_cache.frame_start, modifier.point_cache.frame_end = 5, 77
    settings.keyframe_insert("mass", frame=1)
    reports = []
    kind = bpy.types.BOUCLE_OT_copy_from_cloth
    module = __import__(kind.__module__, fromlist=["copy_from_cloth"])
    real = module.copy_from_cloth.copy
    module.copy_from_cloth.copy = lambda one: reports.append(real(one)) or reports[-1]
    done = bpy.ops.boucle.copy_from_cloth()
    cloth = obj.boucle
    names = (
        "enabled", "mass_mode", "density", "stretch", "shear", "bend", "stiffness_from",
        "damping_per_kind", "damping_stretch", "damping_law", "air_damping", "quality", "speed", "pin_group",
        "object_collision", "self_collision", "self_collision_group", "thickness", "friction",
        "frame_start", "frame_end",
    )  # fmt: skip
    return {
        "none": none,
        "done": list(done),
        "values": {name: getattr(cloth, name) for name in names},
        "weights": [cloth.field_weights.gravity, cloth.field_weights.wind, cloth.field_weights.all],
        "collection": cloth.collision_collection.name,
        "off": [modifier.show_viewport, modifier.show_render],
        "stack": [m.type for m in obj.modifiers],
        "smooth": armature.show_viewport,
        "report": reports[0],
    }


def test_the_settings_come_over_with_their_numbers_and_what_is_lost_is_said(blender):
    result = blender.run(copy_everything)
    assert "no Cloth modifier" in result["none"]
    assert result["done"] == ["FINISHED"]
    expected = {
        "enabled": True, "mass_mode": "density", "density": 0.3 * 441 / 4.0, "stretch": 150_000.0,
        "shear": 50_000.0, "bend": 179.75, "stiffness_from": "springs", "damping_per_kind": True,
        "damping_stretch": 158.11, "damping_law": "axial", "air_damping": 0.31623, "quality": "final", "speed": 0.5,
        "pin_group": "Held", "object_collision": True, "self_collision": True,
        "self_collision_group": "Free", "thickness": 0.01, "friction": 0.2, "frame_start": 5,
        "frame_end": 77,
    }  # fmt: skip
    for name, value in expected.items():
        found = result["values"][name]
        assert found == (pytest.approx(value, rel=1e-3) if isinstance(value, float) else value), (
            name
        )
    assert result["collection"] == "Ground"
    assert result["weights"] == [0.5, 0.0, 1.0]
    assert result["off"] == [False, False] and result["smooth"]
    assert result["stack"] == ["SMOOTH", "CLOTH", "NODES", "MESH_CACHE", "SUBSURF"]
    said, is_whole = result["report"]
    assert "441 vertices of 0.3 kg on 4 m² are 33.1 kg/m²" in said and not is_whole
    lost = said.partition("Not carried over: ")[2].split(", ")
    assert {
        "Compression",
        "Internal Springs",
        "Bending Group",
        "its animation",
        "Field Weight Wind",
        "Field Weight Boid",
    } <= set(lost)
    assert not {
        "Pressure",
        "Field Weight Gravity",
        "Field Weight Drag",
        "Fluid Density",
        "Impulse Clamping",
    } & set(lost)


def hang_both():
    import bpy

    step, count = 0.1, 10
    verts = [(c * step, 0.0, -r * step) for r in range(count + 1) for c in range(2)]
    faces = [(2 * r, 2 * r + 1, 2 * r + 3, 2 * r + 2) for r in range(count)]
    mesh = bpy.data.meshes.new("strip")
    mesh.from_pydata(verts, [], faces)
    obj = bpy.data.objects.new("strip", mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.vertex_groups.new(name="Pin").add([0, 1], 1.0, "REPLACE")
    modifier = obj.modifiers.new("Cloth", "CLOTH")
    modifier.settings.vertex_group_mass = "Pin"
    modifier.settings.shear_stiffness = modifier.settings.bending_stiffness = 0.0
    modifier.settings.tension_stiffness = modifier.settings.compression_stiffness = 2.0
    modifier.settings.air_damping = 5.0

    def lowest():
        for frame in range(1, 121):
            bpy.context.scene.frame_set(frame)
        evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
        return [vertex.co.z for vertex in evaluated.data.vertices][2::2]

    theirs = lowest()
    bpy.ops.boucle.copy_from_cloth()
    obj.boucle.mass_mode = "vertex"  # by area the top row, which is held, weighs half as much
    return [theirs, lowest(), obj.boucle.status]


def test_a_strip_hangs_as_far_as_under_blender_s_cloth(blender):
    theirs, ours, status = blender.run(hang_both)
    assert status.startswith("Live: frames 1 to 120")
    stretched = [-0.1 * (row + 1) - z for row, z in enumerate(theirs)]
    assert stretched[-1] > 0.005, "long enough to tell"
    for row, (one, other) in enumerate(zip(theirs, ours, strict=True)):
        assert other == pytest.approx(one, abs=0.01 * stretched[row]), row
