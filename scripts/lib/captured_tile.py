"""Runs inside Blender: the tile that is the active object becomes a BTF, and that a material."""

from __future__ import annotations

import os
import time

import bpy
from blender_picture import measured_node

NAME = "tile"  # of the material; the BTF lies in NAME.btf


def capture_and_compress(folder: str, capture: dict, megabytes: float) -> dict:
    """Seconds and bytes. `capture`: arguments of the operator; `megabytes`: 0 lets the library choose."""
    btf = os.path.join(folder, f"{NAME}.btf")
    start = time.perf_counter()
    bpy.ops.velour.capture_btf(directory=btf, sides="ONE", **capture)
    captured = time.perf_counter()
    bpy.ops.velour.compress_btf(filepath=btf, megabytes=megabytes)
    compressed = time.perf_counter()
    return {
        "capture_seconds": captured - start,
        "compress_seconds": compressed - captured,
        "btf_bytes": sum(entry.stat().st_size for entry in os.scandir(btf)),
        "model_bytes": measured_node(bpy.data.materials[NAME]).image.packed_file.size,
    }
