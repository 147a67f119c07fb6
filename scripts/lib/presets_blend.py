"""Runs inside Blender: writes a .blend of materials with packed models, marked as assets."""

from __future__ import annotations

import json
import sys

import addon_utils
import bpy
import numpy as np
from velour.core.presets import AUTHOR, LICENCE
from velour.export.nodes import velour_node

_PLAIN_TEXT = f"{LICENCE}, made by Velour's virtual goniometer"


def main() -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("velour", default_set=False, handle_error=_raise)
    write(json.loads(sys.argv[sys.argv.index("--") + 1]))


def write(task: dict) -> None:
    """`task`: path of the .blend, and its presets."""
    for preset in task["presets"]:
        add(preset)
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=task["path"], compress=True)


def add(preset: dict) -> None:
    before = set(bpy.data.materials)
    bpy.ops.velour.load_material(filepath=preset["model"], assign=False)
    (material,) = set(bpy.data.materials) - before
    material.name = preset["name"]
    node = velour_node(material)
    node.group.node_tree.name = preset["name"]
    node.image.name = f"{preset['name']}.velour"
    if preset["repeats"]:
        node.velour.placement.repeats = (preset["repeats"],) * 2
    describe(material, preset)


def describe(material: bpy.types.Material, preset: dict) -> None:
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


def _raise(error):
    raise error


if __name__ == "__main__":
    main()
