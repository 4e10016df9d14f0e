"""Settling before the first frame: what is kept first is the settled cloth, the same live, baked and resumed."""


def hang_and_settle():
    import hashlib
    from pathlib import Path

    import bpy
    from cloths import addon, farthest, mesh_positions, play, shown_positions

    cache, pc2 = addon("bridge.cache"), addon("core.pc2")
    scene = bpy.context.scene
    bpy.ops.boucle.add_cloth(
        vertices_x=10, vertices_y=10, size_x=1.0, size_y=1.0, plane="xy", pins={"top"}
    )
    obj = bpy.context.object
    obj.location = (0.3, 0.0, 0.0)
    obj.boucle.frame_end = 12
    bpy.context.view_layer.update()
    rest = mesh_positions(obj)
    out = {}

    def rows():
        return [
            (row["kinetic_energy"], row["hash"], row["frame"])
            for row in addon("bridge.certificate").rows(obj).values()
        ]

    def lowest(positions):
        return min(positions[2::3])

    play(1, 12)
    out["plain"] = rows()
    obj.boucle.settle_frames = 60
    scene.frame_set(1)
    out["first"] = farthest(shown_positions(obj), rest), lowest(shown_positions(obj))
    play(2, 12)
    out["damped"] = rows()
    live = shown_positions(obj)
    out["drift"] = []
    bpy.ops.boucle.bake()
    scene.frame_set(12)
    out["same"] = farthest(shown_positions(obj), live)
    files = cache.own_files(obj)
    whole = Path(files.pc2).read_bytes()
    out["samples"] = pc2.read_header(files.pc2).sample_count, pc2.read_header(files.pc2).first_frame
    out["hashes"] = [row[1] for row in rows()] == [row[1] for row in out["damped"]]

    # Stopped in the middle and resumed; stopped while it settles.
    baking = addon("bridge.bake")
    for count, name in ((66, "resumed"), (20, "stopped")):
        bake = baking.Bake([obj], scene)
        steps = bake.steps()
        for number, step in enumerate(steps):
            step.run()
            if number == count:
                break
        steps.close()
        if name == "resumed":
            partly = bake.last_frame
            bpy.ops.boucle.bake(resume=True)
            out["partly"] = partly
        out[name] = Path(files.pc2).read_bytes() == whole
    out["status"] = obj.boucle.status
    obj.boucle.settle_frames = 59
    out["drift"] = cache.drift_of(obj, scene, in_full=True)
    obj.boucle.settle_frames = 60
    obj.boucle.settle_damped = False
    out["drift"] += cache.drift_of(obj, scene, in_full=True)
    bpy.ops.boucle.free_bake()
    obj.boucle.settle_frames = 5
    scene.frame_set(1)
    out["undamped"] = rows()[0]
    out["hash"] = hashlib.sha1(whole).hexdigest()
    return out


def settle_in_slices():
    import bpy
    from cloths import add_cloth, addon, mesh_positions, play

    live, settling, scene = addon("bridge.live"), addon("bridge.settling"), bpy.context.scene
    obj = add_cloth(end=8, settle_frames=12)
    rest = mesh_positions(obj)

    def rows():
        return [row["hash"] for row in addon("bridge.certificate").rows(obj).values()]

    play(1, 5)
    out = {"at once": rows()}
    begun = []
    settling.patience, settling.SLICE = (
        (lambda: 0.0),
        1e-9,
    )  # a frame a slice, as in a window that has no time
    live.drop(obj)
    register, bpy.app.timers.register = bpy.app.timers.register, begun.append
    try:
        play(1, 3)
    finally:
        bpy.app.timers.register = register
    out["timer"] = begun == [live.settle_on]
    out["before"] = mesh_positions(obj) == rest, obj.boucle.status
    try:
        addon("bridge.grab").Grab(obj, scene, bpy.context.evaluated_depsgraph_get())
    except addon("core.refusal").Refusal as refusal:
        out["grab"] = str(refusal)
    pauses = [live.settle_on() for _ in range(12)]
    out["pauses"] = pauses == [0.0] * 12, live.settle_on()
    out["settled"] = mesh_positions(obj) == rest, obj.boucle.status
    play(1, 5)
    out["in slices"] = rows()
    live.drop(obj)
    bpy.app.timers.register = begun.append
    try:
        play(1, 1)
        bpy.ops.boucle.reset()
    finally:
        bpy.app.timers.register = register
    out["reset"] = live.settle_on(), mesh_positions(obj) == rest
    return out


def test_a_window_lives_while_a_cloth_settles(blender):
    found = blender.run(settle_in_slices)
    assert found["timer"]
    is_at_rest, status = found["before"]
    assert is_at_rest and status == "Live: settling (0 of 12 frames; Reset stops it)"
    assert "grab it when it is settled" in found["grab"]
    assert found["pauses"] == [True, None]
    is_at_rest, status = found["settled"]
    assert not is_at_rest and status.startswith("Live: frames 1 to 1 in memory")
    assert len(found["at once"]) == 5 and found["in slices"] == found["at once"]
    assert found["reset"] == [None, True]


def test_a_settled_cloth_begins_where_it_hangs_at_rest(blender):
    found = blender.run(hang_and_settle)
    assert found["first"][0] > 0.5 and -1.03 < found["first"][1] < -0.9, "it hangs down, 1 m long"
    assert found["damped"][0][0] == 0.0 and found["damped"][0][2] == 1
    falls, settled = (max(row[0] for row in found[name]) for name in ("plain", "damped"))
    assert settled < 0.01 * falls, (falls, settled)
    assert found["same"] == 0.0 and found["hashes"]
    assert found["samples"] == [12, 1.0]
    assert 1 < found["partly"] < 12
    assert found["resumed"], "a resumed bake is bit-equal"
    assert found["stopped"], "a bake that is stopped while it settles leaves the one before"
    assert found["status"].startswith("Baked: frames 1 to 12"), found["status"]
    assert found["drift"] == ["settle frames", "settle damped"]
    assert found["undamped"][0] > 0.0 and found["undamped"][2] == 1
