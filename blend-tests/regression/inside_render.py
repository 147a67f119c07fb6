"""Runs inside Blender: renders frames of a .blend with Velour, once for each seed, into EXR files.

The task: "blend", "scripts" (whether its own may run), "frames" (numbers, or [null] for the one that the file
was saved at), "seeds" (added to the file's), "samples" (null: the file's), "folder" (of the pictures,
FRAME-SEED.exr, FRAME being "own" for null) and "report".
"""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import inside


def main(task):
    inside.open_file(task["blend"], task["scripts"])
    scene = bpy.context.scene
    inside.enable_velour(scene)
    inside.show_renders(scene)
    scene.render.engine = "VELOUR"
    _set_samples(scene, task["samples"])
    first = scene.velour.seed
    for frame in task["frames"]:
        if frame is not None:
            scene.frame_set(frame)
        for seed in task["seeds"]:
            scene.velour.seed = (first + seed) % (1 << 31)
            name = f"{'own' if frame is None else frame}-{seed}.exr"
            inside.render(scene, Path(task["folder"]) / name)


def _set_samples(scene, samples):
    """`samples`: None leaves those of the file."""
    inside.stop_animation(scene, {"velour.seed"} | ({"velour.samples"} if samples is not None else set()))
    if samples is not None:
        scene.velour.samples = samples


inside.run(main)
