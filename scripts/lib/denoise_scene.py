"""Runs inside Blender: renders the demo's scene with few samples, denoised in two ways, and with many.

The task is the JSON text after "--".
"""

from __future__ import annotations

import json
import os
import sys

import bpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../blend-tests"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from blender_picture import empty_scene
from demo_scene import add_camera, add_ground, add_subject, add_world
from support import inputs, scenes

BOUNCES = 2


def main(task: dict) -> None:
    scene = empty_scene(task["size"], task["few"], BOUNCES)
    subject = add_subject()
    add_ground()
    add_camera(scene)
    add_world(scene)
    bpy.context.view_layer.objects.active = subject
    bpy.ops.velour.load_material(filepath=str(inputs.plastic_measurement()))
    bpy.context.view_layer.velour.use_pass_denoising = True
    for name, samples, passes in (
        ("few", task["few"], None),
        ("without", task["few"], ()),
        ("denoised", task["few"], ("Normal", "Albedo")),
        ("many", task["many"], None),
    ):
        scene.velour.samples = samples
        _compose(scene, passes)
        scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
        scene.render.filepath = os.path.join(task["folder"], f"{name}.exr")
        bpy.ops.render.render(write_still=True)


def _compose(scene: bpy.types.Scene, passes: tuple[str, ...] | None) -> None:
    """Outputs the image through a Denoise node that is fed `passes`; None: the image itself."""
    show = scenes.composite(scene)
    show("Image")
    if passes is None:
        return
    tree = scenes.compositor(scene)
    source = next(node for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers")
    sink = next(link.to_socket for link in tree.links if link.from_node == source)
    denoise = tree.nodes.new("CompositorNodeDenoise")
    tree.links.new(source.outputs["Image"], denoise.inputs["Image"])
    for name in passes:
        tree.links.new(source.outputs[f"Denoising {name}"], denoise.inputs[name])
    tree.links.new(denoise.outputs[0], sink)


main(json.loads(sys.argv[sys.argv.index("--") + 1]))
