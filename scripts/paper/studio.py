"""A small photo studio inside Blender: one cloth, its threads, its pins, soft light, a parallel camera."""

from __future__ import annotations

import contextlib
import math
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .view import Shot, View

SAMPLES = 12
THREAD = 0.0022
"""Radius (m) of the threads drawn along the edges, for a view 1 m wide."""
PIN = 0.011
"""Radius (m) of a pin's head, for a view 1 m wide."""
DISTANCE = 30.0
"""Distance (m) of the camera, which sees in parallel."""
DARK = (0.022, 0.022, 0.022)


@contextlib.contextmanager
def silence() -> Iterator[None]:
    """Keep Blender's own progress lines off standard output."""
    sys.stdout.flush()
    kept = os.dup(1)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


class Studio:
    """Renders shots with Cycles on the processor, denoised, on a transparent ground."""

    def __init__(self) -> None:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.cycles.device = "CPU"
        scene.cycles.samples = SAMPLES
        scene.cycles.use_denoising = True
        scene.cycles.denoising_input_passes = "RGB"
        scene.cycles.denoising_quality = "FAST"
        scene.cycles.max_bounces = 2
        scene.cycles.use_adaptive_sampling = True
        scene.cycles.adaptive_threshold = 0.05
        scene.render.film_transparent = True
        scene.render.image_settings.file_format = "PNG"
        scene.render.image_settings.color_mode = "RGBA"
        scene.render.use_persistent_data = True
        scene.view_settings.view_transform = "Standard"
        self.scene = scene
        self.cloth_material = vertex_color_material()
        self.dark_material = matt_material("Dark", DARK)
        self.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        self.camera.data.type = "ORTHO"
        scene.collection.objects.link(self.camera)
        scene.camera = self.camera
        self.lamp = bpy.data.objects.new("Key", bpy.data.lights.new("Key", "SUN"))
        self.lamp.data.energy, self.lamp.data.angle = 2.3, math.radians(14.0)
        scene.collection.objects.link(self.lamp)
        world = bpy.data.worlds.new("White")
        world.use_nodes = True
        world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.5
        world.node_tree.nodes["Background"].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        scene.world = world

    def render(self, shot: Shot, view: View, width: int, path: Path) -> None:
        """Render one shot into a PNG file, `width` pixels wide."""
        self.place_camera(view)
        scale = max(view.width, view.height)
        made = [self.build_cloth(shot), self.build_threads(shot, THREAD * scale)]
        made += [self.build_pin(shot.positions[pin], PIN * scale) for pin in shot.pins]
        self.photograph(made, view, width, path)

    def photograph(self, made: list[bpy.types.Object], view: View, width: int, path: Path) -> None:
        """Render what is built into a PNG file, `width` pixels wide, and take it away."""
        render = self.scene.render
        render.resolution_x = width
        render.resolution_y = round(width * view.height / view.width)
        render.filepath = str(path.resolve())
        with silence():
            bpy.ops.render.render(write_still=True)
        for thing in made:
            bpy.data.meshes.remove(thing.data)

    def place_camera(self, view: View) -> None:
        """Look as the view says; the lamp stands to the left above the camera."""
        right, up, back = (Vector(axis) for axis in view.axes())
        turned = Matrix((right, up, back)).transposed().to_4x4()
        self.camera.matrix_world = (
            Matrix.Translation(Vector(view.center) + DISTANCE * back) @ turned
        )
        self.camera.data.ortho_scale = max(view.width, view.height)
        light_from = back - 1.1 * right + 0.9 * up
        self.lamp.rotation_euler = light_from.to_track_quat("Z", "Y").to_euler()

    def build_cloth(self, shot: Shot) -> bpy.types.Object:
        """The cloth, coloured by its values."""
        mesh = bpy.data.meshes.new("Cloth")
        mesh.from_pydata(shot.positions.tolist(), [], shot.faces.tolist())
        layer = mesh.color_attributes.new("Load", "BYTE_COLOR", "POINT")
        layer.data.foreach_set("color_srgb", shot.vertex_colors().astype(np.float32).ravel())
        mesh.materials.append(self.cloth_material)
        mesh.shade_smooth()
        return self.link(mesh)

    def build_threads(self, shot: Shot, radius: float) -> bpy.types.Object:
        """The cloth's edges as thin dark threads."""
        mesh = bpy.data.meshes.new("Threads")
        mesh.from_pydata(shot.positions.tolist(), [], shot.faces.tolist())
        mesh.materials.append(self.dark_material)
        made = self.link(mesh)
        made.visible_shadow = False
        wires = made.modifiers.new("Threads", "WIREFRAME")
        wires.thickness = 2.0 * radius
        wires.use_even_offset = False
        return made

    def build_pin(self, place: np.ndarray, radius: float) -> bpy.types.Object:
        """A pin's head."""
        import bmesh

        mesh = bpy.data.meshes.new("Pin")
        work = bmesh.new()
        bmesh.ops.create_uvsphere(work, u_segments=24, v_segments=12, radius=radius)
        work.to_mesh(mesh)
        work.free()
        mesh.materials.append(self.dark_material)
        made = self.link(mesh)
        made.location = place
        return made

    def link(self, mesh: bpy.types.Mesh) -> bpy.types.Object:
        """Put a mesh into the scene."""
        made = bpy.data.objects.new(mesh.name, mesh)
        self.scene.collection.objects.link(made)
        return made


def matt_material(name: str, color: tuple[float, float, float]) -> bpy.types.Material:
    """A matt material of one colour."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    shader = nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*color, 1.0)
    output = nodes.new("ShaderNodeOutputMaterial")
    links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    return made


def vertex_color_material() -> bpy.types.Material:
    """A matt material that takes its colour from the mesh."""
    made = matt_material("Cloth", (1.0, 1.0, 1.0))
    nodes, links = made.node_tree.nodes, made.node_tree.links
    load = nodes.new("ShaderNodeVertexColor")
    load.layer_name = "Load"
    links.new(load.outputs["Color"], nodes["Diffuse BSDF"].inputs["Color"])
    return made
