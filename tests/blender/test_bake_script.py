"""scripts/bake.py on a .blend: every Boucle cloth, with the contract's files and exit codes."""

import json
import os
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EXPLICIT = "Cloth.integrator='symplectic_euler'"
"""For what only steps that are too long can do."""
HEADER = struct.Struct("<12siiffi")


def make_file(path, columns, end, cloths="1"):
    import bpy
    from cloths import add_cloth

    for number in range(int(cloths)):
        obj = add_cloth(columns=int(columns), rows=int(columns), end=int(end))
        obj.location.y = float(number)
        obj.rotation_euler.z = 0.3
    bpy.context.scene.frame_set(1)
    bpy.ops.wm.save_as_mainfile(filepath=path)


def make_named_file(path, names):
    import bpy
    from cloths import add_cloth

    for name in names.split("|"):
        add_cloth(end=4).name = name
    bpy.ops.wm.save_as_mainfile(filepath=path)


def settings_of(path):
    import bpy

    bpy.ops.wm.open_mainfile(filepath=path)
    cloth = bpy.data.objects["Cloth"]
    cache = cloth.modifiers.get("Boucle Cache")
    values = {key: getattr(cloth.boucle, key) for key in ("shear", "limiter", "substeps")}
    return {
        **values,
        "wind_velocity": list(cloth.boucle.wind_velocity),
        "status": cloth.boucle.status,
        "played": cache.filepath if cache else "",
    }


def make_empty_file(path):
    import bpy

    bpy.ops.mesh.primitive_plane_add()
    bpy.ops.wm.save_as_mainfile(filepath=path)


def look(path):
    import bpy
    from cloths import shown_positions

    bpy.ops.wm.open_mainfile(filepath=path)
    out = []
    for obj in sorted(bpy.data.objects, key=lambda obj: obj.name):
        if obj.type == "MESH":
            bpy.context.scene.frame_set(8)
            out.append([obj.name, obj.modifiers["Boucle Cache"].filepath, shown_positions(obj)])
    return out


def bake(*words, check=0, failures=1):
    command = [sys.executable, str(ROOT / "scripts" / "bake.py"), *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=180, check=False)
    assert done.returncode == check, done.stdout + done.stderr
    assert "Traceback" not in done.stderr
    if check == 2 and failures == 1:
        ours = [line for line in done.stderr.splitlines() if line.startswith("bake.py: ")]
        assert len(ours) == 1, done.stderr
    return done


def samples(path):
    return HEADER.unpack(path.read_bytes()[: HEADER.size])


def test_a_folder_gets_pc2_obj_report_and_checkpoint_and_the_file_stays_as_it_was(new_blender):
    path = new_blender.folder / "shot.blend"
    out = new_blender.folder / "out"
    new_blender.run(make_file, path=path, columns=8, end=10, cloths=2)
    before = path.read_bytes()
    done = bake(path, "--out", out)
    assert path.read_bytes() == before
    assert sorted(p.name for p in out.iterdir()) == [
        "Cloth.001.checkpoint", "Cloth.001.json", "Cloth.001.obj", "Cloth.001.pc2",
        "Cloth.checkpoint", "Cloth.json", "Cloth.obj", "Cloth.pc2", "report.json",
    ]  # fmt: skip
    assert "2 cloths baked" in done.stdout
    assert samples(out / "Cloth.pc2") == (b"POINTCACHE2\0", 1, 64, 1.0, 1.0, 10)
    report = json.loads((out / "report.json").read_text())
    assert [cloth["name"] for cloth in report["cloths"]] == ["Cloth", "Cloth.001"]
    assert [row["frame"] for row in report["frames"]] == list(range(1, 11))
    assert report["scene"].endswith("shot.blend")
    assert report["hash_algorithm"] == "xxh3-64"
    first = struct.unpack("<192f", (out / "Cloth.pc2").read_bytes()[32 : 32 + 12 * 64])
    vertices = [
        float(word)
        for line in (out / "Cloth.obj").read_text().splitlines()
        if line.startswith("v ")
        for word in line.split()[1:]
    ]
    assert max(abs(a - b) for a, b in zip(first, vertices, strict=True)) < 1e-6
    bake(path, "--out", out, "--quiet")
    assert not [p for p in out.iterdir() if "previous" in p.name]


def test_without_a_folder_each_cloth_gets_its_own_cache_and_the_file_plays_it(new_blender):
    path = new_blender.folder / "shot.blend"
    new_blender.run(make_file, path=path, columns=8, end=10)
    done = bake(path, "--quiet", "--set", "Cloth.shear=40", "Cloth.limiter='none'")
    assert "frame" not in done.stdout.replace("frames", "")
    cache = next((new_blender.folder / "boucle_cache" / "shot").glob("*.pc2"))
    row = json.loads(cache.with_suffix(".json").read_text())["bake"]["settings"]
    assert row["cloth.springs.shear"] == 40.0 and row["cloth.springs.limiter"] == "none"
    name, played, positions = new_blender.run(look, addon=False, path=path)[0]
    assert name == "Cloth" and played == f"//boucle_cache/shot/{cache.name}"
    data = cache.read_bytes()[32 + 7 * 12 * 64 : 32 + 8 * 12 * 64]
    expected = struct.unpack("<192f", data)
    assert max(abs(a - b) for a, b in zip(positions, expected, strict=True)) < 1e-6


def test_the_files_settings_stay_its_own_and_it_is_saved_only_with_frames_to_play(new_blender):
    path = new_blender.folder / "shot.blend"
    new_blender.run(make_file, path=path, columns=8, end=6)
    untouched, own = path.read_bytes(), new_blender.run(settings_of, path=path)
    overrides = ["Cloth.shear=40", "Cloth.limiter='none'", "Cloth.wind_velocity=[1, 2, 3]"]
    bake(path, "--quiet", "--frames", "9:3", "--set", *overrides, check=2)
    bake(path, "--quiet", "--set", *overrides, EXPLICIT, "Cloth.substeps=1", check=2)
    assert path.read_bytes() == untouched
    bake(path, "--quiet", "--set", *overrides)
    after = new_blender.run(settings_of, path=path)
    assert after["played"] and "outdated, changed since" in after["status"]
    assert {**after, "played": "", "status": ""} == {**own, "status": ""}
    wild = [EXPLICIT, "Cloth.stretch=1e6", "Cloth.substeps=1", "Cloth.allow_unstable=true"]
    bake(path, "--quiet", "--set", *wild, "Cloth.frame_end=20", "Cloth.limiter='none'", check=3)
    after = new_blender.run(settings_of, path=path)
    assert {**after, "played": "", "status": ""} == {**own, "status": ""}
    assert "aked: frames 1 to " in after["status"]


def test_cloths_that_would_share_files_are_refused(new_blender):
    path = new_blender.folder / "shot.blend"
    out = new_blender.folder / "out"
    shared = {
        "Cloth|CLOTH": '"Cloth"',
        "report": "the report of all cloths",
        "a:b|a?b": '"a:b"',
        "end.|end": '"end',
        "caf\u00e9|cafe\u0301": '"caf',
    }
    for names, other in shared.items():
        new_blender.run(make_named_file, path=path, names=names)
        done = bake(path, "--out", out, check=2)
        assert "accepted: cloths whose names differ as file names" in done.stderr
        assert other in done.stderr
        assert not out.exists()


def test_frames_keeps_a_range_and_simulates_from_the_start(new_blender):
    path = new_blender.folder / "shot.blend"
    new_blender.run(make_file, path=path, columns=8, end=10)
    whole, part = new_blender.folder / "whole", new_blender.folder / "part"
    bake(path, "--out", whole)
    bake(path, "--out", part, "--frames", "4:7", "--threads", "1")
    assert samples(part / "Cloth.pc2")[3:] == (4.0, 1.0, 4)
    size = 12 * 64
    expected = (whole / "Cloth.pc2").read_bytes()[32 + 3 * size : 32 + 7 * size]
    assert (part / "Cloth.pc2").read_bytes()[32:] == expected
    rows = json.loads((part / "report.json").read_text())["frames"]
    assert [row["frame"] for row in rows] == [4, 5, 6, 7]


def test_a_bake_that_was_interrupted_or_killed_resumes_bit_equal(new_blender):
    path = new_blender.folder / "shot.blend"
    new_blender.run(make_file, path=path, columns=60, end=80)
    whole, part = new_blender.folder / "whole", new_blender.folder / "part"
    bake(path, "--out", whole, "--quiet")
    command = [sys.executable, str(ROOT / "scripts" / "bake.py"), str(path), "--out", str(part)]
    cache = part / "Cloth.pc2"

    def stop(number, count):
        with subprocess.Popen([*command, "--resume"], stdout=subprocess.DEVNULL) as process:
            until = time.monotonic() + 100
            while time.monotonic() < until and process.poll() is None:
                if cache.is_file() and cache.stat().st_size >= 32 and samples(cache)[-1] >= count:
                    process.send_signal(number)
                    break
                time.sleep(0.005)
            return process.wait(timeout=60)

    assert stop(signal.SIGINT, 5) == 130
    kept = samples(cache)[-1]
    assert 5 <= kept < 80
    assert (part / "Cloth.obj").read_bytes() == (whole / "Cloth.obj").read_bytes()
    assert len(json.loads((part / "report.json").read_text())["frames"]) == kept
    assert stop(signal.SIGKILL, kept + 5) == -signal.SIGKILL
    body = cache.read_bytes()
    count = samples(cache)[-1]
    assert (
        body[32 : 32 + count * 12 * 3600]
        == (whole / "Cloth.pc2").read_bytes()[32:][: count * 12 * 3600]
    )
    bake(path, "--out", part, "--resume", "--quiet")
    assert cache.read_bytes() == (whole / "Cloth.pc2").read_bytes()

    def hashes(folder):
        rows = json.loads((folder / "report.json").read_text())["frames"]
        return [(row["frame"], row["hash"]) for row in rows]

    assert hashes(part) == hashes(whole)
    done = bake(path, "--out", part, "--resume", "--set", "Cloth.shear=50", check=2)
    assert "other settings" in done.stderr


def test_wrong_input_is_one_line_that_names_the_culprit(new_blender):
    path = new_blender.folder / "shot.blend"
    new_blender.run(make_file, path=path, columns=8, end=10)
    empty = new_blender.folder / "empty.blend"
    new_blender.run(make_empty_file, path=empty)
    junk = new_blender.folder / "junk.blend"
    junk.write_bytes(b"no blend at all")
    refusals = {
        ("missing.blend",): "missing.blend is missing",
        (junk,): "junk.blend cannot be opened",
        (empty,): "holds no Boucle cloth",
        (path, "--set", "Cloth.stretch=-1"): "accepted: a number from 0 to",
        (path, "--set", "Cloth.stretch=nan"): "accepted: a number from 0 to",
        (path, "--set", "Cloth.strech=1"): '"strech" is no setting',
        (path, "--set", "Nobody.stretch=1"): '"Nobody" is no Boucle cloth; accepted: "Cloth"',
        (path, "--set", "Cloth.limiter='magic'"): "--set Cloth.limiter='magic' is not accepted",
        (path, "--set", "Cloth.stretch=many"): "many is no TOML value",
        (path, "--set", "Cloth.substeps=2.5"): "accepted: a whole number",
        (path, "--set", "Cloth.pin_group='x'"): 'Pin Group "x" is not a vertex group',
        (path, "--frames", "9:3"): "frames 9 to 3",
        (path, "--blender", "/nowhere/blender"): "/nowhere/blender cannot be started",
    }
    for words, part in refusals.items():
        assert part in bake(*words, check=2).stderr, words


def test_divergence_is_exit_code_3_and_a_folder_that_cannot_be_is_4(new_blender):
    path = new_blender.folder / "shot.blend"
    new_blender.run(make_file, path=path, columns=8, end=20)
    out = new_blender.folder / "out"
    wild = [EXPLICIT, "Cloth.stretch=1e6", "Cloth.substeps=1", "Cloth.allow_unstable=true"]
    done = bake(path, "--out", out, "--set", *wild, "Cloth.limiter='none'", check=3)
    assert "diverged at frame" in done.stderr and "are kept" in done.stderr
    assert 2 <= samples(out / "Cloth.pc2")[-1] < 20
    assert (out / "Cloth.obj").read_text().count("\nv ") == 64
    (new_blender.folder / "file").write_text("in the way")
    done = bake(path, "--out", new_blender.folder / "file" / "out", check=4)
    assert "cannot be written" in done.stderr


def test_a_step_that_becomes_unstable_is_exit_code_3_with_the_frames_before_it(new_blender):
    path = new_blender.folder / "shot.blend"
    new_blender.run(make_file, path=path, columns=8, end=60)
    out = new_blender.folder / "out"
    soft = ["Cloth.stretch=20", "Cloth.shear=5", "Cloth.bend=0.5", "Cloth.limiter='stiffen'"]
    words = [path, "--out", out, "--quiet", "--set", EXPLICIT, *soft]
    refused = bake(*words, "Cloth.substeps=1", check=2).stderr
    least = refused.partition("at least ")[2].partition(" ")[0]
    done = bake(*words, f"Cloth.substeps={least}", check=3)
    kept = samples(out / "Cloth.pc2")[-1]
    assert 1 < kept < 60
    assert f"frame {kept + 1} cannot be simulated: solver: the step of " in done.stderr
    assert f"frames up to {kept} are kept" in done.stderr
    assert len(json.loads((out / "report.json").read_text())["frames"]) == kept
    assert (out / "Cloth.checkpoint").is_file()


def test_a_second_bake_into_a_folder_is_refused_until_the_first_has_ended(new_blender):
    path = new_blender.folder / "shot.blend"
    new_blender.run(make_file, path=path, columns=30, end=5000)
    caches = new_blender.folder / "boucle_cache" / "shot"
    for words, folder in ((), caches), (("--out", str(new_blender.folder / "out")), None):
        folder = folder or Path(words[1])
        command = [sys.executable, str(ROOT / "scripts" / "bake.py"), str(path), *words]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL) as first:
            until = time.monotonic() + 60
            while time.monotonic() < until and not list(folder.glob("*.pc2")):
                time.sleep(0.01)
            done = bake(path, *words, check=2)
            assert f"is being baked into by process {first.pid}; accepted" in done.stderr
            first.terminate()
            assert first.wait(timeout=60) == 130
        assert not (folder / "boucle.lock").exists()


def test_the_exit_code_of_two_cloths_is_that_of_the_first_failure(new_blender):
    path = new_blender.folder / "shot.blend"
    out = new_blender.folder / "out"
    new_blender.run(make_file, path=path, columns=8, end=10, cloths=2)

    def wild(name):
        values = ["stretch=1e6", "substeps=1", "allow_unstable=true", "limiter='none'"]
        return [EXPLICIT.replace("Cloth", name), *(f"{name}.{value}" for value in values)]

    def refused(name):
        return [EXPLICIT.replace("Cloth", name), f"{name}.substeps=1"]

    both = [*wild("Cloth"), *refused("Cloth.001")]
    done = bake(path, "--out", out, "--set", *both, check=3)
    assert done.stderr.index("diverged at frame") < done.stderr.index("stability bound")
    both = [*refused("Cloth"), *wild("Cloth.001")]
    done = bake(path, "--out", out, "--set", *both, check=2, failures=2)
    assert done.stderr.index("stability bound") < done.stderr.index("diverged at frame")
    bake(path, "--out", out, "--set", *wild("Cloth"), check=3)
    assert samples(out / "Cloth.001.pc2")[-1] == 10, "the other one is baked all the same"


def stand_in_blender(folder, python):
    """A program that takes Blender's options and runs the bpy package of another Python."""
    script = folder / "stand_in.py"
    script.write_text(
        "import runpy, sys\n"
        "import bpy\n"
        "bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)\n"
        "at = sys.argv.index('--python')\n"
        "assert sys.argv[1:4] == ['--background', '--factory-startup', '--python-exit-code']\n"
        "runpy.run_path(sys.argv[at + 1], run_name='__main__')\n"
    )
    program = folder / "blender"
    program.write_text(f'#!/bin/sh\nexec "{python}" "{script}" "$@"\n')
    program.chmod(0o755)
    return program


def test_another_blender_bakes_in_background_and_refuses_files_from_a_newer_one(blender):
    path = blender.folder / "shot.blend"
    blender.run(make_file, path=path, columns=40, end=60)
    out = blender.folder / "out"
    python_42 = os.environ.get("BOUCLE_BPY42_PYTHON", str(ROOT / ".venv-bpy42" / "bin" / "python"))
    other = stand_in_blender(blender.folder, python_42)
    if blender.version != "4.2":
        done = bake(path, "--out", out, "--blender", other, check=2)
        from_4 = "is from Blender 4.5 and this is Blender 4.2"
        assert (
            from_4 if blender.version == "4.5" else "cannot be opened by Blender 4.2"
        ) in done.stderr
        assert "--blender PATH" in done.stderr
        other = stand_in_blender(blender.folder, blender.python)
    done = bake(path, "--out", out, "--blender", other)
    assert samples(out / "Cloth.pc2")[-1] == 60
    assert "1 cloth baked" in done.stdout
    command = [sys.executable, str(ROOT / "scripts" / "bake.py"), str(path)]
    command += ["--out", str(blender.folder / "stopped"), "--blender", str(other)]
    cache = blender.folder / "stopped" / "Cloth.pc2"
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        until = time.monotonic() + 60
        while time.monotonic() < until and not cache.is_file():
            time.sleep(0.005)
        process.terminate()
        assert process.wait(timeout=60) == 130
    assert 1 <= samples(cache)[-1] < 60
    bake(path, "--out", cache.parent, "--blender", other, "--resume")
    assert cache.read_bytes() == (out / "Cloth.pc2").read_bytes()


def make_torn_file(path):
    import bpy
    from test_tearing import add_torn_cloth

    add_torn_cloth(end=8)
    bpy.ops.wm.save_as_mainfile(filepath=path)


def look_at_torn(path):
    import bpy
    from test_tearing import at_frames

    bpy.ops.wm.open_mainfile(filepath=path)
    seen = at_frames(bpy.data.objects["Cloth"], (1, 8))
    return [[len(look["positions"]) // 3 for look in seen], seen[1]["faces"], seen[1]["positions"]]


def test_torn_cloth_is_left_with_all_its_vertices_in_a_folder_and_in_the_file(new_blender):
    path = new_blender.folder / "torn.blend"
    new_blender.run(make_torn_file, path=path)
    out = new_blender.folder / "out"
    bake(path, "--out", out)
    lines = (out / "Cloth.obj").read_text().splitlines()
    vertices = [line for line in lines if line.startswith("v ")]
    faces = [
        [int(word) - 1 for word in line.split()[1:]] for line in lines if line.startswith("f ")
    ]
    data = (out / "Cloth.pc2").read_bytes()
    head = HEADER.unpack(data[: HEADER.size])
    assert head[2] == len(vertices) == 63 + 9 and head[5] == 8
    bake(path)
    counts, shown, positions = new_blender.run(look_at_torn, path=path)
    assert counts == [63, 72]
    last = struct.unpack(f"<{3 * 72}f", data[-12 * 72 :])
    here = [last[3 * v : 3 * v + 3] for face in faces for v in face]
    there = [positions[3 * v : 3 * v + 3] for face in shown for v in face]
    assert (
        max(
            abs(a - b)
            for one, other in zip(here, there, strict=True)
            for a, b in zip(one, other, strict=True)
        )
        < 1e-6
    )
