"""Shader nodes of lights."""

from .newer import has_nodes
from .nodes import active_output
from .notes import Notes
from .plugs import Plug, fed_by
from .shaders.values import Reader

_AS_IT_IS = (1.0, 1.0, 1.0)


def emission_factor(lamp):
    """Color factor on a light's emission, as in Cycles; None if its nodes are more than one Emission node
    with constant color and strength."""
    if not has_nodes(lamp):
        return _AS_IT_IS
    output = active_output(lamp.node_tree, "ShaderNodeOutputLight")
    plug = fed_by(Plug(output.inputs["Surface"])) if output else None
    if plug is None:
        return (0.0, 0.0, 0.0)
    if plug.node.bl_idname != "ShaderNodeEmission":
        return None
    reader = Reader("", Notes())
    color, picture = reader.number(plug.input("Color"))
    strength, gain = reader.number(plug.input("Strength"))
    if picture or gain or len(reader.notes):
        return None
    return tuple(strength * c for c in color)
