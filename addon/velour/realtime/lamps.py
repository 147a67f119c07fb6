"""Lights as five texture pixels each (site.glsl), in the terms of native/src/render/lights/area_light.h."""

import math

import numpy as np

PIXELS = 5

_SUN, _POINT, _AREA, _SPOT = range(4)
_LEAST_SPREAD = math.radians(1)  # same as Blender
_MOST_ASPECT = 2.0


def lamp_pixels(kind, color, matrix, values):
    """[5 x 4] float32. Arguments as for Scene.add_light: irradiance of a sun, power of other lights."""
    color, axis, place = np.asarray(color, float), -matrix[:, 2], matrix[:, 3]
    axis = axis / max(np.linalg.norm(axis), 1e-12)
    pixels = np.zeros((PIXELS, 4), np.float32)
    pixels[2, :3] = axis
    if kind == "sun":
        pixels[0] = *-axis, _SUN
        pixels[1] = *color, (values.get("angle", 0.0) / 2) ** 2
        return pixels
    width, height = values.get("size", (0.0, 0.0))
    if kind in ("rectangle", "disk"):
        # A disk of the same area, with Lambertian emission.
        area = width * height * (1.0 if kind == "rectangle" else math.pi / 4)
        pixels[2, 3], focus = _spread(values.get("spread", math.pi))
        pixels[0] = *place, _AREA
        pixels[1] = *(color * focus / math.pi), area / math.pi
        return pixels
    pixels[0] = *place, _POINT
    pixels[1] = *(color / (4 * math.pi)), width**2
    if kind == "spot":
        _add_cone(pixels, matrix, values)
    return pixels


def is_simpler(kind, values):
    """Whether the ray tracer's result differs: elongated areas are not disks, whose rim a spread reveals."""
    if kind not in ("rectangle", "disk") or values.get("spread", math.pi) >= math.pi:
        return False
    low, high = sorted(values["size"])
    return high > _MOST_ASPECT * low


def _spread(angle):
    """Cotangent of half the angle (0: emits everywhere), and radiance along the normal."""
    half = max(angle, _LEAST_SPREAD) / 2
    if half >= math.pi / 2:
        return 0.0, 1.0
    cotangent = 1 / math.tan(half)
    return cotangent, 1 / (1 - half * cotangent)


def _add_cone(pixels, matrix, values):
    edge = math.cos(values.get("angle", math.pi) / 2)
    pixels[0, 3], pixels[2, 3] = _SPOT, edge
    pixels[3, 3], pixels[4, 3] = (1 - edge) * values.get("blend", 0.0), values.get("cosine", 0)
    scale = values.get("cone_scale", (1.0, 1.0))
    if tuple(scale) != (1.0, 1.0):
        pixels[3, :3], pixels[4, :3] = matrix[:, 0] / scale[0], matrix[:, 1] / scale[1]
