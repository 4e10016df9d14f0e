"""Bakes every Boucle cloth of a .blend; runs inside Blender, with the add-on enabled.

Started by another Blender's --python, it enables the add-on itself and tells its events as lines on standard output.
"""

from __future__ import annotations

import importlib
import json
import os
import re
import signal
import sys
import time
import unicodedata
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from typing import Any

if __name__ == "__main__":
    sys.path.append(os.path.dirname(os.path.abspath(__file__)))  # Blender's --python does not

import blend_settings
from blend_settings import WrongInput

MODULE = "bl_ext.user_default.boucle"
MARK = "@boucle "
"""Begins the lines by which a bake in another Blender tells its events."""
DONE, FAULT, WRONG_INPUT, DIVERGED, CACHE, STOPPED = 0, 1, 2, 3, 4, 130
REPORT_SECONDS = 5.0
OLDEST = (4, 2)

Tell = Callable[[Mapping[str, Any]], None]


def addon(name: str) -> Any:
    """A module of the add-on."""
    return importlib.import_module(f"{MODULE}.{name}")


def bake_file(request: Mapping[str, Any], tell: Tell, is_stopped: Callable[[], bool]) -> int:
    """Open the file, bake its cloths and return the exit code."""
    refusal = addon("core.refusal")
    try:
        open_file(request["path"])
        scenes = cloths_by_scene(request["path"])
        if request["out"]:
            refuse_shared_files([cloth.name for cloth, _ in scenes])
        own_values = blend_settings.change(request["overrides"])
        return Baker(request, tell, is_stopped, own_values).bake(scenes)
    except WrongInput as wrong:
        tell({"kind": "complaint", "text": str(wrong)})
        return WRONG_INPUT
    except refusal.CacheRefusal as error:
        tell({"kind": "complaint", "text": str(error)})
        return CACHE
    except refusal.Refusal as error:
        tell({"kind": "complaint", "text": str(error)})
        return WRONG_INPUT


def open_file(path: str) -> None:
    """Open a .blend file of this Blender's version or an older one."""
    import bpy

    try:
        bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    except RuntimeError as error:
        reason = " ".join(str(error).removeprefix("Error: ").split())
        raise WrongInput(
            f"{path} cannot be opened by Blender {bpy.app.version_string} ({reason}); if it is from "
            "a newer Blender, name that one: --blender PATH"
        ) from error
    made_with = tuple(bpy.data.version[:2])
    if made_with > tuple(bpy.app.version[:2]):
        raise WrongInput(
            f"{path} is from Blender {made_with[0]}.{made_with[1]} and this is Blender "
            f"{bpy.app.version_string}; name a Blender that is new enough: --blender PATH"
        )


def cloths_by_scene(path: str) -> list[tuple[Any, Any]]:
    """Every cloth of the file with a scene that it is in."""
    import bpy

    registry = addon("bridge.registry")
    found: list[tuple[Any, Any]] = []
    for scene in bpy.data.scenes:
        known = {cloth.name for cloth, _ in found}
        cloths = [cloth for cloth in registry.cloths_of(scene) if cloth.name not in known]
        found += [(cloth, scene) for cloth in sorted(cloths, key=lambda cloth: cloth.name)]
    if not found:
        raise WrongInput(f"{path} holds no Boucle cloth; accepted: a file with at least one")
    return found


def refuse_shared_files(names: Sequence[str]) -> None:
    """Refuse cloths that would write into each other's files, or into the report of all."""
    known = {"report": ""}
    for name in names:
        other = known.setdefault(file_key(name), name)
        if other != name:
            whose = f'those of the cloth "{other}"' if other else "the report of all cloths"
            raise WrongInput(
                f'the files of the cloth "{name}" in --out would be {whose}; accepted: cloths whose '
                "names differ as file names, in more than case, or a bake without --out"
            )


class Baker:
    """Bakes the cloths of a file: those that collide with each other together, others one after another."""

    def __init__(
        self,
        request: Mapping[str, Any],
        tell: Tell,
        is_stopped: Callable[[], bool],
        own_values: Sequence[tuple[blend_settings.Setting, Any]],
    ) -> None:
        self.request = request
        self.tell = tell
        self.is_stopped = is_stopped
        self.own_values = own_values
        """What --set has changed for this bake, and the file's own value."""
        self.out: str | None = request["out"]
        self.bakes: list[Any] = []
        self._reported = time.monotonic()

    def bake(self, scenes: Sequence[tuple[Any, Any]]) -> int:
        """Bake them all and return the exit code: the first failure's, with the others still baked."""
        preflight = addon("bridge.preflight")
        for cloth, scene in scenes:
            preflight.refuse_errors(cloth, scene)
        code = DONE
        for names, scene_name in self.groups(scenes):
            result = self.bake_together(names, scene_name)
            code = code or result
            if result in {STOPPED, CACHE}:
                break
        if self.out:
            self.write_report()
        elif any(bake.last_frame is not None for bake in self.bakes):
            saved = self.save_file()
            code = code or saved
        if code == DONE:
            where = self.out or "the file's own caches"
            count = "1 cloth" if len(scenes) == 1 else f"{len(scenes)} cloths"
            self.tell({"kind": "sentence", "text": f"{count} baked: {where}"})
        return code

    def groups(self, scenes: Sequence[tuple[Any, Any]]) -> list[tuple[list[str], str]]:
        """Names of cloths that are baked together, with their scene's."""
        out = []
        for scene in dict.fromkeys(scene for _, scene in scenes):
            cloths = [cloth for cloth, of in scenes if of == scene]
            groups, notes = addon("bridge.together").groups(cloths, scene)
            for note in notes:
                self.tell({"kind": "complaint", "text": note})
            out += [([cloth.name for cloth in group], scene.name) for group in groups]
        return out

    def bake_together(self, names: Sequence[str], scene_name: str) -> int:
        """Bake cloths in one simulation, mostly a single one, and return the exit code."""
        import bpy

        native, refusal, bridge = addon("native"), addon("core.refusal"), addon("bridge.bake")
        cloths, scene = [bpy.data.objects[name] for name in names], bpy.data.scenes[scene_name]
        bake = bridge.Bake(cloths, scene, self.options(cloths))
        self.bakes.append(bake)
        count = sum(len(cloth.data.vertices) for cloth in cloths)
        self.tell({"kind": "cloth", "text": f"{bake.title}: {count} vertices"})
        try:
            with closing(bake.steps()) as steps:
                self.pull(bake, steps)
            if self.is_stopped():
                return self.complain(bake, GeneratorExit(), STOPPED)
        except (native.DivergedError, native.UnstableError) as error:
            return self.complain(bake, error, DIVERGED)
        except (refusal.CacheRefusal, OSError) as error:
            return self.complain(bake, error, CACHE)
        except native.InternalError as error:
            return self.complain(bake, error, FAULT)
        except (refusal.Refusal, native.BoucleError) as error:
            return self.complain(bake, error, WRONG_INPUT)
        return DONE

    def pull(self, bake: Any, steps: Any) -> None:
        """Simulate frame after frame until the end or a request to stop."""
        has_rest = not self.out
        for step in steps:
            if bake.stores is None:
                step.run()  # the solver is built, no frame is simulated yet
                continue
            if not has_rest:
                self.write_rest(bake)
                has_rest = True
            step.run()
            first = bake.stores.plan.first
            event = {"kind": "frame", "frame": step.frame, "first": first, "last": bake.end}
            self.tell({**event, "seconds": step.seconds})
            if self.out and time.monotonic() - self._reported > REPORT_SECONDS:
                self.write_report()
            if self.is_stopped():
                return
        if self.out:  # of a torn cloth, with the vertices that it has in the end
            self.write_rest(bake)

    def options(self, cloths: Sequence[Any]) -> Any:
        """How to bake cloths that start at the same frame."""
        frames = self.request["frames"]
        if frames:
            frames = (max(frames[0], cloths[0].boucle.frame_start), frames[1])
        files = None
        if self.out:
            stems = [os.path.join(self.out, file_name(cloth.name)) for cloth in cloths]
            files = [addon("core.cache_paths").files_of(f"{stem}.pc2") for stem in stems]
        return addon("bridge.bake").Options(
            resume=self.request["resume"],
            frames=frames,
            files=files,
            threads=self.request["threads"],
        )

    def complain(self, bake: Any, error: BaseException, code: int) -> int:
        """Say in one line what became of a bake, and pass the exit code on."""
        self.tell({"kind": "complaint", "text": addon("bridge.bake").outcome(bake, error)})
        return code

    def write_rest(self, bake: Any) -> None:
        """The rest meshes as OBJ, in object space as the PC2, whose points they have for vertices."""
        import bpy

        torn = addon("core.torn")
        for name, store in zip(bake.names, bake.stores.each, strict=True):
            cloth = bpy.data.objects[name]
            positions = addon("bridge.rest").positions(cloth.data)
            faces = [list(face.vertices) for face in cloth.data.polygons]
            layout = store.plan.layout and (torn.read(store.files.tear) or store.plan.layout)
            if layout is not None:
                corners = [vertex for face in faces for vertex in face]
                positions = torn.of_vertices(positions, layout, corners)
                points = iter(layout.points)
                faces = [[int(next(points)) for _ in face] for face in faces]
            path = os.path.join(self.out, f"{file_name(cloth.name)}.obj")
            addon("core.obj_file").write(path, cloth.name, positions, faces)

    def write_report(self) -> None:
        """report.json: one for all cloths so far."""
        report = addon("core.report")
        begun = [bake.stores for bake in self.bakes if bake.stores]
        reports = [store.rows.as_dict() for stores in begun for store in stores.each]
        if reports:
            content = report.encode(report.joined(reports))
            addon("core.whole_file").replace(os.path.join(self.out, "report.json"), content)
        self._reported = time.monotonic()

    def save_file(self) -> int:
        """Save the .blend with its own settings, so that it plays the bake."""
        import bpy

        for setting, value in reversed(self.own_values):
            setting.write(value)
        try:
            bpy.ops.wm.save_mainfile()
        except RuntimeError as error:
            self.tell({"kind": "complaint", "text": f"the file cannot be saved: {error}"})
            return CACHE
        return DONE


def file_name(name: str) -> str:
    """An object's name as every file system takes it."""
    return re.sub(r'[<>:"/\\|?*\x00-\x1f]', "_", name)


def file_key(name: str) -> str:
    """The same text for names that some file system takes for one: case, ways to write an accent, dots at the end."""
    return unicodedata.normalize("NFC", file_name(name)).casefold().rstrip(". ")


def run_as_script(request_file: str) -> int:
    """Bake as the --python of another Blender."""
    import addon_utils
    import bpy

    with open(request_file, encoding="utf-8") as file:
        request = json.load(file)

    def tell(event: Mapping[str, Any]) -> None:
        print(MARK + json.dumps(event), flush=True)

    if tuple(bpy.app.version[:2]) < OLDEST:
        text = f"this is Blender {bpy.app.version_string}; accepted: 4.2 or newer"
        tell({"kind": "complaint", "text": f"--blender: {text}"})
        return WRONG_INPUT
    asked: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda number, _frame: asked.append(number))
    parent = os.getppid()
    sys.path.append(request["module"])
    if addon_utils.enable(MODULE, default_set=True, persistent=True) is None:
        tell({"kind": "complaint", "text": "the add-on could not be enabled in this Blender"})
        return FAULT
    return bake_file(request, tell, lambda: bool(asked) or os.getppid() != parent)


if __name__ == "__main__":
    # Blender's own end may hang after a bake; everything is written and closed by now.
    exit_code = run_as_script(sys.argv[sys.argv.index("--") + 1])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(exit_code)
