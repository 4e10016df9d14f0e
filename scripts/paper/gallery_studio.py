"""The photo studio for scenes of contact: cloths with two sides of different colours, and colliders."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from mathutils import Euler, Matrix, Vector

from .studio import Studio, matt_material

if TYPE_CHECKING:
    from gallery_scenes import Exhibit

SAMPLES = 16
FRONTS = ((0.055, 0.19, 0.42), (0.75, 0.38, 0.06), (0.05, 0.33, 0.22))
"""Colours of cloths one after the other, linear."""
BACKS = ((0.78, 0.71, 0.58), (0.85, 0.79, 0.66), (0.85, 0.79, 0.66))
STONE = (0.42, 0.42, 0.43)
CLEAR = 0.25
"""How much of what is seen through covers what is behind."""


class GalleryStudio(Studio):
    """Renders a baked scene with its colliders."""

    def __init__(self) -> None:
        super().__init__()
        self.scene.cycles.samples = SAMPLES
        self.scene.cycles.max_bounces = 3
        sides = zip(FRONTS, BACKS, strict=True)
        self.cloth_materials = [two_sided(front, back) for front, back in sides]
        self.stone = matt_material("Stone", STONE)
        self.clear = clear_material()

    def show(
        self, exhibit: Exhibit, scene: Path, cloths: list[Any], width: int, path: Path
    ) -> None:
        """Render cloths (positions (m), faces) among the colliders of a scene file into a PNG file."""
        self.place_camera(exhibit.view)
        description = tomllib.loads(scene.read_text(encoding="utf-8"))
        made = [
            self.build(positions, faces, self.cloth_materials[number % len(self.cloth_materials)])
            for number, (positions, faces) in enumerate(cloths)
        ]
        for collider in description.get("collider", []):
            material = self.clear if collider["name"] in exhibit.clear else self.stone
            made.append(self.build_collider(collider, exhibit, scene.parent, material))
        self.photograph(made, exhibit.view, width, path)

    def build(self, positions: Any, faces: list[list[int]], material: Any) -> bpy.types.Object:
        """A smooth mesh in the scene."""
        mesh = bpy.data.meshes.new("Mesh")
        mesh.from_pydata(np.asarray(positions).tolist(), [], faces)
        mesh.materials.append(material)
        mesh.shade_smooth()
        return self.link(mesh)

    def build_collider(
        self, collider: dict[str, Any], exhibit: Exhibit, folder: Path, material: Any
    ) -> bpy.types.Object:
        """A collider where it is at the exhibit's frame."""
        if "mesh" in collider:
            return self.build_mesh(collider, exhibit.frame, folder, material)
        import bmesh

        mesh = bpy.data.meshes.new("Collider")
        work = bmesh.new()
        if "sphere" in collider:
            radius = collider["sphere"]["radius"]
            bmesh.ops.create_uvsphere(work, u_segments=96, v_segments=48, radius=radius)
        elif "box" in collider:
            bmesh.ops.create_cube(work, size=1.0)
            bmesh.ops.scale(work, vec=collider["box"]["size"], verts=work.verts)
        else:
            bmesh.ops.create_grid(work, x_segments=1, y_segments=1, size=exhibit.plane)
        work.to_mesh(mesh)
        work.free()
        mesh.materials.append(material)
        if "sphere" in collider:
            mesh.shade_smooth()
        made = self.link(mesh)
        made.matrix_world = Matrix.Translation(motion(collider, exhibit.frame)) @ rest_place(
            collider
        )
        return made

    def build_mesh(
        self, collider: dict[str, Any], frame: int, folder: Path, material: Any
    ) -> bpy.types.Object:
        """A mesh collider, still or from its cache."""
        from gallery import faces_of, frame_of

        file = folder / collider["mesh"]
        if "cache" in collider:
            positions = frame_of(
                folder / collider["cache"], (frame - 1) // 2
            )  # a sample each second frame
        else:
            lines = file.read_text(encoding="utf-8").splitlines()
            positions = [list(map(float, x.split()[1:4])) for x in lines if x.startswith("v ")]
        made = self.build(positions, faces_of(file), material)
        if collider["name"] == "needles":
            made.data.shade_flat()
        return made


def rest_place(collider: dict[str, Any]) -> Matrix:
    """Where a sphere, box or plane stands at rest."""
    if "plane" in collider:
        plane = collider["plane"]
        turned = Vector(plane["normal"]).to_track_quat("Z", "Y").to_matrix().to_4x4()
        return Matrix.Translation(Vector(plane["point"])) @ turned
    body = collider.get("sphere") or collider["box"]
    degrees = body.get("rotation_deg", (0.0, 0.0, 0.0))
    turned = Euler([math.radians(angle) for angle in degrees]).to_matrix().to_4x4()
    return Matrix.Translation(Vector(body["center"])) @ turned


def motion(collider: dict[str, Any], frame: int) -> Vector:
    """How far (m) a collider has moved by a frame: straight from key to key."""
    keys = collider.get("motion", [{"frame": 1}])
    places = [key.get("location", (0.0, 0.0, 0.0)) for key in keys]
    frames = [key["frame"] for key in keys]
    return Vector([np.interp(frame, frames, axis) for axis in zip(*places, strict=True)])


def two_sided(
    front: tuple[float, float, float], back: tuple[float, float, float]
) -> bpy.types.Material:
    """A matt material whose sides have different colours."""
    made = matt_material("Cloth", front)
    nodes, links = made.node_tree.nodes, made.node_tree.links
    other = nodes.new("ShaderNodeBsdfDiffuse")
    other.inputs["Color"].default_value = (*back, 1.0)
    side = nodes.new("ShaderNodeNewGeometry")
    mix = nodes.new("ShaderNodeMixShader")
    links.new(side.outputs["Backfacing"], mix.inputs[0])
    links.new(nodes["Diffuse BSDF"].outputs["BSDF"], mix.inputs[1])
    links.new(other.outputs["BSDF"], mix.inputs[2])
    links.new(mix.outputs[0], nodes["Material Output"].inputs["Surface"])
    return made


def clear_material() -> bpy.types.Material:
    """A material that is mostly seen through."""
    made = matt_material("Clear", STONE)
    nodes, links = made.node_tree.nodes, made.node_tree.links
    through = nodes.new("ShaderNodeBsdfTransparent")
    mix = nodes.new("ShaderNodeMixShader")
    mix.inputs[0].default_value = CLEAR
    links.new(through.outputs["BSDF"], mix.inputs[1])
    links.new(nodes["Diffuse BSDF"].outputs["BSDF"], mix.inputs[2])
    links.new(mix.outputs[0], nodes["Material Output"].inputs["Surface"])
    return made
