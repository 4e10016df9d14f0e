"""Force fields: each kind against Blender's own cloth, as force per area at 24 frames a second; weights; live and baked."""

import math

SIDE = 13
"""Vertices along each side of a sheet."""
MASS = 0.3
"""kg, of every vertex."""
PLACE = (0.3, -0.2, 0.5)
FIELD_PLACE = (0.1, 0.05, -0.2)
FIELD_TURN = (0.4, 0.3, 0.2)
SHEET_TURN = (0.3, 0.2, 0.1)
GRAVITY = (3.0, -2.0, -9.81)
"""In Blender's cloth a thousandth of it, by the square of frames, is an acceleration: sheets come to 0.8 m/s in 3 frames."""

STILL, MOVING = 0, 3
"""The frame after the first at which forces are compared."""

CASES = {
    "force": ("FORCE", {"strength": 2}, STILL),
    "force from a line": ("FORCE", {"strength": 2, "shape": "LINE", "falloff_power": 1}, STILL),
    "force from a plane": ("FORCE", {"strength": -2, "shape": "PLANE"}, STILL),
    "force with gravity falloff": ("FORCE", {"strength": 2, "use_gravity_falloff": True, "falloff_power": 1.5}, STILL),
    "force within distances": ("FORCE", {
        "strength": 2, "falloff_power": 2, "use_min_distance": True, "distance_min": 0.4,
        "use_max_distance": True, "distance_max": 1.3,
    }, STILL),
    "force in a tube": ("FORCE", {
        "strength": 2, "falloff_type": "TUBE", "falloff_power": 2, "radial_falloff": 1.5,
        "use_radial_min": True, "radial_min": 0.3, "use_radial_max": True, "radial_max": 1.0,
    }, STILL),
    "force in a cone": ("FORCE", {
        "strength": 2, "falloff_type": "CONE", "falloff_power": 1, "radial_falloff": 0.3,
        "use_radial_max": True, "radial_max": 80,
    }, STILL),
    "force in front": ("FORCE", {"strength": 2, "z_direction": "POSITIVE"}, STILL),
    "nothing behind": ("FORCE", {"strength": 2, "z_direction": "NEGATIVE"}, STILL),
    "wind": ("WIND", {"strength": 2}, STILL),
    "wind on faces": ("WIND", {"strength": 2, "wind_factor": 1}, STILL),
    "wind half on faces": ("WIND", {"strength": 2, "wind_factor": 0.5, "falloff_power": 1}, STILL),
    "wind with flow": ("WIND", {"strength": 2, "flow": 1.5, "falloff_power": 1}, MOVING),
    "wind with flow on faces": ("WIND", {"strength": 2, "flow": 1.5, "wind_factor": 1}, MOVING),
    "vortex": ("VORTEX", {"strength": 2, "flow": 0.5}, MOVING),
    "vortex of a plane": ("VORTEX", {"strength": 2, "shape": "PLANE", "falloff_power": 1}, MOVING),
    "magnetic": ("MAGNET", {"strength": 2, "falloff_power": 1}, MOVING),
    "magnetic of a plane": ("MAGNET", {"strength": 2, "shape": "PLANE", "flow": 0.3}, MOVING),
    "harmonic": ("HARMONIC", {"strength": 2, "harmonic_damping": 1, "falloff_power": 1}, MOVING),
    "harmonic with a rest length": ("HARMONIC", {"strength": 2, "rest_length": 0.3, "harmonic_damping": 0.5}, MOVING),
    "harmonic of a plane": ("HARMONIC", {"strength": 2, "shape": "PLANE", "harmonic_damping": 0}, MOVING),
    "drag": ("DRAG", {"strength": 1.5, "harmonic_damping": 0.5, "falloff_power": 1}, MOVING),
    "strong drag": ("DRAG", {"strength": 9, "harmonic_damping": 0}, MOVING),
    "nothing without location": ("WIND", {"strength": 2, "apply_to_location": False}, STILL),
    "lennard-jones": ("LENNARDJ", {"strength": 9}, MOVING),
    "charge": ("CHARGE", {"strength": 9}, MOVING),
}  # fmt: skip
"""Kind, settings and state of each comparison."""


def add_field(kind, **values):
    """An empty with a field, above nothing else in the scene."""
    import bpy

    obj = bpy.data.objects.new(kind.title(), None)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.forcefield_toggle()
    obj.field.type = kind
    obj.location, obj.rotation_euler = FIELD_PLACE, FIELD_TURN
    for name, value in values.items():
        setattr(obj.field, name, value)
    return obj


def add_sheets(side=SIDE, size=1.0, turn=SHEET_TURN, place=PLACE):
    """Two sheets in one place: Blender's cloth, free and without any force of its own, and ours."""
    import bpy

    steps = [size * (i / (side - 1) - 0.5) for i in range(side)]
    corners = [(x, y, 0.0) for y in steps for x in steps]
    starts = [r * side + c for r in range(side - 1) for c in range(side - 1)]
    mesh = bpy.data.meshes.new("sheet")
    mesh.from_pydata(corners, [], [(i, i + 1, i + side + 1, i + side) for i in starts])
    pair = [bpy.data.objects.new(name, mesh.copy()) for name in ("theirs", "ours")]
    for obj in pair:
        bpy.context.scene.collection.objects.link(obj)
        obj.location, obj.rotation_euler = place, turn
    theirs, ours = pair
    modifier = theirs.modifiers.new("Cloth", "CLOTH")
    settings = modifier.settings
    settings.quality, settings.mass, settings.air_damping = 1, MASS, 0.0
    for part in ("tension", "compression", "shear", "bending"):
        setattr(settings, f"{part}_stiffness", 0.0)
        setattr(settings, f"{part}_damping", 0.0)
    modifier.collision_settings.use_collision = False
    bpy.context.view_layer.objects.active = ours
    bpy.ops.boucle.enable()
    ours.boucle.use_live = False
    return theirs, ours


def clear():
    import bpy

    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    bpy.context.scene.frame_set(0)


def positions_of(obj):
    import numpy
    from cloths import shown_positions

    local = numpy.array(shown_positions(obj)).reshape(-1, 3)
    matrix = numpy.array(obj.matrix_world)
    return local @ matrix[:3, :3].T + matrix[:3, 3]


def their_forces(theirs, after):
    """Forces (N) of Blender's fields on its cloth after some frames, with the positions (m) and the velocity (m/s) there."""
    import bpy
    import numpy

    scene = bpy.context.scene
    x = []
    for frame in range(1, after + 3):
        scene.frame_set(frame)
        x.append(positions_of(theirs))
    fps = scene.render.fps
    way = x[after] - x[after - 1] if after else numpy.zeros_like(x[0])
    gravity = 1e-3 * numpy.array(scene.gravity) * bool(scene.use_gravity)
    change = x[after + 1] - x[after] - way - gravity
    return MASS * change * fps**2, x[after], way.mean(0) * fps


def our_forces(ours, x, velocity):
    """Forces (N) of the same fields on our cloth in that state, from the change of its momentum in a short step."""
    import bpy
    import numpy
    from cloths import addon

    depsgraph = bpy.context.evaluated_depsgraph_get()
    forces = addon("bridge.fields").Fields(ours, bpy.context.scene).sample(depsgraph)
    if forces is None:
        return numpy.zeros_like(x)
    fps, count = 1e4, len(x)
    cloth = {"name": "ours", "mass_per_vertex": MASS, "velocity": list(velocity)}
    springs = {"stretch": 0, "shear": 0, "bend": 0, "damping": 0, "limiter": "none"}
    cloth |= {"springs": springs, "collision": {"enabled": False}}
    solver = {"integrator": "forward_euler", "substeps": 1, "allow_unstable": True}
    head = {"frames": [1, 2], "fps": fps, "gravity": [0, 0, 0]}
    scene = {"scene": head, "cloth": [cloth], "solver": solver}
    faces = addon("bridge.mesh_arrays").topology(ours.data)
    text = addon("core.scene_json").encode(scene)
    simulation = addon("native").simulation(text, [(x.copy(), faces.starts, faces.corners)])
    simulation.set_fields(forces.fields)
    simulation.advance()
    out = numpy.zeros((count, 3))
    simulation.read_velocities(0, out)
    return MASS * (out - velocity) * fps


def quarters(forces, side=SIDE):
    """The sums over the four quarters of a sheet."""
    square = forces.reshape(side, side, 3)
    half = side // 2
    parts = [square[a, b].sum((0, 1)) for a in (slice(0, half), slice(half, None))
             for b in (slice(0, half), slice(half, None))]  # fmt: skip
    return [part.tolist() for part in parts]


def compare_kinds():
    import bpy

    scene = bpy.context.scene
    scene.render.fps, scene.gravity = 24, GRAVITY
    found = {}
    for name, (kind, values, after) in CASES.items():
        clear()
        scene.use_gravity = after != STILL
        add_field(kind, **values)
        theirs, ours = add_sheets()
        forces, x, velocity = their_forces(theirs, after)
        ours_there = our_forces(ours, x, velocity)
        found[name] = {"theirs": quarters(forces), "ours": quarters(ours_there)}
    return found


def test_every_kind_pushes_as_it_pushes_blenders_cloth(new_blender):
    found = new_blender.run(compare_kinds)
    assert set(found) == set(CASES)
    for name, both in found.items():
        largest = max(math.hypot(*part) for part in both["theirs"])
        if name.startswith("nothing") or CASES[name][0] in {"LENNARDJ", "CHARGE"}:
            assert largest < 2e-3, (name, both)
            assert both["ours"] == [[0.0] * 3] * 4, name
            continue
        assert largest > 5e-3, f"{name}: the test sees no force"
        for ours, theirs in zip(both["ours"], both["theirs"], strict=True):
            # Direction and size at once; the hundredth is float32 of Blender's positions.
            assert math.dist(ours, theirs) < 0.1 * math.hypot(*theirs) + 0.01 * largest, (
                name,
                both,
            )


def weigh_and_time():
    import bpy

    scene = bpy.context.scene
    scene.use_gravity = False
    found = {}

    def total(name, fps=24):
        scene.render.fps = fps
        theirs, ours = add_sheets()
        for key, value in weights.items():
            setattr(theirs.modifiers[0].settings.effector_weights, key, value)
            setattr(ours.boucle.field_weights, key, value)
        forces, x, velocity = their_forces(theirs, STILL)
        found[name] = [forces.sum(0).tolist(), our_forces(ours, x, velocity).sum(0).tolist()]
        bpy.data.objects.remove(theirs)
        bpy.data.objects.remove(ours)
        scene.frame_set(0)

    clear()
    add_field("WIND", strength=2)
    weights = {}
    total("plain")
    total("at 48 frames a second", fps=48)
    weights = {"all": 0.5, "wind": 0.25}
    total("weighted")
    weights = {"all": 0.5, "force": 0.0}
    total("by all alone")
    inside = bpy.data.collections.new("Inside")
    scene.collection.children.link(inside)
    weights = {"collection": inside}
    total("of an empty collection")
    deep = bpy.data.collections.new("Deep")
    inside.children.link(deep)
    deep.objects.link(bpy.data.objects["Wind"])
    total("of a collection in a collection")
    bpy.data.objects["Wind"].hide_viewport, weights = True, {}
    total("disabled in viewports")
    return found


def test_weights_and_collections_count_as_in_blender_and_the_frame_rate_does_not(new_blender):
    found = new_blender.run(weigh_and_time)
    plain = found["plain"][1]
    # 0.48 N/m² for each unit of strength on 1 m².
    assert abs(math.hypot(*plain) - 0.96) < 1e-6
    parts = {
        "plain": 1.0, "weighted": 0.125, "by all alone": 0.5, "of an empty collection": 0.0,
        "of a collection in a collection": 1.0, "disabled in viewports": 0.0,
    }  # fmt: skip
    for name, part in parts.items():
        theirs, ours = found[name]
        assert math.dist(ours, [part * x for x in plain]) < 1e-6, name
        assert math.dist(ours, theirs) < 0.01, (name, theirs, ours)
    theirs, ours = found["at 48 frames a second"]
    assert math.dist(ours, plain) < 1e-6
    assert math.dist(theirs, [2 * x for x in plain]) < 0.02, "Blender's own mixes the rate in"


def measure_turbulence():
    import bpy
    import numpy

    scene = bpy.context.scene
    scene.use_gravity = False
    side, size = 121, 12.0
    inside = slice(1, -1)
    found = {}
    for name, kind, values in (
        ("turbulence", "TURBULENCE", {"strength": 2, "size": 1.0}),
        ("larger", "TURBULENCE", {"strength": 1, "size": 2.0, "use_global_coords": True}),
        ("noise", "WIND", {"strength": 0, "noise": 2.0, "shape": "PLANE"}),
    ):
        clear()
        add_field(kind, **values)
        theirs, ours = add_sheets(side, size)
        forces, x, velocity = their_forces(theirs, STILL)
        area = (size / (side - 1)) ** 2
        rows = []
        for every in (forces, our_forces(ours, x, velocity)):
            field = every.reshape(side, side, 3)[inside, inside] / area
            field = field[..., 2:] if kind == "WIND" else field
            mean = field.mean((0, 1))
            spread = field - mean
            square = (spread**2).mean()
            # Where half of the correlation is left, along rows and columns.
            kept = [1.0]
            for k in range(1, 30):
                along = (spread[k:] * spread[:-k]).mean() + (spread[:, k:] * spread[:, :-k]).mean()
                kept.append(along / (2 * square))
            k = next((k for k in range(1, 30) if kept[k] < 0.5), 29)
            length = (k - (0.5 - kept[k]) / (kept[k - 1] - kept[k])) * size / (side - 1)
            rows.append([float(numpy.sqrt((field**2).mean())), float(length), mean.tolist()])
        found[name] = rows
    return found


def test_turbulence_and_noise_have_the_spread_and_the_correlation_length_of_blenders(new_blender):
    found = new_blender.run(measure_turbulence)
    for name, (theirs, ours) in found.items():
        assert abs(ours[0] / theirs[0] - 1) < 0.1, (name, theirs, ours)
        if name != "noise":
            assert abs(ours[1] / theirs[1] - 1) < 0.1, (name, theirs, ours)
    assert abs(found["larger"][1][1] / found["turbulence"][1][1] - 2) < 0.2
    (theirs,), (ours,) = (row[2] for row in found["noise"])
    assert abs(ours - theirs) < 0.02


def move_among_fields():
    """Live, baked, and baked with a stop: a field that moves and grows, another with noise, weights that are animated."""
    import bpy
    from cloths import add_cloth, addon, farthest, play, shown_positions

    def stopped(obj):
        bake = addon("bridge.bake")
        steps = bake.Bake([obj], bpy.context.scene).steps()
        for _ in range(4):
            next(steps).run()
        steps.close()
        bpy.ops.boucle.bake(resume=True)
        return shown_positions(obj)

    fan = add_field("WIND", strength=3, noise=1.0, flow=0.5)
    fan.location = (0, 2, 0)
    fan.rotation_euler = (math.pi / 2, 0, 0)
    for frame, strength in ((1, 0.0), (8, 6.0)):
        fan.field.strength = strength
        fan.field.keyframe_insert("strength", frame=frame)
        fan.location.x = strength
        fan.keyframe_insert("location", frame=frame)
    add_field("TURBULENCE", strength=4, size=0.5)
    obj = add_cloth(end=8, self_collision=False)
    weights = obj.boucle.field_weights
    for frame, gravity in ((1, 1.0), (8, 0.25)):
        weights.gravity = gravity
        weights.keyframe_insert("gravity", frame=frame)
    scene = bpy.context.scene
    play(1, 8)
    session = addon("bridge.live").session_of(obj)
    last = session.frames.last
    live = shown_positions(obj)
    bpy.ops.boucle.bake()
    baked = shown_positions(obj)
    drift = addon("bridge.cache").drift_of
    words = [drift(obj, scene, in_full=True)]
    scene.frame_set(3)
    words.append(drift(obj, scene, in_full=False))
    scene.frame_set(8)
    bpy.data.objects["Turbulence"].field.size = 0.7
    weights.wind = 0.5
    words.append(drift(obj, scene, in_full=True))
    bpy.data.objects["Turbulence"].field.size = 0.5
    weights.wind = 1.0
    resumed = stopped(obj)
    bpy.ops.boucle.free_bake()
    weights.all = 0.0
    play(1, 8)
    return {
        "last": last,
        "bits": [farthest(live, baked), farthest(baked, resumed)],
        "words": words,
        "moved": farthest(baked, shown_positions(obj)),
    }


def test_fields_that_move_and_are_animated_push_live_baked_and_resumed_alike(new_blender):
    result = new_blender.run(move_among_fields)
    assert result["last"] == 8
    assert result["bits"] == [0.0, 0.0]
    assert result["words"] == [[], [], ['force field "Turbulence"']]
    assert result["moved"] > 0.05


def live_with_everything():
    import bpy
    from cloths import add_cloth, addon, play, refusal_of, world_positions

    obj = add_cloth(end=12, self_collision=False, pin_group="")
    weights = obj.boucle.field_weights

    def lowest():
        bpy.context.view_layer.objects.active = obj
        bpy.ops.boucle.reset(every=True)
        play(1, 4)
        return min(point.z for point in world_positions(obj))

    falls = lowest()
    weights.gravity = 0.0
    floats = lowest()
    for kind in ("FORCE", "WIND", "VORTEX", "MAGNET", "HARMONIC", "TURBULENCE", "DRAG"):
        add_field(kind, strength=1.0)
    pushed = lowest()
    status = obj.boucle.status
    none = weights.unsupported
    for kind in ("TEXTURE", "FLUID_FLOW", "LENNARDJ"):
        add_field(kind)
    bpy.data.objects["Drag"].field.use_absorption = True
    unsupported = weights.unsupported
    still = addon("bridge.live").session_of(obj)
    play(4, 5)
    same = addon("bridge.live").session_of(obj) is still
    bpy.data.objects["Wind"].field.strength = 2.0
    play(6, 7)
    dropped = addon("bridge.live").session_of(obj) is not still
    bpy.data.objects["Wind"].field.strength = float("inf")
    bpy.context.view_layer.objects.active = obj
    refused = refusal_of(bpy.ops.boucle.bake)
    rows = [
        (prop.identifier, prop.is_overridable, prop.hard_min if prop.type == "FLOAT" else 0.0)
        for prop in weights.bl_rna.properties
        if prop.identifier not in {"rna_type", "name"}
    ]
    return {
        "heights": [falls, floats, pushed], "status": status, "none": none, "unsupported": unsupported,
        "same": same, "dropped": dropped, "refused": refused, "rows": rows,
    }  # fmt: skip


def test_fields_and_weights_work_live_in_every_version(blender):
    result = blender.run(live_with_everything)
    falls, floats, pushed = result["heights"]
    assert falls < -0.52 and abs(floats + 0.5) < 1e-4 and abs(pushed - floats) > 1e-3
    assert result["status"].startswith("Live: frames 1 to 4")
    assert result["none"] == ""
    said = result["unsupported"]
    for words in (
        '"Texture": Texture fields are not supported',
        '"Fluid_Flow": Fluid Flow fields are not supported',
        '"Lennardj": Lennard-Jones fields do not act on cloth, nor do they in Blender',
        '"Drag": Absorption is not supported',
    ):
        assert words in said, said
    assert result["same"] and result["dropped"]
    assert 'the force field "Wind" has a strength of inf' in result["refused"]
    assert {row[0] for row in result["rows"]} >= {"gravity", "all", "wind", "drag", "collection"}
    assert all(overridable and least == 0.0 for _, overridable, least in result["rows"])
