"""Joins triangles that are halves of a quad, for meshes that artists edit."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..native.tile import TileMesh


class Faces(NamedTuple):
    corners: list[list[int]]  # vertices of each face, three or four
    uvs: np.ndarray  # [total of corners x 2], in the order of the faces
    slots: np.ndarray  # [faces]


def joined(mesh: TileMesh) -> Faces:
    """Triangles (a, b, c) and (a, c, d) that follow each other become the face (a, b, c, d)."""
    t = mesh.triangles
    first = np.zeros(len(t), bool)
    first[:-1] = (t[:-1, 0] == t[1:, 0]) & (t[:-1, 2] == t[1:, 1])
    second = np.zeros(len(t), bool)
    second[1:] = first[:-1]
    corners = np.full((len(t), 4), -1, np.int64)
    corners[:, :3] = t
    corners[:-1, 3][first[:-1]] = t[1:, 2][first[:-1]]
    uvs = np.concatenate([mesh.corner_uvs, np.roll(mesh.corner_uvs[:, 2:], -1, axis=0)], axis=1)
    kept = ~second
    corners, uvs = corners[kept], uvs[kept]
    return Faces(
        corners=[row[: 3 + (row[3] >= 0)] for row in corners.tolist()],
        uvs=uvs[corners >= 0],
        slots=mesh.material_slots[kept],
    )
