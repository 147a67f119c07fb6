"""Texel size in the scene camera, found with a coarse grid of rays so that hidden parts do not count."""

import numpy as np
from mathutils import Vector

from .camera import final_view

_RAYS = 32  # per axis, over the image region that may contain the object


def texels_per_pixel(depsgraph, obj, texels_per_unit):
    """Minimum and median number of texels across a pixel's width; None if the object is not visible.

    `texels_per_unit`: per face, texels per Blender unit in world space; NaN: face of another material.
    Surfaces are assumed to face the camera; tilted ones have more. Raises ExportError without a camera.
    """
    view = final_view(depsgraph, whole=True)
    found = []
    for x in _places(view, obj):
        ray = _ray(view, x)
        hit, location, _normal, face, other, _matrix = depsgraph.scene.ray_cast(depsgraph, *ray)
        if hit and other.original == obj and 0 <= face < len(texels_per_unit):
            found.append(texels_per_unit[face] * _pixel(view, location))
    found = [texels for texels in found if np.isfinite(texels)]
    return (min(found), float(np.median(found))) if found else None


def _places(view, obj):
    """Grid points as fractions of the image's width and height, from the lower left."""
    low, high = _frame_of(view, obj)
    steps = (np.arange(_RAYS) + 0.5) / _RAYS
    for y in low[1] + steps * (high[1] - low[1]):
        for x in low[0] + steps * (high[0] - low[0]):
            yield x, y


def _frame_of(view, obj):
    """Corners of the image region of the object's bounding box; the whole image if it reaches the eye."""
    corners = [_local(view, obj.matrix_world @ Vector(corner)) for corner in obj.bound_box]
    left, right, bottom, top = view.window
    if view.kind == "perspective":
        if max(corner[2] for corner in corners) >= -view.clip_start:
            return (0.0, 0.0), (1.0, 1.0)
        corners = [corner / -corner[2] for corner in corners]
    columns = [[c[0] for c in corners], [c[1] for c in corners]]
    ends = ((left, right), (bottom, top))
    parts = [
        np.clip([(min(c) - a) / (b - a), (max(c) - a) / (b - a)], 0, 1)
        for c, (a, b) in zip(columns, ends, strict=True)
    ]
    return tuple(part[0] for part in parts), tuple(part[1] for part in parts)


def _local(view, point):
    """`point` in camera space; the camera looks along -z."""
    return view.camera_to_world[:, :3].T @ (np.array(point) - view.camera_to_world[:, 3])


def _ray(view, place):
    left, right, bottom, top = view.window
    x, y = left + place[0] * (right - left), bottom + place[1] * (top - bottom)
    axes, eye = view.camera_to_world[:, :3], view.camera_to_world[:, 3]
    if view.kind == "perspective":
        return Vector(eye), Vector(axes @ (x, y, -1.0)).normalized()
    return Vector(eye + axes @ (x, y, 0.0)), Vector(-axes[:, 2])


def _pixel(view, location):
    """Width of a pixel at `location`, in Blender units."""
    left, right = view.window[:2]
    depth = -_local(view, location)[2] if view.kind == "perspective" else 1.0
    return depth * (right - left) / view.width
