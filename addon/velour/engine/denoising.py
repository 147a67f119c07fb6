"""Denoises pictures, preferably by the Open Image Denoise that Blender ships, and reports their errors."""

import functools
from pathlib import Path

import bpy

from ..native import VelourError, denoise_job, library
from ..native.errors import refuse

_FILES = "libOpenImageDenoise.so.2*"
last_errors = {}  # {name of scene: sentence on the error of its last denoised picture}


def prepare(scene):
    """Raises VelourError if there is no Open Image Denoise."""
    if reason := missing():
        raise refuse(
            f"Scene '{scene.name}' cannot be denoised: {reason} Or disable Render > Denoise > Render."
        )


@functools.cache
def missing():
    """Why denoising is unavailable; empty if it is available."""
    try:
        library.set_denoiser(_blenders_own())
        library.denoiser()
    except VelourError as error:
        return str(error)
    return ""


def _blenders_own():
    """Path of the Open Image Denoise that ships with this Blender; empty if there is none."""
    folders = [Path(bpy.app.binary_path).parent] if bpy.app.binary_path else []
    folders.append(Path(bpy.__file__).parent)  # for Blender as a module
    found = [path for folder in folders for path in sorted((folder / "lib").glob(_FILES))]
    return str(found[0]) if found else ""


def denoise(job, scene, threads, wait):
    """Adds the pass "Denoised" to a render job; `wait(job)` waits for a job. Returns text for a stamp."""
    with denoise_job(job, threads) as denoising:
        wait(denoising.start())
        report = denoising.report()
    bound = report["relmse_bound"]
    if bound is None:
        last_errors[scene.name] = (
            "Error of the denoised image: unknown, as each pixel has a single camera ray. Raise Samples."
        )
        return "relmse unknown"
    percent = 100 * max(bound, 0.0) ** 0.5
    last_errors[scene.name] = f"Error of the last image: at most {percent:.2g} %."
    return f"relmse {max(report['relmse'], 0.0):.3g}, at most {max(bound, 0.0):.3g}"
