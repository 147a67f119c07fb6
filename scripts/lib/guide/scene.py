"""The scene of the guide's pictures: a monkey, or a cloth, under an environment that comes with Blender."""

import math

import bpy
from bench.inside import scene as build


def start(samples: int = 128, size: tuple[int, int] = (640, 420)) -> bpy.types.Scene:
    """Removes the cube and the light of a new file, and selects Velour as the engine."""
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    scene = bpy.context.scene
    scene.render.engine = "VELOUR"
    scene.velour.samples = samples
    scene.render.resolution_x, scene.render.resolution_y = size
    return scene


def add_monkey() -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add(rotation=(math.radians(-25), 0, math.radians(30)))
    monkey = bpy.context.object
    bpy.ops.object.subdivision_set(level=3)
    bpy.ops.object.shade_smooth()
    return monkey


def add_world() -> None:
    """A courtyard whose sun comes from the left."""
    build.world("courtyard", rotation=250.0)


def look_at(target: tuple[float, float, float], origin: tuple[float, float, float], lens: float) -> None:
    camera = bpy.context.scene.camera
    camera.location, camera.data.lens = origin, lens
    build.turn(camera, target)


def render(folder, name: str, size: tuple[int, int] | None = None) -> None:
    """Renders like F12, and saves the picture as displayed."""
    scene = bpy.context.scene
    if size:
        scene.render.resolution_x, scene.render.resolution_y = size
    bpy.ops.render.render()
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    bpy.data.images["Render Result"].save_render(str(folder / f"{name}.png"))
