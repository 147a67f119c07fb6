"""Which UV map a measured material is shown by."""

from .nodes import velour_node


def uv_map_names(materials):
    """What the materials of an object's slots ask for; empty where all take the one that renders."""
    names = tuple(map(_name, materials))
    return names if any(names) else ()


def _name(material):
    node = velour_node(material)
    return node.velour.placement.uv_map if node else ""


def missing_map(obj, name, material_name):
    return (
        f"Object '{obj.name}': it has no UV map '{name}', which material '{material_name}' is placed by; the"
        " one that renders is used."
    )
