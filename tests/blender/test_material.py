"""Fabric materials: assigned in one click, in real size, whole in every version, and they render."""

import os

FABRICS = ("weave", "denim", "satin", "knit", "boucle", "felt")


def broken_links(tree):
    """Links that Blender finds wrong, in a tree and its groups."""
    found = [link for link in tree.links if not link.is_valid]
    for node in tree.nodes:
        if node.type == "GROUP":
            found += broken_links(node.node_tree)
    return found


def dress_in_all():
    import bpy
    from cloths import add_cloth

    obj = add_cloth()
    out = {}
    for key in FABRICS:
        assert bpy.ops.boucle.add_material(fabric=key) == {"FINISHED"}
        tree = obj.active_material.node_tree
        group = next(node for node in tree.nodes if node.type == "GROUP")
        inner = group.node_tree
        sink = next(node for node in inner.nodes if node.type == "GROUP_OUTPUT")
        bump = next(node for node in inner.nodes if node.type == "BUMP")
        out[key] = {
            "slots": len(obj.material_slots),
            "broken": len(broken_links(tree)),
            "shown": tree.nodes[-1].inputs["Surface"].is_linked and sink.inputs["Shader"].is_linked,
            "height": bump.inputs["Height"].is_linked,
            "used": [s.name for s in group.inputs if not uses(inner, s.name)],
            "size": [round(group.inputs[name].default_value, 5) for name in ("Width", "Height")],
            "yarn": group.inputs["Yarn Size"].default_value,
        }
    return out


def uses(tree, name):
    """Whether a value of the group goes anywhere."""
    source = next(node for node in tree.nodes if node.type == "GROUP_INPUT")
    return source.outputs[name].is_linked


def test_every_fabric_is_whole_and_in_the_size_of_the_cloth(blender):
    for key, row in blender.run(dress_in_all).items():
        assert row["slots"] == 1 and row["broken"] == 0 and row["used"] == [], key
        assert row["shown"] and row["height"], key
        assert row["size"] == [2.0, 1.0], key
        assert 1e-4 < row["yarn"] < 1e-2, key


def dress_others():
    import bpy
    from cloths import add_cloth, play, refusal_of

    obj = add_cloth()
    obj.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    bpy.ops.boucle.add_material(fabric="boucle", color=(0.4, 0.35, 0.28), scale=2.0)
    first = obj.active_material
    group = next(node for node in first.node_tree.nodes if node.type == "GROUP")
    out = {
        "scaled": [round(group.inputs[name].default_value, 4) for name in ("Width", "Height")],
        "color": [round(value, 4) for value in group.inputs["Color"].default_value],
        "second": [round(value, 4) for value in group.inputs["Second Color"].default_value],
        "yarn": round(group.inputs["Yarn Size"].default_value, 5),
    }
    bare = add_cloth()
    bare.data.uv_layers.remove(bare.data.uv_layers[0])
    play(1, 8)  # the rest shape counts, not the frame
    bpy.ops.boucle.add_material(fabric="boucle")
    second = bare.active_material
    other = next(node for node in second.node_tree.nodes if node.type == "GROUP")
    uvs = [tuple(corner.vector) for corner in bare.data.uv_layers[0].uv]
    out["own map"] = [round(max(axis) - min(axis), 4) for axis in zip(*uvs, strict=True)]
    out["metres"] = [round(other.inputs[name].default_value, 4) for name in ("Width", "Height")]
    out["shared"] = other.node_tree == group.node_tree and first != second
    out["values kept"] = round(group.inputs["Yarn Size"].default_value, 5)
    bpy.ops.object.mode_set(mode="EDIT")
    out["edit mode"] = refusal_of(bpy.ops.boucle.add_material)
    bpy.ops.object.mode_set(mode="OBJECT")
    out["heat map"] = refusal_of(bpy.ops.boucle.add_heat_map_material)
    bare.boucle.enabled = False
    out["no cloth"] = refusal_of(bpy.ops.boucle.add_material)
    return out


def test_yarns_keep_their_size_on_scaled_cloth_and_without_a_map(new_blender):
    out = new_blender.run(dress_others)
    assert out["scaled"] == [4.0, 2.0]
    assert out["color"] == [0.4, 0.35, 0.28, 1.0]
    assert out["second"] == [0.33, 0.27, 0.2, 1.0]
    assert out["yarn"] == out["values kept"] == 0.013
    assert out["own map"] == [2.0, 1.0] and out["metres"] == [1.0, 1.0]
    assert out["shared"]
    assert "Leave Edit Mode first" in out["edit mode"]
    assert "Choose a heat map in the Overlay panel first" in out["heat map"]
    assert "is no Boucle cloth" in out["no cloth"]


def render_all(folder):
    import bpy
    from cloths import add_cloth

    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.device = 1, "CPU"
    scene.cycles.use_denoising = False
    scene.render.resolution_x = scene.render.resolution_y = 32
    bpy.ops.object.camera_add(location=(0, -4, 0), rotation=(1.5708, 0, 0))
    scene.camera = bpy.context.object
    bpy.ops.object.light_add(type="SUN", rotation=(1.2, 0.3, 0))
    bpy.context.object.data.energy = 4.0
    obj = add_cloth()
    out = {}
    for key in FABRICS:
        bpy.ops.boucle.add_material(fabric=key, scale=20.0)
        scene.render.filepath = os.path.join(folder, f"{key}.png")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        pixels = list(image.pixels)
        middle = [4 * (32 * row + column) for row in range(12, 20) for column in range(4, 28)]
        colors = [pixels[k : k + 3] for k in middle]
        out[key] = [sum(axis) / len(axis) for axis in zip(*colors, strict=True)]
        out[key].append(max(max(c) for c in colors) - min(max(c) for c in colors))
    assert obj.active_material.name.startswith("Boucle")
    return out


def test_every_fabric_renders_in_its_colours_with_relief(blender):
    shown = blender.run(render_all, folder=blender.folder)
    assert "Error" not in blender.output, blender.output
    for key, (red, green, blue, contrast) in shown.items():
        assert not (red > 0.9 and green < 0.1 and blue > 0.9), (
            f"{key} is the pink of a broken shader"
        )
        assert 0.03 < max(red, green, blue) < 0.99 and contrast > 0.02, key
    assert shown["denim"][2] > shown["denim"][0], "denim is blue"
    assert shown["satin"][0] > 2 * shown["satin"][1], "satin is red"
    assert shown["felt"][1] > shown["felt"][0], "felt is green"
