"""Adds nodes to a shader tree, in frames, and finds those that were added by an earlier build."""

import bpy

COLUMN = 260  # width of a node with a curve, and a margin
_FRAME = "NodeFrame"


class NodeBuilder:
    """Places are in columns and pixels, right of and above the origin of the part that was begun last.

    tag: name of a custom property of all nodes added here. Its value is the node's name, which tells a node
    from duplicates that a user made of it.
    """

    def __init__(self, tree, tag, label):
        self._tree, self._tag = tree, tag
        self._frame = None  # of new nodes
        self._column = self._y = 0  # origin of their places
        self._whole = self._frame = self._add_frame(label)

    def begin_part(self, label="", column=0, y=0):
        """Starts a part with its own origin; a part with a label has a frame."""
        self._column, self._y, self._frame = column, y, self._whole
        if label:
            self._frame = self._add_frame(label)

    def add(self, idname, column=0, y=0, label="", **settings):
        node = self._tree.nodes.new(idname)
        node.location = (self._column + column) * COLUMN, self._y + y
        node.parent, node.label = self._frame, label
        for name, value in settings.items():
            setattr(node, name, value)
        node[self._tag] = node.name
        return node

    def math(self, operation, column, *values, **settings):
        """The output of a Math node; values: output sockets and constants."""
        return self._calculation("ShaderNodeMath", operation, column, values, **settings)

    def vector(self, operation, column, *values, **settings):
        """The output of a Vector Math node; values: output sockets and constants."""
        return self._calculation("ShaderNodeVectorMath", operation, column, values, **settings)

    def put(self, socket, value):
        """Links an output to an input socket, or sets a constant: a number for a vector sets all three."""
        if isinstance(value, bpy.types.NodeSocket):
            self._tree.links.new(value, socket)
        else:
            value = (value,) * 3 if socket.type == "VECTOR" and isinstance(value, float) else value
            socket.default_value = (*value, 1.0) if socket.type == "RGBA" else value

    def _calculation(self, idname, operation, column, values, y=0, label="", **settings):
        node = self.add(idname, column, y, label, operation=operation, hide=True, **settings)
        for socket, value in zip((s for s in node.inputs if s.enabled), values, strict=True):
            self.put(socket, value)
        return next(socket for socket in node.outputs if socket.enabled)

    def _add_frame(self, label):
        """Adds a frame at the origin, where places of nodes are the same inside and outside of it."""
        frame = self._tree.nodes.new(_FRAME)
        frame.parent, frame.label = self._frame, label
        frame[self._tag] = frame.name
        return frame


def remove_built(tree, tag):
    """Removes what a NodeBuilder added; returns the other nodes' sockets that were linked to it."""
    ours = {node.name for node in tree.nodes if node.get(tag) == node.name}
    shown_by = [
        link.to_socket for link in tree.links if link.from_node.name in ours and link.to_node.name not in ours
    ]
    for name in ours:
        tree.nodes.remove(tree.nodes[name])
    return shown_by
