"""The pixels of a screen that nobody sees: what Xvfb keeps in its file, in the format of xwd."""

import struct
import time
import zlib

import numpy as np

FILE = "Xvfb_screen0"  # in the folder that Xvfb is given with -fbdir
_BETWEEN, _MOST_READS = 0.15, 20  # seconds
_HEADER = struct.Struct(">25I")  # of XWDFile.h, version 7: sizes, formats, masks


def read(path):
    """[height x width x 3] bytes, the lowest row first as Blender's images have it."""
    content = path.read_bytes()
    header = _HEADER.unpack_from(content)
    header_size, (width, height), (bits, stride), colors = header[0], header[4:6], header[11:13], header[19]
    if bits != 32 or header[7] != 0:
        raise ValueError(f"{path}: {bits} bits a pixel, byte order {header[7]}; 32 and 0 are read.")
    rows = np.frombuffer(content, np.uint8, height * stride, header_size + 12 * colors)
    return rows.reshape(height, stride)[::-1, : 4 * width].reshape(height, width, 4)[..., 2::-1].copy()


def at_rest(path):
    """The same once it stays: what has been drawn takes a while to the screen."""
    pixels = read(path)
    for _ in range(_MOST_READS):
        time.sleep(_BETWEEN)
        last, pixels = pixels, read(path)
        if np.array_equal(last, pixels):
            break
    return pixels


def write_png(path, pixels):
    """[height x width x 3] bytes, the lowest row first."""
    height, width = pixels.shape[:2]
    lines = np.zeros((height, 1 + 3 * width), np.uint8)  # a zero before each: no filter
    lines[:, 1:] = pixels[::-1].reshape(height, -1)
    parts = [
        (b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)),
        (b"IDAT", zlib.compress(lines.tobytes(), 1)),
        (b"IEND", b""),
    ]
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*part) for part in parts))


def _chunk(name, content):
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
