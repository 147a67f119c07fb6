"""Shaders of worlds and lights, which only emit."""

import numpy as np

from ..conversions import converted
from ..image_nodes import UnsupportedError
from ..plugs import fed_by


def radiance_of(plug, reader):
    """The Value of the radiance of a shader that only emits; all others are black, with a note."""
    compiler, draft, node = reader.compiler, reader.compiler.draft, plug.node
    black = draft.vector((0, 0, 0))
    if reader.steps_left <= 0:
        return black
    reader.steps_left -= 1
    if plug.socket.type != "SHADER":  # an emission of this color, as in Cycles
        try:
            return converted(draft, compiler.output(plug), (plug.socket.type, "RGBA"))
        except UnsupportedError as reason:
            reader.note(plug, f"it is not supported ({reason}); rendered black.")
            return black
    if node.bl_idname in ("ShaderNodeBackground", "ShaderNodeEmission"):
        color, strength = compiler.input(plug.input("Color")), compiler.input(plug.input("Strength"))
        scaled = _folded(draft, lambda c, s: c * s, color, strength)
        return scaled or draft.vector_math("scale", color, scale=strength)[0]
    if node.bl_idname in ("ShaderNodeMixShader", "ShaderNodeAddShader"):
        fed = [fed_by(shader) for shader in plug.inputs("NodeSocketShader")]
        first, second = [radiance_of(shader, reader) if shader else black for shader in fed]
        if node.bl_idname == "ShaderNodeMixShader":
            return _mixed(draft, compiler.input(plug.input("Fac", "Factor")), first, second)
        return _folded(draft, lambda a, b: a + b, first, second) or draft.vector_math("add", first, second)[0]
    reader.note(plug, f"{node.bl_label} emits no light here; rendered black.")
    return black


def _mixed(draft, share, first, second):
    mixed = _folded(draft, lambda f, a, b: a + np.clip(f, 0, 1) * (b - a), share, first, second)
    return mixed or draft.one("mix_vector", (draft.joined(share, share, share), first, second), 3, (1,))


def _folded(draft, function, *values):
    """The vector that a function makes of constants, as a constant; None if a value is computed."""
    if any(value.first >= 0 for value in values):
        return None
    return draft.vector(
        np.broadcast_to(function(*(np.array(draft.constants_of(value)) for value in values)), 3)
    )
