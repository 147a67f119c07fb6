"""The Open Image Denoise that Velour uses, preferably the one that Blender ships."""

import functools
from pathlib import Path

import bpy

from ..native import VelourError, library

_FILES = "libOpenImageDenoise.so.2*"


@functools.cache
def missing():
    """Why denoising is unavailable; empty if it is available."""
    try:
        library.set_denoiser(_blenders_own())
        library.denoiser()
    except VelourError as error:
        return f"Open Image Denoise is missing: {error}"
    return ""


def _blenders_own():
    """Path of the Open Image Denoise that ships with this Blender; empty if there is none."""
    folders = [Path(bpy.app.binary_path).parent] if bpy.app.binary_path else []
    folders.append(Path(bpy.__file__).parent)  # for Blender as a module
    found = [path for folder in folders for path in sorted((folder / "lib").glob(_FILES))]
    return str(found[0]) if found else ""
