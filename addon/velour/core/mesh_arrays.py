"""The arrays of a mesh."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class MeshArrays(NamedTuple):
    """Keywords of Scene.add_mesh; the triangles index corners."""

    positions: np.ndarray
    triangles: np.ndarray
    corner_vertices: np.ndarray
    material_slots: np.ndarray | None = None
    corner_normals: np.ndarray | None = None
    vertex_normals: np.ndarray | None = None
    smooth: np.ndarray | None = None
    corner_uvs: np.ndarray | None = None
    more_uvs: np.ndarray | None = None
    relief_uvs: np.ndarray | None = None
    corner_colors: np.ndarray | None = None
    # Shapes of a mesh that deforms: [steps x ...] of the arrays of these names.
    moved_positions: np.ndarray | None = None
    moved_corner_normals: np.ndarray | None = None
    moved_vertex_normals: np.ndarray | None = None

    @property
    def slots(self):
        """[triangles]"""
        return (
            np.zeros(len(self.triangles), np.uint32) if self.material_slots is None else self.material_slots
        )

    @property
    def slot_count(self):
        """Number of slots up to the last one that a triangle uses."""
        return 1 if self.material_slots is None else 1 + int(self.material_slots.max())

    def vertices(self, triangles):
        """[n x 3] Vertices of some triangles."""
        return self.corner_vertices[self.triangles[triangles]]

    def uvs(self, triangles):
        """[n x 3 x 2]"""
        return self.corner_uvs[self.triangles[triangles]]

    def normals(self, triangles):
        """[n x 3 x 3] Corner normals; 0 for flat triangles without area."""
        if self.corner_normals is not None:
            return self.corner_normals[self.triangles[triangles]]
        if self.vertex_normals is None:
            return np.repeat(self._flat_normals(triangles)[:, None], 3, axis=1)
        normals = self.vertex_normals[self.vertices(triangles)]
        if self.smooth is not None:
            flat = self.smooth[triangles] == 0
            normals[flat] = self._flat_normals(triangles)[flat][:, None]
        return normals

    def _flat_normals(self, triangles):
        """[n x 3]"""
        a, b, c = np.moveaxis(self.positions[self.vertices(triangles)].astype(float), 1, 0)
        across = np.cross(b - a, c - a)
        lengths = np.linalg.norm(across, axis=1, keepdims=True)
        return np.divide(across, lengths, out=np.zeros_like(across), where=lengths > 0)
