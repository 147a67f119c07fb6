"""Runs in Blender with a .blend open: writes what a job must know about it as JSON.

Arguments after "--": the add-on's module, the number of parts of a frame, the file to write.
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
_NO_CAMERA = (
    "scene '{scene}' has no camera, and no marker with one; choose one in the Scene tab, and save the .blend."
)
_STEREO = (
    "scene '{scene}' is stereoscopic, which Velour does not support; disable Output > Stereoscopy, and save"
    " the .blend."
)
_UNREADABLE = "{sentence} Frames that show the material fail."
_NOISE = (
    "scene '{scene}' has a noise threshold, which looks at a whole picture; switch it off, and save the"
    " .blend, or leave --parts out."
)
_TOO_MANY = (
    "scene '{scene}' has {rays} camera rays a pixel ({samples} samples, {split} per ray), too few for {parts}"
    " parts; use fewer parts."
)
_FILE_OUTPUT = "the compositor's node '{node}' writes pictures of its own"


def look(addon, parts):
    if addon not in sys.modules:
        return {
            "error": f"there is no add-on {addon!r} in this Blender; install it, or name it with --addon."
        }
    scene = bpy.context.scene
    if not scene.camera and not any(marker.camera for marker in scene.timeline_markers):
        return {"error": _NO_CAMERA.format(scene=scene.name)}
    if scene.render.use_multiview:
        return {"error": _STEREO.format(scene=scene.name)}
    strip = output_strip(scene)
    if strip:
        return {"error": _SEQUENCER.format(scene=scene.name, strip=strip.name)}
    if parts > 1 and scene.velour.use_noise_target:
        return {"error": _NOISE.format(scene=scene.name)}
    options = importlib.import_module(f"{addon}.engine.options")
    if too_few := too_few_rays(scene, parts, options.layer_samples):
        return {"error": too_few}
    node = file_output(scene)
    if parts > 1 and node:
        wrong = _FILE_OUTPUT.format(node=node.name)
        return {"error": f"{wrong}, and would of some samples alone; mute it, or leave --parts out."}
    hashes = importlib.import_module(f"{addon}.export.model_hashes")
    models = {material.name_full: hashes.model_hashes(material) for material in bpy.data.materials}
    unreadable = [each for material in bpy.data.materials for each in hashes.unreadable_models(material)]
    return {
        "velour": importlib.import_module(f"{addon}.native.version").version_text(),
        "models": {name: found for name, found in models.items() if found is not None},
        "frames": list(range(scene.frame_start, scene.frame_end + 1, scene.frame_step)),
        "blender": ".".join(map(str, bpy.app.version)),
        "libraries": [
            library.filepath.removeprefix("//") for library in bpy.data.libraries if is_file(library)
        ],
        "notes": [_UNREADABLE.format(sentence=each) for each in unreadable] + notes(scene.velour, node),
    }


def too_few_rays(scene, parts, layer_samples):
    """Why a frame cannot be rendered in so many parts, each of which takes whole camera rays; else None."""
    for layer in scene.view_layers:
        samples = layer_samples(scene, layer)
        split = min(scene.velour.split, samples)
        rays = -(-samples // split)
        if layer.use and rays < parts:
            return _TOO_MANY.format(scene=scene.name, rays=rays, samples=samples, split=split, parts=parts)
    return None


def output_strip(scene):
    """A strip that makes Blender output the sequencer: any but sounds; in Blender 3.4, even muted ones."""
    editor = scene.sequence_editor
    if not editor or not scene.render.use_sequencer:
        return None
    strips = editor.strips if hasattr(editor, "strips") else editor.sequences  # before Blender 4.4
    return next((strip for strip in strips if strip.type != "SOUND"), None)


def is_file(library):
    """False for libraries packed into the .blend; Blender 5 also packs single data-blocks."""
    return not (library.packed_file or getattr(library, "is_archive", False))


def file_output(scene):
    """A node of the compositor that writes pictures, possibly within a group; None if there is none."""
    if not scene.render.use_compositing:
        return None
    if hasattr(scene, "compositing_node_group"):  # since Blender 5
        trees = [scene.compositing_node_group]
    else:
        trees = [scene.node_tree if scene.use_nodes else None]
    seen = []
    while trees:
        tree = trees.pop()
        if tree is None or tree in seen:
            continue
        seen.append(tree)
        nodes = [node for node in tree.nodes if not node.mute]
        found = next((node for node in nodes if node.bl_idname == "CompositorNodeOutputFile"), None)
        if found:
            return found
        trees += [node.node_tree for node in nodes if hasattr(node, "node_tree")]
    return None


def notes(settings, node):
    own = [f"{_FILE_OUTPUT.format(node=node.name)}, of which the job checks none."] if node else []
    return own + limit_notes(settings)


def limit_notes(settings):
    if not settings.time_limit:
        return []
    limit = f"The .blend has a time limit of {settings.time_limit:g} s"
    if settings.use_noise_target:
        return [f"{limit}: a frame that it ends above the noise threshold counts as done."]
    return [f"{limit}: a frame that it ends is left, and the next run goes on from there."]


addon, parts, report = sys.argv[sys.argv.index("--") + 1 :]
Path(report).write_text(json.dumps(look(addon, int(parts))), encoding="utf-8")
