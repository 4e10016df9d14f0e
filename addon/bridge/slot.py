"""The slot: the modifiers that stand where the simulation belongs in a cloth's stack.

First the node group that stores positions as `boucle_target`, then the Mesh Cache that plays a result; of a torn cloth, around
it, a node group that splits edges and one that mends. What is above (armature, hooks, lattices) moves the pins and the rest
shape; what is below (subdivision, thickness) works on the simulated cloth.
"""

from __future__ import annotations

from typing import NamedTuple

import bpy

from .._identifiers import CACHE_MODIFIER, MEND_MODIFIER, TARGET_MODIFIER, TEAR_MODIFIER
from . import target_group, tear_groups

COUNT_CHANGING = frozenset({
    "ARRAY", "BEVEL", "BOOLEAN", "BUILD", "DECIMATE", "EDGE_SPLIT", "EXPLODE", "MASK",
    "MESH_SEQUENCE_CACHE", "MIRROR", "MULTIRES", "NODES", "OCEAN", "PARTICLE_INSTANCE", "REMESH",
    "SCREW", "SKIN", "SOLIDIFY", "SUBSURF", "TRIANGULATE", "VOLUME_TO_MESH", "WELD", "WIREFRAME",
})  # fmt: skip
"""Modifier types that may give a mesh other vertices: the slot stands above the first of them."""


KEEPING_FIRST = frozenset({"ARRAY", "EDGE_SPLIT", "MULTIRES", "SOLIDIFY", "SUBSURF", "TRIANGULATE"})
"""Of those, the types that leave the first vertices and their attributes exactly as they are (tried in 4.2 and 4.5)."""


class Slot(NamedTuple):
    """The modifiers."""

    target: bpy.types.NodesModifier
    cache: bpy.types.MeshCacheModifier
    tear: bpy.types.NodesModifier | None
    """Of a torn cloth, and so the next."""
    mend: bpy.types.NodesModifier | None

    @property
    def last(self) -> bpy.types.Modifier:
        """The last of them."""
        return self.cache if self.mend is None else self.mend


def find(obj: bpy.types.Object) -> Slot | None:
    """The slot of an object, if it is whole."""
    target = next(
        (m for m in obj.modifiers if m.type == "NODES" and target_group.is_ours(m.node_group)),
        None,
    )
    caches = [m for m in obj.modifiers if m.type == "MESH_CACHE"]
    cache = next((m for m in caches if m.name.startswith(CACHE_MODIFIER)), None)
    if target is None or cache is None:
        return None
    tear = next((m for m in obj.modifiers if _is_tear(m)), None)
    return Slot(target, cache, tear, next((m for m in obj.modifiers if _is_mend(m)), None))


def ensure(obj: bpy.types.Object) -> Slot:
    """The slot, completed if a part of it is missing."""
    found = find(obj)
    if found is not None:
        return found
    remove(obj)
    place, active = _place(obj), obj.modifiers.active
    target = obj.modifiers.new(TARGET_MODIFIER, "NODES")
    target.node_group = target_group.ensure()
    target.show_expanded = False
    cache = obj.modifiers.new(CACHE_MODIFIER, "MESH_CACHE")
    cache.cache_format = "PC2"
    cache.time_mode = "FRAME"
    cache.show_expanded = False
    cache.show_in_editmode = False
    silence(cache)
    for offset, name in enumerate((target.name, cache.name)):
        obj.modifiers.move(obj.modifiers.find(name), place + offset)
    _activate(obj, active)
    return find(obj)


def add_tear(obj: bpy.types.Object) -> Slot:
    """What a torn cloth needs around the Mesh Cache."""
    remove_tear(obj)
    cache, active = find(obj).cache.name, obj.modifiers.active
    tear = obj.modifiers.new(TEAR_MODIFIER, "NODES")
    tear.node_group = tear_groups.ensure(tear_groups.ALL)
    mend = obj.modifiers.new(MEND_MODIFIER, "NODES")
    mend.node_group = tear_groups.ensure(tear_groups.MEND)
    for modifier in (tear, mend):
        modifier.show_expanded = modifier.show_in_editmode = False
    place = obj.modifiers.find(cache)
    for offset, name in enumerate((tear.name, cache, mend.name)):
        obj.modifiers.move(obj.modifiers.find(name), place + offset)
    _activate(obj, active)
    return find(obj)


def _activate(obj: bpy.types.Object, modifier: bpy.types.Modifier | None) -> None:
    """A new modifier becomes the active one: let that be the artist's again."""
    if modifier is not None:
        obj.modifiers.active = modifier


def is_in_order(obj: bpy.types.Object) -> bool:
    """Whether an object has all that a torn cloth needs, from what splits to what mends."""
    found = find(obj)
    if found is None or found.tear is None or found.mend is None:
        return False
    names = [one.name for one in (found.target, found.tear, found.cache, found.mend)]
    return [modifier.name for modifier in obj.modifiers if modifier.name in names] == names


def remove_tear(obj: bpy.types.Object) -> None:
    """Take that away."""
    for modifier in [m for m in obj.modifiers if _is_tear(m) or _is_mend(m)]:
        obj.modifiers.remove(modifier)


def splits(obj: bpy.types.Object) -> bool:
    """Whether an object has what a torn cloth needs, or a part of it."""
    return any(_is_tear(modifier) or _is_mend(modifier) for modifier in obj.modifiers)


def _is_tear(modifier: bpy.types.Modifier) -> bool:
    return _kind(modifier) in (tear_groups.TORN, tear_groups.ALL)


def _is_mend(modifier: bpy.types.Modifier) -> bool:
    return _kind(modifier) == tear_groups.MEND


def _kind(modifier: bpy.types.Modifier) -> str:
    return tear_groups.kind_of(modifier.node_group) if modifier.type == "NODES" else ""


def show(found: Slot, on: bool) -> None:
    """Let what plays a result be seen in viewports or not."""
    for modifier in (found.tear, found.cache, found.mend):
        if modifier is not None:
            modifier.show_viewport = on


def play(modifier: bpy.types.MeshCacheModifier, path: str, first_frame: int) -> None:
    """Make the Mesh Cache play a PC2 whose first sample is at first_frame."""
    if modifier.filepath != path:
        modifier.filepath = path
    modifier.cache_format = "PC2"
    modifier.time_mode = "FRAME"
    modifier.play_mode = "SCENE"
    modifier.deform_mode = "OVERWRITE"
    modifier.interpolation = "LINEAR"
    modifier.frame_start = float(first_frame)
    modifier.frame_scale = 1.0
    modifier.factor = 1.0
    _switch(modifier, True)


def silence(modifier: bpy.types.MeshCacheModifier) -> None:
    """Make the Mesh Cache play nothing.

    An empty path is not enough: the first save of a file makes it a relative path to nowhere, and Blender complains.
    """
    modifier.filepath = ""
    _switch(modifier, False)


def played(modifier: bpy.types.MeshCacheModifier) -> str:
    """The path that the Mesh Cache plays; empty if it plays nothing."""
    return modifier.filepath if modifier.filepath.lower().endswith(".pc2") else ""


def _switch(modifier: bpy.types.MeshCacheModifier, on: bool) -> None:
    for name in ("show_viewport", "show_render"):
        if getattr(modifier, name) is not on:
            setattr(modifier, name, on)


def remove(obj: bpy.types.Object) -> None:
    """Take the slot, or what is left of it, out of the stack."""
    for modifier in list(obj.modifiers):
        is_target = modifier.type == "NODES" and target_group.is_ours(modifier.node_group)
        is_cache = modifier.type == "MESH_CACHE" and modifier.name.startswith(CACHE_MODIFIER)
        if is_target or is_cache or _is_tear(modifier) or _is_mend(modifier):
            obj.modifiers.remove(modifier)


def above(obj: bpy.types.Object) -> list[bpy.types.Modifier]:
    """The modifiers above the slot."""
    found = find(obj)
    if found is None:
        return []
    names = [modifier.name for modifier in obj.modifiers]
    return list(obj.modifiers)[: names.index(found.target.name)]


def below(obj: bpy.types.Object) -> list[bpy.types.Modifier]:
    """The modifiers below the slot."""
    found = find(obj)
    if found is None:
        return []
    names = [modifier.name for modifier in obj.modifiers]
    return list(obj.modifiers)[names.index(found.last.name) + 1 :]


def hiding(
    obj: bpy.types.Object, evaluated_count: int, in_render: bool
) -> bpy.types.Modifier | None:
    """The modifier below the slot after which the cloth's own vertices cannot be told, if there is one."""
    for modifier in below(obj):
        is_on = modifier.show_render if in_render else modifier.show_viewport
        if not is_on or modifier.type not in COUNT_CHANGING - KEEPING_FIRST:
            continue
        if modifier.type != "NODES" or evaluated_count != len(obj.data.vertices):
            return modifier
    return None


def _place(obj: bpy.types.Object) -> int:
    """Above the first modifier that may change the vertices; at the end if there is none."""
    for index, modifier in enumerate(obj.modifiers):
        if modifier.type in COUNT_CHANGING:
            return index
    return len(obj.modifiers)
