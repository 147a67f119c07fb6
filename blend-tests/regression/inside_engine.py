"""Runs inside Blender: renders a .blend with Velour or Cycles, both asked for the same picture.

The task: "blend", "scripts" (whether its own may run), "engine" (VELOUR, CYCLES), "bounces" (numbers),
"seeds", "samples", "width" (pixels; the height keeps the shape), "folder" (of the pictures,
BOUNCES-SEED.exr) and "report".
"""

from pathlib import Path

import addon_utils
import bpy
import inside

from parity import engines

_SEEDS_AND_SAMPLES = {"velour.seed", "velour.samples", "cycles.seed", "cycles.samples"}


def main(task):
    inside.open_file(task["blend"], task["scripts"])
    scene = bpy.context.scene
    addon_utils.enable("cycles")
    inside.enable_velour(scene)
    inside.show_renders(scene)
    inside.stop_animation(scene, _SEEDS_AND_SAMPLES)
    if scene.camera is None:
        raise RuntimeError("it has no camera; give its scene one.")
    scene.render.engine = task["engine"]
    _set_size(scene.render, task["width"])
    scene.velour.samples = task["samples"]
    engines.set_cycles_samples(scene.cycles, task["samples"])
    for bounces in task["bounces"]:
        engines.set_up_cycles(scene.cycles, bounces)
        scene.velour.bounces, scene.velour.split = (
            bounces,
            1,
        )  # every direction has its own place in the pixel
        for seed in task["seeds"]:
            scene.cycles.seed = scene.velour.seed = seed
            inside.render(scene, Path(task["folder"]) / f"{bounces}-{seed}.exr")


def _set_size(render, width):
    height = round(width * render.resolution_y * render.pixel_aspect_y)
    height //= max(round(render.resolution_x * render.pixel_aspect_x), 1)
    render.resolution_x, render.resolution_y = width, min(max(height, 16), 4 * width)
    render.resolution_percentage, render.use_border = 100, False
