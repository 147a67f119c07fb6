"""Builds a large scene and renders few pixels of it, with both engines in turn."""

import addon_utils
import bpy

from . import scene as build


def grid(triangles):
    """One mesh: a smooth-shaded plane."""
    side = round((triangles / 2) ** 0.5)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side, y_subdivisions=side, size=10)
    bpy.ops.object.shade_smooth()


def instances(count):
    """Instances of a small sphere at the vertices of a plane. Returns both."""
    side = round(count**0.5)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=0.01)
    sphere = bpy.context.object
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side - 1, y_subdivisions=side - 1, size=10)
    plane = bpy.context.object
    sphere.parent, plane.instance_type = plane, "VERTS"
    plane.show_instancer_for_render = plane.show_instancer_for_viewport = False
    return sphere, plane


def objects(count):
    """Cubes, each with its own mesh."""
    bpy.ops.mesh.primitive_cube_add(size=0.05)
    first, side = bpy.context.object, round(count**0.5)
    for i in range(1, count):
        build.link("Cube", first.data.copy(), (i % side / 10, i // side / 10, 0))


def main(task):
    addon_utils.enable("velour", default_set=True)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("velour", default_set=True)
    {"grid": grid, "instances": instances, "objects": objects}[task["kind"]](task["count"])
    scene = bpy.context.scene
    build.camera((0, 0, 20))
    scene.world = bpy.data.worlds.new("World")
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.velour.samples = scene.cycles.samples = 1
    scene.cycles.use_denoising = False
    for engine in ("VELOUR", "CYCLES") * task["renders"]:
        scene.render.engine = engine
        bpy.ops.render.render()
