"""Following links between nodes, past reroutes and muted nodes, into node groups and out of them."""

from typing import Any, NamedTuple

from .nodes import first_input

_MOST_STEPS = 1000  # links of a broken file may go round


class Plug(NamedTuple):
    """A socket, and the group nodes that its tree is shown by, the outermost first."""

    socket: Any
    groups: tuple = ()

    @property
    def node(self):
        return self.socket.node

    def input(self, *names):
        """An input of its node, by the first of these names that there is, or None."""
        socket = first_input(self.node, *names)
        return Plug(socket, self.groups) if socket is not None else None

    def inputs(self, idname):
        """The inputs of its node of a type, in their order: a Mix Shader has two of one name."""
        return [Plug(socket, self.groups) for socket in self.node.inputs if socket.bl_idname == idname]


def followed(plug):
    """The output of the node that feeds an input; an input whose own value holds; None: nothing does.

    The input may be another one: that of a group node around, or of a muted node before.
    """
    for _ in range(_MOST_STEPS):
        step = _step_out_of(plug) if plug.socket.is_output else _step_into(plug)
        if step is plug or step is None:
            return step
        plug = step
    return None


def fed_by(plug):
    """The output that feeds an input; None where its own value holds."""
    found = followed(plug) if plug else None
    return found if found and found.socket.is_output else None


def _step_into(plug):
    socket, groups = plug
    if not (socket.is_linked and socket.links) or socket.links[0].is_muted:
        return plug
    return Plug(socket.links[0].from_socket, groups)


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
    if node.bl_idname == "ShaderNodeGroup":
        outputs = (
            [n for n in node.node_tree.nodes if n.bl_idname == "NodeGroupOutput"] if node.node_tree else []
        )
        inner = next((n for n in outputs if n.is_active_output), None)
        return _same(inner.inputs, socket, (*groups, node)) if inner else None
    return plug


def _same(sockets, socket, groups):
    found = next((other for other in sockets if other.identifier == socket.identifier), None)
    return Plug(found, groups) if found else None
