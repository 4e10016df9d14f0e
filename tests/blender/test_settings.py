"""The settings, their panels and the add-on's registration."""

import re

DESIGN_NAMES = {
    "enabled", "stretch", "shear", "bend", "damping", "damping_law", "deformation_rate", "limiter",
    "density", "mass_per_vertex", "mass_mode", "pin_group", "integrator", "substeps", "frame_start",
    "frame_end", "quality", "tolerance", "linear_solver", "stiffness_from", "use_strain",
    "self_collision", "thickness", "friction", "object_collision", "collision_collection",
    "collision_group", "self_collision_group", "show_thickness", "use_contact", "use_intersection",
    "use_tension", "model", "stretch_warp", "stretch_weft", "use_compression", "compression_warp",
    "compression_weft", "bend_warp", "bend_weft", "damping_ratio", "damping_ratio_per_kind",
    "damping_ratio_stretch", "damping_ratio_shear", "damping_ratio_bend", "warp", "warp_uv_map",
    "yield_curvature", "hardening", "bend_hysteresis",
    "use_tear", "tear_stress", "tear_force", "tear_strain", "tear_noise", "tear_seed", "tear_strength_group",
    "seam_force", "tear_opening_group", "tear_opening_frame", "use_force",
    "overlay", "overlay_range", "overlay_minimum", "overlay_maximum", "overlay_opacity",
}  # fmt: skip


def walk_settings():
    import bpy

    pointer = bpy.types.Object.bl_rna.properties["boucle"]
    rows = []
    for prop in pointer.fixed_type.properties:
        if prop.identifier in {"rna_type", "name"}:
            continue
        is_number = prop.type in {"INT", "FLOAT"}
        rows.append(
            {
                "name": prop.identifier,
                "overridable": prop.is_overridable,
                "label": prop.name,
                "description": prop.description,
                "bounded": not is_number or (prop.hard_min > -3e38 and prop.hard_max < 3e38),
            }
        )
    return {"pointer": pointer.is_overridable, "rows": rows}


def test_every_setting_is_overridable_described_and_bounded(blender):
    found = blender.run(walk_settings)
    assert found["pointer"]
    assert {row["name"] for row in found["rows"]} >= DESIGN_NAMES
    for row in found["rows"]:
        assert row["overridable"], row
        assert row["label"] and row["description"], row
        assert row["bounded"], row
    units = {
        "stretch": "(N/m)",
        "stretch_warp": "(N/m)",
        "bend_warp": "(N·m)",
        "bend_warp_micro": "(µN·m",
        "yield_curvature": "(1/m",
        "bend_hysteresis": "(N·m/m)",
        "tear_stress": "(N/m)",
        "tear_force": "(N)",
        "seam_force": "(N)",
        "damping": "(N·s/m)",
        "density": "(kg/m²)",
        "mass_per_vertex": "(kg)",
    }
    words = {row["name"]: row["description"] for row in found["rows"]}
    for name, unit in units.items():
        assert unit in words[name]


class Layout:
    """Takes the place of Blender's layout, which needs a window: it knows what was drawn and refuses wrong names."""

    def __init__(self, drawn):
        self.drawn = drawn

    def _inner(self, **_):
        return Layout(self.drawn)

    column = row = box = split = grid_flow = _inner

    def separator(self, **_):
        """A gap."""

    def menu(self, name, text="", **_):
        import bpy

        class Menu:
            layout = self

        getattr(bpy.types, name).draw(Menu(), bpy.context)
        self.drawn.append(text)

    def popover(self, panel, **_):
        import bpy

        assert hasattr(bpy.types, panel), panel
        self.drawn.append(panel)

    def prop(self, data, name, **_):
        assert name in data.bl_rna.properties, name
        getattr(data, name)
        self.drawn.append(name)

    def prop_search(self, data, name, where, items, **_):
        assert hasattr(where, items)
        self.prop(data, name)

    def operator(self, idname, **_):
        import bpy

        group, name = idname.split(".")
        kind = getattr(getattr(bpy.ops, group), name).get_rna_type()
        self.drawn.append(idname)

        class Settings:
            def __setattr__(self, key, value):
                assert key in kind.properties, key

        return Settings()

    def template_list(self, kind, _name, data, items, active, number, **_):
        import bpy

        assert hasattr(bpy.types, kind)
        for owner, name in ((data, items), (active, number)):
            assert name in owner.bl_rna.properties, name

    def operator_enum(self, idname, name, **_):
        import bpy

        group, operator = idname.split(".")
        assert name in getattr(getattr(bpy.ops, group), operator).get_rna_type().properties
        self.drawn.append(idname)

    def label(self, text="", **_):
        assert text, "an empty line"
        self.drawn.append(text)


def draw_everything():
    import bpy
    from cloths import add_cloth, addon

    obj = add_cloth()
    drawn, hidden = [], set()

    def draw_panels():
        for name in dir(bpy.types):
            if not name.startswith("BOUCLE_PT_"):
                continue
            kind = getattr(bpy.types, name)
            if not kind.poll(bpy.context):
                hidden.add(name)
                continue

            class Panel:
                layout = Layout(drawn)
                column = getattr(kind, "column", None)

            kind.draw(Panel(), bpy.context)
            if "draw_header" in vars(kind):
                kind.draw_header(Panel(), bpy.context)
            if "draw_header_preset" in vars(kind):
                kind.draw_header_preset(Panel(), bpy.context)

    draw_panels()
    bpy.context.scene.frame_set(1)
    bpy.context.scene.frame_set(2)
    for name, value in {
        "quality": "custom",
        "mass_mode": "vertex",
        "use_wind": True,
        "wind_law": "face",
        "limiter": "none",
        "overlay": "tension",
        "overlay_range": "manual",
        "tear_noise": 0.1,
        "tear_opening_group": "top",
    }.items():
        setattr(obj.boucle, name, value)
    for mode in ("substeps", "time_step", "auto"):
        obj.boucle.step_mode = mode
        draw_panels()
    obj.boucle.integrator = "verlet"
    obj.boucle.damping_per_kind = True
    bpy.ops.boucle.bake()
    obj.modifiers.new("Cloth", "CLOTH")
    bpy.ops.boucle.save_preset(preset="Mine")
    draw_panels()
    obj.boucle.model, obj.boucle.warp = "fabric", "uv"
    bpy.ops.boucle.apply_preset(preset="denim")
    draw_panels()
    obj.boucle.yield_curvature = 100.0
    obj.boucle.use_compression = obj.boucle.damping_ratio_per_kind = True
    draw_panels()

    class Any:
        layout = Layout(drawn)

    addon("panels.cloth").draw_button(Any(), bpy.context)
    addon("operators.starters").BOUCLE_MT_add.draw(Any(), bpy.context)
    preferences = bpy.context.preferences.addons["bl_ext.user_default.boucle"].preferences

    class Preferences:
        layout = Layout(drawn)
        bl_rna = preferences.bl_rna
        live_memory = preferences.live_memory

    type(preferences).draw(Preferences(), bpy.context)
    bpy.ops.mesh.primitive_plane_add()
    polls = [
        getattr(bpy.types, name).poll(bpy.context)
        for name in dir(bpy.types)
        if name.startswith("BOUCLE_PT_")
    ]
    addon("panels.cloth").draw_button(Any(), bpy.context)
    return {"drawn": drawn, "polls": polls, "hidden": sorted(hidden)}


def test_every_setting_is_drawn_and_the_safe_time_step_is_shown(blender):
    result = blender.run(draw_everything)
    drawn = result["drawn"]
    assert set(drawn) >= DESIGN_NAMES - {"enabled", "bend_warp", "bend_weft"} | {
        "bend_warp_micro", "bend_weft_micro", "Denim", "* Denim", "Choose...", "Knit",
        "damping_shear", "air_damping", "wind_velocity", "wind_air_density", "time_step",
        "allow_unstable", "boucle.bake", "boucle.free_bake", "boucle.reset", "boucle.check",
        "boucle.bake_all", "boucle.enable", "boucle.disable", "boucle.add_cloth", "live_memory",
        "boucle.apply_preset", "boucle.save_preset", "boucle.delete_preset", "preset_name",
        "BOUCLE_PT_presets", "boucle.copy_from_cloth",
    }  # fmt: skip
    text = " ".join(drawn)
    assert re.search(r"Safe time step: [\d.]+ ms, \d+ substeps a frame at 24 fps", text)
    assert "Any time step is stable with this integrator" in " ".join(drawn)
    assert "Baked: frames 1 to 20" in text
    assert "Frame 2: stretch" in text and " hash " in text
    assert all(len(line) < 45 for line in drawn), "Blender would cut it"
    assert not any(result["polls"])
    models = {"BOUCLE_PT_springs", "BOUCLE_PT_fabric"}
    parts = ("stiffness", "damping", "deformation")
    models |= {f"BOUCLE_PT_{part}" for part in parts} | {
        f"BOUCLE_PT_fabric_{part}" for part in parts
    }
    assert set(result["hidden"]) == models | {"BOUCLE_PT_fabric_bending"}, "one model at a time"


def switch_the_add_on():
    import addon_utils
    import bpy

    module = "bl_ext.user_default.boucle"

    def state():
        handlers = [
            function.__module__
            for name in dir(bpy.app.handlers)
            if isinstance(getattr(bpy.app.handlers, name), list)
            for function in getattr(bpy.app.handlers, name)
            if "boucle" in function.__module__
        ]
        return (
            [name for name in dir(bpy.types) if name.startswith("BOUCLE_")],
            hasattr(bpy.types.Object, "boucle"),
            len(handlers),
            len(bpy.types.VIEW3D_MT_mesh_add._dyn_ui_initialize()),
            len(bpy.types.PHYSICS_PT_add._dyn_ui_initialize()),
        )

    on = state()
    for _ in range(20):
        addon_utils.disable(module)
        off = state()
        assert addon_utils.enable(module) is not None
        assert state() == on
    return {"on": on, "off": off}


def test_the_add_on_can_be_switched_off_and_on_twenty_times(blender):
    result = blender.run(switch_the_add_on)
    assert result["off"][0] == []
    assert result["off"][1:3] == [False, 0]
    assert [a - b for a, b in zip(result["on"][3:], result["off"][3:], strict=True)] == [1, 1]


def fail_to_register():
    import sys

    import addon_utils
    import bpy
    from cloths import addon

    module = "bl_ext.user_default.boucle"
    handlers, transaction = addon("handlers"), addon("core.transaction")
    addon_utils.disable(module)
    package = sys.modules[handlers.__package__]

    def fail():
        raise RuntimeError("on purpose")

    package._STEPS = (*package._STEPS, transaction.Step(fail, fail))
    said = ""
    try:
        package.register()
    except RuntimeError as error:
        said = str(error)
    left = [name for name in dir(bpy.types) if name.startswith("BOUCLE_")]
    listening = handlers.frame_change_post in bpy.app.handlers.frame_change_post
    return [said, left, listening, hasattr(bpy.types.Object, "boucle")]


def test_a_registration_that_fails_leaves_nothing_behind(blender):
    assert blender.run(fail_to_register) == ["on purpose", [], False, False]


def other_version():
    import bpy
    from cloths import addon, refusal_of

    bpy.ops.boucle.add_cloth(vertices_x=4, vertices_y=4)
    native = addon("native")
    native._core.__dict__["__version__"] = "9.9.9"
    native.problem.cache_clear()
    can = bpy.ops.boucle.bake.poll()
    return [native.problem(), can, refusal_of(bpy.ops.boucle.bake)]


def test_another_version_of_the_compiled_module_is_named(blender):
    sentence, can, said = blender.run(other_version)
    assert "9.9.9" in sentence and "restart Blender" in sentence
    assert not can
    assert sentence in said


def idle_handlers():
    import bpy
    from cloths import addon

    registry = addon("bridge.registry")
    bpy.ops.mesh.primitive_plane_add()
    bpy.context.scene.frame_set(2)
    looked = []
    real = registry._look
    registry._look = lambda: looked.append(1) or real()
    live = addon("bridge.live")
    live.on_frame = lambda *_: looked.append("live")
    for frame in range(3, 30):
        bpy.context.scene.frame_set(frame)
    return looked


def test_without_a_cloth_no_handler_does_any_work(blender):
    assert blender.run(idle_handlers) == []


def choose_who_counts_the_steps():
    from cloths import add_cloth, play

    obj = add_cloth()
    settings = obj.boucle
    shown = [(settings.step_mode, settings.substeps, settings.time_step, settings.safe_step)]

    def choose(mode):
        settings.step_mode = mode
        shown.append((settings.step_mode, settings.substeps, round(settings.time_step, 6), ""))

    choose("substeps")
    choose("auto")
    settings.quality = "final"
    play(1, 3)
    shown.append((settings.step_mode, 0, 0.0, settings.safe_step))
    choose("substeps")
    choose("substeps")
    choose("time_step")
    choose("auto")
    settings.time_step = 0.01
    shown.append((settings.step_mode, settings.substeps, 0.01, ""))
    return shown


def test_steps_are_automatic_or_one_of_two_numbers_and_begin_with_what_a_frame_took(new_blender):
    shown = new_blender.run(choose_who_counts_the_steps)
    assert shown[0] == ["auto", 0, 0.0, "Any time step is stable with this integrator"]
    assert shown[1][:3] == ["substeps", 10, 0.0], "nothing is known of the frame yet"
    assert shown[2][:3] == ["auto", 0, 0.0]
    taken = int(re.fullmatch(r"This frame took (\d+) steps?; any step is stable", shown[3][3])[1])
    assert taken > 1
    assert [row[:3] for row in shown[4:]] == [
        ["substeps", taken, 0.0],
        ["substeps", taken, 0.0],
        ["time_step", 0, 0.001],
        ["auto", 0, 0.0],
        ["time_step", 0, 0.01],
    ]


def shown_with_dampings():
    from cloths import add_cloth

    settings = add_cloth().boucle
    settings.integrator = "symplectic_euler"
    shown = []
    for damping, law in ((0.0, "relative"), (50.0, "relative"), (50.0, "axial")):
        settings.damping, settings.damping_law = damping, law
        shown.append(settings.safe_step)
    settings.integrator = "forward_euler"
    settings.damping, settings.damping_law = 0.001, "relative"
    shown.append(settings.safe_step)
    settings.integrator = "bdf2"
    settings.damping = 50.0
    shown.append(settings.safe_step)
    return shown


def test_the_panel_warns_of_damping_that_costs_an_explicit_integrator_its_step(blender):
    none, much, axial, little, implicit = blender.run(shown_with_dampings)
    assert none.startswith("Safe time step: ") and "Damping" not in none
    for text in (much, axial):
        assert re.search(
            r"Safe time step: .*\. Damping ratio \S+ of .* above 0\.68 .* lower damping", text
        )
    assert "below 0.45" in little and "raise damping" in little
    assert "Damping" not in implicit
