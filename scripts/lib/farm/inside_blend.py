"""Runs in Blender with a .blend open: what a job has to know of it, as JSON.

Arguments after "--": the add-on's module, the file to write.
"""

import importlib
import json
import sys
from pathlib import Path

import bpy

_SEQUENCER = (
    "scene '{scene}' puts out its sequencer (strip '{strip}'), whose pictures do not say what rendered them;"
    " switch off Output > Post Processing > Sequencer, and save the .blend."
)


def look(addon):
    if addon not in sys.modules:
        return {
            "error": f"there is no add-on {addon!r} in this Blender; install it, or name it with --addon."
        }
    scene = bpy.context.scene
    strip = output_strip(scene)
    if strip:
        return {"error": _SEQUENCER.format(scene=scene.name, strip=strip.name)}
    hashes = importlib.import_module(f"{addon}.export.model_hashes").model_hashes
    models = {material.name_full: hashes(material) for material in bpy.data.materials}
    return {
        "velour": importlib.import_module(f"{addon}.native.version").version_text(),
        "models": {name: found for name, found in models.items() if found is not None},
        "frames": list(range(scene.frame_start, scene.frame_end + 1, scene.frame_step)),
        "notes": notes(scene.velour),
    }


def output_strip(scene):
    """One for which Blender puts out the sequencer: any but sounds; Blender 3.4 does for muted ones, too."""
    editor = scene.sequence_editor
    if not editor or not scene.render.use_sequencer:
        return None
    strips = editor.strips if hasattr(editor, "strips") else editor.sequences  # before Blender 4.4
    return next((strip for strip in strips if strip.type != "SOUND"), None)


def notes(settings):
    if not settings.time_limit:
        return []
    limit = f"The .blend has a time limit of {settings.time_limit:g} s"
    if settings.use_noise_target:
        return [f"{limit}: a frame that it ends above the noise threshold counts as done."]
    return [f"{limit}: a frame that it ends is left, and the next run goes on from there."]


addon, report = sys.argv[sys.argv.index("--") + 1 :]
Path(report).write_text(json.dumps(look(addon)), encoding="utf-8")
