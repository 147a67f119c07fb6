"""Estimates the memory to read and trace a mesh file from counts, before the mesh is read.

The factors come from measured peaks. A file that cannot be counted is estimated by its size; the reader will
say what is wrong with it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO

from .files import open_regular

# Bytes per vertex: its position as read and as kept; per corner: its vertex; per triangle: its corners twice,
# three normals, the BVH; per corner and vertex, where there are any: normal and texture coordinates.
_VERTEX, _CORNER, _TRIANGLE = 24, 4, 132
_NORMAL, _TEXCOORD = 12, 8
_SECOND_NORMALS = 24  # per triangle that has texture coordinates but no normals
_TEXT_CORNER = 24  # more per corner of a text: indices of vertex, texture coordinates and normal
_SMOOTH_CORNER = 20  # more per corner where smoothing groups make normals
_TEXT = 6.5  # per byte of a file that cannot be counted

_HEAD, _BLOCK = 1 << 16, 1 << 24
_SIZES = {"char": 1, "uchar": 1, "short": 2, "ushort": 2, "int": 4, "uint": 4, "float": 4, "double": 8}
_SIZES |= {"int8": 1, "uint8": 1, "int16": 2, "uint16": 2}
_SIZES |= {"int32": 4, "uint32": 4, "float32": 4, "float64": 8}
_BLANKS = (b" ", b"\t")


@dataclass(frozen=True)
class _Counts:
    vertices: int
    faces: int
    corners: int
    has_normals: bool = False
    has_texcoords: bool = False
    is_text: bool = False
    is_smooth: bool = False

    @property
    def bytes(self) -> int:
        of_normal = _NORMAL * self.has_normals
        more = of_normal + _TEXCOORD * self.has_texcoords
        corner = _CORNER + more + _TEXT_CORNER * self.is_text + _SMOOTH_CORNER * self.is_smooth
        triangle = _TRIANGLE + _SECOND_NORMALS * (self.has_texcoords and not self.has_normals)
        triangles = max(0, self.corners - 2 * self.faces)
        return self.vertices * (_VERTEX + more) + self.corners * corner + triangles * triangle


def mesh_memory(path: str) -> int:
    """Peak memory in bytes, in addition to what the process had before."""
    with open_regular(path) as file:
        size = os.fstat(file.fileno()).st_size
        try:
            head = file.read(_HEAD)
            count = _ply if head.startswith(b"ply") else _obj
            return size + count(file, head, size).bytes
        except (OSError, ValueError, KeyError, IndexError, StopIteration):
            return round(_TEXT * size)


def _obj(file: BinaryIO, head: bytes, _size: int) -> _Counts:
    """Corners are the blanks in the file minus those of vertices, texture coordinates and normals."""
    first = next(re.finditer(rb"^v[ \t].*$", head.replace(b"\r", b"\n"), re.MULTILINE)).group()
    of_vertex = len(first.split()) - 1  # colors may follow
    starts = (b"\nv ", b"\nv\t", b"\nvt", b"\nvn", b"\nf", b"\ns")
    spaced, tabbed, texcoords, normals, faces, groups, *blanks = _totals(file, 0, (*starts, *_BLANKS))
    vertices = spaced + tabbed
    corners = sum(blanks) - vertices * of_vertex - 2 * texcoords - 3 * normals
    corners = max(corners, 3 * faces)
    return _Counts(vertices, faces, corners, normals > 0, texcoords > 0, is_text=True, is_smooth=groups > 0)


def _ply(file: BinaryIO, head: bytes, size: int) -> _Counts:
    text, found, _ = head.partition(b"end_header")
    if not found:
        raise ValueError
    elements = _ply_elements(text.decode("latin-1"))
    vertices, of_vertex = elements["vertex"]
    faces, of_face = elements.get("face", (0, []))
    strips, of_strip = elements.get("tristrips", (0, []))
    lists = [words for words in of_face + of_strip if words[0] == "list"]
    begin = len(text) + len(found)
    if b"format ascii" in text:
        values = sum(_totals(file, begin, (*_BLANKS, b"\n")))
        corners = values - vertices * len(of_vertex) - faces * len(of_face) - strips * len(of_strip)
    else:
        count, index = _SIZES[lists[0][1]], min(_SIZES[words[2]] for words in lists)
        in_faces = size - begin - vertices * sum(_SIZES[words[0]] for words in of_vertex)
        corners = (in_faces - faces * count) // index
    if strips:
        faces, corners = max(corners, 0), 3 * corners  # up to a triangle per index
    names = {words[-1] for words in of_vertex + of_face}
    has_texcoords = bool(names & {"s", "u", "texture_u", "texcoord"})
    return _Counts(vertices, faces, max(corners, 0), "nx" in names, has_texcoords, b"format ascii" in text)


def _ply_elements(head: str) -> dict[str, tuple[int, list[list[str]]]]:
    """{name: (count, words of its properties)}"""
    elements: dict[str, tuple[int, list[list[str]]]] = {}
    for words in map(str.split, head.splitlines()):
        if words[:1] == ["element"]:
            properties: list[list[str]] = []
            elements[words[1]] = int(words[2]), properties
        elif words[:1] == ["property"]:
            properties.append(words[1:])
    return elements


def _totals(file: BinaryIO, begin: int, needles: tuple[bytes, ...]) -> list[int]:
    """Counts each of `needles` in a file from `begin` on; line ends are read as \\n."""
    longest = max(map(len, needles))
    totals, last = [0] * len(needles), b"\n"
    for block in _blocks(file, begin):
        whole = last + block.replace(b"\r", b"\n")
        for i, needle in enumerate(needles):
            totals[i] += whole.count(needle) - last.count(needle)
        last = whole[-(longest - 1) :]
    return totals


def _blocks(file: BinaryIO, begin: int) -> Iterator[bytes]:
    file.seek(begin)
    while block := file.read(_BLOCK):
        yield block
