"""Runs inside Blender: captures and compresses a tile of weave, and renders the demo's subject with the model
and with the BTF itself. The task is the JSON text after "--"."""

from __future__ import annotations

import json
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from blender_picture import empty_scene, measured_node, render_picture
from captured_tile import NAME, capture_and_compress
from demo_scene import SIZE, add_camera, add_ground, add_subject, add_world
from steps import print_step

SAMPLES, BOUNCES = 96, 1
CAPTURE = {"texels": 48, "views": 81, "lights": 81, "samples": 8, "bounces": 1}
TILE = 0.11  # meters on the subject: large enough to see


def main(task: dict) -> None:
    scene = empty_scene(SIZE, SAMPLES, BOUNCES)
    report = _make_material(task["folder"])
    _add_subject().data.materials.append(bpy.data.materials[NAME])
    add_ground()
    add_camera(scene)
    add_world(scene)
    node = measured_node(bpy.data.materials[NAME])
    for name, itself, step in (
        ("reference", True, "rendering the BTF"),
        ("model", False, "rendering the model of the BTF"),
    ):
        print_step(step)
        node.velour.use_reference = itself
        report[f"{name}_seconds"] = render_picture(scene, task["folder"], name)["seconds"]
    with open(task["report"], "w") as file:
        json.dump(report, file)


def _make_material(folder: str) -> dict:
    bpy.ops.velour.add_mesostructure(type="WEAVE")
    tile = bpy.context.object
    print_step("capturing a tile of weave")
    report = capture_and_compress(
        folder, CAPTURE, 0, captured=lambda: print_step("fitting a model to its BTF")
    )
    bpy.data.objects.remove(tile)
    return report


def _add_subject() -> bpy.types.Object:
    """With a cube projection: tiles of one size all over the subject, with seams between the six sides."""
    subject = add_subject()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.cube_project(cube_size=TILE)
    bpy.ops.object.mode_set(mode="OBJECT")
    return subject


if __name__ == "__main__":
    main(json.loads(sys.argv[sys.argv.index("--") + 1]))
