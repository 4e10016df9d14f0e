"""Presets in Blender: applied, saved, deleted, and in the menu that adds a cloth."""

import os


def use_presets():
    import bpy
    from cloths import add_cloth, addon, mesh_positions, play, refusal_of

    presets = addon("bridge.presets")
    ops = bpy.ops.boucle
    out = {"shipped": presets.shipped_names(), "moves": [], "descriptions": []}
    obj = add_cloth()
    rest = mesh_positions(obj)
    for name in out["shipped"]:
        ops.apply_preset(preset=name)
        out["descriptions"].append(presets.description(name))
        play(1, 6)
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
    out["back"] = {key for key in before if before[key] != after[key]} == {
        "pin_group"
    } and not group
    out["own"] = obj.boucle.own_presets
    out["refused"] = [
        refusal_of(ops.save_preset, preset="été 1"),
        refusal_of(ops.save_preset, preset="cotton"),
        refusal_of(ops.save_preset, preset=" "),
        refusal_of(ops.delete_preset, preset="Cotton"),
        refusal_of(ops.delete_preset, preset="../Cotton"),
        refusal_of(ops.apply_preset, preset="Velvet"),
    ]
    with open(os.path.join(presets._own_folder(), "Bad.toml"), "w") as file:
        file.write('[settings]\nstretch = 5.0\nlimiter = "elastic"\n')
    stretch = obj.boucle.stretch
    out["refused"].append(refusal_of(ops.apply_preset, preset="Bad"))
    out["nothing"] = obj.boucle.stretch == stretch
    ops.add_cloth(vertices_x=4, vertices_y=4, preset="Denim")
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
    button = type("Button", (), {"preset": "Silk"})
    out["tip"] = kind.description(bpy.context, button)
    out["poll"] = ops.apply_preset.poll()
    return out


def test_presets_are_applied_saved_with_all_their_settings_and_deleted(blender):
    result = blender.run(use_presets)
    assert result["shipped"] == ["Cotton", "Denim", "Leather", "Rubber", "Silk"]
    assert all(result["descriptions"])
    assert all(moves and status.startswith("Live") for status, moves in result["moves"])
    assert "density = 0.3\n" in result["text"] and 'limiter = "provot"' in result["text"]
    assert "pin_group" not in result["text"] and "frame_start" not in result["text"]
    assert not result["inside"], "the extension's own folder is emptied by an update"
    assert result["back"] and result["own"] == "Été 1"
    for said, words in zip(
        result["refused"],
        (
            "delete that one first", "choose another", "has no name", "ships with Boucle",
            "is not there", 'known are "Cotton"', 'limiter is "elastic", but accepted is one of none',
        ),
        strict=True,
    ):  # fmt: skip
        assert words in said
    assert result["nothing"], "a preset with a mistake sets nothing"
    assert result["added"] == [0.41, "Pin", 7, 0.2]
    assert result["tip"].startswith("Light silk")
    assert result["left"] == ["Bad"] and not result["poll"]
