"""Runs inside Blender: renders frames of a .blend with Velour, once for each seed, into EXR files.

The task: "blend", "scripts" (whether its own may run), "frames" (numbers, or [null] for the one that the file
was saved at), "seeds" (added to the file's), "samples" (null: the file's), "folder" (of the pictures,
FRAME-SEED.exr, FRAME being "own" for null) and "report".
"""

import json
import sys
from pathlib import Path

import addon_utils
import bpy


def main(task):
    report = {"error": None}
    try:
        _open(task["blend"], task["scripts"])
        scene = bpy.context.scene
        _enable_velour(scene)
        _set_up(scene, task["samples"])
        first = scene.velour.seed
        for frame in task["frames"]:
            if frame is not None:
                scene.frame_set(frame)
            for seed in task["seeds"]:
                scene.velour.seed = (first + seed) % (1 << 31)
                name = f"{'own' if frame is None else frame}-{seed}.exr"
                _render(scene, Path(task["folder"]) / name)
    except Exception as error:
        report["error"] = _sentence(error)
    Path(task["report"]).write_text(json.dumps(report))


def _open(blend, scripts):
    try:
        bpy.ops.wm.open_mainfile(filepath=blend, load_ui=False, use_scripts=scripts)
    except RuntimeError as error:
        remedy = "save it again with this version of Blender, or take it away"
        raise RuntimeError(f"it cannot be opened ({_sentence(error).rstrip('.')}); {remedy}.") from error


def _enable_velour(scene):
    if hasattr(scene, "velour"):
        return
    for module in addon_utils.modules(refresh=False):
        name = module.__name__
        if name == "velour" or name.endswith(".velour"):
            addon_utils.enable(name, default_set=False, handle_error=_raise)
            return
    raise RuntimeError("this Blender has no Velour; install the add-on, or name a staged one.")


def _raise(error):
    raise error


def _set_up(scene, samples):
    """The picture as the renderer makes it, before compositor, sequencer and display."""
    render = scene.render
    render.engine = "VELOUR"
    render.use_compositing = render.use_sequencer = render.use_placeholder = False
    render.use_overwrite = render.use_file_extension = True
    settings = render.image_settings
    if hasattr(settings, "media_type"):  # 5.0 and newer
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"
    if samples is not None:
        scene.velour.samples = samples
    _stop_animation(scene, {"velour.seed"} | ({"velour.samples"} if samples is not None else set()))


def _stop_animation(scene, paths):
    """An animated seed would be the same in all renders of a frame."""
    for path in paths:
        scene.driver_remove(path)
    action = scene.animation_data.action if scene.animation_data else None
    for curves in _curve_lists(action):
        for curve in [c for c in curves if c.data_path in paths]:
            curves.remove(curve)


def _curve_lists(action):
    if action is None:
        return []
    if hasattr(action, "fcurves"):  # before 5.0
        return [action.fcurves]
    return [bag.fcurves for layer in action.layers for strip in layer.strips for bag in strip.channelbags]


def _render(scene, path):
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    if not path.is_file():
        raise RuntimeError(f"Blender rendered but wrote no picture to {path}.")


def _sentence(error):
    """What an operator reports, without its "Error:", on one line."""
    text = " ".join(str(error).split()) or type(error).__name__
    return text.removeprefix("Error: ")


main(json.loads(sys.argv[sys.argv.index("--") + 1]))
