"""Runs inside Blender: times Cycles on one mesh, world and camera. The task is the JSON text after "--"."""

from __future__ import annotations

import json
import sys
import time

import bpy
from mathutils import Vector


def main(task: dict) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = _settings(task)
    bpy.ops.wm.obj_import(filepath=task["mesh"])
    subject = bpy.context.object
    bpy.ops.object.shade_smooth()
    subject.data.materials.clear()
    subject.data.materials.append(_material(task))
    _add_camera(scene, task)
    _add_world(scene, task["world"])
    _render(scene, task["rays"][0])  # the first render of a process does extra work
    seconds = [_render(scene, rays) for rays in task["rays"]]
    with open(task["report"], "w") as file:
        json.dump({"seconds": seconds, "version": bpy.app.version_string}, file)


def _settings(task: dict) -> bpy.types.Scene:
    """Direct light only, without adaptive sampling and denoising."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = task["size"]
    scene.render.threads_mode, scene.render.threads = "FIXED", task["threads"]
    scene.cycles.device = "CPU"
    scene.cycles.max_bounces = 0
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    return scene


def _material(task: dict) -> bpy.types.Material:
    material = bpy.data.materials.new("Closest")
    material.use_nodes = True
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (*task["color"], 1)
    inputs["Metallic"].default_value = 1
    inputs["Roughness"].default_value = task["roughness"]
    return material


def _add_camera(scene: bpy.types.Scene, task: dict) -> None:
    *places, fov = map(float, task["camera"].split(","))
    eye, target = Vector(places[:3]), Vector(places[3:])
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = eye
    camera.rotation_euler = (target - eye).to_track_quat("-Z", "Y").to_euler()
    camera.data.sensor_fit, camera.data.angle = "VERTICAL", fov * 0.017453292519943295
    scene.collection.objects.link(camera)
    scene.camera = camera


def _add_world(scene: bpy.types.Scene, path: str) -> None:
    world = scene.world = bpy.data.worlds.new("World")
    world.use_nodes = True
    picture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    picture.image = bpy.data.images.load(path)
    world.node_tree.links.new(picture.outputs["Color"], world.node_tree.nodes["Background"].inputs["Color"])


def _render(scene: bpy.types.Scene, rays: int) -> float:
    scene.cycles.samples = rays
    start = time.perf_counter()
    bpy.ops.render.render()
    return time.perf_counter() - start


if __name__ == "__main__":
    main(json.loads(sys.argv[sys.argv.index("--") + 1]))
