"""Compiles the nodes that feed an input."""

from ..image_nodes import UnsupportedError
from ..plugs import followed
from .conversions import converted, own
from .draft import MOST_INSTRUCTIONS, Draft
from .nodes import NODES

_MOST_DEPTH = 100  # links of a broken file may be cyclic


class Compiler:
    """Compiles inputs of one material's shaders to one Draft. `metres`: per unit of Blender's coordinates."""

    def __init__(self, reader, metres):
        self.reader = reader
        self.metres = metres
        self.draft = Draft()
        self.more_nodes = {}  # compiled beside NODES
        self.is_world = False  # directions are evaluated in place of points of a surface
        self.shift = "none"  # the point at which sources are read
        self.displaced_normal = None  # Value of the surface's normal with displacement as bump
        self._values = {}
        self._depth = 0

    def computed(self, plug, asked, kind):
        """The Computed of the output `plug` for the socket `asked`; raises UnsupportedError.

        kind: color, number, normal.
        """
        value = converted(self.draft, self.output(plug), plug.socket.type, asked.type)
        found = self.draft.output(value, kind)
        if found is None:
            raise UnsupportedError("the material has too many computed inputs")
        return found

    def input(self, plug):
        """The Value of an input, as its type; its own value, with a note, if it cannot be evaluated."""
        fed = followed(plug)
        if fed is None or not fed.socket.is_output:
            return own(self.draft, (fed or plug).socket, plug.socket.type)
        try:
            return converted(self.draft, self.output(fed), fed.socket.type, plug.socket.type)
        except UnsupportedError as reason:
            self.reader.note_link(plug, f" ({reason})")
            return own(self.draft, plug.socket, plug.socket.type)

    def linked(self, plug):
        """The Value of an input if a node feeds it, else None."""
        fed = followed(plug) if plug else None
        return self.input(plug) if fed is not None and fed.socket.is_output else None

    def output(self, plug):
        """The Value of an output, as its type; raises UnsupportedError."""
        key = plug.socket.as_pointer(), tuple(g.as_pointer() for g in plug.groups), self.shift
        if key not in self._values:
            self._values[key] = self._compiled(plug)
        return self._values[key]

    def _compiled(self, plug):
        compile_node = NODES.get(plug.node.bl_idname) or self.more_nodes.get(plug.node.bl_idname)
        if compile_node is None:
            raise UnsupportedError(f"'{plug.node.name}' is not a node that Velour evaluates")
        if self._depth == _MOST_DEPTH or len(self.draft.steps) > MOST_INSTRUCTIONS:
            raise UnsupportedError(f"'{plug.node.name}' depends on too many nodes")
        self._depth += 1
        try:
            return compile_node(self, plug)
        finally:
            self._depth -= 1

    def shifted(self, shift, plug):
        """The Value of an input at the point moved by `shift`."""
        before, self.shift = self.shift, shift
        try:
            return self.input(plug)
        finally:
            self.shift = before

    def surface_normal(self):
        """The shading normal on the viewer's side."""
        return self.draft.source("normal") if self.displaced_normal is None else self.displaced_normal

    def computed_normal(self):
        """The Computed of the surface's normal if it is displaced, else None."""
        return self.displaced_normal and self.draft.output(self.displaced_normal, "normal")

    def computed_source(self, kind):
        """The Computed of a number that is the same all over the surface; None if there are too many."""
        return self.draft.output(self.draft.source(kind).component(0), "number")

    def source(self, kind, number=0):
        """A property of the surface that moves with the point; raises UnsupportedError if it is a world."""
        if self.is_world and kind in ("uv", "corner"):
            raise UnsupportedError("a world has no UV maps and attributes")
        return self.draft.source(kind, number, self.shift)
