"""Inputs of the node group of a measured material."""

from typing import NamedTuple

from ..export.nodes import nodes_of


class Input(NamedTuple):
    name: str
    kind: str  # type of the socket
    subtype: str = "NONE"
    default: float | tuple = 0.0
    bounds: tuple | None = None
    description: str = ""
    hides_value: bool = False  # only a link has an effect


_LOOK = (
    Input("Tint", "Color", default=(1, 1, 1, 1), description="Color that multiplies the reflection"),
    Input("Exposure", "Float", bounds=(-32, 32), description="Exposure of the reflection in stops"),
    Input(
        "Roughness Offset",
        "Float",
        "FACTOR",
        bounds=(0, 1),
        description="Widens the highlights, keeping their brightness",
    ),
    Input("Normal", "Vector", default=(0, 0, 0), hides_value=True),
)
_NOT_OF_BTFS = {"Roughness Offset"}
_ROTATION = Input(
    "Rotation",
    "Float",
    "ANGLE",
    description="Counterclockwise rotation of the tiles, or of the direction of anisotropy",
)
_TILES = (
    Input("Scale", "Float", default=1.0, bounds=(1e-3, 1e6), description="Factor on the size of the tiles"),
    Input("Vector", "Vector", default=(0, 0, 0), hides_value=True),
    # The placement for other engines, which follows the settings of the material.
    Input("Repeats", "Vector", default=(1, 1, 1)),
    Input("Offset", "Vector", default=(0, 0, 0)),
)


def wanted(info):
    """The inputs of a group for a model. `info`: the model's; empty without a model."""
    has_tiles = "texels" in info or "shell" in info
    turns = (_ROTATION,) if has_tiles or not info.get("isotropic", True) else ()
    look = (each for each in _LOOK if "texels" not in info or each.name not in _NOT_OF_BTFS)
    return (*look, *turns, *(_TILES if has_tiles else ()))


def put(tree, inputs):
    """Gives the tree these of Velour's inputs; those that it has keep their links and values."""
    others = {each.name for each in (*_LOOK, _ROTATION, *_TILES)} - {each.name for each in inputs}
    for socket in list(_sockets(tree)):
        if socket.name in others:
            _remove(tree, socket)
    existing = {socket.name for socket in _sockets(tree)}
    added = [each for each in inputs if each.name not in existing]
    for each in added:
        _add(tree, each)
    for node in nodes_of(tree):
        for each in added:  # a new input of an existing node ignores the default of the tree
            node.inputs[each.name].default_value = each.default


def set_default(tree, name, value):
    """Sets the value that an input has in new nodes of the tree."""
    next(socket for socket in _sockets(tree) if socket.name == name).default_value = value


def put_output(tree, name, kind):
    """Gives the tree an output with this name, unless it has one."""
    if hasattr(tree, "interface"):  # 4.0 and newer
        items = (item for item in tree.interface.items_tree if item.item_type == "SOCKET")
        if not any(item.in_out == "OUTPUT" and item.name == name for item in items):
            tree.interface.new_socket(name=name, in_out="OUTPUT", socket_type=f"NodeSocket{kind}")
    elif name not in tree.outputs:
        tree.outputs.new(f"NodeSocket{kind}", name)


def _sockets(tree):
    if hasattr(tree, "interface"):  # 4.0 and newer
        return [
            item
            for item in tree.interface.items_tree
            if item.item_type == "SOCKET" and item.in_out == "INPUT"
        ]
    return tree.inputs


def _remove(tree, socket):
    (tree.interface if hasattr(tree, "interface") else tree.inputs).remove(socket)


def _add(tree, each):
    if hasattr(tree, "interface"):
        socket = tree.interface.new_socket(
            name=each.name, in_out="INPUT", socket_type=f"NodeSocket{each.kind}", description=each.description
        )
        if each.subtype != "NONE":
            socket.subtype = each.subtype
    else:
        suffix = "" if each.subtype == "NONE" else each.subtype.capitalize()
        socket = tree.inputs.new(f"NodeSocket{each.kind}{suffix}", each.name)
        socket.description = each.description
    socket.default_value = each.default
    if each.bounds:
        socket.min_value, socket.max_value = each.bounds
    socket.hide_value = each.hides_value
