"""Normal Map nodes."""

import bpy

from ..corner_colors import CornerColors
from ..plugs import fed_by
from .layer import Relief

# Cycles' correction of steep normals changed in these versions; no property reveals it.
_CORRECTION = "turned" if bpy.app.version < (4, 0) else "faded" if bpy.app.version < (4, 5) else "shadowed"


def correction(material):
    """Correction of steep normals, named as in Shader.add_layer."""
    # A Cycles setting since 4.2, on by default.
    corrects = getattr(getattr(material, "cycles", None), "use_bump_map_correction", True)
    return _CORRECTION if corrects else "as-it-is"


def read_relief(plug, reader):
    """The Relief of a shader node, or None; notes unsupported links to its normal."""
    fed = fed_by(plug.input("Normal"))
    if fed is None:
        return None
    if fed.node.bl_idname != "ShaderNodeNormalMap":
        reader.note_link(plug.input("Normal"), f" ('{fed.node.name}' is not a Normal Map)")
        return None
    if fed.node.space != "TANGENT":
        reader.note(fed, "only normal maps in tangent space are supported; ignored.")
        return None
    _, picture = reader.number(fed.input("Color"))
    strength = max(reader.value(fed.input("Strength")), 0.0)
    if isinstance(picture, CornerColors):
        reader.note_link(fed.input("Color"), " (it is not an image)")
        return None
    if picture is None or strength == 0.0:
        return None
    return Relief(picture, strength, fed.node.uv_map)
