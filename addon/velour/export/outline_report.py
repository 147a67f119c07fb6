"""Report on the height of a material's VOTF on one object, for the panel and for scripts."""

import math
from typing import NamedTuple

import numpy as np

from ..core.curvature import curvature_range
from .notes import ExportError
from .placement import tile_map
from .shown_surface import ShownSurface


class OutlineReport(NamedTuple):
    rows: tuple[tuple[str, str], ...]  # name and value for display
    warnings: tuple[str, ...]
    share: float  # height or depth over the minimum radius of curvature; from 1 on, the shell folds


def outline_report_on(depsgraph, obj, material, shell, tile, width=0.0):
    """OutlineReport of an original object that shows `material`, whose model info contains `shell`.

    `tile`: the material's Tile; None if it has no texture. `width`: width of a tile in Blender units; 0: from
    the texture coordinates. Returns None if it cannot be determined, as without texture coordinates.
    """
    shown = ShownSurface.of(depsgraph, obj, material)
    if shown.metrics is None:
        return None
    try:
        width = shown.metres * width or _tile_width(shown.metrics, tile, shell)
    except ExportError:  # the placement report has the reason
        return None
    low, high = (width * height for height in shell["heights"])
    share = _share(_bends(shown), low, high)
    rows = (
        ("Tile width", _metres(width)),
        ("Structure height", f"{_metres(low)} to {_metres(high)}"),
        ("Height / radius", f"{share:.0%}"),
    )
    return OutlineReport(rows, _warnings(obj, share), share)


def _metres(length):
    return f"{length:.3g} m" if abs(length) >= 1 else f"{1e3 * length:.3g} mm"


def _tile_width(metrics, tile, shell):
    """Width in meters of a tile that covers one unit of its texture coordinates."""
    placed = metrics.world if tile is None else metrics.world.placed(tile_map(tile, metrics))
    width, height = shell["points"][:2]
    return 1 / math.sqrt(math.prod(placed.density()) * height / width)


def _bends(shown):
    """Minimum and maximum curvature of a ShownSurface in world space, 1/m."""
    arrays = shown.arrays
    triangles = np.isin(arrays.slots, shown.slots)
    matrix = np.array(shown.obj.matrix_world, float)[:3, :3]
    corners = arrays.positions[arrays.vertices(triangles)] @ matrix.T * shown.metres
    normals = arrays.normals(triangles) @ np.linalg.inv(matrix)
    with np.errstate(divide="ignore", invalid="ignore"):
        normals = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    return curvature_range(corners, normals)


def _share(bends, low, high):
    return max(0.0, *(-bend * height for bend in bends for height in (low, high)))


def _warnings(obj, share):
    if share < 1:
        return ()
    sentence = (
        f"Object '{obj.name}': the structure reaches farther than the surface's minimum radius of curvature"
        " and folds over itself there; make the tiles smaller or the surface smoother."
    )
    return (sentence,)
