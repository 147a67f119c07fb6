"""Image files. Linear pixels [height x width x channels] float32, row 0 at the bottom."""

from __future__ import annotations

import ctypes
import os
from ctypes import byref, c_double, c_uint32
from typing import NamedTuple

import numpy as np

from . import library, structs
from .arrays import checked, pointer
from .errors import refuse
from .handle import path_bytes, text_bytes


def write(path: str | os.PathLike, pixels: np.ndarray) -> None:
    """Atomic. The extension picks the format: .exr keeps floats, .png gets the sRGB curve and 8 bits."""
    pixels = checked("pixels", pixels, (None, None, None))
    height, width, channels = pixels.shape
    library.load().vlr_image_write(path_bytes(path), width, height, channels, pointer(pixels))


class Frame(NamedTuple):
    """Position of a part in a picture: size of the whole picture, and the part's lower left pixel in it."""

    width: int
    height: int
    x: int = 0
    y: int = 0


def write_part(path: str | os.PathLike, pixels: np.ndarray, frame: Frame, texts: dict[str, str]) -> None:
    """Like write(), for .exr only; the header has the position of the part, and `texts`."""
    pixels = checked("pixels", pixels, (None, None, None))
    height, width, channels = pixels.shape
    place = structs.ImageFrame(**frame._asdict())
    words = [word.encode() for pair in texts.items() for word in pair]
    library.load().vlr_image_write_part(
        path_bytes(path), width, height, channels, pointer(pixels), byref(place),
        (ctypes.c_char_p * len(words))(*words), len(texts),
    )  # fmt: skip


def header(path: str | os.PathLike) -> dict:
    """OpenEXR header: width, height, channels (names), frame (a Frame), texts (by name), multi_part."""
    said = library.json_of(library.load().vlr_image_header_json, path_bytes(path))
    return said | {"frame": Frame(**said["frame"])}


def size(path: str | os.PathLike) -> tuple[int, int, int]:
    """Width, height and channels, without reading the pixels."""
    width, height, channels = c_uint32(), c_uint32(), c_uint32()
    places = byref(width), byref(height), byref(channels)
    library.load().vlr_image_read(path_bytes(path), *places, None, 0)
    return width.value, height.value, channels.value


def read(path: str | os.PathLike) -> np.ndarray:
    """All channels of a file that Velour wrote, as they are stored; for others see read_picture()."""
    width, height, channels = size(path)
    pixels = np.empty((height, width, channels), np.float32)
    again = byref(c_uint32()), byref(c_uint32()), byref(c_uint32())
    library.load().vlr_image_read(path_bytes(path), *again, pointer(pixels), pixels.size)
    return pixels


def read_picture(path: str | os.PathLike, layer: str = "", as_stored: bool = False) -> np.ndarray:
    """The picture in a file from any program (OpenEXR, Radiance HDR, PNG, JPEG, TIFF, BMP): 1 to 4
    channels, upright, linear Rec. 709. `layer`: layer of an OpenEXR file. `as_stored`: ignores orientation,
    exposure, primaries and windows in the header, as Blender does.
    """
    width, height, channels = picture_size(path, layer, as_stored)
    pixels = np.empty((height, width, channels), np.float32)
    again, options = [byref(c_uint32()) for _ in range(3)], picture_options(layer, as_stored)
    library.load().vlr_picture_read(path_bytes(path), byref(options), *again, pointer(pixels), pixels.size)
    return pixels


def picture_size(path: str | os.PathLike, layer: str = "", as_stored: bool = False) -> tuple[int, int, int]:
    """Width, height and channels of read_picture(), without reading the pixels."""
    width, height, channels = c_uint32(), c_uint32(), c_uint32()
    places, options = (byref(width), byref(height), byref(channels)), picture_options(layer, as_stored)
    library.load().vlr_picture_read(path_bytes(path), byref(options), *places, None, 0)
    return width.value, height.value, channels.value


def picture_warnings(path: str | os.PathLike, layer: str = "", as_stored: bool = False) -> list[dict]:
    """What read_picture() leaves out or ignores in the header: warnings, each {code, values}."""
    options = picture_options(layer, as_stored)
    return library.json_of(library.load().vlr_picture_notes_json, path_bytes(path), byref(options))


def read_warnings() -> list[dict]:
    """Warnings of this thread's last read_picture(), also about replaced values: each {code, values}."""
    return library.json_of(library.load().vlr_picture_notes_json, None, None)


def picture_options(layer: str, as_stored: bool) -> structs.PictureOptions:
    return structs.PictureOptions(as_stored=int(as_stored), layer=text_bytes(layer))


def compare(pixels: np.ndarray, reference: np.ndarray) -> tuple[float, float]:
    """rmse and relmse of linear RGB; relmse = mean((x - r)^2 / (r^2 + 0.01 mean(r)^2)). Sizes must agree."""
    pixels, reference = (
        checked(n, a, (None, None, None)) for n, a in (("pixels", pixels), ("reference", reference))
    )
    if pixels.shape != reference.shape:
        raise refuse(
            f"The image is {_size(pixels)}, but the reference is {_size(reference)}; they must agree."
        )
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
