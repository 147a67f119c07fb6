"""Runs inside Blender: renders a scene in which Cycles and Velour are compared at equal noise with both.

The scenes favor neither engine: objects with Principled and diffuse materials under common lights. The
environment maps are those that every Blender includes.
"""

import importlib
import json
import math
import resource
import sys
from pathlib import Path

import addon_utils
import bpy
import mathutils

BOUNCES = 4
_MOST = 1 << 15  # maximum number of samples of a render that stops at an error
_COLORS = ((0.8, 0.2, 0.1), (0.9, 0.6, 0.3), (0.2, 0.3, 0.8), (0.7, 0.7, 0.7))


def main(task):
    build = SCENES[task["scene"]]
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("cycles")
    addon_utils.enable("velour")
    scene = bpy.context.scene
    _set_up(scene, *task["size"])
    build()
    seconds = {}
    for engine, samples in task["samples"].items():
        scene.render.engine = engine
        seconds[engine] = []
        for seed in range(task["seeds"]):
            seconds[engine].append(_render(scene, engine, samples, seed, Path(task["folder"])))
    scene.render.engine = "VELOUR"
    denoised = _denoised(scene, task["relmse"], task["seeds"], Path(task["folder"]))
    said = {"blender": bpy.app.version_string, "seconds": seconds, "denoised": denoised}
    Path(task["report"]).write_text(json.dumps(said), encoding="utf-8")


def _denoised(scene, relmse, seeds, folder):
    """Processor seconds of renders that stop when the error of the denoised picture is certain to be at most
    `relmse`; empty if there is no denoiser."""
    denoising = importlib.import_module("velour.engine.denoising")
    if denoising.missing():
        return []
    velour = scene.velour
    velour.use_denoising = velour.use_noise_target = True
    velour.noise_target = relmse**0.5
    return [_render(scene, "DENOISED", _MOST, seed, folder) for seed in range(seeds)]


def _render(scene, engine, samples, seed, folder):
    """Processor seconds, including the export and the BVH build."""
    scene.cycles.seed = scene.velour.seed = seed
    scene.cycles.samples = scene.velour.samples = samples
    scene.render.filepath = str(folder / f"{engine}{seed}.exr")
    before = resource.getrusage(resource.RUSAGE_SELF)
    bpy.ops.render.render(write_still=True)
    after = resource.getrusage(resource.RUSAGE_SELF)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def _set_up(scene, width, height):
    """The same light transport for both: unbiased, with a filter of one pixel."""
    render, cycles = scene.render, scene.cycles
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = scene.velour.bounces = BOUNCES
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.pixel_filter_type = "BOX"
    scene.velour.use_denoising = False


def _material(name, color=(0.5, 0.5, 0.5), **inputs):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    node = material.node_tree.nodes["Principled BSDF"]
    for socket, value in {"Base Color": (*color, 1), **inputs}.items():
        node.inputs[socket.replace("_", " ")].default_value = value
    return material


def _diffuse(name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeBsdfDiffuse")
    node.inputs["Color"].default_value = (*color, 1)
    tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    return material


def _emission(name, color, strength):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeEmission")
    node.inputs["Color"].default_value, node.inputs["Strength"].default_value = (*color, 1), strength
    tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    return material


def _plane(size, material, location=(0, 0, 0), rotation=(0, 0, 0)):
    bpy.ops.mesh.primitive_plane_add(size=size, location=location, rotation=rotation)
    bpy.context.object.data.materials.append(material)


def _box(low, high, material):
    corners = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    mesh = bpy.data.meshes.new("Box")
    mesh.from_pydata(corners, [], faces)
    mesh.materials.append(material)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Box", mesh))


def _ball(location, radius, material):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=location, segments=48, ring_count=24)
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(material)


def _four_balls():
    looks = ({"Roughness": 0.4}, {"Metallic": 1.0, "Roughness": 0.3}, {"Roughness": 0.2}, {"Roughness": 0.9})
    for i, (color, look) in enumerate(zip(_COLORS, looks, strict=True)):
        _ball(((i - 1.5) * 1.6, 0, 0.7), 0.7, _material(f"Ball {i}", color, **look))


def _world(name=None, strength=1.0, color=(0, 0, 0)):
    """`name`: an environment map that comes with Blender."""
    world = bpy.context.scene.world = bpy.data.worlds.new("World")
    world.use_nodes = True
    tree = world.node_tree
    background = tree.nodes["Background"]
    background.inputs["Color"].default_value = (*color, 1)
    background.inputs["Strength"].default_value = strength
    if name:
        picture = tree.nodes.new("ShaderNodeTexEnvironment")
        folder = bpy.utils.system_resource("DATAFILES")
        picture.image = bpy.data.images.load(f"{folder}/studiolights/world/{name}.exr")
        tree.links.new(picture.outputs[0], background.inputs["Color"])


def _lamp(kind, energy, location, towards=(0, 0, 0), **settings):
    lamp = bpy.data.lights.new("Lamp", kind)
    lamp.energy = energy
    for name, value in settings.items():
        setattr(lamp, name, value)
    obj = bpy.data.objects.new("Lamp", lamp)
    obj.location = location
    way = mathutils.Vector(towards) - mathutils.Vector(location)
    obj.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(obj)
    return obj


def _camera(location, towards, lens=50.0):
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.lens, camera.location = lens, location
    way = mathutils.Vector(towards) - mathutils.Vector(location)
    camera.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def _floor(size):
    """Four balls under an environment map and an area light, on a floor of `size` m."""
    _plane(size, _material("Floor", Roughness=0.5))
    _four_balls()
    _world("forest")
    _lamp("AREA", 1000, (2, -2, 3), size=1.0)
    _camera((0, -7, 2.6), (0, 0, 0.7))


def _interior():
    """A room with ten lights and three windows, whose portals both engines support."""
    wall, wood = _diffuse("Wall", (0.75, 0.73, 0.7)), _material("Wood", (0.4, 0.2, 0.1), Roughness=0.3)
    _box((-4, -3, -0.2), (4, 3, 0), wood)
    _box((-4, -3, 3), (4, 3, 3.2), wall)
    _box((-4.2, -3, 0), (-4, 3, 3), wall)
    _box((-4, 3, 0), (4, 3.2, 3), wall)
    _box((-4, -3.2, 0), (4, -3, 3), wall)
    for low, high in (((-3, 0), (3, 1)), ((-3, 2.4), (3, 3))):  # below and above the windows
        _box((4, low[0], low[1]), (4.2, high[0], high[1]), wall)
    edges = (-3, -2.4, -1.2, -0.6, 0.6, 1.2, 2.4, 3)
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        _box((4, begin, 1), (4.2, end, 2.4), wall)
    for begin, end in zip(edges[1:-1:2], edges[2:-1:2], strict=True):
        portal = _lamp("AREA", 1, (4.1, (begin + end) / 2, 1.7), (0, (begin + end) / 2, 1.7))
        portal.data.shape, portal.data.size, portal.data.size_y = "RECTANGLE", end - begin, 1.4
        portal.data.cycles.is_portal = True
    for i in range(10):
        place = (-3.2 + 1.5 * (i % 5), -1.5 + 3 * (i // 5), 2.8)
        _lamp("AREA", 12, place, (place[0], place[1], 0), size=0.25)
    _box((-1.6, -0.7, 0.7), (0.8, 0.7, 0.78), wood)
    for x, y in ((-1.5, -0.6), (0.65, -0.6), (-1.5, 0.55), (0.65, 0.55)):
        _box((x, y, 0), (x + 0.08, y + 0.08, 0.7), wood)
    _ball((-0.9, 0, 0.98), 0.2, _material("Steel", (0.8, 0.8, 0.8), Metallic=1.0, Roughness=0.25))
    _ball((0.1, 0.2, 0.93), 0.15, _material("Plastic", (0.1, 0.4, 0.2), Roughness=0.35))
    _world("forest", 3.0)
    _camera((-3.4, -2.6, 1.8), (1.0, 0.6, 0.9), 24)


def _hundred_lamps():
    _plane(20, _material("Floor", Roughness=0.5))
    _four_balls()
    _world()
    for i in range(100):
        place = ((i % 10 - 4.5) * 0.9, (i // 10 - 4.5) * 0.9, 3)
        _lamp("AREA", 10, place, (place[0], place[1], 0), size=0.2)
    _camera((0, -7, 2.6), (0, 0, 0.7))


def _metals():
    """Lit by an environment map alone."""
    _plane(30, _material("Floor", (0.2, 0.2, 0.22), Roughness=0.25))
    for i in range(4):
        look = {"Metallic": 1.0, "Roughness": 0.15 + 0.15 * i}
        _ball(((i - 1.5) * 1.6, 0, 0.7), 0.7, _material(f"Metal {i}", _COLORS[i], **look))
    _world("city")
    _camera((0, -7, 2.6), (0, 0, 0.7))


def _corridor():
    """Lit mostly by indirect light from the walls."""
    wall = _diffuse("Wall", (0.8, 0.78, 0.75))
    _box((-1.2, -0.2, -0.2), (1.2, 12, 0), _material("Tiles", (0.3, 0.3, 0.32), Roughness=0.2))
    _box((-1.2, -0.2, 2.5), (1.2, 12, 2.7), wall)
    _box((-1.4, -0.2, 0), (-1.2, 12, 2.5), wall)
    _box((1.2, -0.2, 0), (1.4, 7, 2.5), wall)
    _box((1.2, 8.5, 0), (1.4, 12, 2.5), wall)
    _box((-1.4, 12, 0), (1.4, 12.2, 2.5), wall)
    _ball((0.4, 5, 0.5), 0.5, _material("Ball", (0.7, 0.15, 0.1), Roughness=0.3))
    _world()
    _lamp("AREA", 150, (3.5, 7.7, 2.2), (0, 7.7, 1), size=0.8)
    _camera((0, 0.2, 1.5), (0, 8, 1.1), 28)


def _glowing():
    """Emissive signs, and a small strong emissive mesh to one side."""
    _plane(20, _material("Floor", (0.3, 0.3, 0.3), Roughness=0.35))
    _four_balls()
    _world(strength=0.05, color=(0.6, 0.7, 1.0))
    for i, color in enumerate(((1, 0.3, 0.2), (0.2, 1, 0.4), (0.3, 0.4, 1))):
        place = ((i - 1) * 2.4, 1.8, 1.6)
        _plane(1.0, _emission(f"Sign {i}", color, 8), place, (math.pi / 2, 0, 0))
    _plane(0.2, _emission("Spot", (1, 0.9, 0.7), 200), (2.5, -1.5, 2.5), (math.pi, 0, 0))
    _camera((0, -7, 2.6), (0, 0, 0.7))


def _copper(clamp=0.0):
    """Polished copper casts a small light's caustics on a wall. `clamp`: indirect clamp of both engines."""
    _plane(8, _material("Floor", (0.3, 0.3, 0.3), Roughness=0.6))
    _plane(8, _diffuse("Wall", (0.7, 0.7, 0.7)), (0, 2, 2), (math.pi / 2, 0, 0))
    copper = _material("Copper", (0.95, 0.64, 0.54), Metallic=1.0, Roughness=0.12)
    _plane(1.6, copper, (-0.7, 0.9, 0.05), (0.1, 0.05, 0.3))
    _ball((0.9, 0.7, 0.6), 0.6, copper)
    _world(strength=0.2, color=(0.6, 0.7, 0.9))
    _lamp("AREA", 60, (-1.5, -1.5, 2.6), (-0.5, 1, 0), size=0.15)
    _camera((0, -5, 1.8), (0, 0.8, 0.8), 45)
    scene = bpy.context.scene
    scene.cycles.sample_clamp_indirect = scene.velour.clamp_indirect = clamp


SCENES = {
    "floor of 9 m": lambda: _floor(9),
    "floor of 20 m": lambda: _floor(20),
    "floor of 200 m": lambda: _floor(200),
    "room": _interior,
    "hundred lamps": _hundred_lamps,
    "metals": _metals,
    "corridor": _corridor,
    "signs": _glowing,
    "copper": _copper,
    "clamped copper": lambda: _copper(10),  # Cycles' default
}


if __name__ == "__main__":
    main(json.loads(sys.argv[sys.argv.index("--") + 1]))
