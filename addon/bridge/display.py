"""How a live frame is shown: written into the mesh, or through a temporary PC2."""

from __future__ import annotations

import os
from typing import Protocol

import bpy

from ..core import cache_paths, pc2
from ..core.live_frames import LiveFrames
from ..core.refusal import Refusal
from ..core.torn import Layout
from . import mesh_arrays, rest, runtime, slot, tearing


def may_write(obj: bpy.types.Object) -> bool:
    """Whether a frame may stand in the mesh: nobody else shows it, nothing moves it above the slot, and it stays whole."""
    mesh = obj.data
    return (
        mesh.library is None
        and mesh.override_library is None
        and mesh.users == 1
        and mesh.shape_keys is None
        and not obj.boucle.use_tear
        and slot.find(obj) is not None
        and not slot.above(obj)
    )


def silence_leftover(obj: bpy.types.Object) -> None:
    """Name no temporary file of frames that are gone: undo brings its name back."""
    found = slot.find(obj)
    if found is not None and cache_paths.is_live(found.cache.filepath):
        slot.silence(found.cache)
        tearing.show(obj, None)


class Display(Protocol):
    """A way of showing frames."""

    def show(self, obj: bpy.types.Object, frames: LiveFrames, frame: int) -> None:
        """Show the kept frame."""

    def is_shown(self, obj: bpy.types.Object, frames: LiveFrames) -> bool:
        """Whether the object looks as `show` left it."""

    def begin_again(self, obj: bpy.types.Object) -> None:
        """Forget the frames shown so far: others take their place."""

    def hide(self, obj: bpy.types.Object) -> None:
        """Take the frame away, so that the file can be saved; `show` brings it back."""

    def end(self, obj: bpy.types.Object) -> None:
        """Take the frame away for good."""

    def forget(self) -> None:
        """The object is gone: tidy up."""


class Direct:
    """Frames in the mesh's `position`."""

    def __init__(self) -> None:
        """Nothing is shown yet."""
        self._frame = 0

    def show(self, obj: bpy.types.Object, frames: LiveFrames, frame: int) -> None:
        """Write the frame; the rest shape is kept before the first one."""
        if not rest.is_displaced(obj.data):
            if runtime.rendering:
                return
            rest.keep(obj.data)
        mesh_arrays.write_positions(obj.data, frames.nearest(frame).positions)
        self._frame = frame

    def is_shown(self, obj: bpy.types.Object, frames: LiveFrames) -> bool:
        """Whether nobody else has moved the vertices since."""
        present = memoryview(mesh_arrays.read_positions(obj.data)).cast("B")
        return present == memoryview(frames.nearest(self._frame).positions).cast("B")

    def begin_again(self, _obj: bpy.types.Object) -> None:
        """The mesh holds one frame only."""

    def hide(self, obj: bpy.types.Object) -> None:
        """Put the rest shape back."""
        rest.put_back(obj.data)

    def end(self, obj: bpy.types.Object) -> None:
        """Put the rest shape back."""
        if not runtime.rendering:
            rest.put_back(obj.data)

    def forget(self) -> None:
        """Nothing is left."""


class TemporaryFile:
    """Frames in a PC2 of this session, which the slot's Mesh Cache plays and scrubs by itself."""

    def __init__(self, uid: int, layout: Layout | None = None) -> None:
        """The file is made with the first frame shown; of a cloth that may tear, the layout says whose its points are."""
        self._layout = layout
        self._path = cache_paths.live_file(runtime.session_folder(), uid)
        self._writer: pc2.Writer | None = None

    def show(self, obj: bpy.types.Object, frames: LiveFrames, _frame: int) -> None:
        """Append what the file lacks and let Blender look at it again."""
        found = slot.find(obj)
        if found is None:
            return
        try:
            is_new = self._append(obj, frames)
        except Refusal as refusal:
            runtime.messages[obj.session_uid] = str(refusal)
            return
        if slot.played(found.cache) != self._path:
            tearing.show(obj, self._layout)
            slot.play(slot.find(obj).cache, self._path, frames.first)
            is_new = True
        if is_new:
            obj.update_tag()

    def is_shown(self, _obj: bpy.types.Object, _frames: LiveFrames) -> bool:
        """The mesh is the artist's own and may be moved at will."""
        return True

    def _append(self, obj: bpy.types.Object, frames: LiveFrames) -> bool:
        if self._writer is None:
            count = self._layout.point_count if self._layout else len(obj.data.vertices)
            self._writer = pc2.Writer.create(self._path, count, frames.first)
        missing = frames.positions_from(self._writer.sample_count)
        for positions in missing:
            self._writer.append(positions)
        return bool(missing)

    def begin_again(self, obj: bpy.types.Object) -> None:
        """Make the file anew with the next frame shown."""
        self.forget()
        self.hide(obj)

    def hide(self, obj: bpy.types.Object) -> None:
        """Name no temporary file."""
        silence_leftover(obj)

    def end(self, obj: bpy.types.Object) -> None:
        """Name no temporary file, and remove it."""
        self.hide(obj)
        obj.update_tag()
        self.forget()

    def forget(self) -> None:
        """Remove the file."""
        if self._writer is not None:
            self._writer.close()
            self._writer = None
        if os.path.isfile(self._path):
            os.remove(self._path)
