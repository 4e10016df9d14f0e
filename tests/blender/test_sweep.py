"""scripts/sweep.py on a .blend: parameters by data path, each run in a Blender of its own, the file left as it is."""

import json
import os
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
DATA_PATH = 'objects["Cloth"].boucle.shear'


def make_file(path, end="6"):
    import bpy
    from cloths import add_cloth

    cloth = add_cloth(end=int(end))
    cloth["size"] = 2.0
    ball = bpy.data.objects.new("Ball", bpy.data.meshes.new("Ball"))
    bpy.context.scene.collection.objects.link(ball)
    ball.location = (1.0, 2.0, 3.0)
    ball.keyframe_insert("scale", index=0, frame=1)
    bpy.ops.wm.save_as_mainfile(filepath=path)


def change_settings(path, scripts, words):
    """Set what the words say one after another; return values before, after and restored, or the refusals."""
    import bpy

    sys.path.append(scripts)
    import blend_settings

    bpy.ops.wm.open_mainfile(filepath=path)

    def state():
        ball, cloth = bpy.data.objects["Ball"], bpy.data.objects["Cloth"]
        scene = bpy.data.scenes[0]
        numbers = [*ball.location, *scene.gravity, cloth["size"], cloth.boucle.shear]
        return [
            *(round(number, 4) for number in numbers),
            cloth.boucle.integrator,
            sorted(ball.lock_location),
            ball.display_type,
            ball.hide_render,
        ]

    before = state()
    found = []
    for word in json.loads(words):
        try:
            kept = blend_settings.change([word])
        except blend_settings.WrongInput as wrong:
            found.append(str(wrong))
            continue
        found.append(state())
        for setting, value in reversed(kept):
            setting.write(value)
        assert state() == before, word
    return before, found


def run_sweep(*words, code=0):
    command = [sys.executable, str(ROOT / "scripts" / "sweep.py"), *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == code, done.stdout + done.stderr
    assert all(line.startswith("sweep.py: ") for line in done.stderr.splitlines()), done.stderr
    return done


def outcome(folder):
    return json.loads((folder / "run.json").read_text())


def last_sample(path):
    data = path.read_bytes()
    _, _, count, _, _, samples = struct.unpack("<12siiffi", data[:32])
    return data[32 + 12 * count * (samples - 1) :]


@pytest.fixture
def shot(new_blender):
    path = new_blender.folder / "shot.blend"
    new_blender.run(make_file, path=path)
    return path


def test_a_data_path_sets_what_it_names_and_can_be_taken_back(new_blender, shot):
    changes = {
        'objects["Ball"].location[2] = 7': (2, 7.0),
        'bpy.data.objects["Ball"].location=[4, 5.5, 6]': (1, 5.5),
        'scenes["Scene"].gravity[0]=-2.5': (3, -2.5),
        "scenes[0].gravity=[0, 0, -1]": (5, -1.0),
        'objects["Cloth"]["size"]=3': (6, 3.0),
        'objects["Cloth"].boucle.shear=40': (7, 40.0),
        "Cloth.shear=41": (7, 41.0),
        "objects[\"Cloth\"].boucle.integrator='verlet'": (8, "verlet"),
        'objects["Ball"].lock_location=[true, false, true]': (9, [False, True, True]),
        "objects[\"Ball\"].display_type='WIRE'": (10, "WIRE"),
        'objects["Ball"].hide_render=true': (11, True),
    }
    words = json.dumps(list(changes))
    before, found = new_blender.run(
        change_settings, path=shot, scripts=ROOT / "scripts", words=words
    )
    for (word, (index, value)), after in zip(changes.items(), found, strict=True):
        assert isinstance(after, list), after
        assert after[index] == value, word
        assert before[index] != value, word


def test_a_data_path_that_leads_nowhere_is_told_in_one_line(new_blender, shot):
    refusals = {
        'objects["Nobody"].location=1': 'there is no "Nobody"; accepted: "Ball", "Cloth"',
        'objects["Ball"].locatoin=1': 'there is no "locatoin"; accepted: "location"',
        'objects["Ball"].location[5]=1': 'there is no "5"',
        'objects["Ball"].location[0]=nan': "accepted: a number from",
        'objects["Ball"].location="x"': "accepted: a number from",
        'objects["Ball"].hide_render=3': "accepted: true or false",
        'objects["Ball"].parent.location=[1, 2, 3]': '"parent" is empty',
        'objects["Ball"].data=3': '"data" cannot be set',
        'objects["Ball"].name="x"': '"name" cannot be set',
        'objects["Ball"].matrix_world.foo=3': 'there is no "foo"',
        "objects[\"Ball\"].display_type='MAGIC'": "is not accepted",
        'objects["Ball"].scale[0]=2': "its keys or its driver would set it back at every frame",
        'objects["Cloth"]["size"]="big"': "accepted: a number",
        'objects["Cloth"]["sizes"]=1': 'there is no "sizes"',
        'objects["Ball"].location': "the data path cannot be read",
        'objects["Ball"](3)=1': "the data path cannot be read",
        'objects["Ball"].location=maybe': "maybe is no TOML value",
        'objects["Cloth"].boucle.shear=-1': "accepted: a number from 0 to",
    }
    words = json.dumps(list(refusals))
    _, found = new_blender.run(change_settings, path=shot, scripts=ROOT / "scripts", words=words)
    for (word, part), said in zip(refusals.items(), found, strict=True):
        assert isinstance(said, str), word
        assert said.startswith(f"--set {word}"), said
        assert part in said, said
        assert "accepted" in said and "\n" not in said


def test_a_blend_is_swept_and_each_run_is_what_bake_makes_of_it(new_blender, shot):
    folder = new_blender.folder
    before = shot.read_bytes()
    path = folder / "sweep.toml"
    path.write_text(
        '[sweep]\nscene = "shot.blend"\nmethod = "grid"\n[parameters]\n'
        f"'{DATA_PATH}' = [5, 80.5]\n'scenes[\"Scene\"].gravity[0]' = [0, 4]\n"
    )
    run_sweep(path, "--out", folder / "out", "--table", "csv")
    assert shot.read_bytes() == before
    runs = folder / "out" / "runs"
    assert sorted(run.name for run in runs.iterdir()) == ["000", "001", "002", "003"]
    for run in runs.iterdir():
        assert sorted(path.name for path in run.iterdir()) == [
            "Cloth.json", "Cloth.obj", "Cloth.pc2", "report.json", "run.json",
        ]  # fmt: skip
        assert json.loads((run / "report.json").read_text())["threads"] == 1
        assert outcome(run)["certificate"]["frames"] == 6
    assert len({last_sample(run / "Cloth.pc2") for run in runs.iterdir()}) == 4
    words = [f"{DATA_PATH}=80.5", 'scenes["Scene"].gravity[0]=4']
    command = [sys.executable, str(ROOT / "scripts" / "bake.py"), str(shot), "--quiet"]
    command += ["--out", str(folder / "single"), "--set", *words]
    assert subprocess.run(command, timeout=120, check=False).returncode == 0
    assert (runs / "003" / "Cloth.pc2").read_bytes() == (
        folder / "single" / "Cloth.pc2"
    ).read_bytes()
    header, *rows = (folder / "out" / "table.csv").read_text().splitlines()
    assert DATA_PATH.replace('"', '""') in header and len(rows) == 4
    assert (folder / "out" / "contact_sheet.png").stat().st_size > 1000


def test_a_killed_blender_and_a_wrong_run_lose_nothing_else(new_blender):
    import psutil

    folder = new_blender.folder
    shot = folder / "shot.blend"
    new_blender.run(make_file, path=shot, end="400")
    path = folder / "sweep.toml"
    path.write_text(
        '[sweep]\nscene = "shot.blend"\nmethod = "list"\n'
        + "".join(f"[[run]]\n'{DATA_PATH}' = {value}\n" for value in (5, -1, 10))
    )
    command = [sys.executable, str(ROOT / "scripts" / "sweep.py"), str(path)]
    command += ["--out", str(folder / "out"), "--workers", "1"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        until = time.monotonic() + 100
        while not list(folder.glob("out/parts/*/000.*/Cloth.pc2")):
            assert time.monotonic() < until and process.poll() is None
            time.sleep(0.02)
        blenders = [
            child
            for child in psutil.Process(process.pid).children(recursive=True)
            if "blend_bake.py" in " ".join(child.cmdline())
        ]
        assert len(blenders) == 1
        os.kill(blenders[0].pid, signal.SIGKILL)
        _, errors = process.communicate(timeout=200)
        assert process.returncode == 3, errors
    assert sorted(run.name for run in (folder / "out" / "runs").iterdir()) == ["002"]
    assert "exit code -9" in outcome(folder / "out" / "failed" / "000")["error"]
    assert "accepted: a number from 0 to" in outcome(folder / "out" / "failed" / "001")["error"]
    run_sweep(path, "--out", folder / "out", "--resume", "--quiet", code=3)
    assert sorted(run.name for run in (folder / "out" / "runs").iterdir()) == ["000", "002"]


def test_blenders_end_when_the_sweep_is_killed(new_blender):
    import psutil

    folder = new_blender.folder
    shot = folder / "shot.blend"
    new_blender.run(make_file, path=shot, end="100000")
    path = folder / "sweep.toml"
    path.write_text(
        f'[sweep]\nscene = "shot.blend"\nmethod = "list"\n[[run]]\n\'{DATA_PATH}\' = 5\n'
    )
    command = [sys.executable, str(ROOT / "scripts" / "sweep.py"), str(path)]
    with subprocess.Popen([*command, "--out", str(folder / "out"), "--workers", "1"]) as process:
        until = time.monotonic() + 100
        while not list(folder.glob("out/parts/*/000.*/Cloth.pc2")):
            assert time.monotonic() < until and process.poll() is None
            time.sleep(0.02)
        children = psutil.Process(process.pid).children(recursive=True)
        process.kill()
    _, alive = psutil.wait_procs(children, timeout=20)
    assert alive == []


def play_run(new_blender, *words, code=0, file=None):
    """Run scripts/play_run.py as another Blender without the add-on would."""
    program = (
        "import runpy, sys, bpy\n"
        "bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)\n"
        "if sys.argv[1]: bpy.ops.wm.open_mainfile(filepath=sys.argv[1])\n"
        "sys.argv = ['blender', '--', *sys.argv[3:]]\n"
        f"runpy.run_path({str(ROOT / 'scripts' / 'play_run.py')!r}, run_name='__main__')\n"
    )
    command = [new_blender.python, "-c", program, str(file or ""), "--", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)
    assert done.returncode == code, done.stdout + done.stderr
    return done


def shown(path, name, frame):
    """What a file shows of an object, and which modifier plays it, without the add-on."""
    import bpy
    from cloths import shown_positions

    bpy.ops.wm.open_mainfile(filepath=path)
    bpy.context.scene.frame_set(int(frame))
    obj = bpy.data.objects[name]
    caches = [modifier for modifier in obj.modifiers if modifier.type == "MESH_CACHE"]
    return (
        shown_positions(obj),
        [modifier.filepath for modifier in caches],
        bpy.context.scene.frame_end,
    )


@pytest.mark.parametrize("kind", ["blend", "toml"])
def test_a_run_plays_without_the_add_on(new_blender, kind):
    folder = new_blender.folder
    if kind == "blend":
        new_blender.run(make_file, path=folder / "shot.blend")
        scene, name, key = "shot.blend", "Cloth", DATA_PATH
    else:
        scene, name, key = (
            str(ROOT / "tests" / "scenes" / "curtain.toml"),
            "curtain",
            "cloth.0.density",
        )
    small = "" if kind == "blend" else '"cloth.0.grid.vertices" = [9, 7]\n"scene.frames" = [3, 8]\n'
    path = folder / "sweep.toml"
    path.write_text(f"[sweep]\nscene = '{scene}'\nmethod = 'list'\n[[run]]\n'{key}' = 0.5\n{small}")
    run_sweep(path, "--out", folder / "out")
    run = folder / "out" / "runs" / "000"
    file = folder / "shot.blend" if kind == "blend" else None
    done = play_run(new_blender, run, "--save", folder / "out" / "played.blend", file=file)
    first, last = (1, 6) if kind == "blend" else (3, 8)
    assert f"frames {first} to {last}" in done.stdout
    positions, paths, end = new_blender.run(
        shown, addon=False, path=folder / "out" / "played.blend", name=name, frame=last
    )
    expected = struct.unpack(f"<{len(positions)}f", last_sample(run / f"{name}.pc2"))
    assert max(abs(a - b) for a, b in zip(positions, expected, strict=True)) < 1e-6
    assert paths == [f"//runs/000/{name}.pc2"]
    assert kind == "blend" or end == last
    before, _, _ = new_blender.run(
        shown, addon=False, path=folder / "out" / "played.blend", name=name, frame=first
    )
    assert max(abs(a - b) for a, b in zip(before, expected, strict=True)) > 1e-3


def make_shot(path):
    """A cloth before a camera, to be rendered small."""
    import bpy

    make_file(path, end="10")
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler = (0.0, -4.0, -0.3), (1.5708, 0.0, 0.0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.rotation_euler, sun.data.energy = (1.0, 0.0, 0.0), 3.0
    scene.collection.objects.link(sun)
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    scene.render.resolution_x = scene.render.resolution_y = 48
    scene.render.filepath = "//frames/"
    scene.frame_start, scene.frame_end, scene.frame_step = 1, 10, 9
    scene.world = bpy.data.worlds.new("World")
    bpy.ops.wm.save_as_mainfile(filepath=path)


def test_a_run_is_rendered_without_the_add_on(new_blender):
    from PIL import Image, ImageChops

    folder = new_blender.folder
    new_blender.run(make_shot, path=folder / "shot.blend")
    path = folder / "sweep.toml"
    head = "[sweep]\nscene = 'shot.blend'\nmethod = 'list'\nset = { 'scenes[0].gravity' = [6, 0, 0] }\n"
    path.write_text(f"{head}[[run]]\n'{DATA_PATH}' = 5\n")
    run_sweep(path, "--out", folder / "out", "--no-sheet")
    run = folder / "out" / "runs" / "000"
    play_run(new_blender, run, "--render-anim", file=folder / "shot.blend")
    frames = sorted((folder / "frames").iterdir())
    assert [frame.name for frame in frames] == ["0001.png", "0010.png"]
    with Image.open(frames[0]) as first, Image.open(frames[1]) as last:
        changed = ImageChops.difference(first.convert("L"), last.convert("L"))
    assert np.count_nonzero(np.asarray(changed) > 20) > 20, "the cloth has moved"


def test_what_cannot_be_played_is_told_in_one_line(new_blender, shot):
    folder = new_blender.folder
    said = play_run(new_blender, folder, code=2).stderr
    assert "holds no PC2; accepted: a bake's folder" in said
    header = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, 3, 1.0, 1.0, 2)
    (folder / "Cloth.pc2").write_bytes(header + bytes(40))
    assert "Cloth.pc2 is torn or empty" in play_run(new_blender, folder, code=2).stderr
    (folder / "Cloth.pc2").write_bytes(header + bytes(72))
    said = play_run(new_blender, folder, code=2, file=shot).stderr
    assert 'has 3 vertices and the object "Cloth" 48; accepted: the mesh that was baked' in said
