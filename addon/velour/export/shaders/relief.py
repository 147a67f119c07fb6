"""Normals of shader nodes."""

import bpy

from ..image_nodes import Picture, UnsupportedError
from ..newer import is_directx
from ..plugs import fed_by
from .layer import Relief

# Cycles' correction of steep normals changed in these versions; no property reveals it.
_CORRECTION = "turned" if bpy.app.version < (4, 0) else "faded" if bpy.app.version < (4, 5) else "shadowed"

# Nodes whose vectors have unit length.
_UNIT = (
    "ShaderNodeNormalMap",
    "ShaderNodeBump",
    "ShaderNodeNormal",
    "ShaderNodeNewGeometry",
    "ShaderNodeTexCoord",
)
_UNTILTED = (0.5, 0.5, 1.0)  # color of a normal map


def correction(material):
    """Correction of steep normals, named as in Shader.add_layer."""
    # A Cycles setting since 4.2, on by default.
    corrects = getattr(getattr(material, "cycles", None), "use_bump_map_correction", True)
    return _CORRECTION if corrects else "as-it-is"


def read_relief(plug, reader):
    """The Relief of a shader node, or None; notes unsupported links to its normal."""
    return _relief_of(plug.input("Normal"), reader)


def read_coat_relief(plug, reader):
    """The Relief of the coat of a Principled BSDF, or None."""
    return _relief_of(plug.input("Coat Normal", "Clearcoat Normal"), reader)


def _relief_of(socket, reader):
    fed = fed_by(socket)
    if fed is None:
        displaced = reader.compiler.computed_normal()
        return displaced and Relief(displaced, 1.0, is_surface=True)
    if fed.node.bl_idname == "ShaderNodeNormalMap":
        if fed.node.space != "TANGENT":
            reader.note(fed, "only normal maps in tangent space are supported; ignored.")
            return None
        color, picture = reader.number(fed.input("Color"))
        strength, varies = reader.number(fed.input("Strength"))
        if (picture is None and color == _UNTILTED) or (varies is None and strength <= 0.0):
            return None
        if isinstance(picture, Picture) and varies is None and not is_directx(fed.node):
            return Relief(picture, strength, fed.node.uv_map)
    if not _has_unit_length(fed.node):
        reader.note(
            fed,
            f"'{fed.socket.name}' may not have unit length; normalized. Before 4.0, Cycles does not"
            " normalize it, which changes brightness. Normalize it with a Vector Math node for the same"
            " image.",
        )
    try:
        return Relief(reader.compiler.computed(socket, "normal"), 1.0)
    except UnsupportedError as reason:
        reader.note_link(socket, f" ({reason})")
        return None


def _has_unit_length(node):
    """Whether Cycles uses the normal of a node as Velour does."""
    is_normalized = node.bl_idname == "ShaderNodeVectorMath" and node.operation == "NORMALIZE"
    return bpy.app.version >= (4, 0) or is_normalized or node.bl_idname in _UNIT
