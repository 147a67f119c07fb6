"""Procedural mesostructure."""

from __future__ import annotations

from ctypes import POINTER, byref, c_float, c_uint32, cast
from typing import NamedTuple

import numpy as np

from . import library, structs
from .handle import Handle, set_fields, text_bytes
from .scene import Scene


class TileMesh(NamedTuple):
    """Keywords of Scene.add_mesh."""

    positions: np.ndarray
    triangles: np.ndarray
    corner_normals: np.ndarray
    corner_uvs: np.ndarray
    material_slots: np.ndarray


class Tile(Handle):
    """One period of a small structure. The cell is [0, period x] x [0, period y], meters, +z up.

    Geometry that crosses the cell's border exists once and sticks out; copies shifted by the period complete
    the structure.
    """

    _free_name = "vlr_tile_free"

    @staticmethod
    def kinds() -> list[dict]:
        """name, summary and defaults of each kind; options that a kind does not take have no default."""
        return library.json_of(library.load().vlr_tile_kinds_json)["kinds"]

    @classmethod
    def create(cls, kind: str, **shape) -> Tile:
        """size (meters), count, resolution, thickness, gap (pitches), irregularity (0..1), seed.

        Options that are not given have the kind's defaults.
        """
        options = structs.TileOptions()
        library.load().vlr_tile_options_init(byref(options))
        set_fields(options, {"kind": text_bytes(kind.lower()), **shape})
        return cls._create("vlr_tile_create", byref(options))

    def mesh(self) -> TileMesh:
        """Copies of the arrays."""
        desc = structs.MeshDesc()
        self._lib.vlr_tile_desc(self.pointer, byref(desc))

        def array(address, *shape, kind=c_float):
            return np.ctypeslib.as_array(cast(address, POINTER(kind)), shape).copy()

        count = desc.triangle_count
        return TileMesh(
            positions=array(desc.positions, desc.vertex_count, 3),
            triangles=array(desc.triangles, count, 3, kind=c_uint32),
            corner_normals=array(desc.corner_normals, count, 3, 3),
            corner_uvs=array(desc.corner_uvs, count, 3, 2),
            material_slots=array(desc.material_slots, count, kind=c_uint32),
        )

    def info(self) -> dict:
        """kind, period, heights, open, open_area, vertices, triangles, shape, materials."""
        return library.json_of(self._lib.vlr_tile_info_json, self.pointer)

    def add_to(self, scene: Scene) -> tuple[int, list[int]]:
        """Adds the tile. Returns the numbers of its mesh and its materials, for Scene.add_instance."""
        mesh, _dropped = scene.add_mesh(**self.mesh()._asdict())
        materials = [
            scene.add_principled_material(**{name: m[name] for name in m if name != "name"})
            for m in self.info()["materials"]
        ]
        return mesh, materials
