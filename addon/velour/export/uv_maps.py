"""UV maps that a material uses."""

from typing import NamedTuple

from .image_nodes import Coordinates, Picture
from .nodes import source, velour_node

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
        """The set of a picture's UV map. The first set of a measured material is placed for its model."""
        first = int(self.projects and len(self.names) > 1)
        return self.names.index(name, first) if name in self.names[first:] else 0

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
    return UvMaps((placed_by(node),), projects=True) if node else RENDERED


def placed_by(node):
    """Name of the UV map that places a MeasuredNode: a UV Map node linked to Vector, or that of the
    placement."""
    linked = linked_uv_map(node)
    return node.velour.placement.uv_map if linked is None else linked.uv_map


def linked_uv_map(node):
    """The UV Map node linked to the Vector of a MeasuredNode, or None."""
    vector = node.group and node.group.inputs.get("Vector")
    found = source(vector) if vector else None
    return found if found and found.bl_idname == "ShaderNodeUVMap" else None


def shader_maps(owner, sources, reliefs, notes, first=None):
    """UvMaps of a material from sources of its layers and UV maps of its reliefs.

    first: name of the map of a measured layer. It alone is placed, so other layers have a set of their own.
    """
    pictures = [source for source in sources if isinstance(source, (Picture, Coordinates))]
    names = tuple(sorted({picture.coordinates for picture in pictures})) or tuple(reliefs[:1])
    if first is not None:
        names = (first, *names)
    if not names:
        return UNUSED
    if len(names) > MOST_SETS:
        notes.add(
            f"{owner}: its images use {len(names)} UV maps, but only {MOST_SETS} are supported; others are"
            f" replaced by {_called(names[0])}."
        )
        names = names[:MOST_SETS]
    if first is None:
        return UvMaps(names, _relief_map(owner, names[0], reliefs, notes))
    return UvMaps(names, _relief_map(owner, None, reliefs, notes), projects=True)


def _relief_map(owner, usual, reliefs, notes):
    """Name of the map of normal maps' tangents; None if it is `usual` or there are none."""
    asked = list(dict.fromkeys(reliefs))
    if len(asked) > 1:
        notes.add(
            f"{owner}: its Normal Maps use several UV maps; the tangents of all follow {_called(asked[0])}."
        )
    return asked[0] if asked and asked[0] != usual else None


def _called(name):
    return f"'{name}'" if name else "the active render UV map"


def missing_map(obj, name, material_name):
    return (
        f"Object '{obj.name}': it has no UV map '{name}' for material '{material_name}'; the active"
        " render UV map is used."
    )
