"""Blender's lights in the library's units."""

import math

import bpy

from ..native import VelourError
from .axes import column_lengths, unscaled
from .light_nodes import emission_factor
from .newer import choice
from .notes import ExportError
from .unused_settings import note_emitter

# The emission of a given nominal power changed between Blender 3.4 and 4.3, in the release that made point
# lights spheres; no property reveals it. Area lights had a radiance of P / (4 A), while a Lambertian emitter
# has P / (pi A); suns were disks on a plane at distance 1 and now are cones of constant radiance.
_OLDER_LAMPS = bpy.app.version < (4, 0)
_AREA_POWER = math.pi / 4 if _OLDER_LAMPS else 1.0

_FACTORS = ("diffuse_factor", "specular_factor", "volume_factor")


def add_light(scene, obj, matrix, notes, hidden=()):
    """Adds a light; returns whether it emits.

    obj: evaluated object. matrix: transform of its instance. hidden: rays that do not see it.
    """
    lamp = obj.data
    if is_portal(lamp):
        return False  # not a light: portals only guide Cycles' environment sampling
    owner = f"Light '{obj.name}'"
    emission = emission_factor(lamp)
    if emission is None:
        notes.add(
            f"{owner}: shader nodes that vary by place or direction, such as IES files, are not supported;"
            " its color and power are used."
        )
        emission = (1.0, 1.0, 1.0)
    if any(abs(getattr(lamp, name, 1.0) - 1.0) > 1e-6 for name in _FACTORS):
        notes.add(f"{owner}: its diffuse, specular and volume factors are not supported; ignored.")
    note_emitter(owner, getattr(lamp, "cycles", None), notes)
    kind, factor, values = choice(_DESCRIBE, lamp.type, "POINT", owner, "type", notes)(lamp, matrix)
    watts = power(lamp, matrix) * factor
    color = tuple(watts * c * e for c, e in zip(tinted(lamp), emission, strict=True))
    _note_shape(lamp, matrix, owner, notes)
    values.update(casts_shadow=_casts_shadow(lamp), mirrored=_is_mirrored(lamp))
    try:
        scene.add_light(kind, color, unscaled(matrix), hidden=hidden, **values)
    except VelourError as error:
        raise ExportError(f"{owner}: {error}") from error
    return any(c != 0.0 for c in color) and not _is_flat(lamp, matrix)


def is_portal(lamp):
    return lamp.type == "AREA" and getattr(getattr(lamp, "cycles", None), "is_portal", False)


def power(lamp, matrix):
    """Power in W, or W/m^2 for suns: nominal power times 2^exposure and, unless normalized, the area."""
    watts = lamp.energy * 2.0 ** getattr(lamp, "exposure", 0.0)  # exposure and normalize: 4.5 and newer
    return watts if getattr(lamp, "normalize", True) else watts * lamp.area(matrix_world=matrix)


def tinted(lamp):
    """The light's color times the blackbody color of its temperature."""
    tint = lamp.temperature_color if getattr(lamp, "use_temperature", False) else (1.0, 1.0, 1.0)
    return tuple(c * t for c, t in zip(lamp.color, tint, strict=True))


def _is_flat(lamp, matrix):
    return lamp.type == "AREA" and 0.0 in _area(lamp, matrix)[2]["size"]


def _note_shape(lamp, matrix, owner, notes):
    if _is_flat(lamp, matrix):
        notes.add(f"{owner}: its size or scale is zero along an axis; it emits nothing.")
    elif lamp.type == "AREA" and lamp.shape in ("SQUARE", "RECTANGLE") and _is_skewed(matrix):
        notes.add(
            f"{owner}: the scale of its parent makes it a parallelogram, which Cycles samples as a rectangle:"
            " its light is not that of Cycles. Apply the parent's scale."
        )


def _is_skewed(matrix):
    """Whether the x and y axes are not perpendicular."""
    x, y = (matrix.col[axis].to_3d().normalized() for axis in (0, 1))
    return abs(x.dot(y)) > 1e-3


def _sun(lamp, _matrix):
    return "sun", _sun_factor(lamp.angle), {"angle": lamp.angle}


def _sun_factor(angle):
    """Irradiance on a facing plane divided by Blender's strength; 1 for a small sun.

    For older suns, the mean cosine over a disk that subtends `angle`, uniform on the plane at distance 1.
    """
    if angle < 1e-3 or not _OLDER_LAMPS:
        return 1.0
    tangent_sq = math.tan(min(angle, math.pi - 1e-3) / 2) ** 2
    return 2 * (math.sqrt(1 + tangent_sq) - 1) / tangent_sq


def _point(lamp, _matrix):
    # Those with soft falloff are disks facing the shading point. It is an option from 4.1 on.
    sphere = not getattr(lamp, "use_soft_falloff", _OLDER_LAMPS)
    # Lights of a type unknown to this Blender have no size.
    return "point", 1.0, {"size": (getattr(lamp, "shadow_soft_size", 0.0), 0.0), "sphere": int(sphere)}


def _spot(lamp, matrix):
    _kind, factor, values = _point(lamp, matrix)
    values.update(angle=lamp.spot_size, blend=lamp.spot_blend, cosine=int(bpy.app.version < (3, 5)))
    if bpy.app.version >= (3, 5):
        values["cone_scale"] = cone_scale(matrix)
    return "spot", factor, values


def cone_scale(matrix):
    """Scale of a spot's cone along x and y; 1 if the object's scale is uniform, or zero along an axis."""
    x, y, z = column_lengths(matrix)
    return (x / z, y / z) if x * y * z > 0.0 else (1.0, 1.0)


def _area(lamp, matrix):
    x, y, _z = column_lengths(matrix)
    height = lamp.size if lamp.shape in ("SQUARE", "DISK") else lamp.size_y
    kind = "rectangle" if lamp.shape in ("SQUARE", "RECTANGLE") else "disk"
    return kind, _AREA_POWER, {"size": (lamp.size * x, height * y), "spread": lamp.spread}


_DESCRIBE = {"SUN": _sun, "POINT": _point, "SPOT": _spot, "AREA": _area}


def _is_mirrored(lamp):
    """Without Multiple Importance, Cycles finds its light only by rays toward it: not in perfect mirrors."""
    return int(getattr(getattr(lamp, "cycles", None), "use_multiple_importance_sampling", True))


def _casts_shadow(lamp):
    # Older versions have a shadow switch for ray tracers in Cycles' settings; the other one is EEVEE's then.
    cycles = getattr(lamp, "cycles", None)
    return int(getattr(cycles, "cast_shadow", getattr(lamp, "use_shadow", True)))
