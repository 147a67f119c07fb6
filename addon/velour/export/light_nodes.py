"""Shader nodes of lights."""

import numpy as np

from .image_nodes import UnsupportedError
from .newer import has_nodes
from .nodes import active_output
from .notes import Notes
from .plugs import Plug, fed_by
from .programs import finished
from .shaders.emission import radiance_of
from .shaders.values import Reader

_AS_IT_IS = (1.0, 1.0, 1.0)
_VARIES = ("source", "image")  # operations


def emission_factor(lamp):
    """Color factor on a light's emission, as in Cycles; None if its nodes cannot be evaluated to one."""
    if not has_nodes(lamp):
        return _AS_IT_IS
    output = active_output(lamp.node_tree, "ShaderNodeOutputLight")
    plug = fed_by(Plug(output.inputs["Surface"])) if output else None
    if plug is None:
        return (0.0, 0.0, 0.0)
    reader = Reader("", Notes())
    reader.compiler.is_world = True
    reader.compiler.more_nodes = {"ShaderNodeLightFalloff": _falloff}
    draft = reader.compiler.draft
    radiance = radiance_of(plug, reader)
    found = draft.output(radiance, "color")
    if len(reader.notes) or any(step.operation in _VARIES for step in draft.steps):
        return None
    if radiance.first < 0:
        return draft.constants_of(radiance)
    program = finished(draft, None, (), None)
    return tuple(map(float, program.radiance(found.index, "others", np.array([[0, 0, 1]], np.float32))[0]))


def _falloff(c, plug):
    smooth = c.input(plug.input("Smooth"))
    if plug.socket.name != "Quadratic" or smooth.first >= 0 or c.draft.constants_of(smooth)[0] != 0.0:
        raise UnsupportedError(f"'{plug.node.name}' is not a quadratic falloff without smoothing")
    return c.input(plug.input("Strength"))
