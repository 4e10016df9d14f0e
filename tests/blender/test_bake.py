"""Bake, stop, resume, free; the result plays without the add-on."""

import json
import os
import struct
from pathlib import Path


def bake_and_save(folder):
    import bpy
    from cloths import add_cloth, mesh_positions, play, shown_positions

    obj = add_cloth(end=15)
    rest = mesh_positions(obj)
    obj.modifiers.new("Subdivision", "SUBSURF")
    play(1, 15)
    live = mesh_positions(obj)
    path = os.path.join(folder, "curtain.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    done = bpy.ops.boucle.bake()
    obj.modifiers["Subdivision"].show_viewport = False
    frames = []
    for frame in range(-1, 18):
        bpy.context.scene.frame_set(frame)
        frames.append(shown_positions(obj))
    bpy.context.scene.frame_set(4, subframe=0.5)
    half = shown_positions(obj)
    obj.modifiers["Subdivision"].show_viewport = True
    bpy.ops.wm.save_mainfile()
    return {
        "done": list(done),
        "frames": frames,
        "half": half,
        "live": live,
        "rest": rest,
        "mesh": mesh_positions(obj) == rest,
        "filepath": obj.modifiers["Boucle Cache"].filepath,
        "uuid": obj.boucle.uuid,
        "status": obj.boucle.status,
        "frame": bpy.context.scene.frame_current,
    }


def play_without_the_add_on(path):
    import bpy
    from cloths import shown_positions

    bpy.ops.wm.open_mainfile(filepath=path)
    assert not hasattr(bpy.types.Object, "boucle")
    obj = bpy.data.objects["Cloth"]
    obj.modifiers["Subdivision"].show_viewport = False
    frames = []
    for frame in range(-1, 18):
        bpy.context.scene.frame_set(frame)
        frames.append(shown_positions(obj))
    bpy.context.scene.frame_set(4, subframe=0.5)
    return {"frames": frames, "half": shown_positions(obj)}


def distance(one, other):
    return max(abs(a - b) for a, b in zip(one, other, strict=True))


def test_a_bake_is_the_live_result_and_plays_without_the_add_on(blender):
    baked = blender.run(bake_and_save, folder=blender.folder)
    assert baked["done"] == ["FINISHED"]
    assert baked["mesh"]
    assert baked["filepath"] == f"//boucle_cache/curtain/{baked['uuid']}.pc2"
    assert baked["status"].startswith("Baked: frames 1 to 15")
    assert distance(baked["frames"][2], baked["rest"]) < 1e-6, "but for the solver's perturbation"
    assert baked["frames"][0] == baked["frames"][2], "before the start the rest pose is shown"
    assert distance(baked["frames"][16], baked["live"]) < 1e-6
    assert baked["frames"][18] == baked["frames"][16], "after the end the last frame is shown"
    between = [(a + b) / 2 for a, b in zip(baked["frames"][5], baked["frames"][6], strict=True)]
    assert distance(baked["half"], between) < 1e-6
    alone = blender.run(play_without_the_add_on, addon=False, path=blender.folder / "curtain.blend")
    assert alone["frames"] == baked["frames"]
    assert alone["half"] == baked["half"]


def test_a_bake_leaves_a_pc2_a_report_and_a_checkpoint(blender):
    baked = blender.run(bake_and_save, folder=blender.folder)
    folder = blender.folder / "boucle_cache" / "curtain"
    uuid = baked["uuid"]
    assert sorted(p.name for p in folder.iterdir()) == [
        f"{uuid}.checkpoint",
        f"{uuid}.json",
        f"{uuid}.pc2",
    ]
    data = (folder / f"{uuid}.pc2").read_bytes()
    head = struct.unpack("<12siiffi", data[:32])
    assert head == (b"POINTCACHE2\0", 1, 48, 1.0, 1.0, 15)
    assert len(data) == 32 + 15 * 48 * 12
    report = json.loads((folder / f"{uuid}.json").read_text())
    assert set(report) >= {
        "boucle", "scene", "threads", "cloths", "frames", "total_seconds", "peak_memory_bytes",
    }  # fmt: skip
    assert report["cloths"][0]["name"] == "Cloth"
    assert report["cloths"][0]["vertices"] == 48
    assert report["cloths"][0]["triangles"] == 2 * 7 * 5
    assert [row["frame"] for row in report["frames"]] == list(range(1, 16))
    assert set(report["frames"][0]) >= {
        "frame", "seconds", "substeps", "iterations", "max_strain", "p99_strain", "intersections",
        "clipped", "kinetic_energy", "potential_energy", "hash",
    }  # fmt: skip
    assert report["frames"][0]["max_strain"] < 1e-9


def stop_and_resume(folder):
    import bpy
    from cloths import add_cloth, addon, shown_positions

    obj = add_cloth(end=30, columns=12, rows=12)
    obj.modifiers.new("Subdivision", "SUBSURF")
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bake = addon("bridge.bake")
    worker = addon("bridge.worker").Worker()
    scene = bpy.context.scene
    scene.frame_set(7)

    def pc2():
        return bpy.path.abspath(obj.modifiers["Boucle Cache"].filepath)

    running = bake.Bake([obj], scene)
    steps = running.steps()
    for step in steps:
        worker.begin(step)
        assert worker.is_done(60.0)
        if step.frame == 12:
            break
    off = obj.modifiers["Subdivision"].show_viewport
    worker.end()
    steps.close()
    stopped = [obj.boucle.status, obj.modifiers["Subdivision"].show_viewport, scene.frame_current]
    scene.frame_set(12)
    partial = shown_positions(obj)
    bpy.ops.boucle.bake(resume=True)
    resumed = Path(pc2()).read_bytes()
    report = Path(pc2().replace(".pc2", ".json")).read_text()
    status = obj.boucle.status
    bpy.ops.boucle.bake()
    whole = Path(pc2()).read_bytes()
    again = bpy.ops.boucle.bake(resume=True)
    after = Path(pc2()).read_bytes()
    obj.boucle.frame_end = 35
    bpy.ops.boucle.bake(resume=True)
    longer = Path(pc2()).read_bytes()
    bpy.ops.boucle.free_bake()
    bpy.ops.boucle.bake()
    return {
        "off": off,
        "stopped": stopped,
        "partial": len(partial) > 0,
        "bit_equal": resumed == whole,
        "rows": [row["frame"] for row in json.loads(report)["frames"]],
        "status": status,
        "again": [list(again), after == whole],
        "longer": longer == Path(pc2()).read_bytes() and longer[32:].startswith(whole[32:]),
        "longer_status": obj.boucle.status,
    }


def test_a_stopped_bake_is_kept_and_resumes_bit_equal(blender):
    result = blender.run(stop_and_resume, folder=blender.folder)
    assert result["off"] is False, "modifiers below the slot rest during a bake"
    assert result["stopped"] == ["Partly baked: frames 1 to 12 of 30; Resume goes on", True, 7]
    assert result["bit_equal"]
    assert result["rows"] == list(range(1, 31))
    assert result["status"].startswith("Baked: frames 1 to 30")
    assert result["again"] == [["FINISHED"], True]
    assert result["longer"]
    assert result["longer_status"].startswith("Baked: frames 1 to 35")


def free_and_restore():
    import bpy
    from cloths import add_cloth, play, shown_positions

    obj = add_cloth(end=8)
    scene = bpy.context.scene

    def at_eight():
        scene.frame_set(8)
        return shown_positions(obj)

    bpy.ops.boucle.bake()
    first = at_eight()
    none = bpy.ops.boucle.restore_bake.poll() and obj.boucle.has_previous
    obj.boucle.stretch = 50.0
    outdated = obj.boucle.status
    still = at_eight() == first
    bpy.ops.boucle.bake()
    second = at_eight()
    has = obj.boucle.has_previous
    bpy.ops.boucle.restore_bake()
    restored = at_eight() == first, obj.boucle.status
    bpy.ops.boucle.restore_bake()
    swapped = at_eight() == second, obj.boucle.status
    folder = os.path.dirname(bpy.path.abspath(obj.modifiers["Boucle Cache"].filepath))
    before = len(os.listdir(folder))
    bpy.ops.boucle.free_bake()
    after = os.listdir(folder)
    scene.frame_set(1)
    play(1, 3)
    return {
        "none": none,
        "outdated": outdated,
        "still": still,
        "differ": first != second,
        "has": has,
        "restored": restored,
        "swapped": swapped,
        "files": [before, after],
        "live": obj.boucle.status,
    }


def test_the_bake_before_is_kept_until_the_cache_is_freed(blender):
    result = blender.run(free_and_restore)
    assert not result["none"] and result["has"]
    assert "outdated, changed since: stretch stiffness" in result["outdated"]
    assert result["still"] and result["differ"]
    assert result["restored"][0] and "outdated" in result["restored"][1]
    assert result["swapped"][0] and "outdated" not in result["swapped"][1]
    assert result["files"] == [6, []]
    assert result["live"].startswith("Live: frames 1 to 3")


def refuse():
    import bpy
    from cloths import add_cloth, play, refusal_of

    def mesh_cloth(vertices, faces, edges=()):
        mesh = bpy.data.meshes.new("Bad")
        mesh.from_pydata(vertices, edges, faces)
        obj = bpy.data.objects.new("Bad", mesh)
        bpy.context.collection.objects.link(obj)
        bpy.context.view_layer.objects.active = obj
        obj.select_set(True)
        obj.boucle.enabled = True
        obj.boucle.frame_end = 5
        return obj

    quad = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    out = {}

    def note(name, obj):
        out[name] = [refusal_of(bpy.ops.boucle.bake), obj.boucle.status, list(obj.modifiers.keys())]
        bpy.ops.boucle.check()
        out[name].append([v.index for v in obj.data.vertices if v.select])
        play(1, 3)
        bpy.data.objects.remove(obj)

    note("loose", mesh_cloth([*quad, (5, 5, 5), (6, 6, 6)], [(0, 1, 2, 3)], [(4, 5)]))
    note("no faces", mesh_cloth([(0, 0, 0), (1, 0, 0)], [], [(0, 1)]))
    note("empty", mesh_cloth([], []))
    note("flat", mesh_cloth([*quad, (2, 0, 0), (3, 0, 0), (4, 0, 0)], [(0, 1, 2, 3), (4, 5, 6)]))
    note("short", mesh_cloth([*quad, (0, 1, 0)], [(0, 1, 2, 3), (0, 3, 4)]))
    note("nan", mesh_cloth([*quad[:3], (float("nan"), 0, 0)], [(0, 1, 2, 3)]))

    obj = mesh_cloth(quad, [(0, 1, 2, 3)])
    obj.scale.z = 0.0
    obj.scale.x = 0.0
    bpy.context.view_layer.update()
    note("scale", obj)
    obj = mesh_cloth(quad, [(0, 1, 2, 3)])
    obj.boucle.pin_group = "Nowhere"
    note("group", obj)
    obj = mesh_cloth(quad, [(0, 1, 2, 3)])
    obj.boucle.frame_end = -5
    note("range", obj)
    obj = mesh_cloth(quad, [(0, 1, 2, 3)])
    obj.boucle.substeps, obj.boucle.time_step = 10, 0.001
    note("two steps", obj)
    obj = mesh_cloth(quad, [(0, 1, 2, 3)])
    obj.boucle.integrator = "symplectic_euler"
    obj.boucle.substeps, obj.boucle.stretch = 1, 1e6
    note("unstable", obj)
    obj = mesh_cloth(quad, [(0, 1, 2, 3)])
    obj.modifiers.new("Subsurf", "SUBSURF")
    obj.modifiers.move(2, 0)
    note("above", obj)
    obj = mesh_cloth(quad, [(0, 1, 2, 3)])
    group = bpy.data.node_groups.new("Doubling", "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    nodes = [
        group.nodes.new(n)
        for n in ("NodeGroupInput", "GeometryNodeSubdivideMesh", "NodeGroupOutput")
    ]
    group.links.new(nodes[0].outputs[0], nodes[1].inputs[0])
    group.links.new(nodes[1].outputs[0], nodes[2].inputs[0])
    obj.modifiers.new("Doubling", "NODES").node_group = group
    obj.modifiers.move(2, 0)
    note("nodes above", obj)
    obj = mesh_cloth(quad, [(0, 1, 2, 3)])
    obj.hide_viewport = True
    note("hidden", obj)
    good = add_cloth(end=3)
    return out, list(bpy.ops.boucle.bake()), good.boucle.status


def test_what_cannot_be_simulated_is_refused_in_one_sentence_with_its_culprits(blender):
    found, done, status = blender.run(refuse)
    assert done == ["FINISHED"] and status.startswith("Baked")
    words = {
        "loose": "2 vertices that no face uses (4, 5): delete them",
        "no faces": "no faces",
        "empty": "no faces",
        "flat": "3 vertices on faces of no area (4, 5, 6)",
        "short": "2 vertices on edges of no length (3, 4)",
        "nan": "1 vertex with a position that is no number (3)",
        "scale": "flattens it",
        "group": 'Pin Group "Nowhere" is not a vertex group',
        "range": "the end frame is -5, before the start frame 1",
        "two steps": "Substeps is 10 and Time Step is 0.001 s",
        "unstable": "substeps",
        "above": 'the modifier "Subsurf" stands above',
        "nodes above": 'the modifiers above Boucle\'s ("Doubling")',
        "hidden": "hidden",
    }
    for name, part in words.items():
        said, status, modifiers, _ = found[name]
        assert part in said, (name, said)
        assert "Traceback" not in said and len(said.strip().splitlines()) == 1, name
        assert '"Bad"' in said or name == "unstable", name
        assert status in said, (name, status)
        assert modifiers[:2] == ["Boucle Target", "Boucle Cache"] or "above" in name
    assert found["loose"][3] == [4, 5]
    assert found["flat"][3] == [4, 5, 6]
    assert found["short"][3] == [0, 3, 4]
    assert found["nan"][3] == [3]


def diverge():
    import bpy
    from cloths import add_diverging_cloth, refusal_of, shown_positions

    obj = add_diverging_cloth()
    said = refusal_of(bpy.ops.boucle.bake)
    status = obj.boucle.status
    bpy.context.scene.frame_set(2)
    shown = shown_positions(obj)
    path = bpy.path.abspath(obj.modifiers["Boucle Cache"].filepath)
    samples = struct.unpack("<12siiffi", Path(path).read_bytes()[:32])[-1]
    obj.boucle.substeps, obj.boucle.stretch, obj.boucle.shear = 0, 500.0, 100.0
    return [said, status, samples, all(abs(v) < 1e9 for v in shown), list(bpy.ops.boucle.bake())]


def test_a_bake_that_diverges_keeps_the_frames_before_it(blender):
    said, status, samples, finite, later = blender.run(diverge)
    assert "diverged at frame" in said and "are kept" in said
    frame = int(said.split("diverged at frame ")[1].split(",")[0])
    assert samples == frame - 1 >= 2
    assert status.startswith(f"Partly baked: frames 1 to {samples} of 20")
    assert finite and later == ["FINISHED"]


def fault():
    import bpy
    from cloths import add_cloth, addon, refusal_of

    obj = add_cloth(end=10)
    native, simulation = addon("native"), addon("bridge.simulation")
    real = native.simulation

    class Broken:
        def __init__(self, solver):
            self._solver = solver

        def __getattr__(self, name):
            return getattr(self._solver, name)

        def advance(self):
            if self._solver.frame == 4:
                raise native.InternalError("a fault of Boucle's own: on purpose")
            return self._solver.advance()

    native.simulation = lambda *a: Broken(real(*a))
    assert simulation.native is native
    said = refusal_of(bpy.ops.boucle.bake)
    status = obj.boucle.status
    native.simulation = real
    return [said, status, list(bpy.ops.boucle.bake()), obj.boucle.status]


def test_a_fault_of_the_solver_ends_the_bake_and_nothing_else(blender):
    said, status, later, final = blender.run(fault)
    assert "on purpose" in said and "frames up to 4 are kept" in said
    assert status.startswith("Partly baked: frames 1 to 4 of 10")
    assert later == ["FINISHED"] and final.startswith("Baked: frames 1 to 10")


def full_disk(folder):
    import bpy
    from cloths import add_cloth, refusal_of

    obj = add_cloth(end=10)
    blocked = os.path.join(folder, "boucle_cache")
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    Path(blocked).write_text("in the way")
    said = refusal_of(bpy.ops.boucle.bake)
    status = obj.boucle.status
    os.remove(blocked)
    return [said, status, list(bpy.ops.boucle.bake())]


def test_a_cache_that_cannot_be_written_is_named(blender):
    said, status, later = blender.run(full_disk, folder=blender.folder)
    assert "boucle_cache" in said and "cannot be written" in said
    assert status in said
    assert later == ["FINISHED"]


def damage(folder):
    import bpy
    from cloths import add_cloth, mesh_positions, refusal_of, shown_positions

    obj = add_cloth(end=6)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "a.blend"))
    bpy.ops.boucle.bake()
    path = bpy.path.abspath(obj.modifiers["Boucle Cache"].filepath)
    whole = Path(path).read_bytes()
    out = {}

    def note(name):
        bpy.context.scene.frame_set(3)
        bpy.context.scene.frame_set(5)
        out[name] = [obj.boucle.status, len(shown_positions(obj)) == len(mesh_positions(obj))]

    os.rename(path, path + ".away")
    note("missing")
    for name, data in {
        "truncated": whole[:-700],
        "no pc2": b"hello" * 100,
        "short": whole[:20],
        "other mesh": whole[:16] + struct.pack("<i", 40) + whole[20:],
        "no frame": whole[:28] + struct.pack("<i", 0) + whole[32:],
    }.items():
        Path(path).write_bytes(data)
        note(name)
    bpy.ops.boucle.check()
    checked = obj.boucle.status
    Path(path).write_bytes(whole)
    note("whole")
    checkpoint = path.replace(".pc2", ".checkpoint")
    state = Path(checkpoint).read_bytes()
    refusals = []
    for data in (state[:-9], b"x" * 50, state[:-1] + bytes([state[-1] ^ 1])):
        Path(checkpoint).write_bytes(data)
        obj.boucle.frame_end = 8
        refusals.append(refusal_of(bpy.ops.boucle.bake, resume=True))
    Path(checkpoint).write_bytes(state)
    obj.boucle.shear = 50.0
    refusals.append(refusal_of(bpy.ops.boucle.bake, resume=True))
    still = Path(path).read_bytes() == whole
    return out, checked, refusals, still


def test_a_missing_or_damaged_cache_is_said_in_words(blender):
    found, checked, refusals, still = blender.run(damage, folder=blender.folder)
    words = {
        "missing": "is missing",
        "truncated": "is truncated: 4 of 6 frames",
        "no pc2": "is not a PC2 file",
        "short": "is not a PC2 file",
        "other mesh": "holds 40 vertices and the mesh has 48",
        "no frame": "holds no frame",
        "whole": "Baked: frames 1 to 6",
    }
    for name, part in words.items():
        assert part in found[name][0], (name, found[name])
        assert found[name][1], name
    assert "holds no frame" in checked
    assert all("checkpoint" in said for said in refusals), refusals
    assert "other settings" in refusals[-1]
    assert still


def ngons():
    import math

    import bpy
    from cloths import shown_positions

    ring = [(math.cos(k * math.pi / 3), math.sin(k * math.pi / 3), 0.0) for k in range(6)]
    mesh = bpy.data.meshes.new("Hexagon")
    mesh.from_pydata([*ring, (2.0, 0.8, 0.0)], [], [(0, 1, 2, 3, 4, 5), (0, 6, 1)])
    obj = bpy.data.objects.new("Hexagon", mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.vertex_groups.new(name="Held").add([2, 3], 1.0, "REPLACE")
    bpy.ops.boucle.enable()
    obj.boucle.pin_group = "Held"
    obj.boucle.frame_end = 6
    bpy.ops.boucle.bake()
    bpy.context.scene.frame_set(6)
    return [obj.boucle.status, shown_positions(obj)]


def test_polygons_of_many_corners_are_cloth_too(blender):
    status, positions = blender.run(ngons)
    assert status.startswith("Baked: frames 1 to 6")
    assert positions[2 * 3 + 2] == positions[3 * 3 + 2] == 0.0
    assert positions[6 * 3 + 2] < -0.01


def two_cloths():
    import bpy
    from cloths import add_cloth

    one = add_cloth(end=6)
    two = add_cloth(end=9)
    two.boucle.frame_start = 3
    done = bpy.ops.boucle.bake_all()
    bpy.data.objects.remove(two)
    bpy.data.objects.remove(one)
    return [list(done), bpy.ops.boucle.bake_all.poll()]


def test_bake_all_bakes_every_cloth_of_the_scene(blender):
    assert blender.run(two_cloths) == [["FINISHED"], False]


def wind_and_gravity():
    import bpy
    from cloths import add_cloth, shown_positions

    def end(**values):
        obj = add_cloth(end=10, **values)
        for name in values:
            assert getattr(obj.boucle, name) is not None
        bpy.ops.boucle.bake()
        bpy.context.scene.frame_set(10)
        out = shown_positions(obj)
        bpy.data.objects.remove(obj)
        return out

    still = end()
    blown = end(use_wind=True, wind_velocity=(0.0, 5.0, 0.0), wind_coefficient=0.01)
    pressed = end(use_wind=True, wind_law="face", wind_velocity=(0.0, 5.0, 0.0))
    bpy.context.scene.use_gravity = False
    floating = end()
    return {
        "still": max(abs(y) for y in still[1::3]),
        "blown": sum(blown[1::3]),
        "pressed": sum(pressed[1::3]),
        "fall": still[2],
        "floating": floating[2],
    }


def test_gravity_is_the_scenes_and_wind_blows_along_its_velocity(blender):
    result = blender.run(wind_and_gravity)
    assert result["still"] < 1e-6
    assert result["blown"] > 0.1 and result["pressed"] > 0.1
    assert result["fall"] < -0.5
    assert result["floating"] == -0.5
