"""The part of an object's surface that shows one material."""

from __future__ import annotations

from typing import Any, NamedTuple

from ..core.mesh_arrays import MeshArrays
from ..core.placement import Surface
from .meshes import has_uv_maps, object_arrays
from .objects import all_materials, slots_of
from .placement import Metrics, surface_of
from .units import metres_per_unit
from .uv_maps import placed_maps


class ShownSurface(NamedTuple):
    obj: Any  # evaluated
    arrays: MeshArrays | None
    slots: tuple[int, ...]  # slots that show the material
    surface: Surface | None  # surface of these slots
    metres: float  # meters per scene unit
    metrics: Metrics | None  # None if texture coordinates are missing or have no extent
    is_projected: bool

    @classmethod
    def of(cls, depsgraph, obj, material) -> ShownSurface:
        """`obj`: an original object."""
        evaluated = obj.evaluated_get(depsgraph)
        arrays = object_arrays(evaluated, placed_maps(all_materials(evaluated)))
        slots = slots_of(evaluated, arrays, material)
        surface = surface_of(arrays, slots)
        metres = metres_per_unit(depsgraph.scene)
        is_projected = surface is not None and not has_uv_maps(evaluated)
        metrics = None
        if surface is not None:
            metrics = Metrics.of(surface, evaluated.matrix_world, metres, is_projected)
        has_extent = metrics is not None and not metrics.world.is_flat
        return cls(evaluated, arrays, slots, surface, metres, metrics if has_extent else None, is_projected)
