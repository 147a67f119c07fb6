"""Runs inside Blender: builds a scene of blend-tests/scenes and saves it as a .blend.

The task: "scene" (the Python file), "blend" (to write) and "report", which gets "meaning".
"""

import importlib.util
from pathlib import Path

import addon_utils
import bpy


def main(task):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    for name in ("velour", "cycles"):  # film exposure and ray visibility are settings of Cycles
        addon_utils.enable(name, default_set=True)
    spec = importlib.util.spec_from_file_location("scene", task["scene"])
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    blend = Path(task["blend"])
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))  # what is beside the file is named relative to it
    module.build(blend.parent)
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    return {"meaning": getattr(module, "meaning", str)()}
