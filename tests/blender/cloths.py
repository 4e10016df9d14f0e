"""Cloths to test with; runs inside Blender."""

import importlib
from array import array

import bpy


def addon(name):
    """A module of the installed add-on: addon("bridge.live")."""
    return importlib.import_module(f"bl_ext.user_default.boucle.{name}")


def add_cloth(columns=8, rows=6, end=20, **values):
    """A hanging cloth of 2 m x 1 m, held at its top, at rest at frame 1."""
    bpy.ops.boucle.add_cloth(
        vertices_x=columns, vertices_y=rows, size_x=2.0, size_y=1.0, plane="xz", pins={"top"}
    )
    obj = bpy.context.object
    obj.boucle.frame_end = end
    for name, value in values.items():
        setattr(obj.boucle, name, value)
    return obj


def add_diverging_cloth():
    """A cloth whose springs are far too stiff for its step."""
    return add_cloth(
        integrator="symplectic_euler",
        stretch=1e6,
        shear=1e6,
        limiter="none",
        substeps=1,
        allow_unstable=True,
        damping=0.0,
        self_collision=False,
    )


def play(first, last):
    """Go through frames one by one, as the play button does."""
    for frame in range(first, last + 1):
        bpy.context.scene.frame_set(frame)


def mesh_positions(obj):
    """What stands in the mesh, as a list of floats."""
    out = array("f", bytes(12 * len(obj.data.vertices)))
    obj.data.attributes["position"].data.foreach_get("vector", out)
    return out.tolist()


def shown_positions(obj):
    """What Blender shows, as a list of floats."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    out = array("f", bytes(12 * len(evaluated.data.vertices)))
    evaluated.data.attributes["position"].data.foreach_get("vector", out)
    return out.tolist()


def world_positions(obj):
    """What Blender shows, in world space, as a list of vectors."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return [evaluated.matrix_world @ vertex.co for vertex in evaluated.data.vertices]


def farthest(one, other):
    """The largest difference of two lists of floats."""
    assert len(one) == len(other), (len(one), len(other))
    return max(abs(a - b) for a, b in zip(one, other, strict=True))


def pinned_vertices(obj):
    """The vertices of the pin group."""
    index = obj.vertex_groups[obj.boucle.pin_group].index
    return [v.index for v in obj.data.vertices if any(g.group == index for g in v.groups)]


def refusal_of(operator, **arguments):
    """The sentence with which an operator refuses."""
    try:
        operator(**arguments)
    except RuntimeError as error:
        return str(error)
    raise AssertionError("nothing was refused")
