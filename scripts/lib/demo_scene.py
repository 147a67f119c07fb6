"""Runs inside Blender: builds the demo's scene, renders it with the model and with the measurement itself,
and measures the points of the error-against-time plot. The task is the JSON text after "--"."""

from __future__ import annotations

import json
import math
import os
import sys

import bpy
import numpy as np
from mathutils import Vector
from velour.native import images, render_job

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from blender_picture import empty_scene, measured_node, render_picture
from steps import print_step

SIZE = (640, 480)
SAMPLES, BOUNCES = 384, 1
WORLD, WORLD_ROTATION, WORLD_STRENGTH = "courtyard.exr", 250.0, 0.7

PLOT_REDUCTION = 4  # factor by which the sides of the picture shrink
PLOT_REFERENCE_SAMPLES = 2048
PLOT_SAMPLES = (16, 64, 256)
PLOT_STRATEGIES = ("uniform", "cosine", "srbf", "light", "mis")


def main(task: dict) -> None:
    scene = empty_scene(SIZE, SAMPLES, BOUNCES)
    subject = add_subject()
    add_ground()
    add_camera(scene)
    add_world(scene)
    node = _add_materials(subject, task["model"], task["measurement"])
    report = _render_pictures(scene, node, task["folder"])
    print_step("taking error against time")
    report["curves"] = _curves(scene)
    with open(task["report"], "w") as file:
        json.dump(report, file)


def add_subject() -> bpy.types.Object:
    rotation = (math.radians(-25), 0, math.radians(30))
    bpy.ops.mesh.primitive_monkey_add(size=2.0, rotation=rotation)
    subject = bpy.context.object
    smooth = subject.modifiers.new("Smooth", "SUBSURF")
    smooth.levels = smooth.render_levels = 3
    bpy.ops.object.shade_smooth()
    subject.location.z = -_lowest_point(subject)
    return subject


def _lowest_point(subject: bpy.types.Object) -> float:
    evaluated = subject.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return min((evaluated.matrix_world @ vertex.co).z for vertex in evaluated.data.vertices)


def add_ground() -> None:
    bpy.ops.mesh.primitive_circle_add(vertices=128, radius=9.0, fill_type="NGON")
    material = bpy.data.materials.new("Ground")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (0.18, 0.17, 0.16, 1)
    shader.inputs["Roughness"].default_value = 0.6
    bpy.context.object.data.materials.append(material)


def add_camera(scene: bpy.types.Scene) -> None:
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = (0.6, -6.4, 1.2)
    camera.rotation_euler = (Vector((0, 0, 0.8)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = 72
    scene.collection.objects.link(camera)
    scene.camera = camera


def add_world(scene: bpy.types.Scene) -> None:
    """One of the environments that come with Blender."""
    world = scene.world = bpy.data.worlds.new("World")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    background = next(node for node in nodes if node.bl_idname == "ShaderNodeBackground")
    background.inputs["Strength"].default_value = WORLD_STRENGTH
    picture, mapping, place = (
        nodes.new(f"ShaderNode{name}") for name in ("TexEnvironment", "Mapping", "TexCoord")
    )
    path = os.path.join(bpy.utils.system_resource("DATAFILES"), "studiolights", "world", WORLD)
    picture.image = bpy.data.images.load(path)
    mapping.inputs["Rotation"].default_value[2] = math.radians(WORLD_ROTATION)
    links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
    links.new(picture.outputs["Color"], background.inputs["Color"])


def _add_materials(subject: bpy.types.Object, model: str, measurement: str):
    """The subject's measured node, with the model and the measurement that the model was fitted to."""
    bpy.context.view_layer.objects.active = subject
    bpy.ops.velour.load_material(filepath=measurement, fit=False)
    raw = measured_node(subject.active_material)
    bpy.ops.velour.load_material(filepath=model)
    node = measured_node(subject.active_material)
    node.velour.measurement = raw.velour.measurement
    return node


def _render_pictures(scene: bpy.types.Scene, node, folder: str) -> dict:
    """Writes model.{exr,png} and reference.{exr,png}; returns the report of the model's render."""
    print_step("rendering the measurement")
    node.velour.use_reference = True
    render_picture(scene, folder, "reference")
    print_step("rendering the model")
    node.velour.use_reference = False
    return render_picture(scene, folder, "model")


def _curves(scene: bpy.types.Scene) -> dict[str, list[tuple[float, float]]]:
    """Strategy -> (seconds, relmse), against a long render of the same model: sampling error alone."""
    from velour.export import Notes, export_scene
    from velour.export.camera import final_view

    scene.render.resolution_x, scene.render.resolution_y = (side // PLOT_REDUCTION for side in SIZE)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    view = final_view(depsgraph, Notes())
    exported = export_scene(depsgraph, view, Notes()).scene
    with exported:

        def picture(strategy: str, samples: int, seed: int) -> tuple[np.ndarray, float]:
            options = {"strategy": strategy, "spp": samples, "seed": seed}
            with render_job(exported, width=view.width, height=view.height, **options) as job:
                seconds = job.run()["seconds"]
                return job.read_pass("Combined")[..., :3].copy(), seconds

        reference, _ = picture("mis", PLOT_REFERENCE_SAMPLES, seed=1)

        def point(strategy: str, samples: int) -> tuple[float, float]:
            pixels, seconds = picture(strategy, samples, seed=2)
            return seconds, images.compare(pixels, reference)[1]

        return {name: [point(name, samples) for samples in PLOT_SAMPLES] for name in PLOT_STRATEGIES}


if __name__ == "__main__":
    main(json.loads(sys.argv[sys.argv.index("--") + 1]))
