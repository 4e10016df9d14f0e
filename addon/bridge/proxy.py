"""A coarse cloth that moves a dense mesh: Blender's Surface Deform, bound where both are at rest."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ..core.refusal import Refusal, sentence_of
from . import cache, cloth, live, registry, slot

MODIFIER = "Boucle Proxy"
"""Name of the Surface Deform modifier."""


def make(dense: bpy.types.Object, scene: bpy.types.Scene, vertex_count: int) -> bpy.types.Object:
    """A decimated copy of about so many vertices that is a cloth in the dense mesh's place, with its pins and settings.

    Raises:
        Refusal: The mesh has no more vertices than that, or no faces.
    """
    count = len(dense.data.vertices)
    if not dense.data.polygons or count <= vertex_count:
        raise Refusal(
            f'"{dense.name}" has {count} vertices and {len(dense.data.polygons)} faces: a proxy of '
            f"{vertex_count} vertices needs more of them to stand for"
        )
    was_cloth = registry.is_cloth(dense)
    if was_cloth:
        live.drop(dense)
    proxy = dense.copy()
    proxy.data = dense.data.copy()
    proxy.name = proxy.data.name = f"{dense.name} Proxy"
    for collection in dense.users_collection:
        collection.objects.link(proxy)
    _forget_result(proxy)
    _decimate(proxy, scene, vertex_count / count)
    proxy.display_type = "WIRE"
    proxy.hide_render = True
    if not was_cloth:
        cloth.set_range(proxy, scene)
    proxy.boucle.enabled = False
    proxy.boucle.enabled = True
    return proxy


def drive(dense: bpy.types.Object, proxy: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """Let the proxy move the dense mesh; what else was changed, in a sentence.

    Raises:
        Refusal: Blender cannot bind one to the other; the dense mesh is as it was.
    """
    was_cloth = registry.is_cloth(dense)
    if was_cloth:
        dense.boucle.enabled = False
    if not proxy.boucle.enabled:
        cloth.set_range(proxy, scene)
        proxy.boucle.enabled = True
    live.drop(proxy)
    name = _surface_deform(dense)
    dense.modifiers[name].target = proxy
    off = _switch_off_above(dense, name)
    with _at_rest(proxy):
        trouble = _bind(dense, name)
    if not trouble:
        return f"the proxy does now what {', '.join(off)} did, which is off" if off else ""
    dense.modifiers.remove(dense.modifiers[name])
    for other in off:
        dense.modifiers[other].show_viewport = dense.modifiers[other].show_render = True
    dense.boucle.enabled = was_cloth
    raise Refusal(f'"{dense.name}" cannot be bound to "{proxy.name}": {trouble}')


def _surface_deform(dense: bpy.types.Object) -> str:
    """The name of the modifier that is bound, made if it is not there: above what changes the vertices."""
    for modifier in dense.modifiers:
        if modifier.type == "SURFACE_DEFORM":
            return modifier.name
    place = next(
        (k for k, one in enumerate(dense.modifiers) if one.type in slot.COUNT_CHANGING),
        len(dense.modifiers),
    )
    name = dense.modifiers.new(MODIFIER, "SURFACE_DEFORM").name
    dense.modifiers.move(dense.modifiers.find(name), place)
    return name


def _switch_off_above(dense: bpy.types.Object, name: str) -> list[str]:
    """Switch off what would move the dense mesh before the proxy does; their names."""
    off = []
    for modifier in dense.modifiers:
        if modifier.name == name:
            break
        if modifier.show_viewport:
            modifier.show_viewport = modifier.show_render = False
            off.append(modifier.name)
    return off


def remove(proxy: bpy.types.Object) -> None:
    """Take a proxy away that could not be bound."""
    mesh = proxy.data
    bpy.data.objects.remove(proxy)
    bpy.data.meshes.remove(mesh)
    registry.forget()


def _forget_result(proxy: bpy.types.Object) -> None:
    """A copy knows its original's caches: they are not of this mesh."""
    if slot.find(proxy) is not None:
        cache.detach(proxy)
        slot.remove(proxy)
    proxy.boucle.uuid = ""
    proxy.boucle.bake_record = ""
    proxy.boucle.takes.clear()
    for modifier in list(proxy.modifiers):
        if modifier.type in slot.COUNT_CHANGING or modifier.type in {"SURFACE_DEFORM", "COLLISION"}:
            proxy.modifiers.remove(modifier)


def _decimate(proxy: bpy.types.Object, scene: bpy.types.Scene, ratio: float) -> None:
    """Put a coarser mesh in place of the copy's, with its vertex groups."""
    modifier = proxy.modifiers.new("Decimate", "DECIMATE")
    modifier.ratio = ratio
    with _at_rest(proxy, but=modifier.name):
        depsgraph = registry.depsgraph_of(proxy, scene)
        depsgraph.update()
        evaluated = proxy.evaluated_get(depsgraph)
        mesh = bpy.data.meshes.new_from_object(
            evaluated, preserve_all_data_layers=True, depsgraph=depsgraph
        )
    proxy.modifiers.remove(proxy.modifiers[modifier.name])
    proxy.boucle.rest_shape_key = ""  # the coarse mesh has no shape keys
    old = proxy.data
    mesh.name = old.name
    proxy.data = mesh
    bpy.data.meshes.remove(old)
    mesh.name = proxy.name


@contextmanager
def _at_rest(obj: bpy.types.Object, but: str = "") -> Iterator[None]:
    """All modifiers of an object off in the viewport, but one."""
    states = {modifier.name: modifier.show_viewport for modifier in obj.modifiers}
    for name in states:
        obj.modifiers[name].show_viewport = name == but
    try:
        yield
    finally:
        for name, state in states.items():
            obj.modifiers[name].show_viewport = state


def _bind(dense: bpy.types.Object, name: str) -> str:
    """Bind a Surface Deform modifier; why it cannot be bound, empty if it is."""
    context = bpy.context
    if dense.modifiers[name].is_bound:
        with context.temp_override(object=dense, active_object=dense):
            bpy.ops.object.surfacedeform_bind(modifier=name)  # of another proxy: unbinds
    context.view_layer.update()
    try:
        with context.temp_override(object=dense, active_object=dense):
            bpy.ops.object.surfacedeform_bind(modifier=name)
    except RuntimeError as error:
        return sentence_of(error)
    context.view_layer.update()
    if dense.modifiers[name].is_bound:
        return ""
    return (
        "Surface Deform wants a proxy without concave faces, doubled vertices and edges of more than "
        "two faces"
    )
