"""How the demo looks: yarn, room, light, camera. Runs inside Blender; knows no simulation.

The cloth hangs in the plane y = 0 with its top edge at z = TOP (m); the camera looks along +y.
"""

from __future__ import annotations

import math

import bpy

TOP = 2.05
"""Height (m) of the rod that the cloth hangs from."""
RING = 0.026
"""Radius (m) of the rings on the rod."""
FLOOR = 0.0
WALL = 1.1
"""Distance (m) of the wall behind the cloth."""
YARN = (0.86, 0.27, 0.13)
SECOND_YARN = (0.95, 0.48, 0.29)
LOOPS = 2.2
"""Size of the loops, as a fraction of the material's own."""
WARM_WHITE = (0.80, 0.72, 0.62)
BRASS = (0.83, 0.58, 0.27)


def dress(cloth: bpy.types.Object, rod_length: float) -> None:
    """Give the cloth its yarn and build the room around it."""
    weave_in(cloth)
    for polygon in cloth.data.polygons:
        polygon.use_smooth = True
    refine(cloth)
    build_room()
    build_rod(rod_length)
    light_room()
    place_camera()


def refine(cloth: bpy.types.Object) -> None:
    """Smooth the mesh and give it thickness, below the simulation in the modifier stack."""
    smooth = cloth.modifiers.new("Smooth", "SUBSURF")
    smooth.levels, smooth.render_levels = 0, 1
    thicken = cloth.modifiers.new("Thickness", "SOLIDIFY")
    thicken.thickness = 0.006


def material(name: str, color: tuple[float, float, float], **sockets: float) -> bpy.types.Material:
    """A principled material; `sockets` are its inputs, with _ for blanks."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    for key, value in sockets.items():
        shader.inputs[key.replace("_", " ").title()].default_value = value
    return made


def weave_in(cloth: bpy.types.Object) -> None:
    """The add-on's bouclé, in two shades of one colour and with loops that a picture of the whole curtain shows."""
    bpy.context.view_layer.objects.active = cloth
    bpy.ops.boucle.add_material(fabric="boucle", color=YARN, scale=LOOPS)
    values = next(
        node for node in cloth.active_material.node_tree.nodes if node.type == "GROUP"
    ).inputs
    values["Second Color"].default_value = (*SECOND_YARN, 1.0)


def flatten(cloth: bpy.types.Object) -> None:
    """Leave the loops their colours but no relief: in a small video they are less than two pixels wide and would flicker."""
    for node in cloth.active_material.node_tree.nodes:
        if node.type == "GROUP":
            bump = next(inner for inner in node.node_tree.nodes if inner.type == "BUMP")
            node.node_tree.nodes.remove(bump)


def build_room() -> None:
    """A floor that bends up into a wall, so that no edge shows."""
    radius, steps = 0.7, 24
    profile = [(-9.0, FLOOR)]
    for i in range(steps + 1):
        angle = 0.5 * math.pi * i / steps
        y = WALL - radius + radius * math.sin(angle)
        profile.append((y, FLOOR + radius * (1.0 - math.cos(angle))))
    profile.append((WALL, 7.0))
    vertices = [(x, y, z) for y, z in profile for x in (-9.0, 9.0)]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
    mesh = bpy.data.meshes.new("Room")
    mesh.from_pydata(vertices, [], faces)
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    room = bpy.data.objects.new("Room", mesh)
    mesh.materials.append(material("Plaster", WARM_WHITE, roughness=0.9))
    bpy.context.scene.collection.objects.link(room)


def build_rod(length: float) -> None:
    """A brass rod just above the cloth, with a ball at each end."""
    brass = material("Brass", BRASS, metallic=1.0, roughness=0.25)
    bpy.ops.mesh.primitive_cylinder_add(
        vertices=48,
        radius=0.011,
        depth=length,
        location=(0, 0, TOP),
        rotation=(0, 0.5 * math.pi, 0),
    )
    parts = [bpy.context.object]
    for side in (-0.5, 0.5):
        bpy.ops.mesh.primitive_uv_sphere_add(
            segments=48, ring_count=24, radius=0.028, location=(side * length, 0, TOP)
        )
        parts.append(bpy.context.object)
    for part in parts:
        part.name = "Rod"
        part.data.materials.append(brass)
        for polygon in part.data.polygons:
            polygon.use_smooth = True


def build_rings(places: list[float]) -> list[bpy.types.Object]:
    """A brass ring on the rod at each place along it (m), for the cloth to hang from."""
    brass = bpy.data.materials["Brass"]
    rings = []
    for x in places:
        bpy.ops.mesh.primitive_torus_add(
            major_segments=32,
            minor_segments=10,
            major_radius=RING,
            minor_radius=0.0032,
            location=(x, 0, TOP - RING + 0.013),
            rotation=(0, 0.5 * math.pi, 0),
        )
        ring = bpy.context.object
        ring.name = "Ring"
        ring.data.materials.append(brass)
        rings.append(ring)
    return rings


def area_light(
    name: str, place: tuple, target: tuple, size: float, power: float, color: tuple
) -> None:
    """A square lamp (m, W) at a place, looking at a target."""
    lamp = bpy.data.lights.new(name, "AREA")
    lamp.shape, lamp.size, lamp.energy, lamp.color = "SQUARE", size, power, color
    made = bpy.data.objects.new(name, lamp)
    made.location = place
    made.rotation_euler = look(place, target)
    bpy.context.scene.collection.objects.link(made)


def look(place: tuple, target: tuple) -> tuple:
    """Rotation that turns a camera or lamp at `place` towards `target`."""
    from mathutils import Vector

    return (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()


def light_room() -> None:
    """A large warm lamp from the left that grazes the folds, a cool one opposite, little from everywhere."""
    middle = (0.0, 0.0, 1.2)
    area_light("Window", (-2.9, -1.5, 2.5), middle, 1.8, 250.0, (1.0, 0.95, 0.88))
    area_light("Fill", (3.6, -2.6, 1.6), middle, 2.6, 40.0, (0.78, 0.87, 1.0))
    area_light("Rim", (1.6, 0.85, 3.2), middle, 0.7, 40.0, (1.0, 0.95, 0.88))
    world = bpy.data.worlds.new("Room")
    bpy.context.scene.world = world
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.75, 0.8, 0.9, 1.0)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.10


def place_camera() -> None:
    """A portrait lens, a little to the right of the middle."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.lens = 74.0
    camera.location = (0.9, -4.3, 1.30)
    camera.rotation_euler = look(camera.location, (0.0, 0.0, 1.14))
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def prepare_render(width: int, height: int, samples: int) -> None:
    """Cycles on the processor, denoised."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = True
    scene.cycles.use_denoising = True
    scene.cycles.denoising_prefilter = "FAST"
    scene.cycles.denoising_quality = "BALANCED"
    scene.cycles.use_light_tree = False
    scene.cycles.max_bounces = 2
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.use_persistent_data = True
    scene.view_settings.view_transform = "AgX"
    scene.view_settings.look = "AgX - Medium High Contrast"
