"""What a BTF's placement on one object comes to, for the panel and for scripts."""

from typing import NamedTuple

import numpy as np

from ..core.placement import LARGEST_STRETCH
from .camera_texels import texels_per_pixel
from .meshes import object_arrays, triangle_faces
from .notes import ExportError
from .objects import slot_materials
from .placement import (
    Metrics,
    lie_on,
    missing_coordinates,
    stretch_sentence,
    surface_of,
    tile_map,
)
from .units import metres_per_unit


class PlacementReport(NamedTuple):
    rows: tuple[tuple[str, str], ...]  # name and value, for people
    warnings: tuple[str, ...]
    uv_density: tuple[float, float] | None = None  # of the object without its scale, 1/m


def report_on(depsgraph, obj, material, tile):
    """Of an object of the .blend that shows `material`, whose Tile is `tile`."""
    evaluated = obj.evaluated_get(depsgraph)
    arrays = object_arrays(evaluated)
    slots = _slots(evaluated, arrays, material)
    surface = surface_of(arrays, slots)
    metres = metres_per_unit(depsgraph.scene)
    metrics = None if surface is None else Metrics.of(surface, evaluated.matrix_world, metres)
    if metrics is None or metrics.world.is_flat:
        return PlacementReport((), (missing_coordinates(obj, material.name),))
    try:
        uv_map = tile_map(tile, metrics)
    except ExportError as error:
        return PlacementReport(_density_rows(metrics), (str(error),), metrics.local.density())
    lie = lie_on(tile, metrics, uv_map)
    rows = [*_density_rows(metrics), *_size_rows(tile, lie), _texel_row(tile, lie)]
    scales = metrics.world.placed(uv_map).scales() * metres * np.sqrt(np.prod(tile.texels))
    rows.append(("In the camera", _camera_value(depsgraph, obj, _of_faces(evaluated, arrays, slots, scales))))
    rows.append(("Stretch", _stretch_value(lie)))
    warnings = (stretch_sentence(obj, tile, lie, surface),) if lie.is_stretched else ()
    return PlacementReport(tuple(rows), warnings, metrics.local.density())


def _slots(obj, arrays, material):
    if arrays is None:
        return ()
    shown = slot_materials(obj, int(np.max(arrays.material_slots)) + 1)
    return tuple(slot for slot, other in enumerate(shown) if other and other.original == material.original)


def _of_faces(obj, arrays, slots, values):
    """Values of the slots' triangles as values of the object's faces; NaN of other slots."""
    faces = triangle_faces(obj)
    found = np.full(int(faces.max()) + 1, np.nan)
    found[faces[np.isin(arrays.material_slots, slots)]] = values
    return found


def _density_rows(metrics):
    u, v = metrics.world.density()
    return (("UV density", f"{u:.3g} x {v:.3g} per metre"),)


def _size_rows(tile, lie):
    width, height = (1e3 * side / lie.scale for side in tile.shape)
    size = f"{width:.3g} x {height:.3g} mm"
    if tile.metres is not None:
        real = 1 / lie.scale / np.sqrt(np.prod(tile.metres))
        size += f", {real:.3g} of real"
    else:
        size += ", real size not known"
    low, high = lie.spread
    return (("Tile here", size), ("Spread", f"{low:.2f} to {high:.2f}"))


def _texel_row(tile, lie):
    return "Texels", f"{1e-3 * lie.scale * np.sqrt(np.prod(tile.texels)):.3g} per mm"


def _stretch_value(lie):
    most = f"{lie.stretch:.2f}:1" if np.isfinite(lie.stretch) else "without end"
    return f"{most}, {lie.stretched:.0%} above {LARGEST_STRETCH:g}:1"


def _camera_value(depsgraph, obj, texels_per_unit):
    try:
        found = texels_per_pixel(depsgraph, obj, texels_per_unit)
    except ExportError:
        return "no camera that renders"
    if found is None:
        return "not seen"
    least, median = found
    return f"{median:.3g} texels per pixel, least {least:.3g}"
