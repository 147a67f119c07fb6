"""Report on a BTF's placement on one object, for the panel and for scripts."""

import math
from typing import NamedTuple

import numpy as np

from ..core.placement import LARGEST_STRETCH
from .camera_texels import texels_per_pixel
from .meshes import has_uv_maps, triangle_faces
from .notes import ExportError
from .placement import lie_on, projected_onto, stretch_sentence, tile_map, uv_problem
from .shown_surface import ShownSurface

_SAME = 0.005  # relative deviation from real size that is not visible


class PlacementReport(NamedTuple):
    rows: tuple[tuple[str, str], ...]  # name and value for display
    warnings: tuple[str, ...]


def report_on(depsgraph, obj, material, tile):
    """PlacementReport of an original object that shows `material`, whose Tile is `tile`."""
    shown = ShownSurface.of(depsgraph, obj, material)
    metrics, problem = shown.metrics, uv_problem(obj, shown, material.name)
    warnings = (problem,) if problem else ()
    if metrics is None:
        return PlacementReport((), warnings)
    rows = [_density_row(metrics)]
    try:
        uv_map = tile_map(tile, metrics)
    except ExportError as error:
        return PlacementReport(tuple(rows), (*warnings, str(error)))
    tiles, lie = metrics.world.placed(uv_map), lie_on(tile, metrics, uv_map)
    rows += [_size_row(tile, tiles), _spread_row(lie), _texel_row(tile, lie)]
    of_faces = _of_faces(shown, tiles.scales() * shown.metres * _texels(tile))
    rows += [_camera_row(depsgraph, obj, of_faces), _stretch_row(lie)]
    if lie.is_stretched:
        warnings += (stretch_sentence(obj, tile, lie, shown.surface),)
    return PlacementReport(tuple(rows), warnings)


def uv_density_on(depsgraph, obj, material):
    """UV density without the object's scale, 1/m. Raises ExportError if there is no UV map."""
    shown = ShownSurface.of(depsgraph, obj, material)
    if problem := uv_problem(obj, shown, material.name):
        raise ExportError(problem)
    return shown.metrics.local.density()


def report_on_brushed(depsgraph, obj, material):
    """PlacementReport of an anisotropic material, which has no tile."""
    is_projected = not has_uv_maps(obj.evaluated_get(depsgraph))
    return PlacementReport((), (projected_onto(obj, material.name),) if is_projected else ())


def _of_faces(shown, values):
    """Converts a ShownSurface's values per triangle to values per face; NaN for other slots."""
    faces = triangle_faces(shown.obj)
    found = np.full(int(faces.max()) + 1, np.nan)
    found[faces[np.isin(shown.arrays.slots, shown.slots)]] = values
    return found


def _texels(tile):
    """Number of texels along a side, geometric mean of both sides."""
    return math.sqrt(math.prod(tile.texels))


def _density_row(metrics):
    return "UV density", "{:.3g} x {:.3g} per meter".format(*metrics.world.density())


def _size_row(tile, tiles):
    sides = [1 / grow for grow in tiles.density()]
    unit, factor = ("m", 1) if max(sides) >= 1 else ("mm", 1e3)
    size = "{:.3g} x {:.3g} {}".format(*(factor * side for side in sides), unit)
    if tile.metres is None:
        return "Tile size", f"{size}, real size unknown"
    times = [side / real for side, real in zip(sides, tile.metres, strict=True)]
    if max(abs(t - 1) for t in times) < _SAME:
        return "Tile size", f"{size}, real size"
    return "Tile size", "{}, {:.3g} x {:.3g} times real size".format(size, *times)


def _spread_row(lie):
    return "Spread", "{:.2f} to {:.2f}".format(*lie.spread)


def _texel_row(tile, lie):
    return "Texels", f"{1e-3 * lie.scale * _texels(tile):.3g} per mm"


def _stretch_row(lie):
    most = f"{lie.stretch:.2f}:1" if math.isfinite(lie.stretch) else "infinite"
    return "Stretch", f"{most}, {lie.stretched:.0%} above {LARGEST_STRETCH:g}:1"


def _camera_row(depsgraph, obj, texels_per_unit):
    name = "In the camera"
    try:
        found = texels_per_pixel(depsgraph, obj, texels_per_unit)
    except ExportError:
        return name, "no render camera"
    return name, "{1:.3g} texels per pixel, minimum {0:.3g}".format(*found) if found else "not visible"
