"""Meshes for the GPU: one vertex per corner, triangles grouped by material slot."""

from __future__ import annotations

import numpy as np

from .errors import asking_for
from .tile_widths import TileWidths

_ATTRIBUTES = {"position": 3, "normal": 3, "uv": 2, "lift": 3}  # attributes of the surface shaders


def split_meshes(meshes):
    """Splits the argument of Scene.add_meshes into each mesh's flat arrays by name; None: not given."""
    starts = {name: np.concatenate(([0], np.cumsum(sizes))) for name, (_values, sizes) in meshes.items()}
    count = len(next(iter(meshes.values()))[1])
    for i in range(count):
        yield {
            name: values[starts[name][i] : starts[name][i + 1]].copy() if sizes[i] else None
            for name, (values, sizes) in meshes.items()
        }


class GpuMesh:
    """A mesh, kept as arrays until it is first drawn."""

    def __init__(self, arrays):
        get = arrays.get
        self.triangles = get("triangles").reshape(-1, 3)
        positions = get("positions").reshape(-1, 3)
        vertices = get("corner_vertices")
        if vertices is None:  # triangles index vertices; other arrays have three corners each
            vertices = self.triangles.reshape(-1)
            self.triangles = np.arange(len(vertices), dtype=np.uint32).reshape(-1, 3)
        corners = len(vertices)
        self.positions = positions[vertices]
        self.normals = self._corner_normals(get, vertices, corners)
        uvs = get("corner_uvs")
        self.uvs = np.zeros((corners, 2), np.float32) if uvs is None else uvs.reshape(-1, 2)
        self.has_uvs = uvs is not None
        self.slots = get("material_slots")
        self.lifts = self.widths = None  # for shells
        self._vertices = vertices
        self._batches = None

    def prepare_shell(self):
        """Prepares drawing as the top of a shell; False if the mesh was uploaded without it."""
        if self.lifts is None and self.positions is not None:
            self.lifts = self._lifted()
            self.widths = TileWidths(self.positions, self.uvs, self.triangles, self.slots)
        return self.lifts is not None

    def _lifted(self):
        """Sum of the normals of all corners at a corner's vertex, for each corner; not normalized."""
        normals = self.normals[self.triangles]
        corner = self.positions[self.triangles]
        across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-30)
        normals = np.where((normals == 0).all(axis=2, keepdims=True), across[:, None], normals).reshape(-1, 3)
        of_corner = self._vertices[self.triangles].reshape(-1)
        sums = [np.bincount(of_corner, normals[:, axis]) for axis in range(3)]
        return np.stack(sums, axis=1)[self._vertices].astype(np.float32)

    def _corner_normals(self, get, vertices, corners):
        """Corner normals; zero on flat triangles, for which the shader computes its own."""
        if get("corner_normals") is not None:
            return get("corner_normals").reshape(-1, 3)
        of_vertices, smooth = get("vertex_normals"), get("smooth")
        if of_vertices is None:
            return np.zeros((corners, 3), np.float32)
        normals = of_vertices.reshape(-1, 3)[vertices]
        if smooth is not None:
            normals[self.triangles[smooth == 0]] = 0
        return normals

    def batches(self, gpu):
        """GPUBatch of each slot; None if it has no triangle."""
        if self._batches is None:
            with asking_for(f"a mesh of {len(self.triangles):,} triangles"):
                self._batches = self._made_batches(gpu)
            self.positions = self.normals = self.uvs = self._vertices = None
        return self._batches

    def _made_batches(self, gpu):
        arrays = {"position": self.positions, "normal": self.normals, "uv": self.uvs}
        if self.lifts is not None:
            arrays["lift"] = self.lifts
        form = gpu.types.GPUVertFormat()
        for name in arrays:
            form.attr_add(id=name, comp_type="F32", len=_ATTRIBUTES[name], fetch_mode="FLOAT")
        vertices = gpu.types.GPUVertBuf(form, len(self.positions))
        for name, array in arrays.items():
            vertices.attr_fill(name, np.ascontiguousarray(array, np.float32))
        return [self._batch(gpu, vertices, triangles) for triangles in self._by_slot()]

    def _by_slot(self):
        if self.slots is None:
            return [self.triangles]
        return [self.triangles[self.slots == slot] for slot in range(int(self.slots.max()) + 1)]

    @staticmethod
    def _batch(gpu, vertices, triangles):
        if not len(triangles):
            return None
        indices = gpu.types.GPUIndexBuf(type="TRIS", seq=np.ascontiguousarray(triangles, np.uint32))
        return gpu.types.GPUBatch(type="TRIS", buf=vertices, elem=indices)
