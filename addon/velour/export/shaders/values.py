"""Values, colors and pictures of a node's inputs."""

import numpy as np

from ..color import luminance_weights
from ..corner_colors import corner_colors_of
from ..image_nodes import UnsupportedError, picture_of, uv_placement
from ..plugs import followed
from ..programs import Compiler

_MOST_STEPS = 256


class Reader:
    """Reads inputs of one material's nodes; notes what it leaves out."""

    def __init__(self, owner, notes, metres=1.0, opens_measured=False):
        """`metres`: per unit of Blender's coordinates.

        opens_measured: read the nodes in measured groups instead of their models."""
        self.owner = owner
        self.notes = notes
        self.opens_measured = opens_measured
        self.compiler = Compiler(self, metres)
        self.steps_left = _MOST_STEPS  # shaders that may still be read

    def number(self, plug):
        """Value or color of an input that may vary, and its Picture, CornerColors, Computed or None."""
        fed = followed(plug) if plug else None
        if fed is None or not fed.socket.is_output:
            return own_value((fed or plug).socket, plug.socket) if plug else 0.0, None
        if fed.node.bl_idname in ("ShaderNodeValue", "ShaderNodeRGB"):
            return own_value(fed.socket, plug.socket), None
        try:
            return own_value(plug.socket), self._source_of(fed, plug.socket)
        except UnsupportedError as reason:
            self.note_link(plug, f" ({reason})")
            return own_value(plug.socket), None

    def value(self, plug):
        """Value or color of an input that cannot vary; notes a link."""
        value, picture = self.number(plug)
        if picture is not None:
            self.note_link(plug)
        return value

    def _source_of(self, fed, asked):
        """What an output that feeds the socket `asked` provides; raises UnsupportedError."""
        is_number = isinstance(asked.default_value, (int, float))
        if fed.node.bl_idname in ("ShaderNodeVertexColor", "ShaderNodeAttribute"):
            return corner_colors_of(fed, is_number)
        if fed.node.bl_idname == "ShaderNodeTexImage" and self._is_on_uv_map(fed):
            return picture_of(fed, self.owner, self.notes)
        return self.compiler.computed(fed, asked, "number" if is_number else "color")

    @staticmethod
    def _is_on_uv_map(fed):
        """Whether an Image Texture needs no program."""
        try:
            uv_placement(fed.input("Vector"))
        except UnsupportedError:
            return False
        return True

    def note(self, plug, sentence):
        self.notes.add(f"{self.owner}: node '{plug.node.name}': {sentence}")

    def note_link(self, plug, reason="", used="the value of the input"):
        self.note(plug, f"the link to '{plug.socket.name}' is not supported{reason}; {used} is used.")


def own_value(socket, asked=None):
    """Float, or color triple, in the kind of the socket `asked`; 0 for None and shader sockets."""
    value = getattr(socket, "default_value", 0.0)
    value = float(value) if isinstance(value, (int, float)) else tuple(value[:3])
    if asked is None or isinstance(asked.default_value, (int, float)) == isinstance(value, float):
        return value
    return (value,) * 3 if isinstance(value, float) else float(np.dot(luminance_weights(), value))
