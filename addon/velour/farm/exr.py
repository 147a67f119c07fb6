"""Reads the header of an OpenEXR file and checks that the file is complete, without a library: nodes may have
none.

Layout: "OpenEXR File Layout" of the OpenEXR documentation. Scanline images of one or several parts, as
Blender writes them; all other files are refused.
"""

from __future__ import annotations

import os
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

MAGIC = 20000630
_TILED, _DEEP, _MULTIPART = 0x200, 0x800, 0x1000
_LARGEST_ATTRIBUTE = 1 << 24  # bytes; manifests of Cryptomatte are the largest
_MOST_PARTS = 4096
_MOST_LINES = 1 << 20
# Scanlines per chunk, by compression number: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
_LINES = (1, 1, 1, 16, 32, 16, 32, 32, 32, 256)
_ZLIB = (2, 3)
_PIXEL_BYTES = (4, 2, 4)  # bytes per channel: uint, half, float


class ExrError(ValueError):
    """Its message says what is wrong with the file, in one sentence without the file's name."""


class UnknownExrError(ExrError):
    """The file may be whole, but is of a kind that is not read here."""


@dataclass(frozen=True)
class Part:
    attributes: dict[str, bytes]

    def text(self, name: str) -> str | None:
        value = self.attributes.get(name)
        return None if value is None else value.decode("utf-8", errors="replace")

    @property
    def compression(self) -> int:
        found = self.attributes.get("compression", b"")
        if len(found) != 1 or found[0] >= len(_LINES):
            raise UnknownExrError("its compression is not known")
        return found[0]

    @property
    def lines(self) -> tuple[int, int]:
        """The first scanline, and the number of scanlines."""
        if len(self.attributes.get("dataWindow", b"")) != 16:
            raise ExrError("it has no data window")
        _, first, _, last = struct.unpack("<4i", self.attributes["dataWindow"])
        if not 0 <= last - first < _MOST_LINES:
            raise ExrError("its data window makes no sense")
        return first, last - first + 1

    @property
    def chunks(self) -> int:
        return -(-self.lines[1] // _LINES[self.compression])

    def unpacked_bytes(self, line: int) -> int:
        """Unpacked size of the chunk that begins with scanline `line`."""
        first, count = self.lines
        left, _, right, _ = struct.unpack("<4i", self.attributes["dataWindow"])
        lines = min(_LINES[self.compression], first + count - line)
        return (right - left + 1) * lines * _pixel_bytes(self.attributes.get("channels", b""))


def text_attribute(path: str | os.PathLike, name: str) -> str | None:
    """The attribute of the first part that has it. Raises ExrError and OSError."""
    with open(path, "rb") as file:
        found = (part.text(name) for part in _parts(file))
        return next((text for text in found if text is not None), None)


def check_whole(path: str | os.PathLike, unpack: bool = True) -> None:
    """Raises ExrError unless every scanline of every part is in the file and, with `unpack`, all zlib data
    unpack."""
    size = Path(path).stat().st_size
    with open(path, "rb") as file:
        parts = _parts(file)
        tables = [struct.unpack(f"<{part.chunks}Q", _read(file, 8 * part.chunks)) for part in parts]
        for number, part in enumerate(parts):
            expected = _chunk_starts(part)
            found = {
                _check_chunk(file, offset, size, len(parts) > 1, number, part, unpack)
                for offset in tables[number]
            }
            if found != expected:
                raise ExrError("scanlines are missing")


def _chunk_starts(part: Part) -> set[int]:
    first, count = part.lines
    return set(range(first, first + count, _LINES[part.compression]))


def _check_chunk(
    file: BinaryIO, offset: int, size: int, multipart: bool, number: int, part: Part, unpack: bool
) -> int:
    """The first scanline of the chunk at `offset`."""
    if not 0 < offset < size:
        raise ExrError("a part of it was never written")
    file.seek(offset)
    if multipart and struct.unpack("<i", _read(file, 4))[0] != number:
        raise ExrError("a chunk belongs to another part")
    line, length = struct.unpack("<2i", _read(file, 8))
    if not 0 <= length <= size - file.tell():
        raise ExrError("it ends too early")
    if not unpack:
        return line
    unpacked = part.unpacked_bytes(line)
    if part.compression in _ZLIB and length != unpacked:  # equal: stored as is, packing would not save bytes
        _check_packed(_read(file, length), unpacked)
    return line


def _check_packed(data: bytes, unpacked: int) -> None:
    try:
        if len(zlib.decompressobj().decompress(data, unpacked + 1)) == unpacked:
            return
    except zlib.error:
        pass
    raise ExrError("scanlines cannot be unpacked")


def _pixel_bytes(channels: bytes) -> int:
    """Bytes of all channels of a pixel. A channel: its name, ended by 0, type, flags, x and y sampling."""
    total, at = 0, 0
    while at < len(channels) and channels[at]:
        at = channels.find(b"\0", at) + 1
        if not at or at + 16 > len(channels):
            raise ExrError("its channels make no sense")
        kind, _, across, down = struct.unpack_from("<4i", channels, at)
        if kind not in range(len(_PIXEL_BYTES)) or (across, down) != (1, 1):
            raise ExrError("its channels make no sense")
        total, at = total + _PIXEL_BYTES[kind], at + 16
    return total


def _parts(file: BinaryIO) -> list[Part]:
    magic, version = struct.unpack("<2i", _read(file, 8))
    if magic != MAGIC:
        raise ExrError("it is no OpenEXR file")
    if version & (_TILED | _DEEP):
        raise UnknownExrError("it has tiles or deep pixels, which Blender does not write")
    if not version & _MULTIPART:
        return [_part(file)]
    parts = []
    while (part := _part(file)).attributes:
        if len(parts) == _MOST_PARTS:
            raise ExrError("it has too many parts")
        parts.append(part)
    return parts


def _part(file: BinaryIO) -> Part:
    """Reads a header; it has no attributes at the end of all headers."""
    attributes = {}
    while name := _name(file):
        _name(file)  # its type
        (length,) = struct.unpack("<i", _read(file, 4))
        if not 0 <= length <= _LARGEST_ATTRIBUTE:
            raise ExrError("its header makes no sense")
        attributes[name] = _read(file, length)
    return Part(attributes)


def _name(file: BinaryIO) -> str:
    name = bytearray()
    while (byte := _read(file, 1)) != b"\0":
        name += byte
        if len(name) > 255:
            raise ExrError("its header makes no sense")
    return name.decode("utf-8", errors="replace")


def _read(file: BinaryIO, length: int) -> bytes:
    data = file.read(length)
    if len(data) != length:
        raise ExrError("it ends too early")
    return data
