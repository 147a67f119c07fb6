"""Renders a Sky Texture by Cycles, in a Blender of its own: Blender's models of the sky have no interface.

Run as a script. Its last argument is a JSON file with "node" (values of the node's properties), "width" (of
the image, pixels), "path" (of the .npz to write). It writes

- sky [width / 2 x width x 3] float16: radiance without the sun, equirectangular, row 0 at the bottom
- sun [3]: mean radiance of the disk of the sun; 0 if the node shows none
"""

import json
import math
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np

_SIDE, _MARGIN = 32, 1.2  # pixels of the picture of the sun, and its width over that of the disk


def main(order):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene, node = bpy.context.scene, _sky_node(order["node"])
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = "CPU", 1, False, False
    cycles.pixel_filter_type, scene.render.filter_size = "BOX", 1.0
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    has_sun = bool(getattr(node, "sun_disc", False))
    if has_sun:
        node.sun_disc = False
    with tempfile.TemporaryDirectory() as folder:
        sky = _panorama(scene, order["width"], Path(folder))
        sun = _sun(scene, node, Path(folder)) if has_sun else np.zeros(3)
    with open(order["path"], "wb") as file:
        largest = np.finfo(np.float16).max
        np.savez_compressed(file, sky=np.minimum(sky, largest).astype(np.float16), sun=sun)


def _sky_node(values):
    world = bpy.data.worlds.new("World")
    bpy.context.scene.world = world
    world.use_nodes = True
    tree = world.node_tree
    node = tree.nodes.new("ShaderNodeTexSky")
    for name, value in sorted(values.items(), key=lambda item: item[0] != "sky_type"):
        setattr(node, name, value)
    tree.links.new(node.outputs[0], tree.nodes["Background"].inputs["Color"])
    return node


def _panorama(scene, width, folder):
    """[height x width x 3], whose middle looks along +x, as in an Environment Texture."""
    camera = scene.camera.data
    camera.type = "PANO"
    owner = camera if hasattr(camera, "panorama_type") else camera.cycles
    owner.panorama_type = "EQUIRECTANGULAR"
    scene.camera.rotation_euler = math.pi / 2, 0, -math.pi / 2
    return _rendered(scene, (width, width // 2), folder)


def _sun(scene, node, folder):
    """Mean radiance [3] of the disk, without what the sky adds there."""
    camera = scene.camera.data
    camera.type, camera.sensor_width, camera.sensor_fit = "PERSP", 1.0, "HORIZONTAL"
    camera.angle = 2 * math.atan(_MARGIN * math.tan(node.sun_size / 2))
    elevation, turn = node.sun_elevation, node.sun_rotation
    scene.camera.rotation_euler = math.pi / 2 + elevation, 0, -turn
    scene.cycles.samples = 16
    means = []
    for node.sun_disc in (True, False):
        means.append(_rendered(scene, (_SIDE, _SIDE), folder).mean(axis=(0, 1), dtype=np.float64))
    return (means[0] - means[1]) * _MARGIN**2 / (math.pi / 4)


def _rendered(scene, size, folder):
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage, scene.render.filepath = 100, str(folder / "picture.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath, check_existing=False)
    pixels = np.empty(4 * size[0] * size[1], np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(size[1], size[0], 4)[..., :3]


if __name__ == "__main__":
    main(json.loads(Path(sys.argv[-1]).read_text(encoding="utf-8")))
