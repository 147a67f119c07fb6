"""Writes a .blend of the preset materials with packed models: assets, as are their node groups."""

from unittest import mock

import addon_utils
import bpy
import numpy as np
from velour.core import presets
from velour.core.presets import AUTHOR, LICENCE
from velour.core.srgb import encoded
from velour.export.nodes import velour_node
from velour.native import images
from velour.operators import approximation_group, group_inputs

from . import scene as build

_PLAIN_TEXT = f"{LICENCE}, made by Velour's virtual goniometer"


def main(task):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("velour", default_set=False, handle_error=build.refuse)
    write(task)


def write(task):
    """`task`: path of the .blend, folder of the presets, ids of the catalogs of materials and of groups by
    name."""
    found = presets.listed(task["folder"])
    for number, preset in enumerate(found, 1):
        print(f"[{number}/{len(found)}] {preset.name}", flush=True)  # as scripts/build counts them
        # Assets are not refitted where they are used: they are right in Blender 3.5 and newer.
        with mock.patch.object(approximation_group, "MASKING", "correlated"):
            bpy.ops.velour.add_preset(preset=preset.name, directory=task["folder"], assign=False)
        material = bpy.data.materials[preset.name]
        _describe(material, preset, task["catalogs"][preset.catalog])
        group = velour_node(material).group.node_tree
        _describe(group, preset, task["group_catalogs"][preset.catalog])
        if preset.repeats:  # which belong to the material
            group_inputs.set_default(group, "Scale", 1 / preset.repeats)
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=task["path"], compress=True)


def _describe(datablock, preset, catalog):
    datablock.asset_mark()
    asset = datablock.asset_data
    asset.catalog_id = catalog
    asset.author = AUTHOR
    asset.description = f"{preset.description} ({_PLAIN_TEXT})"
    if hasattr(asset, "license"):  # not in Blender 3.4; the description names the license as well
        asset.license = LICENCE
    for tag in (*preset.tags, "velour"):
        asset.tags.new(tag, skip_if_exists=True)
    pixels = encoded(_halved(images.read_picture(preset.picture)))
    opaque = np.concatenate([pixels, np.ones((*pixels.shape[:2], 1))], axis=-1)
    preview = datablock.preview_ensure()
    preview.image_size = pixels.shape[1], pixels.shape[0]
    preview.image_pixels_float.foreach_set(opaque.astype(np.float32).ravel())


def _halved(pixels):
    """Means of 2 x 2 pixels: larger than the browser shows them, previews would outweigh most models."""
    height, width, channels = pixels.shape
    return pixels.reshape(height // 2, 2, width // 2, 2, channels).mean(axis=(1, 3))
