"""Presets in Blender: applied, saved, deleted, and in the menu that adds a cloth."""

import os
import re

import boucle_core


def use_presets():
    import bpy
    from cloths import add_cloth, addon, mesh_positions, play, refusal_of

    presets = addon("bridge.presets")
    ops = bpy.ops.boucle
    out = {"shipped": presets.shipped(), "moves": [], "descriptions": []}
    obj = add_cloth(columns=6, rows=5)
    rest = mesh_positions(obj)
    for name, _, _ in out["shipped"]:
        ops.apply_preset(preset=name)
        out["descriptions"].append(presets.description(name))
        for model in ("springs", "fabric"):
            obj.boucle.model = model
            play(1, 3)
            out["moves"].append([obj.boucle.status[:20], mesh_positions(obj) != rest])
            ops.reset()
    obj.boucle.density, obj.boucle.substeps, obj.boucle.limiter = 0.3, 7, "provot"
    obj.boucle.pin_group = "Pin"
    ops.save_preset(preset="Été 1")
    path = os.path.join(presets._own_folder(), "Été 1.toml")
    with open(path, encoding="utf-8") as file:
        out["text"] = file.read()
    package = os.path.dirname(addon("native").__file__)
    out["inside"] = os.path.realpath(path).startswith(os.path.realpath(package))
    before = addon("bridge.settings").values(obj)
    for key, setting in presets.schema(obj).items():  # something else everywhere
        if setting.kind == "BOOLEAN":
            other = not before[key]
        elif setting.kind == "ENUM":
            other = next(choice for choice in setting.choices if choice != before[key])
        else:
            other = {"INT": int, "FLOAT": float}[setting.kind](setting.maximum)
        setattr(obj.boucle, key, other)
    group = obj.boucle.pin_group = ""
    ops.apply_preset(preset="Été 1")
    after = addon("bridge.settings").values(obj)
    out["back"] = sorted(key for key in before if before[key] != after[key]), group
    out["own"] = obj.boucle.own_presets
    out["refused"] = [
        refusal_of(ops.save_preset, preset="été 1"),
        refusal_of(ops.save_preset, preset="Linen"),
        refusal_of(ops.save_preset, preset="cotton_Poplin"),
        refusal_of(ops.save_preset, preset=" "),
        refusal_of(ops.delete_preset, preset="denim"),
        refusal_of(ops.delete_preset, preset="../denim"),
        refusal_of(ops.apply_preset, preset="Moleskin"),
    ]
    with open(os.path.join(presets._own_folder(), "Bad.toml"), "w") as file:
        file.write('[settings]\nstretch = 5.0\nlimiter = "elastic"\n')
    stretch = obj.boucle.stretch
    out["refused"].append(refusal_of(ops.apply_preset, preset="Bad"))
    out["nothing"] = obj.boucle.stretch == stretch
    ops.add_cloth(vertices_x=4, vertices_y=4, preset="denim")
    out["added"] = [
        round(bpy.context.object.boucle.density, 4),
        bpy.context.object.boucle.pin_group,
    ]
    ops.add_cloth(vertices_x=4, vertices_y=4, preset="Été 1")
    out["added"].append(bpy.context.object.boucle.substeps)
    ops.add_cloth(vertices_x=4, vertices_y=4)
    out["added"].append(round(bpy.context.object.boucle.density, 4))
    ops.delete_preset(preset="Été 1")
    out["left"] = presets.own_names()
    bpy.context.object.boucle.enabled = False
    kind = bpy.types.BOUCLE_OT_apply_preset
    button = type("Button", (), {"preset": "silk_habotai"})
    out["tip"] = kind.description(bpy.context, button)
    out["poll"] = ops.apply_preset.poll()
    return out


def test_presets_are_applied_saved_with_all_their_settings_and_deleted(blender):
    result = blender.run(use_presets)
    names = [name for name, _, _ in result["shipped"]]
    assert len(names) == 38 and {"denim", "rubber_sheet", "linen"} <= set(names)
    groups = [group for _, group, _ in result["shipped"]]
    assert groups == sorted(groups) and 4 < len(set(groups)) < 12
    titles = [title for _, _, title in result["shipped"]]
    assert len(set(titles)) == len(titles)
    assert all(re.match(r"[\d.]+ g/m², [\d.]+ mm thick; ", said) for said in result["descriptions"])
    assert all(moves and status.startswith("Live") for status, moves in result["moves"])
    assert "density = 0.3\n" in result["text"] and 'limiter = "provot"' in result["text"]
    assert "pin_group" not in result["text"] and "frame_start" not in result["text"]
    assert not result["inside"], "the extension's own folder is emptied by an update"
    assert result["back"] == [["pin_group", "preset", "preset_digest"], ""]
    assert result["own"] == "Été 1"
    for said, words in zip(
        result["refused"],
        (
            "delete that one first", "choose another", "choose another", "has no name",
            "ships with Boucle", "is not there", "known are cotton_canvas", 'limiter is "elastic", but accepted is one of none',
        ),
        strict=True,
    ):  # fmt: skip
        assert words in said
    assert result["nothing"], "a preset with a mistake sets nothing"
    denim = boucle_core.fabric_presets()["denim"]
    assert result["added"] == [denim["density"], "Pin", 7, 0.2]
    assert result["tip"].startswith("35 g/m², ")
    assert result["left"] == ["Bad"] and not result["poll"]


def give_a_fabric():
    import bpy
    from cloths import add_cloth, addon

    ops, native = bpy.ops.boucle, addon("native")
    settings = add_cloth(columns=9, rows=5).boucle
    names = (*addon("core.fabric_preset").SETTINGS, "thickness")

    def told():
        plain = addon("core.scene_json").decimal
        values = {name: getattr(settings, name) for name in names}
        return {k: plain(v) if isinstance(v, float) else v for k, v in values.items()}

    labels = [[settings.preset_title, settings.is_preset_changed]]
    ops.apply_preset(preset="denim")
    out = {
        "denim": told(),
        "springs": native.fabric_springs("denim", 0.25),
        "model": settings.model,
        "tears": [settings.use_tear, settings.tear_force, settings.tear_strain],
    }
    labels.append([settings.preset_title, settings.is_preset_changed])
    settings.shear = 1.0
    labels.append([settings.preset_title, settings.is_preset_changed])
    ops.apply_preset(preset="linen")
    labels.append([settings.preset_title, settings.is_preset_changed])
    out["followed"] = settings.thickness
    settings.thickness = 0.003
    ops.apply_preset(preset="felt")
    out["own"] = settings.thickness
    settings.model, settings.damping_ratio_stretch = "fabric", 0.07
    settings.damping_ratio_per_kind = settings.use_compression = True
    settings.compression_warp = 77.0
    ops.save_preset(preset="Mine")
    ops.apply_preset(preset="denim")
    settings.model = "springs"
    ops.apply_preset(preset="Mine")
    labels.append([settings.preset_title, settings.is_preset_changed])
    out["mine"] = [
        settings.model,
        settings.compression_warp,
        round(settings.damping_ratio_stretch, 4),
    ]
    out["mine"] += [settings.use_compression, round(settings.friction, 4)]
    settings.bend_warp_micro = 12.5
    out["micro"] = [settings.bend_warp, settings.bend_weft_micro]
    out["labels"] = labels
    return out


def test_a_fabric_sets_both_models_and_the_thickness_that_nobody_chose(blender):
    result = blender.run(give_a_fabric)
    presets = boucle_core.fabric_presets()
    denim = presets["denim"]
    told, springs = result["denim"], result["springs"]
    shared = set(denim) & set(told) - {"thickness"}
    assert len(shared) == 12 and all(told[name] == denim[name] for name in shared)
    assert told["use_compression"], "yarns buckle"
    assert told["thickness"] == 0.5 * denim["thickness"]
    for name in ("stretch", "bend", "damping_stretch", "damping_bend"):
        assert abs(told[name] / springs[name] - 1.0) < 5e-5, name
    assert told["damping_law"] == "axial" and told["stiffness_from"] == "continuum"
    assert told["damping_per_kind"] and not told["damping_ratio_per_kind"]
    assert result["model"] == "springs", "the model is the user's"
    assert result["tears"] == [False, 0.0, 0.0], "a fabric says at which stress, not whether"
    assert abs(result["followed"] / (0.5 * presets["linen"]["thickness"]) - 1.0) < 1e-6
    assert abs(result["own"] / 0.003 - 1.0) < 1e-6, "a thickness that was chosen stays"
    assert result["mine"] == ["fabric", 77.0, 0.07, True, presets["felt"]["friction"]]
    assert abs(result["micro"][0] / 12.5e-6 - 1.0) < 1e-6
    assert abs(result["micro"][1] / (1e6 * presets["felt"]["bend_weft"]) - 1.0) < 1e-5
    assert result["labels"] == [
        ["", False], ["Denim", False], ["Denim", True], ["Linen", False], ["Mine", False]
    ]  # fmt: skip


def give_a_fabric_to_odd_meshes():
    import bpy
    from cloths import add_cloth, addon, refusal_of

    native = addon("native")
    wanted = native.fabric_springs("denim", 0.125)["bend"]
    obj = add_cloth(columns=9, rows=5)  # edges of 0.25 m
    obj.scale = (0.5, 0.5, 0.5)
    bpy.context.view_layer.update()
    bpy.ops.boucle.apply_preset(preset="denim")
    out = [obj.boucle.bend / wanted]
    # A seam is no edge of the cloth, and the lengths at rest are those of the rest shape key.
    obj = add_cloth(columns=9, rows=5)
    obj.data.edges.add(1)
    obj.data.edges[-1].vertices = (0, 44)
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Half")
    for point in key.data:
        point.co *= 0.5
    obj.boucle.rest_shape_key = "Half"
    bpy.ops.boucle.apply_preset(preset="denim")
    out.append(obj.boucle.bend / wanted)
    bpy.context.collection.objects.link(
        empty := bpy.data.objects.new("E", bpy.data.meshes.new("E"))
    )
    bpy.context.view_layer.objects.active = empty
    bpy.ops.boucle.enable()
    out.append(refusal_of(bpy.ops.boucle.apply_preset, preset="denim"))
    return out


def test_a_fabric_is_made_springs_on_the_edges_that_the_cloth_has_at_rest(blender):
    scaled, keyed, refused = blender.run(give_a_fabric_to_odd_meshes)
    assert abs(scaled - 1.0) < 1e-3 and abs(keyed - 1.0) < 1e-3
    assert '"E" has edges of 0 m' in refused
