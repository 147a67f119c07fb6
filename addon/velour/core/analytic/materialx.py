"""Writes OpenPBR parameters as a MaterialX document."""

from __future__ import annotations

import re
from xml.etree import ElementTree

from .open_pbr import OpenPbr

_VERSION = "1.39"  # the first with open_pbr_surface


def document(name: str, material: OpenPbr, along_bitangent: bool, note: str) -> str:
    """Text of a .mtlx file with a surface material and a `note` on it. along_bitangent: the tangent is y."""
    root = ElementTree.Element("materialx", version=_VERSION, colorspace="lin_rec709")
    own = element_name(name)
    shader = ElementTree.SubElement(
        root, "open_pbr_surface", name=f"SR_{own}", type="surfaceshader", doc=note
    )
    if along_bitangent:
        bitangent = ElementTree.Element("bitangent", name=f"T_{own}", type="vector3")
        _add(bitangent, "space", "string", value="world")  # that of the surface; the default is the object's
        root.insert(0, bitangent)
        _add(shader, "geometry_tangent", "vector3", nodename=f"T_{own}")
    for key, value in material.inputs().items():
        is_color = isinstance(value, list)
        text = ", ".join(f"{each:.6g}" for each in value) if is_color else f"{value:.6g}"
        _add(shader, key, "color3" if is_color else "float", value=text)
    surface = ElementTree.SubElement(root, "surfacematerial", name=own, type="material", doc=note)
    _add(surface, "surfaceshader", "surfaceshader", nodename=f"SR_{own}")
    ElementTree.indent(root)
    return '<?xml version="1.0"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def element_name(name: str) -> str:
    """`name` with the characters that MaterialX allows in names."""
    allowed = re.sub(r"[^A-Za-z0-9_]", "_", name) or "material"
    return f"_{allowed}" if allowed[0].isdigit() else allowed


def _add(parent, name, kind, **attributes):
    ElementTree.SubElement(parent, "input", name=name, type=kind, **attributes)
