"""Lamps as four pixels of a texture each (site.glsl)."""

import math

import numpy as np

_SUN, _POINT, _AREA, _SPOT = range(4)


def lamp_pixels(kind, color, matrix, values):
    """[4 x 4] float32. Arguments as of Scene.add_light: a sun's irradiance, of others the power."""
    color, axis, place = np.asarray(color, float), -matrix[:, 2], matrix[:, 3]
    axis = axis / max(np.linalg.norm(axis), 1e-12)
    pixels = np.zeros((4, 4), np.float32)
    pixels[2, :3] = axis
    if kind == "sun":
        pixels[0] = *-axis, _SUN
        pixels[1] = *color, (values.get("angle", 0.0) / 2) ** 2
        return pixels
    width, height = values.get("size", (0.0, 0.0))
    if kind in ("rectangle", "disk"):
        # A disk of the same area; it radiates as the cosine.
        area = width * height * (1.0 if kind == "rectangle" else math.pi / 4)
        pixels[0] = *place, _AREA
        pixels[1] = *(color / math.pi), area / math.pi
        return pixels
    pixels[0] = *place, _SPOT if kind == "spot" else _POINT
    pixels[1] = *(color / (4 * math.pi)), width**2
    edge = math.cos(values.get("angle", math.pi) / 2)
    pixels[2, 3] = edge
    pixels[3, 0] = (1 - edge) * values.get("blend", 0.0)
    return pixels
