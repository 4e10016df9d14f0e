"""Pins as they are painted, weakened by keyframes and drivers, and moved by whatever moves the mesh."""

import pytest


def soften():
    import bpy
    from cloths import add_cloth, addon, farthest, play, shown_positions

    obj = add_cloth(end=14, pin_stiffness=200.0, pin_damping=3.0, damping=0.05)
    rest = shown_positions(obj)
    top = list(range(40, 48))

    def height():
        shown = shown_positions(obj)
        return sum(shown[3 * pin + 2] - rest[3 * pin + 2] for pin in top) / len(top)

    def heights(last):
        out = []
        for frame in range(1, last + 1):
            bpy.context.scene.frame_set(frame)
            out.append(height())
        return out

    def compare():
        """How far the bake is from what was played last."""
        played = shown_positions(obj)
        bpy.ops.boucle.bake()
        bpy.context.scene.frame_set(14)
        off = farthest(shown_positions(obj), played)
        bpy.ops.boucle.free_bake()
        return off

    out = {"hard": heights(14)}
    obj.vertex_groups["Pin"].add(top, 0.5, "REPLACE")
    obj.boucle.pin_stiffness = 400.0
    play(1, 14)
    out["check"] = bpy.ops.boucle.check() and obj.boucle.status
    out["soft"] = [height(), compare()]
    obj.vertex_groups["Pin"].add(top, 0.9995, "REPLACE")
    bpy.ops.boucle.reset()
    out["nearly"] = heights(3)
    settings = obj.boucle
    for frame, value in ((1, 1.0), (6, 1.0), (7, 0.0)):
        settings.pin_strength = value
        settings.keyframe_insert("pin_strength", frame=frame)
    bpy.ops.boucle.reset()
    out["keyed"] = [*heights(14), compare()]
    bpy.ops.boucle.bake()
    out["outdated"] = addon("bridge.cache").drift_of(obj, bpy.context.scene, in_full=True)
    bpy.ops.boucle.free_bake()
    obj.animation_data_clear()
    settings.pin_strength = 1.0
    driver = settings.driver_add("pin_strength").driver
    driver.expression = "1.0 if frame < 5 else 0.4"
    settings.keyframe_insert("pin_stiffness", frame=1)
    settings.pin_stiffness = 4000.0
    settings.keyframe_insert("pin_stiffness", frame=10)
    bpy.ops.boucle.reset()
    out["driven"] = [*heights(14), compare()]
    obj.animation_data_clear()
    settings.pin_strength, settings.pin_stiffness = 1.0, 1000.0
    bpy.ops.boucle.bake()
    settings.pin_strength, settings.pin_stiffness = 0.5, 900.0
    out["changed"] = addon("bridge.cache").drift_of(obj, bpy.context.scene, in_full=False)
    return out


def test_painted_weights_are_springs_that_keyframes_and_drivers_weaken(blender):
    out = blender.run(soften)
    assert max(map(abs, out["hard"])) < 1e-6
    sag, off = out["soft"]
    # 0.4 kg on half of 400 N/m: 20 mm, after half a second of settling.
    assert sag == pytest.approx(-0.4 * 9.81 / 200.0, rel=0.25) and off < 1e-6
    assert "not supported" not in out["check"]
    assert max(map(abs, out["nearly"])) < 1e-6, "0.999 is firm, as in Blender"
    keyed = out["keyed"]
    assert max(map(abs, keyed[:6])) < 1e-6 and keyed[-1] < 1e-6
    assert keyed[6] < -1e-4 and keyed[13] < -0.3, "let go at frame 7"
    assert out["outdated"] == []
    driven = out["driven"]
    assert max(map(abs, driven[:4])) < 1e-6 and driven[4] < -1e-4 and driven[-1] < 1e-6
    assert driven[13] == pytest.approx(-0.4 * 9.81 / (0.4 * 4000.0), rel=0.3), "stiffer by frame 10"
    assert sorted(out["changed"]) == ["pin stiffness", "pin strength"]


def move_by_nodes_and_parent():
    import bpy
    from cloths import add_cloth, pinned_vertices, play, world_positions

    obj = add_cloth()
    tree = bpy.data.node_groups.new("Move", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    first, last = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    move, time = (
        tree.nodes.new("GeometryNodeSetPosition"),
        tree.nodes.new("GeometryNodeInputSceneTime"),
    )
    combine = tree.nodes.new("ShaderNodeCombineXYZ")
    scale = tree.nodes.new("ShaderNodeMath")
    scale.operation = "MULTIPLY_ADD"
    scale.inputs[1].default_value, scale.inputs[2].default_value = 0.02, -0.02
    for one, other in (
        (first.outputs[0], move.inputs["Geometry"]), (move.outputs[0], last.inputs[0]),
        (time.outputs["Frame"], scale.inputs[0]), (scale.outputs[0], combine.inputs["Y"]),
        (combine.outputs[0], move.inputs["Offset"]),
    ):  # fmt: skip
        tree.links.new(one, other)
    obj.modifiers.new("Move", "NODES").node_group = tree
    obj.modifiers.move(len(obj.modifiers) - 1, 0)
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    obj.parent = parent
    for frame, x in ((1, 0.0), (11, 0.5)):
        parent.location.x = x
        parent.keyframe_insert("location", frame=frame)
    play(1, 1)
    begin = world_positions(obj)
    play(2, 11)
    end = world_positions(obj)
    return [list(end[pin] - begin[pin]) for pin in pinned_vertices(obj)]


def test_pins_follow_geometry_nodes_and_a_parent_together(blender):
    for moved in blender.run(move_by_nodes_and_parent):
        assert moved == pytest.approx([0.5, 0.2, 0.0], abs=1e-5)
