"""Follows links between nodes through reroutes and muted nodes, into and out of node groups."""

from typing import Any, NamedTuple

import bpy

from .nodes import first_input, link_to, model_texture

# Whether Cycles sees a tree without groups, reroutes and muted nodes: 5.0 and newer.
INLINES = hasattr(bpy.types.Material, "inline_shader_nodes")
# Nodes that are then replaced by their values if all their inputs are constant.
_FOLDED = (
    "ShaderNodeValue",
    "ShaderNodeMath",
    "ShaderNodeVectorMath",
    "ShaderNodeMix",
    "ShaderNodeCombineXYZ",
    "ShaderNodeSeparateXYZ",
    "ShaderNodeClamp",
    "ShaderNodeMapRange",
    "ShaderNodeVectorRotate",
    "ShaderNodeValToRGB",
    "ShaderNodeRGBCurve",
    "ShaderNodeVectorCurve",
    "ShaderNodeFloatCurve",
)
_MOST_STEPS = 1000  # links of a broken file may be cyclic


class Plug(NamedTuple):
    """A socket, and the group nodes that contain its tree, outermost first."""

    socket: Any
    groups: tuple = ()

    @property
    def node(self):
        return self.socket.node

    def input(self, *names):
        """The node's input with the first of these names that exists, or None."""
        socket = first_input(self.node, *names)
        return Plug(socket, self.groups) if socket is not None else None

    def inputs(self, idname):
        """The node's inputs of a type, in order; a Mix Shader has two with one name."""
        return [Plug(socket, self.groups) for socket in self.node.inputs if socket.bl_idname == idname]


def followed(plug):
    """The output that feeds an input, or the input whose own value applies; None if there is neither.

    That input may belong to an enclosing group node, or to a muted node upstream. The shader of a group that
    contains a measured model is an output like that of any other shader node.
    """
    return _path(plug)[-1]


def types_between(plug):
    """Types of the sockets that convert a value on its way to an input, from its source to the input.

    Like Cycles: inputs of muted nodes do not. Where it sees no groups, they convert only constants.
    """
    passed = [each for each in _path(plug) if each and (each.socket.is_output or not each.node.mute)]
    types = [each.socket.type for each in reversed(passed)]
    source = passed[-1]
    if INLINES and source.socket.is_output and not set(types) <= {types[0], types[-1]}:
        return types if _is_folded(source) else [types[0], types[-1]]
    return types


def _is_folded(plug):
    """Whether an output is replaced by its value before Cycles sees it."""
    waiting, seen = [plug], set()
    while waiting:
        node, groups = (found := waiting.pop()).node, found.groups
        if node.bl_idname not in _FOLDED:
            return False
        feeding = {fed_by(Plug(each, groups)) for each in node.inputs if each.enabled and each.is_linked}
        waiting += feeding - seen - {None}
        seen |= feeding
    return True


def is_within_tree(plug):
    """Whether links lead to the value of an input without leaving its tree or entering a group."""
    return all(each is None or each.groups == plug.groups for each in _path(plug))


def _path(plug):
    """The plugs from an input to what followed() finds."""
    path = [plug]
    for _ in range(_MOST_STEPS):
        step = _step_out_of(plug) if plug.socket.is_output else _step_into(plug)
        if step is plug:
            return path
        path.append(step)
        if step is None:
            return path
        plug = step
    return [*path, None]


def is_passed_through(node):
    """Whether links pass through a node."""
    return node.mute or node.bl_idname == "NodeReroute"


def fed_by(plug):
    """The output that feeds an input; None if its own value applies."""
    found = followed(plug) if plug else None
    return found if found and found.socket.is_output else None


def _step_into(plug):
    link = link_to(plug.socket)
    return Plug(link.from_socket, plug.groups) if link else plug


def _step_out_of(plug):
    socket, groups = plug
    node = socket.node
    if node.bl_idname == "NodeReroute":
        return Plug(node.inputs[0], groups)
    if node.mute:
        through = next((link.from_socket for link in node.internal_links if link.to_socket == socket), None)
        return Plug(through, groups) if through else None
    if node.bl_idname == "NodeGroupInput" and groups:
        return _same(groups[-1].inputs, socket, groups[:-1])
    if node.bl_idname == "ShaderNodeGroup" and not is_measured(plug):
        return inside(plug)
    return plug


def is_measured(plug):
    """Whether it is the shader of a group that contains a measured model."""
    node, socket = plug.node, plug.socket
    is_shader = node.bl_idname == "ShaderNodeGroup" and node.node_tree and socket.type == "SHADER"
    return bool(is_shader) and model_texture(node.node_tree) is not None


def inside(plug):
    """The input of a group's tree behind an output of its node, or None."""
    node = plug.node
    outputs = [n for n in node.node_tree.nodes if n.bl_idname == "NodeGroupOutput"] if node.node_tree else []
    inner = next((n for n in outputs if n.is_active_output), None)
    return _same(inner.inputs, plug.socket, (*plug.groups, node)) if inner else None


def _same(sockets, socket, groups):
    found = next((other for other in sockets if other.identifier == socket.identifier), None)
    return Plug(found, groups) if found else None
