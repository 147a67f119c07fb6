"""How much the part of a night's shot flickers in which nothing moves."""

import os

import addon_utils
import bpy
import numpy as np

from . import scene as build

STATIC = (0.0, 0.25, 0.55, 0.95)  # left, right, bottom, top of what nothing moves in, as parts of the image


def main(task):
    """Renders `count` images each of consecutive frames with the seeds of the shot and with one seed, and of
    one frame with independent seeds. Returns _difference() of each kind."""
    addon_utils.enable("velour", default_set=False, handle_error=build.refuse)
    bpy.ops.wm.open_mainfile(filepath=task["blend"])
    scene = bpy.context.scene
    for layer in scene.view_layers[1:]:
        layer.use = False
    scene.render.use_border = scene.render.use_crop_to_border = True
    border = dict(zip(("min_x", "max_x", "min_y", "max_y"), STATIC, strict=True))
    for name, value in border.items():
        setattr(scene.render, f"border_{name}", value)
    middle, count = task["frame"], task["count"]
    frames = range(middle, middle + count)
    found = {"seed per frame": _difference(task, "own", [(frame, None) for frame in frames])}
    curves = scene.animation_data.action.fcurves
    curves.remove(next(curve for curve in curves if curve.data_path == "velour.seed"))
    found["fixed seed"] = _difference(task, "fixed", [(frame, 1) for frame in frames])
    found["independent"] = _difference(task, "one", [(middle, 1000 + 7919 * k) for k in range(count)])
    return found


def _difference(task, name, images):
    """Mean squared difference of consecutive images within STATIC: the median of the pairs, as a firefly
    would outweigh all others. `images`: frames and seeds (None: the shot's)."""
    scene, before, found = bpy.context.scene, None, []
    for frame, seed in images:
        if seed is not None:
            scene.velour.seed = seed
        scene.frame_set(frame)
        now = _rendered(os.path.join(task["folder"], f"{name}.exr"))
        if before is not None:
            found.append(float(np.mean((now - before) ** 2)))
        before = now
    return float(np.median(found))


def _rendered(path):
    """The pixels of the current frame."""
    scene = bpy.context.scene
    bpy.ops.render.render()
    scene.render.image_settings.file_format = "OPEN_EXR"
    bpy.data.images["Render Result"].save_render(path, scene=scene)
    found = bpy.data.images.load(path)
    pixels = np.empty(len(found.pixels), np.float32)
    found.pixels.foreach_get(pixels)
    bpy.data.images.remove(found)
    return pixels.reshape(-1, 4)[:, :3].astype(np.float64)
