"""Compiles the nodes that feed an input."""

from ..conversions import converted, numbers_of, own_numbers
from ..image_nodes import UnsupportedError
from ..plugs import fed_by, types_between
from .draft import MOST_INSTRUCTIONS, Draft
from .nodes import NODES

_MOST_DEPTH = 100  # links of a broken file may be cyclic


class Compiler:
    """Compiles inputs of one material's shaders to one Draft. `unit`: length of Blender's in the scene."""

    def __init__(self, reader, unit):
        self.reader = reader
        self.unit = unit
        self.draft = Draft()
        self.more_nodes = {}  # compiled beside NODES
        self.is_world = False  # directions are evaluated in place of points of a surface
        self.shift = "none"  # the point at which sources are read
        self.displaced_normal = None  # Value of the surface's normal with displacement as bump
        self._values = {}
        self._depth = 0

    def computed(self, plug, kind):
        """The Computed of what feeds the input `plug` through an output; raises UnsupportedError.

        kind: color, number, normal.
        """
        found = self.draft.output(self._fed(plug), kind)
        if found is None:
            raise UnsupportedError("the material has too many computed inputs")
        return found

    def input(self, plug):
        """The Value of an input, as its type; its own value, with a note, if it cannot be evaluated."""
        if fed_by(plug) is None:
            return self.draft.constant(own_numbers(plug))
        try:
            return self._fed(plug)
        except UnsupportedError as reason:
            self.reader.note_link(plug, f" ({reason})")
            return self.draft.constant(numbers_of(plug.socket))

    def _fed(self, plug):
        return converted(self.draft, self.output(fed_by(plug)), types_between(plug))

    def linked(self, plug):
        """The Value of an input if a node feeds it, else None."""
        return self.input(plug) if fed_by(plug) else None

    def output(self, plug):
        """The Value of an output, as its type; raises UnsupportedError."""
        groups = tuple(g.as_pointer() for g in plug.groups)
        key = plug.socket.as_pointer(), groups, self.shift, self.displaced_normal
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
