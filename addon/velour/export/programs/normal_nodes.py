"""Nodes of the normal and the view."""

import math

import bpy

from ..conversions import own_numbers
from ..image_nodes import UnsupportedError
from ..newer import is_directx

# Filter width of displacement as bump, and of Bump nodes without that input; no property reveals it.
_USUAL_WIDTH = 0.1 if bpy.app.version >= (4, 4) else 1.0


def _normal(c, plug):
    """The Normal input of a node; unlinked: the surface's."""
    given = c.linked(plug.input("Normal"))
    return c.surface_normal() if given is None else given


def _fresnel(c, plug):
    return c.draft.one("fresnel", (c.input(plug.input("IOR")), *_view(c, plug)))


def _layer_weight(c, plug):
    inputs = c.input(plug.input("Blend")), *_view(c, plug)
    fresnel, facing = c.draft.step("layer_weight", inputs, (1, 1))
    return facing if plug.socket.name == "Facing" else fresnel


def _view(c, plug):
    back = c.draft.source("backfacing").component(0)
    return _normal(c, plug), c.draft.source("incoming"), back


def _bump(c, plug):
    normal, height = _normal(c, plug), plug.input("Height")
    if c.linked(height) is None or c.shift != "none":
        return normal
    heights = [c.input(height), c.shifted("x", height), c.shifted("y", height)]
    side = -c.unit if plug.node.invert else c.unit
    return bumped(c, plug, normal, heights, c.draft.math("multiply", c.input(plug.input("Distance")), side))


def bumped(c, plug, normal, heights, distance):
    """A normal bent by the height at the point and beside it. `distance`: scene length per unit of height."""
    width = plug.input("Filter Width")  # 4.5 and newer
    _shift_by(c, plug, max(own_numbers(width)[0], 1e-3) if width else _USUAL_WIDTH)
    strength = plug.input("Strength")
    steps = c.draft.source("step_x"), c.draft.source("step_y")
    inputs = c.input(strength) if strength else c.draft.number(1.0), distance, *heights, normal, *steps
    return c.draft.one("bump", inputs, 3)


def _shift_by(c, plug, width):
    """Sets the distance of shifted points, in pixels."""
    if c.draft.width is not None and not math.isclose(c.draft.width, width, rel_tol=1e-5):
        c.reader.note(plug, "bump with several filter widths is not supported; the smallest is used for all.")
        width = min(width, c.draft.width)
    c.draft.width = width


def displaced(c, plug):
    """The surface's normal with the output of a Displacement node as bump; raises UnsupportedError."""
    node = plug.node
    if node.bl_idname != "ShaderNodeDisplacement":
        raise UnsupportedError(f"'{node.name}' is not a Displacement node")
    if c.linked(plug.input("Normal")) is not None:
        raise UnsupportedError(f"'{node.name}' has a linked normal")
    heights = [_displacement(c, plug, shift) for shift in ("none", "x", "y")]
    return bumped(c, plug, c.draft.source("normal"), heights, _length_of(c, node.space))


def _displacement(c, plug, shift):
    height, middle, scale = (c.shifted(shift, plug.input(name)) for name in ("Height", "Midlevel", "Scale"))
    return c.draft.math("multiply", c.draft.math("subtract", height, middle), scale)


def _length_of(c, space):
    """Length of a unit of displacement; in object space it scales with the object, along the surface."""
    if space == "WORLD":
        return c.draft.number(c.unit)
    here, beside = (c.draft.source("object_position", 0, shift) for shift in ("none", "x"))
    in_object = c.draft.vector_math("distance", here, beside)[1]
    in_world = c.draft.vector_math("length", c.draft.source("step_x"))[1]
    return c.draft.math("divide", in_world, in_object)


def _normal_map(c, plug):
    node = plug.node
    if node.space != "TANGENT":
        raise UnsupportedError(f"'{node.name}' is not in tangent space")
    c.draft.relief_maps.append(node.uv_map)
    axes = [c.draft.source(f"map_{name}") for name in ("tangent", "bitangent", "normal")]
    color, strength = c.input(plug.input("Color")), c.input(plug.input("Strength"))
    if is_directx(node):
        green = c.draft.math("subtract", 1.0, color.component(1))
        color = c.draft.joined(color.component(0), green, color.component(2))
    strength = c.draft.math("maximum", strength, 0.0)
    return c.draft.one("normal_map", (color, strength, *axes, c.surface_normal()), 3)


def _direction(c, plug):
    """A Normal node: a constant direction, and its cosine with the input."""
    direction = c.draft.vector_math("normalize", c.draft.vector(plug.node.outputs[0].default_value))[0]
    if plug.socket.name == "Normal":
        return direction
    given = c.draft.vector_math("normalize", c.input(plug.input("Normal")))[0]
    return c.draft.vector_math("dot_product", direction, given)[1]


NODES = {
    "ShaderNodeFresnel": _fresnel,
    "ShaderNodeLayerWeight": _layer_weight,
    "ShaderNodeBump": _bump,
    "ShaderNodeNormalMap": _normal_map,
    "ShaderNodeNormal": _direction,
}
