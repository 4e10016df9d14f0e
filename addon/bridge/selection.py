"""Selecting parts of a mesh, in Edit Mode or out of it."""

from __future__ import annotations

import bmesh
import bpy


def select(obj: bpy.types.Object, vertices: set[int]) -> None:
    """Select these vertices of a mesh and no others."""
    mesh = obj.data
    if mesh.is_editmode:
        edited = bmesh.from_edit_mesh(mesh)
        for vertex in edited.verts:
            vertex.select_set(vertex.index in vertices)
        edited.select_flush_mode()
        bmesh.update_edit_mesh(mesh)
        return
    _write(
        mesh,
        [vertex.index in vertices for vertex in mesh.vertices],
        [vertices.issuperset(edge.vertices) for edge in mesh.edges],
        [vertices.issuperset(face.vertices) for face in mesh.polygons],
    )


def select_edges(obj: bpy.types.Object, edges: set[int]) -> None:
    """Select these edges of a mesh and no others."""
    mesh = obj.data
    if mesh.is_editmode:
        edited = bmesh.from_edit_mesh(mesh)
        for part in (*edited.faces, *edited.edges, *edited.verts):
            part.select_set(False)
        for edge in edited.edges:
            if edge.index in edges:
                edge.select_set(True)
        bmesh.update_edit_mesh(mesh)
        return
    vertices = {vertex for edge in edges for vertex in mesh.edges[edge].vertices}
    _write(
        mesh,
        [vertex.index in vertices for vertex in mesh.vertices],
        [edge.index in edges for edge in mesh.edges],
        [False] * len(mesh.polygons),
    )


def _write(
    mesh: bpy.types.Mesh, vertices: list[bool], edges: list[bool], faces: list[bool]
) -> None:
    """In Blender 5.0 the flags of a fresh mesh may be stored as one value for all: they are made anew."""
    for name, domain, flags in (
        (".select_vert", "POINT", vertices),
        (".select_edge", "EDGE", edges),
        (".select_poly", "FACE", faces),
    ):
        if mesh.attributes.get(name) is not None:
            mesh.attributes.remove(mesh.attributes[name])
        mesh.attributes.new(name, "BOOLEAN", domain).data.foreach_set("value", flags)
    mesh.update()
