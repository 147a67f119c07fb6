"""Which UV map a material is shown by."""

from .image_nodes import named_uv_maps
from .nodes import velour_node


def uv_map_names(materials):
    """What the materials of an object's slots ask for; empty where all take the one that renders."""
    names = tuple(map(_name, materials))
    return names if any(names) else ()


def _name(material):
    node = velour_node(material)
    if node:
        return node.velour.placement.uv_map
    named = named_uv_maps(material.node_tree) if material and material.use_nodes else []
    return named[0] if named else ""


def missing_map(obj, name, material_name):
    return (
        f"Object '{obj.name}': it has no UV map '{name}', which material '{material_name}' is placed by; the"
        " one that renders is used."
    )
