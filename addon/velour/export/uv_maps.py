"""UV maps that a material uses."""

from typing import NamedTuple

from .image_nodes import Coordinates, Picture
from .nodes import velour_node

MOST_SETS = 4  # VLR_MOST_UV_SETS


class UvMaps(NamedTuple):
    """UV maps of a mesh by name; "": the active render map."""

    names: tuple = ("",)  # maps of pictures; the first is also used for tiles and anisotropy
    relief: str | None = None  # map of normal maps' tangents; None: the first map, or no normal map
    projects: bool = False  # onto meshes without UV maps (core/projection.py), instead of one point

    @property
    def first(self):
        return self.names[0] if self.names else ""

    def number(self, name):
        """The set of a picture's UV map."""
        return self.names.index(name) if name in self.names else 0

    @property
    def all_names(self):
        return {*self.names, self.relief or ""}


RENDERED = UvMaps()
UNUSED = UvMaps(())  # for uniform materials


def maps_of_slots(maps):
    """The `uv_maps` argument of object_arrays() for the UvMaps of a mesh's slots."""
    if all(each == UNUSED for each in maps):
        return None
    return () if all(each in (UNUSED, RENDERED) for each in maps) else maps


def placed_maps(materials):
    """The `uv_maps` argument of object_arrays() that measured materials in the slots need."""
    return maps_of_slots(tuple(map(placed_map, materials)))


def placed_map(material):
    node = velour_node(material)
    return UvMaps((node.velour.placement.uv_map,), projects=True) if node else RENDERED


def shader_maps(owner, sources, reliefs, notes):
    """UvMaps of a material that is not measured, from sources of its layers and UV maps of its reliefs."""
    pictures = [source for source in sources if isinstance(source, (Picture, Coordinates))]
    names = tuple(sorted({picture.coordinates for picture in pictures}))
    if not names:
        return UNUSED
    if len(names) > MOST_SETS:
        notes.add(
            f"{owner}: its images use {len(names)} UV maps, but only {MOST_SETS} are supported; others are"
            f" replaced by {_called(names[0])}."
        )
        names = names[:MOST_SETS]
    return UvMaps(names, _relief_map(owner, names, reliefs, notes))


def _relief_map(owner, names, reliefs, notes):
    asked = list(dict.fromkeys(reliefs))
    if len(asked) > 1:
        notes.add(
            f"{owner}: its Normal Maps use several UV maps; the tangents of all follow {_called(asked[0])}."
        )
    return asked[0] if asked and asked[0] != names[0] else None


def _called(name):
    return f"'{name}'" if name else "the active render UV map"


def missing_map(obj, name, material_name):
    return (
        f"Object '{obj.name}': it has no UV map '{name}' for material '{material_name}'; the active"
        " render UV map is used."
    )
