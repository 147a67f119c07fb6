"""Math, Vector Math, Clamp, Map Range, Mapping; separate and combine vectors."""

from ...native import table
from ..image_nodes import UnsupportedError
from ..newer import UNKNOWN
from ..plugs import Plug


def known(node, name, names):
    """The value of an enum property in lower case; raises UnsupportedError unless it is among `names`."""
    value = getattr(node, name)
    if value.lower() not in names:
        shown = f"'{value}', which is not supported" if value else UNKNOWN
        raise UnsupportedError(f"the {name.replace('_', ' ')} of '{node.name}' is {shown}")
    return value.lower()


def by_identifier(plug, identifier):
    """Input with an identifier: names of sockets may occur several times."""
    return Plug(next(s for s in plug.node.inputs if s.identifier == identifier), plug.groups)


def _at(plug, index):
    return Plug(plug.node.inputs[index], plug.groups)


def _math(c, plug):
    operation = known(plug.node, "operation", table.MATH)
    inputs = [c.input(_at(plug, i)) for i in range(3)]
    return c.draft.one("math", inputs, 1, (operation, plug.node.use_clamp))


def _vector_math(c, plug):
    operation = known(plug.node, "operation", table.VECTOR_MATH)
    inputs = [c.input(_at(plug, i)) for i in range(4)]
    vector, value = c.draft.step("vector_math", inputs, (3, 1), (operation,))
    return value if plug.socket.type == "VALUE" else vector


def _clamp(c, plug):
    inputs = [c.input(plug.input(name)) for name in ("Value", "Min", "Max")]
    return c.draft.one("clamp", inputs, 1, (plug.node.clamp_type == "RANGE",))


_RANGE = ("Value", "From Min", "From Max", "To Min", "To Max", "Steps")


def _map_range(c, plug):
    node = plug.node
    curve = known(node, "interpolation_type", table.RANGES)
    if node.data_type == "FLOAT":
        inputs = [c.input(plug.input(name)) for name in _RANGE]
        return c.draft.one("map_range", inputs, 1, (curve, node.clamp))
    names = ("Vector", *(f"{name.replace(' ', '_')}_FLOAT3" for name in _RANGE[1:5]), "Steps_FLOAT3")
    inputs = [c.input(by_identifier(plug, name)) for name in names]
    return c.draft.one("map_range_vector", inputs, 3, (curve, node.clamp))


def _mapping(c, plug):
    kind = known(plug.node, "vector_type", table.MAPPINGS)
    vector = c.input(plug.input("Vector"))
    # Newer Blenders have sockets only for the types that use them.
    location = plug.input("Location")
    inputs = [
        c.input(location) if location and kind in ("point", "texture") else c.draft.vector((0, 0, 0)),
        c.input(plug.input("Rotation")),
        c.input(plug.input("Scale")),
    ]
    return c.draft.one("mapping", (vector, *inputs), 3, (kind,))


def _separate_xyz(c, plug):
    return c.input(plug.input("Vector")).component("XYZ".index(plug.socket.name))


def _combine_xyz(c, plug):
    return c.draft.joined(*(c.input(plug.input(name)) for name in "XYZ"))


def _value(c, plug):
    return c.draft.number(plug.socket.default_value)


NODES = {
    "ShaderNodeMath": _math,
    "ShaderNodeVectorMath": _vector_math,
    "ShaderNodeClamp": _clamp,
    "ShaderNodeMapRange": _map_range,
    "ShaderNodeMapping": _mapping,
    "ShaderNodeSeparateXYZ": _separate_xyz,
    "ShaderNodeCombineXYZ": _combine_xyz,
    "ShaderNodeValue": _value,
}
