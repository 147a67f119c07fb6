"""Renders the demo's scene with few samples, denoised in two ways, and with many."""

import os

import bpy
from support import inputs, scenes

from . import demo
from . import scene as build

BOUNCES = 2


def main(task):
    scene = build.empty(task["size"], task["few"], BOUNCES)
    bpy.context.view_layer.objects.active = demo.furnish()
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


def _compose(scene, passes):
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
