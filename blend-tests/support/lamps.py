"""Lamps that shine alike in every Blender, where their settings can do that."""

import math

import bpy


def are_of_4_0():
    """Whether lamps emit of their power what they do since 4.0, which made spheres of those with a radius."""
    return bpy.app.version >= (4, 0)


def area_watts(watts):
    """Power of an area lamp whose radiance is watts / (4 * its area)."""
    return watts * math.pi / 4 if are_of_4_0() else watts


def sun_strength(strength, angle):
    """Strength of a sun whose irradiance, in all versions, is that of a disk of `angle` at distance 1."""
    if not are_of_4_0():
        return strength
    tangent_sq = math.tan(angle / 2) ** 2
    return strength * 2 * (math.sqrt(1 + tangent_sq) - 1) / tangent_sq


def as_disk(lamp):
    """The lamp's object, a point or a spot, whose radius is that of a disk which faces what it lights.

    Blender 4.0 has only spheres."""
    if hasattr(lamp.data, "use_soft_falloff"):
        lamp.data.use_soft_falloff = True
    return lamp


def spots():
    """Which references hold where there are spots: until 3.4 their light also falls with the cosine to the
    axis, which no setting brings about."""
    return "wide-spots" if are_of_4_0() else ""
