"""The shape of a frame made the artist's own: as the rest shape, as where the simulation begins, or as a shape key."""

from __future__ import annotations

from array import array

import bpy

from ..core import store
from ..core.points import Points
from ..core.refusal import Refusal
from . import cache, live, mesh_arrays, rest, shown, slot

REST_KEY = "Rest"
"""Shape key that keeps the rest shape while the mesh begins elsewhere."""


def as_rest(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """Let the mesh be what is shown; what became of the result, in a sentence.

    Raises:
        Refusal: There is no result, or the mesh does not decide alone how the cloth begins.
    """
    positions = _shown(obj, scene)
    _refuse_others(obj)
    if obj.data.shape_keys is not None:
        raise Refusal(
            f'"{obj.name}" has shape keys, which would not follow its rest shape: remove them, or apply '
            "the frame as a shape key"
        )
    text = _let_go(obj)
    mesh_arrays.write_positions(obj.data, positions)
    return text


def as_start(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """Begin where the cloth is shown; its rest lengths stay, as a shape key that is switched off.

    Raises:
        Refusal: There is no result, or the mesh does not decide alone how the cloth begins.
    """
    positions = _shown(obj, scene)
    _refuse_others(obj)
    if obj.boucle.use_dynamic_mesh:
        raise Refusal(
            f'"{obj.name}" has Dynamic Mesh on, with which its lengths at rest are those of the mesh and '
            "would change with it: switch it off, or apply the frame as the rest shape"
        )
    keys = obj.data.shape_keys
    named = obj.boucle.rest_shape_key
    if keys is not None and [key.name for key in keys.key_blocks[1:]] != [named]:
        raise Refusal(
            f'"{obj.name}" has shape keys of its own, which would not follow: remove them first'
        )
    text = _let_go(obj)
    if keys is None:
        resting = rest.positions(obj.data)
        obj.shape_key_add(name="Start", from_mix=False)
        key = obj.shape_key_add(name=REST_KEY, from_mix=False)
        key.value = 0.0  # 1 in Blender 5.0
        key.data.foreach_set("co", resting)
        obj.boucle.rest_shape_key = key.name
    obj.data.shape_keys.reference_key.data.foreach_set("co", positions)
    mesh_arrays.write_positions(obj.data, positions)
    return text


def as_shape_key(obj: bpy.types.Object, scene: bpy.types.Scene, name: str) -> str:
    """Keep what is shown as a new shape key, switched off; its name.

    Raises:
        Refusal: There is no result.
    """
    positions = _shown(obj, scene)
    if obj.data.library is not None or obj.data.override_library is not None:
        raise Refusal(f'"{obj.name}": its mesh is linked: make it local first')
    session = live.session_of(obj)
    if session is not None:
        session.display.end(obj)
    if obj.data.shape_keys is None:
        obj.shape_key_add(name="Basis", from_mix=False)
    key = obj.shape_key_add(name=name or f"Frame {scene.frame_current}", from_mix=False)
    key.value = 0.0  # 1 in Blender 5.0
    key.data.foreach_set("co", positions)
    live.show_anew(obj, scene)
    obj.update_tag()
    return key.name


def _shown(obj: bpy.types.Object, scene: bpy.types.Scene) -> Points:
    found = shown.at_frame(obj, scene.frame_current)
    if found is None:
        raise Refusal(f'"{obj.name}" has no result to apply: play or bake it first')
    if shown.is_torn(obj, scene.frame_current):
        raise Refusal(
            f'"{obj.name}" is torn at frame {scene.frame_current}, and its mesh has no vertices for the pieces: '
            "choose an earlier frame, or apply the modifiers of Boucle to a copy"
        )
    return array("f", found)


def _refuse_others(obj: bpy.types.Object) -> None:
    """Refuse a mesh that is others', too, or that modifiers move before the simulation begins."""
    mesh = obj.data
    if mesh.library is not None or mesh.override_library is not None:
        raise Refusal(f'"{obj.name}": its mesh is linked: make it local first')
    if mesh.users - mesh.use_fake_user > 1:
        raise Refusal(
            f'"{obj.name}" shares its mesh with others, which would change with it: make it single-user '
            "(Object > Relations)"
        )
    moving = [modifier.name for modifier in slot.above(obj) if modifier.show_viewport]
    if moving:
        raise Refusal(
            f'"{obj.name}": the modifier "{moving[0]}" above Boucle\'s would move the new shape once '
            "more: apply or remove it first"
        )


def _let_go(obj: bpy.types.Object) -> str:
    """No frame is shown any more; a bake of one's own is kept as the one before."""
    was_baked, is_foreign = cache.is_baked(obj), cache.is_foreign(obj)
    live.drop(obj)
    if not was_baked:
        return "the live frames are let go"
    if not is_foreign:
        store.set_aside(cache.own_files(obj))
    cache.detach(obj)
    return "its bake is let go" + ("" if is_foreign else "; Restore Previous plays it again")
