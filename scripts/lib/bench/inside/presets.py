"""Writes a .blend of materials with packed models, marked as assets."""

import addon_utils
import bpy
import numpy as np
from velour.core.presets import AUTHOR, LICENCE

from . import scene as build

_PLAIN_TEXT = f"{LICENCE}, made by Velour's virtual goniometer"


def main(task):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("velour", default_set=False, handle_error=build.refuse)
    write(task)


def write(task):
    """`task`: path of the .blend, and its presets."""
    for preset in task["presets"]:
        _add(preset)
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=task["path"], compress=True)


def _add(preset):
    before = set(bpy.data.materials)
    bpy.ops.velour.load_material(filepath=preset["model"], assign=False)
    (material,) = set(bpy.data.materials) - before
    material.name = preset["name"]
    node = build.measured_node(material)
    node.image.name = f"{preset['name']}.velour"
    if preset["repeats"]:
        node.velour.placement.repeats = (preset["repeats"],) * 2
        bpy.ops.velour.approximate(material=material.name)  # its image is placed like the tiles
    material.asset_mark()
    asset = material.asset_data
    asset.catalog_id = preset["catalog"]
    asset.author = AUTHOR
    asset.description = f"{preset['description']} ({_PLAIN_TEXT})"
    if hasattr(asset, "license"):  # not in Blender 3.4; the description names the license as well
        asset.license = LICENCE
    for tag in preset["tags"]:
        asset.tags.new(tag, skip_if_exists=True)
    pixels = np.load(preset["preview"])
    preview = material.preview_ensure()
    preview.image_size = pixels.shape[1], pixels.shape[0]
    preview.image_pixels_float.foreach_set(np.ascontiguousarray(pixels).ravel())
