"""Runs inside Blender: captures the active object, a tile, as a BTF and makes a material from it."""

from __future__ import annotations

import os
import time
from collections.abc import Callable

import bpy
from blender_picture import measured_node

NAME = "tile"  # name of the material; its BTF is in NAME.btf


def capture_and_compress(
    folder: str, capture: dict, megabytes: float, captured: Callable[[], None] = lambda: None
) -> dict:
    """Returns seconds and bytes. `capture`: arguments of the operator; `megabytes`: 0: the library chooses.
    `captured` is called before the fit."""
    btf = os.path.join(folder, f"{NAME}.btf")
    start = time.perf_counter()
    bpy.ops.velour.capture_btf(directory=btf, sides="ONE", **capture)
    middle = time.perf_counter()
    captured()
    bpy.ops.velour.compress_btf(filepath=btf, megabytes=megabytes)
    end = time.perf_counter()
    return {
        "capture_seconds": middle - start,
        "compress_seconds": end - middle,
        "btf_bytes": sum(entry.stat().st_size for entry in os.scandir(btf)),
        "model_bytes": measured_node(bpy.data.materials[NAME]).image.packed_file.size,
    }
