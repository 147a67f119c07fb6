"""Times Cycles on one mesh, world and camera, by direct light, without adaptive sampling and denoising."""

import time

import bpy

from . import scene as build


def main(task):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = task["size"]
    scene.render.threads_mode, scene.render.threads = "FIXED", task["threads"]
    scene.cycles.device = "CPU"
    scene.cycles.max_bounces = 0
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    bpy.ops.wm.obj_import(filepath=task["mesh"])
    bpy.ops.object.shade_smooth()
    look = {"Base_Color": tuple(task["color"]), "Metallic": 1, "Roughness": task["roughness"]}
    materials = bpy.context.object.data.materials
    materials.clear()
    materials.append(build.material("Closest", **look))
    build.framed_camera(task["camera"])
    build.world(task["world"])
    _render(scene, task["rays"][0])  # the first render of a process does extra work
    return {"seconds": [_render(scene, rays) for rays in task["rays"]], "version": bpy.app.version_string}


def _render(scene, rays):
    scene.cycles.samples = rays
    start = time.perf_counter()
    bpy.ops.render.render()
    return time.perf_counter() - start
