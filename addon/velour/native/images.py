"""Pictures as files. Linear pixels [height x width x channels] float32, row 0 at the bottom."""

from __future__ import annotations

import ctypes
import os
from ctypes import byref, c_double, c_uint32

import numpy as np

from . import library
from .arrays import checked, pointer
from .errors import refuse
from .handle import path_bytes


def write(path: str | os.PathLike, pixels: np.ndarray) -> None:
    """Atomic. The extension picks the format: .exr keeps floats, .png gets the sRGB curve and 8 bits."""
    pixels = checked("pixels", pixels, (None, None, None))
    height, width, channels = pixels.shape
    library.load().vlr_image_write(path_bytes(path), width, height, channels, pointer(pixels))


def read(path: str | os.PathLike) -> np.ndarray:
    lib, name = library.load(), path_bytes(path)
    width, height, channels = c_uint32(), c_uint32(), c_uint32()
    size = byref(width), byref(height), byref(channels)
    lib.vlr_image_read(name, *size, None, 0)
    pixels = np.empty((height.value, width.value, channels.value), np.float32)
    lib.vlr_image_read(name, *size, pointer(pixels), pixels.size)
    return pixels


def compare(pixels: np.ndarray, reference: np.ndarray) -> tuple[float, float]:
    """rmse and relmse of linear RGB; relmse = mean((x - r)^2 / (r^2 + 0.01 mean(r)^2)). Sizes must agree."""
    pixels, reference = (
        checked(n, a, (None, None, None)) for n, a in (("pixels", pixels), ("reference", reference))
    )
    if pixels.shape != reference.shape:
        raise refuse(f"The picture is {_size(pixels)}, the reference {_size(reference)}; they must agree.")
    rmse, relmse = c_double(), c_double()
    height, width, channels = pixels.shape
    library.load().vlr_image_compare(
        ctypes.c_uint64(height * width),
        channels,
        pointer(pixels),
        pointer(reference),
        byref(rmse),
        byref(relmse),
    )
    return rmse.value, relmse.value


def _size(pixels: np.ndarray) -> str:
    height, width, channels = pixels.shape
    return f"{width}x{height} with {channels} channels"
