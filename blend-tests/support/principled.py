"""The Principled BSDF, which is another one since Blender 4.0."""

from . import lamps


def meaning():
    """Which references hold where one is seen."""
    return "layered" if lamps.are_of_4_0() else ""
