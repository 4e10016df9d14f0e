"""Play a bake's caches in a Blender that has no add-on: Mesh Cache modifiers and nothing else.

```sh
blender --background shot.blend --python scripts/play_run.py -- out/runs/003 --render-anim
blender --background --python scripts/play_run.py -- out/runs/003 --save out/003.blend
```

FOLDER is what `bake.py --out` or a run of `sweep.py` left. A cache NAME.pc2 is played by the object NAME of the file that
is open (of a swept .blend, where the cache is in the object's own space); where there is none, by a new object made of
NAME.obj (of a TOML scene, in world space). Needs Blender 4.2 or later, no package and no other file of ours.

`--save FILE.blend` keeps the file, with the caches' paths relative to it; `--render-anim` renders the scene's frames as it
stands.
Exit codes: 0 done; 2 the input is wrong, told in one line.
"""

from __future__ import annotations

import argparse
import os
import re
import struct
import sys
from pathlib import Path
from typing import Any

HEADER = struct.Struct("<12siiffi")
MODIFIER = "Boucle Cache"


class WrongInput(Exception):
    """A cache cannot be played; one sentence."""


def file_name(name: str) -> str:
    """An object's name as a bake makes a file name of it."""
    return re.sub(r'[<>:"/\\|?*\x00-\x1f]', "_", name)


def read_header(cache: Path) -> tuple[int, float, int]:
    """Vertices, first frame and number of frames of a PC2."""
    try:
        with cache.open("rb") as file:
            magic, _, vertices, start, _, samples = HEADER.unpack(file.read(HEADER.size))
    except (OSError, struct.error) as error:
        raise WrongInput(f"{cache} cannot be read ({error}); accepted: a whole PC2") from error
    size = HEADER.size + 12 * vertices * samples
    if magic != b"POINTCACHE2\0" or samples < 1 or cache.stat().st_size < size:
        raise WrongInput(f"{cache} is torn or empty; accepted: a whole PC2")
    return vertices, start, samples


def object_of(cache: Path, vertices: int) -> Any:
    """The object that plays a cache."""
    import bpy

    for obj in bpy.data.objects:
        if obj.type == "MESH" and file_name(obj.name) == cache.stem:
            break
    else:
        obj = new_object(cache.with_suffix(".obj"))
    if len(obj.data.vertices) != vertices:
        raise WrongInput(
            f'{cache} has {vertices} vertices and the object "{obj.name}" {len(obj.data.vertices)}; '
            "accepted: the mesh that was baked"
        )
    return obj


def new_object(path: Path) -> Any:
    """An object made of a rest mesh, vertex by vertex; Blender's own importer would turn it."""
    import bpy

    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise WrongInput(
            f"{path} cannot be read ({error.strerror}); accepted: a bake's folder"
        ) from error
    words = [line.split() for line in lines]
    positions = [tuple(map(float, line[1:4])) for line in words if line[:1] == ["v"]]
    faces = [
        [int(corner.partition("/")[0]) - 1 for corner in line[1:]]
        for line in words
        if line[:1] == ["f"]
    ]
    mesh = bpy.data.meshes.new(path.stem)
    mesh.from_pydata(positions, [], faces)
    mesh.shade_smooth()
    obj = bpy.data.objects.new(path.stem, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def play(obj: Any, cache: Path, first: float) -> None:
    """Let an object's Mesh Cache play a PC2: the one that the add-on has put into its stack, or a new one."""
    known = [m for m in obj.modifiers if m.type == "MESH_CACHE" and m.name.startswith(MODIFIER)]
    modifier = known[0] if known else obj.modifiers.new(MODIFIER, "MESH_CACHE")
    modifier.filepath = str(cache.resolve())
    modifier.cache_format = "PC2"
    modifier.time_mode = "FRAME"
    modifier.play_mode = "SCENE"
    modifier.deform_mode = "OVERWRITE"
    modifier.interpolation = "LINEAR"
    modifier.frame_start = first  # in this mode Blender does not read it from the file
    modifier.frame_scale = modifier.factor = 1.0
    modifier.show_viewport = modifier.show_render = True


def run(words: list[str]) -> None:
    """Do what the words after -- ask for."""
    import bpy

    lines = argparse.ArgumentParser(prog="play_run.py", description=__doc__)
    lines.add_argument("folder", type=Path, metavar="FOLDER")
    lines.add_argument("--save", type=Path, metavar="FILE.blend")
    lines.add_argument("--render-anim", action="store_true")
    options = lines.parse_args(words)
    caches = sorted(options.folder.glob("*.pc2"))
    if not caches:
        raise WrongInput(f"{options.folder} holds no PC2; accepted: a bake's folder")
    scene = bpy.context.scene
    for cache in caches:
        vertices, first, samples = read_header(cache)
        obj = object_of(cache, vertices)
        play(obj, cache, first)
        print(f'"{obj.name}" plays {cache}, frames {first:.0f} to {first + samples - 1:.0f}')
        if not bpy.data.filepath:
            scene.frame_start = min(scene.frame_start, int(first))
            scene.frame_end = int(first) + samples - 1
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(options.save.resolve()), relative_remap=True)
        bpy.ops.file.make_paths_relative()
        bpy.ops.wm.save_mainfile()
    if options.render_anim:
        bpy.ops.render.render(animation=True)


if __name__ == "__main__":
    code = 0
    try:
        run(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:])
    except WrongInput as wrong:
        print(f"play_run.py: {wrong}", file=sys.stderr)
        code = 2
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # some renders hang when Blender ends
