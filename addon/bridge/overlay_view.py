"""The heat map in the viewports: the shown cloth, or its edges, in the colours of what happens to it, and a legend.

Blender calls the two handlers only while some cloth wants it; without a window there is nothing to draw on. The mesh and the
shading stay as they are: coloured triangles are laid over the surface, a touch nearer to the eye. Turning the view costs no
more than drawing; a new frame costs new positions and colours, the triangles are kept as long as the faces are the same.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy

from ..core import heat_map, points, quantity
from ..core.points import Points
from ..core.quantity import Quantity
from . import legend, live, mesh_arrays, registry, tear_settings, vertex_attributes

_NEARER = 5e-4
"""Part of the distance to the eye by which the colours lie before the surface: enough for every depth buffer."""

_LINE_WIDTH = 2.5
"""Of coloured edges (pixels)."""

_handles: list[Any] = []
_shown: dict[int, tuple[Any, Any, legend.Legend]] = {}
"""Batch, its shader and legend of each cloth, by `session_uid`; the batch is None where the numbers are not known."""
_faces: dict[tuple[int, str], tuple[Points, Points]] = {}
"""Corners and triangles of each mesh that was drawn, by the object's `session_uid` and what the triangles are of."""


class HeatMap(NamedTuple):
    """What is drawn of a cloth."""

    positions: Points
    """(m), object space, float32, flat."""
    """Of the vertices, or of the corners where numbers are told at these."""
    parts: Points
    """Triangles, or edges where `is_lines`: three or two of the positions each, int32, flat."""
    is_lines: bool
    colors: Points
    """Red, green, blue, alpha of each position, float32, flat."""
    low: float
    high: float


def follow() -> None:
    """Draw if a cloth wants it, else stop."""
    forget()
    wanted = _has_window() and any(_quantity(obj) for obj in registry.all_cloths())
    if not wanted:
        end()
    elif not _handles:
        add = bpy.types.SpaceView3D.draw_handler_add
        _handles.append(add(_draw_surfaces, (), "WINDOW", "POST_VIEW"))
        _handles.append(add(_draw_legends, (), "WINDOW", "POST_PIXEL"))


def _has_window() -> bool:
    return not bpy.app.background


def end() -> None:
    """Draw no more."""
    forget()
    _faces.clear()
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")


def forget() -> None:
    """Something has changed in the scene: compute anew at the next drawing."""
    _shown.clear()


def _quantity(obj: bpy.types.Object) -> Quantity | None:
    return quantity.BY_KEY.get(obj.boucle.overlay)


def heat_map_of(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene
) -> HeatMap | None:
    """The surface of a cloth as it is shown and its colours; None where nothing is known of the frame."""
    evaluated = obj.evaluated_get(depsgraph)
    mesh = evaluated.data
    one = _quantity(obj)
    if one is None or mesh is None or not mesh.polygons:
        return None
    values, domain = _values(obj, mesh, scene, one)
    if values is None:
        return None
    settings = obj.boucle
    low, high = heat_map.span(values)
    if not one.unit:
        high = max(high, 1.0)  # it is counted
    if settings.overlay_range == "tear":
        high = tear_settings.limit(obj, one.key) or high
    if settings.overlay_range == "manual":
        low, high = settings.overlay_minimum, settings.overlay_maximum
    positions = mesh_arrays.read_positions(mesh)
    colors = heat_map.colors(values, low, high, settings.overlay_opacity)
    if domain == "POINT":
        return HeatMap(
            positions, _triangles(obj.session_uid, mesh, "vertices"), False, colors, low, high
        )
    corners = _corners(mesh)
    positions = points.take(positions, corners)
    if one.reader:
        return HeatMap(
            positions, _triangles(obj.session_uid, mesh, "loops"), False, colors, low, high
        )
    ends = mesh_arrays.next_corners(mesh)
    both = points.joined(positions, points.take(positions, ends))
    lines = points.pairs(len(ends))
    return HeatMap(both, lines, True, points.joined(colors, colors), low, high)


def _values(
    obj: bpy.types.Object, mesh: bpy.types.Mesh, scene: bpy.types.Scene, one: Quantity
) -> tuple[Points | None, str]:
    """Values of the evaluated mesh, and whether at its vertices or corners: modifiers below carry the attribute on."""
    attribute = mesh.attributes.get(one.attribute)
    if (
        attribute is not None
        and attribute.data_type == "FLOAT"
        and attribute.domain in {"POINT", "CORNER"}
    ):
        values = points.empty("f", len(attribute.data))
        attribute.data.foreach_get("value", values)
        return values, attribute.domain
    values = live.numbers_at(obj, scene).get(one.key)
    domain = (
        ""
        if values is None
        else vertex_attributes.domain_of(mesh, one, values, obj.boucle.use_tear)
    )
    return (values, domain) if domain else (None, "")


def _corners(mesh: bpy.types.Mesh) -> Points:
    corners = points.empty("i", len(mesh.loops))
    mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
    return corners


def _triangles(uid: int, mesh: bpy.types.Mesh, of: str) -> Points:
    """The triangles of a mesh, by its "vertices" or by its corners ("loops").

    Reading them from Blender takes far longer than looking whether the faces changed.
    """
    corners = _corners(mesh)
    mesh.calc_loop_triangles()
    kept = _faces.get((uid, of))
    if kept is not None and len(kept[1]) == 3 * len(mesh.loop_triangles):
        numpy = points.numpy_module()
        is_same = kept[0] == corners if numpy is None else numpy.array_equal(kept[0], corners)
        if is_same:
            return kept[1]
    triangles = points.empty("i", 3 * len(mesh.loop_triangles))
    mesh.loop_triangles.foreach_get(of, triangles)
    _faces[uid, of] = (corners, triangles)
    return triangles


def _cloths(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The cloths that show a heat map in this view, in the order of their names."""
    space = context.space_data
    if space is not None and not space.overlay.show_overlays:
        return []
    found = [
        obj
        for obj in registry.cloths_of(context.scene)
        if _quantity(obj) and obj.mode == "OBJECT" and obj.visible_get()
    ]
    return sorted(found, key=lambda obj: obj.name)


def _draw_surfaces() -> None:
    import gpu

    context = bpy.context
    cloths = _cloths(context)
    if not cloths:
        return
    depsgraph = context.evaluated_depsgraph_get()
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.depth_mask_set(True)
    for obj in cloths:
        if obj.session_uid not in _shown:
            _shown[obj.session_uid] = _prepare(obj, depsgraph, context.scene)
        batch, shader, _ = _shown[obj.session_uid]
        if batch is not None:
            with gpu.matrix.push_pop():
                _come_nearer(gpu.matrix, context.region_data)
                gpu.matrix.multiply_matrix(obj.evaluated_get(depsgraph).matrix_world)
                batch.draw(shader)
    gpu.state.depth_mask_set(False)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def _come_nearer(matrix: Any, view: Any) -> None:
    """Everything a little nearer to the eye, without a change of the picture."""
    from mathutils import Matrix

    before = matrix.get_model_view_matrix()
    if view is None or view.is_perspective:
        nearer = Matrix.Scale(1.0 - _NEARER, 4)
        nearer[3][3] = 1.0
    else:
        nearer = Matrix.Translation((0.0, 0.0, _NEARER * view.view_distance))
    matrix.load_matrix(nearer @ before)


def _prepare(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene
) -> tuple[Any, Any, legend.Legend]:
    import gpu

    one = quantity.BY_KEY[obj.boucle.overlay]
    made = heat_map_of(obj, depsgraph, scene)
    if made is None:
        return None, None, legend.unknown(obj.name, one)
    kind, width, name = ("LINES", 2, "POLYLINE_") if made.is_lines else ("TRIS", 3, "")
    shader = gpu.shader.from_builtin(f"{name}SMOOTH_COLOR")
    if made.is_lines:
        shader.bind()
        shader.uniform_float("lineWidth", _LINE_WIDTH)
        shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    vertices = gpu.types.GPUVertBuf(shader.format_calc(), len(made.positions) // 3)
    vertices.attr_fill("pos", points.rows(made.positions, 3))
    vertices.attr_fill("color", points.rows(made.colors, 4))
    order = gpu.types.GPUIndexBuf(type=kind, seq=points.rows(made.parts, width))
    batch = gpu.types.GPUBatch(type=kind, buf=vertices, elem=order)
    return batch, shader, legend.of(obj.name, one, made.low, made.high)


def _draw_legends() -> None:
    context = bpy.context
    cloths = [obj for obj in _cloths(context) if obj.session_uid in _shown]
    legend.draw([_shown[obj.session_uid][2] for obj in cloths], context)
