"""Materials on a cloth: yarns in the size that its rest shape and UV map ask for."""

from __future__ import annotations

import bpy

from ..core import heat_map, points, quantity, uv_scale
from ..core.points import Points
from . import fabrics, live, mesh_arrays, rest, tear_settings

_UV_MAP = "UVMap"
_STOPS = len(heat_map.VIRIDIS)


def dress(
    obj: bpy.types.Object, key: str, color: tuple[float, ...] | None, scale: float
) -> bpy.types.Material:
    """Put a new material of a fabric into the object's active slot; a mesh without a UV map gets one in metres."""
    mesh = obj.data
    corners = _corners(mesh)
    places = _take(
        points.transform(rest.positions(mesh), mesh_arrays.world_matrix(obj), "f"), corners, 3
    )
    if not mesh.uv_layers:
        _project(mesh, places)
    uvs = points.empty("f", 2 * len(mesh.loops))
    _active_map(mesh).uv.foreach_get("vector", uvs)
    metres = uv_scale.metres(places, _take(uvs, _loops(mesh), 2))
    made = fabrics.make(key, metres)
    node = fabrics.group_node(made)
    if color is not None:
        _recolor(node, color)
    node.inputs["Yarn Size"].default_value *= scale
    node.inputs["Relief"].default_value *= scale
    obj.active_material = made
    return made


def _recolor(node: bpy.types.Node, color: tuple[float, ...]) -> None:
    """Another colour; the second keeps its ratio to the first."""
    pairs = zip(
        color, node.inputs["Color"].default_value, node.inputs["Second Color"].default_value,
        strict=False,
    )  # fmt: skip
    second = [min(1.0, new * other / max(old, 1e-3)) for new, old, other in pairs]
    node.inputs["Color"].default_value = (*color, 1.0)
    node.inputs["Second Color"].default_value = (*second, 1.0)


def show_heat_map(obj: bpy.types.Object, scene: bpy.types.Scene) -> bpy.types.Material:
    """Put a material into the active slot that has the overlay's colours, over its range as it is now."""
    one = quantity.BY_KEY[obj.boucle.overlay]
    settings = obj.boucle
    values = live.numbers_at(obj, scene).get(one.key)
    low, high = heat_map.span(values if values is not None else ())
    if settings.overlay_range == "tear":
        high = tear_settings.limit(obj, one.key) or high
    if settings.overlay_range == "manual":
        low, high = settings.overlay_minimum, settings.overlay_maximum
    made = bpy.data.materials.new(f"Boucle {one.label}")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Roughness"].default_value = 0.8
    source = nodes.new("ShaderNodeAttribute")
    source.attribute_name = one.attribute
    place = nodes.new("ShaderNodeMapRange")
    place.inputs["From Min"].default_value = low
    place.inputs["From Max"].default_value = high
    ramp = nodes.new("ShaderNodeValToRGB")
    _fill(ramp.color_ramp)
    links.new(source.outputs["Fac"], place.inputs["Value"])
    links.new(place.outputs["Result"], ramp.inputs[0])
    links.new(ramp.outputs["Color"], shader.inputs["Base Color"])
    for column, node in enumerate((source, place, ramp)):
        node.location = (-900.0 + 220.0 * column, 200.0)
    obj.active_material = made
    return made


def _fill(ramp: bpy.types.ColorRamp) -> None:
    ramp.elements[1].position = 1.0
    for k in range(1, _STOPS - 1):
        ramp.elements.new(k / (_STOPS - 1))
    for k, element in enumerate(ramp.elements):
        element.color = (*heat_map.linear(heat_map.VIRIDIS[k]), 1.0)


def _active_map(mesh: bpy.types.Mesh) -> bpy.types.MeshUVLoopLayer:
    """The UV map that renders use."""
    return next((layer for layer in mesh.uv_layers if layer.active_render), mesh.uv_layers[0])


def _loops(mesh: bpy.types.Mesh) -> Points:
    """Three corners of faces for each triangle."""
    mesh.calc_loop_triangles()
    loops = points.empty("i", 3 * len(mesh.loop_triangles))
    mesh.loop_triangles.foreach_get("loops", loops)
    return loops


def _corners(mesh: bpy.types.Mesh) -> Points:
    """Three vertices for each triangle."""
    mesh.calc_loop_triangles()
    corners = points.empty("i", 3 * len(mesh.loop_triangles))
    mesh.loop_triangles.foreach_get("vertices", corners)
    return corners


def _take(flat: Points, indices: Points, width: int) -> Points:
    """The rows of some indices, flat."""
    if points.numpy_module() is not None:
        return flat.reshape(-1, width)[indices].reshape(-1)
    return [value for index in indices for value in flat[width * index : width * index + width]]


def _project(mesh: bpy.types.Mesh, places: Points) -> None:
    """A UV map in metres: every triangle as it is seen along the axis that it faces most."""
    layer = mesh.uv_layers.new(name=_UV_MAP)
    uvs = points.empty("f", 2 * len(mesh.loops))
    projected = uv_scale.projected(places)
    for number, loop in enumerate(_loops(mesh)):
        uvs[2 * loop], uvs[2 * loop + 1] = projected[2 * number], projected[2 * number + 1]
    layer.uv.foreach_set("vector", uvs)
