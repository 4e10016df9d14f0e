"""Where a result is worst: its frames by their certificates, its edges by the solver's own rest lengths."""

from __future__ import annotations

import bpy

from ..core import points, scene_json, worst
from ..core.refusal import Refusal
from ..core.worst import Edge
from . import certificate, live, mesh_arrays, shown, simulation, start_pose, tearing

ALLOWANCE = 1e-3
"""An edge is over the rate from a tenth of a percent of its rest length beyond it, as in the certificates."""


def frame(obj: bpy.types.Object, key: str) -> tuple[int, float]:
    """The worst frame by a number of the certificates, and that number.

    Raises:
        Refusal: There is no result.
    """
    found = worst.frame(certificate.rows(obj), key)
    if found is None:
        raise Refusal(f'"{obj.name}" has no result: play or bake it first')
    return found


def edges(obj: bpy.types.Object, scene: bpy.types.Scene) -> list[Edge]:
    """The strain of every edge in the frame that is shown, the largest first.

    Raises:
        Refusal, native.BoucleError: There is no result, or the start frame cannot be looked at.
    """
    positions, layout = shown.points_at_frame(obj, scene.frame_current), shown.layout(obj)
    if positions is None:
        raise Refusal(f'"{obj.name}" has no result: play or bake it first')
    session = live.session_of(obj)
    is_whole = session is not None and layout is None
    solver = session.solver if is_whole else None
    if solver is None:
        start = start_pose.sample(obj, scene)
        alone = scene_json.without_contact(start.description)
        solver = simulation.maker(alone, [start.given])()
    lengths = worst.rest_lengths(solver.read_springs(0))
    world = points.transform(positions, mesh_arrays.world_matrix(obj), "d")
    places = tearing.edge_points(obj.data, layout) if layout is not None else None
    return worst.edges(world, mesh_arrays.edges(obj.data), lengths, places)


def over_the_rate(obj: bpy.types.Object, found: list[Edge]) -> list[Edge]:
    """Those of the edges that are longer than the deformation rate allows."""
    limit = obj.boucle.deformation_rate + ALLOWANCE
    return [edge for edge in found if edge.strain > limit]
