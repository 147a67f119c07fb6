"""The arrays of a mesh."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class MeshArrays(NamedTuple):
    """The keywords of Scene.add_mesh; triangles name corners."""

    positions: np.ndarray
    triangles: np.ndarray
    corner_vertices: np.ndarray
    material_slots: np.ndarray
    corner_uvs: np.ndarray | None = None
    more_uvs: np.ndarray | None = None
    relief_uvs: np.ndarray | None = None
    corner_colors: np.ndarray | None = None
    corner_normals: np.ndarray | None = None
    vertex_normals: np.ndarray | None = None
    face_normals: np.ndarray | None = None
    face_smooth: np.ndarray | None = None
    triangle_faces: np.ndarray | None = None

    @property
    def slot_count(self):
        """Up to the last that a triangle is of."""
        return 1 + int(self.material_slots.max()) if self.material_slots.any() else 1

    def vertices(self, triangles):
        """[n x 3] Of some of the triangles."""
        return self.corner_vertices[self.triangles[triangles]]

    def uvs(self, triangles):
        """[n x 3 x 2]"""
        return self.corner_uvs[self.triangles[triangles]]

    def normals(self, triangles):
        """[n x 3 x 3]"""
        if self.corner_normals is not None:
            return self.corner_normals[self.triangles[triangles]]
        if self.face_normals is None:
            return self.vertex_normals[self.vertices(triangles)]
        faces = self.triangle_faces[triangles]
        normals = np.repeat(self.face_normals[faces, None], 3, axis=1)
        if self.face_smooth is not None:
            smooth = self.face_smooth[faces] != 0
            normals[smooth] = self.vertex_normals[self.vertices(triangles)[smooth]]
        return normals
