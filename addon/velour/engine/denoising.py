"""Denoised pictures: by Blender's own Open Image Denoise where it brings one; and what is known of errors."""

import functools
from pathlib import Path

import bpy

from ..native import VelourError, denoise_job, library
from ..native.errors import refuse

_FILES = "libOpenImageDenoise.so.2*"
last_errors = {}  # {scene's name: sentence on the picture that was denoised last}


def prepare(scene):
    """Raises a sentence where there is no Open Image Denoise."""
    if reason := missing():
        raise refuse(
            f"Scene '{scene.name}' is to be denoised, but {reason} Or switch off Render > Denoise > Render."
        )


@functools.cache
def missing():
    """Why nothing can be denoised; empty where something can."""
    try:
        library.set_denoiser(_blenders_own())
        library.denoiser()
    except VelourError as error:
        return str(error)
    return ""


def _blenders_own():
    """Its file; empty where this Blender has none beside it."""
    folders = [Path(bpy.app.binary_path).parent] if bpy.app.binary_path else []
    folders.append(Path(bpy.__file__).parent)  # of the module bpy
    found = [path for folder in folders for path in sorted((folder / "lib").glob(_FILES))]
    return str(found[0]) if found else ""


def denoise(job, scene, threads, wait):
    """Gives a render job the pass "Denoised"; `wait(job)` waits for another job. Returns text for a stamp."""
    with denoise_job(job, threads) as denoising:
        wait(denoising.start())
        report = denoising.report()
    bound = report["relmse_bound"]
    if bound is None:
        last_errors[scene.name] = "Error of the denoised picture: unknown, a pixel has one camera ray."
        return "relmse unknown"
    percent = 100 * max(bound, 0.0) ** 0.5
    last_errors[scene.name] = f"Error of the last picture: at most {percent:.2g} %."
    return f"relmse {max(report['relmse'], 0.0):.3g}, at most {max(bound, 0.0):.3g}"
