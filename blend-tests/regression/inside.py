"""Opening files and rendering them, for the scripts that run inside Blender. Run by itself, it obeys orders.

An order is a line of stdin, a JSON object: "script" (inside_*.py, whose main(task) is called), "task", and
"log" (the file that gets what is said meanwhile). The file task["report"] gets the dictionary that main()
returns, or its error; then stdout gets the line DONE. Blender ends with the orders.
"""

import ctypes
import importlib
import json
import os
import sys
import traceback
from pathlib import Path

import addon_utils
import bpy

DONE = "velour: done"
HERE = Path(__file__).resolve().parent


def obey():
    orders, answers = os.fdopen(os.dup(0)), os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    sys.path[:0] = [str(HERE), str(HERE.parent)]
    for line in orders:
        order = json.loads(line)
        _log_to(order["log"])
        _run(Path(order["script"]).stem, order["task"])
        _flush()
        print(DONE, file=answers, flush=True)


def _run(module, task):
    report = {"error": None}
    try:
        report |= importlib.import_module(module).main(task) or {}
    except Exception as error:
        traceback.print_exc()
        report["error"] = sentence(error)
    Path(task["report"]).write_text(json.dumps(report))


def _log_to(path):
    _flush()
    log = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    for output in (1, 2):
        os.dup2(log, output)
    os.close(log)


def _flush():
    """Python's outputs and Blender's own."""
    sys.stdout.flush()
    sys.stderr.flush()
    ctypes.CDLL(None).fflush(None)


def open_file(blend, scripts):
    try:
        bpy.ops.wm.open_mainfile(filepath=blend, load_ui=False, use_scripts=scripts)
    except RuntimeError as error:
        remedy = "save it again with this version of Blender, or take it away"
        raise RuntimeError(f"it cannot be opened ({sentence(error).rstrip('.')}); {remedy}.") from error


def enable_velour(scene):
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


def show_renders(scene):
    """Pictures as the renderer makes them, before compositor, sequencer and display."""
    render = scene.render
    render.use_compositing = render.use_sequencer = render.use_placeholder = False
    render.use_overwrite = render.use_file_extension = True
    settings = render.image_settings
    if hasattr(settings, "media_type"):  # 5.0 and newer
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"


def stop_animation(scene, paths):
    """Removes the animation of these settings: a keyed seed would be the same in all renders of a frame."""
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


def render(scene, path):
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True, scene=scene.name)
    if not path.is_file():
        raise RuntimeError(f"Blender rendered but wrote no picture to {path}.")


def sentence(error):
    """What an operator reports, without its "Error:", on one line."""
    text = " ".join(str(error).split()) or type(error).__name__
    return text.removeprefix("Error: ")


if __name__ == "__main__":
    obey()
