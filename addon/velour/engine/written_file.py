"""Checks the file of a frame: Blender calls an OpenEXR or TIFF file saved even if the disk was full.

A file that was written only in part is removed, and in a Blender without a window the render ends with exit
status 1. The files of other formats are left to Blender.
"""

import os
import signal
import struct
from pathlib import Path

import bpy

from ..farm import exr

_ENGINE = "VELOUR"  # frames of other engines are left alone
_before = {}  # {path: state} of the files that this frame may replace
_TIFF = {b"II*\0": "<I", b"MM\0*": ">I"}  # offset of the first directory, by the first four bytes


def watch(scene):
    """Call before a frame is rendered."""
    _before.clear()
    _before.update({path: _state(path) for path in _places(scene)})


def was_written_whole(scene):
    """Call after Blender wrote the frame. Whether its file is complete; reports and removes it otherwise."""
    if scene.render.engine != _ENGINE:
        return True
    written = [path for path in _places(scene) if _state(path) not in (None, _before.get(path))]
    damage = {path: why for path in written if (why := _damage(path))}
    for path, why in damage.items():
        path.unlink(missing_ok=True)
        print(
            f"Error: {path}: Blender wrote only a part of it ({why}), so Velour removed it; free space on the"
            " disk, then render the frame again.",
            flush=True,
        )
    if damage:
        end_render()
    return not damage


def end_render():
    """Like Ctrl-C: the only way in which a handler can make Blender stop an animation and exit with 1."""
    if bpy.app.background and signal.getsignal(signal.SIGINT) is None:  # the module bpy leaves it to Python
        signal.raise_signal(signal.SIGINT)


def _places(scene):
    """Where Blender may write: with the number of the frame, or without one for a still of a script."""
    render = scene.render
    still = bpy.path.abspath(render.filepath)
    if render.use_file_extension:
        still = bpy.path.ensure_ext(still, render.file_extension)
    return {Path(still), Path(render.frame_path(frame=scene.frame_current))}


def _state(path):
    try:
        found = os.stat(path)
    except (OSError, ValueError):
        return None
    return found.st_ino, found.st_size, found.st_mtime_ns


def _damage(path):
    """Returns what the file lacks: "" if it is complete, or of a format that Blender itself checks."""
    try:
        with open(path, "rb") as file:
            start = file.read(8)
        if path.suffix == ".exr":
            exr.check_whole(path, unpack=False)
        elif start[:4] in _TIFF and not _has_directory(start, os.path.getsize(path)):
            return "it ends too early"
    except exr.UnknownExrError:
        pass  # of a later Blender
    except exr.ExrError as error:
        return str(error)
    except OSError:
        pass  # it is gone, or on a medium that cannot be read
    return ""


def _has_directory(start, size):
    """libtiff writes the directory last, after all pixels."""
    if len(start) < 8:
        return False
    (offset,) = struct.unpack(_TIFF[start[:4]], start[4:])
    return 8 <= offset < size
