"""Renders a scene in which Cycles and Velour are compared at equal noise with both.

The scenes favor neither engine: objects with Principled and diffuse materials under common lights. The
environment maps are those that every Blender includes.
"""

import importlib
import math
import resource
from pathlib import Path

import addon_utils
import bpy

from . import scene as build

BOUNCES = 4
_MOST = 1 << 15  # maximum number of samples of a render that stops at an error
_COLORS = ((0.8, 0.2, 0.1), (0.9, 0.6, 0.3), (0.2, 0.3, 0.8), (0.7, 0.7, 0.7))


def main(task):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("cycles")
    addon_utils.enable("velour")
    scene, folder = bpy.context.scene, Path(task["folder"])
    _set_up(scene, *task["size"])
    SCENES[task["scene"]]()
    seconds = {}
    for engine, samples in task["samples"].items():
        scene.render.engine = engine
        seconds[engine] = [_render(scene, engine, samples, seed, folder) for seed in range(task["seeds"])]
    scene.render.engine = "VELOUR"
    denoised = _denoised(scene, task["relmse"], task["seeds"], folder)
    return {"blender": bpy.app.version_string, "seconds": seconds, "denoised": denoised}


def _denoised(scene, relmse, seeds, folder):
    """Processor seconds of renders that stop when the error of the denoised picture is certain to be at most
    `relmse`; empty if there is no denoiser."""
    if importlib.import_module("velour.engine.denoising").missing():
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


def _principled(name, color=(0.5, 0.5, 0.5), **inputs):
    return build.material(name, **{"Base_Color": color, **inputs})


def _diffuse(name, color):
    return build.material(name, "BsdfDiffuse", Color=color)


def _emission(name, color, strength):
    return build.material(name, "Emission", Color=color, Strength=strength)


def _plane(size, material, location=(0, 0, 0), rotation=(0, 0, 0)):
    bpy.ops.mesh.primitive_plane_add(size=size, location=location, rotation=rotation)
    bpy.context.object.data.materials.append(material)


def _box(low, high, material):
    corners = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    build.polygons("Box", corners, faces, material)


def _four_balls():
    looks = ({"Roughness": 0.4}, {"Metallic": 1.0, "Roughness": 0.3}, {"Roughness": 0.2}, {"Roughness": 0.9})
    for i, (color, look) in enumerate(zip(_COLORS, looks, strict=True)):
        build.ball(((i - 1.5) * 1.6, 0, 0.7), 0.7, _principled(f"Ball {i}", color, **look))


def _floor(size):
    """Four balls under an environment map and an area light, on a floor of `size` m."""
    _plane(size, _principled("Floor", Roughness=0.5))
    _four_balls()
    build.world("forest")
    build.lamp("AREA", 1000, (2, -2, 3), (0, 0, 0), size=1.0)
    build.camera((0, -7, 2.6), (0, 0, 0.7), lens=50)


def _interior():
    """A room with ten lights and three windows, whose portals both engines support."""
    wall, wood = _diffuse("Wall", (0.75, 0.73, 0.7)), _principled("Wood", (0.4, 0.2, 0.1), Roughness=0.3)
    _box((-4, -3, -0.2), (4, 3, 0), wood)
    for low, high in (
        ((-4, -3, 3), (4, 3, 3.2)),
        ((-4.2, -3, 0), (-4, 3, 3)),
        ((-4, 3, 0), (4, 3.2, 3)),
        ((-4, -3.2, 0), (4, -3, 3)),
        ((4, -3, 0), (4.2, 3, 1)),  # below the windows
        ((4, -3, 2.4), (4.2, 3, 3)),  # above the windows
    ):
        _box(low, high, wall)
    edges = (-3, -2.4, -1.2, -0.6, 0.6, 1.2, 2.4, 3)
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        _box((4, begin, 1), (4.2, end, 2.4), wall)
    for begin, end in zip(edges[1:-1:2], edges[2:-1:2], strict=True):
        middle, size = (begin + end) / 2, {"shape": "RECTANGLE", "size": end - begin, "size_y": 1.4}
        build.lamp("AREA", 1, (4.1, middle, 1.7), (0, middle, 1.7), **size).data.cycles.is_portal = True
    for i in range(10):
        x, y = -3.2 + 1.5 * (i % 5), -1.5 + 3 * (i // 5)
        build.lamp("AREA", 12, (x, y, 2.8), (x, y, 0), size=0.25)
    _box((-1.6, -0.7, 0.7), (0.8, 0.7, 0.78), wood)
    for x, y in ((-1.5, -0.6), (0.65, -0.6), (-1.5, 0.55), (0.65, 0.55)):
        _box((x, y, 0), (x + 0.08, y + 0.08, 0.7), wood)
    build.ball((-0.9, 0, 0.98), 0.2, _principled("Steel", (0.8, 0.8, 0.8), Metallic=1.0, Roughness=0.25))
    build.ball((0.1, 0.2, 0.93), 0.15, _principled("Plastic", (0.1, 0.4, 0.2), Roughness=0.35))
    build.world("forest", 3.0)
    build.camera((-3.4, -2.6, 1.8), (1.0, 0.6, 0.9), lens=24)


def _hundred_lamps():
    _plane(20, _principled("Floor", Roughness=0.5))
    _four_balls()
    build.world()
    for i in range(100):
        x, y = (i % 10 - 4.5) * 0.9, (i // 10 - 4.5) * 0.9
        build.lamp("AREA", 10, (x, y, 3), (x, y, 0), size=0.2)
    build.camera((0, -7, 2.6), (0, 0, 0.7), lens=50)


def _metals():
    """Lit by an environment map alone."""
    _plane(30, _principled("Floor", (0.2, 0.2, 0.22), Roughness=0.25))
    for i in range(4):
        look = {"Metallic": 1.0, "Roughness": 0.15 + 0.15 * i}
        build.ball(((i - 1.5) * 1.6, 0, 0.7), 0.7, _principled(f"Metal {i}", _COLORS[i], **look))
    build.world("city")
    build.camera((0, -7, 2.6), (0, 0, 0.7), lens=50)


def _corridor():
    """Lit mostly by indirect light from the walls."""
    wall = _diffuse("Wall", (0.8, 0.78, 0.75))
    _box((-1.2, -0.2, -0.2), (1.2, 12, 0), _principled("Tiles", (0.3, 0.3, 0.32), Roughness=0.2))
    for low, high in (
        ((-1.2, -0.2, 2.5), (1.2, 12, 2.7)),
        ((-1.4, -0.2, 0), (-1.2, 12, 2.5)),
        ((1.2, -0.2, 0), (1.4, 7, 2.5)),
        ((1.2, 8.5, 0), (1.4, 12, 2.5)),
        ((-1.4, 12, 0), (1.4, 12.2, 2.5)),
    ):
        _box(low, high, wall)
    build.ball((0.4, 5, 0.5), 0.5, _principled("Ball", (0.7, 0.15, 0.1), Roughness=0.3))
    build.world()
    build.lamp("AREA", 150, (3.5, 7.7, 2.2), (0, 7.7, 1), size=0.8)
    build.camera((0, 0.2, 1.5), (0, 8, 1.1), lens=28)


def _signs():
    """Emissive signs, and a small strong emissive mesh to one side."""
    _plane(20, _principled("Floor", (0.3, 0.3, 0.3), Roughness=0.35))
    _four_balls()
    build.world(strength=0.05, color=(0.6, 0.7, 1.0))
    for i, color in enumerate(((1, 0.3, 0.2), (0.2, 1, 0.4), (0.3, 0.4, 1))):
        place = ((i - 1) * 2.4, 1.8, 1.6)
        _plane(1.0, _emission(f"Sign {i}", color, 8), place, (math.pi / 2, 0, 0))
    _plane(0.2, _emission("Spot", (1, 0.9, 0.7), 200), (2.5, -1.5, 2.5), (math.pi, 0, 0))
    build.camera((0, -7, 2.6), (0, 0, 0.7), lens=50)


def _copper(clamp=0.0):
    """Polished copper casts a small light's caustics on a wall. `clamp`: indirect clamp of both engines."""
    _plane(8, _principled("Floor", (0.3, 0.3, 0.3), Roughness=0.6))
    _plane(8, _diffuse("Wall", (0.7, 0.7, 0.7)), (0, 2, 2), (math.pi / 2, 0, 0))
    copper = _principled("Copper", (0.95, 0.64, 0.54), Metallic=1.0, Roughness=0.12)
    _plane(1.6, copper, (-0.7, 0.9, 0.05), (0.1, 0.05, 0.3))
    build.ball((0.9, 0.7, 0.6), 0.6, copper)
    build.world(strength=0.2, color=(0.6, 0.7, 0.9))
    build.lamp("AREA", 60, (-1.5, -1.5, 2.6), (-0.5, 1, 0), size=0.15)
    build.camera((0, -5, 1.8), (0, 0.8, 0.8), lens=45)
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
    "signs": _signs,
    "copper": _copper,
    "clamped copper": lambda: _copper(10),  # Cycles' default
}
