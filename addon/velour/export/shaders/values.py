"""Values, colors and pictures of a node's inputs."""

from ..conversions import numbers_of, own_numbers
from ..corner_colors import corner_colors_of
from ..image_nodes import UnsupportedError, picture_of, uv_placement
from ..plugs import fed_by, types_between
from ..programs import Compiler

_MOST_STEPS = 256


class Reader:
    """Reads inputs of one material's nodes; notes what it leaves out."""

    def __init__(self, owner, notes, unit=1.0, opens_measured=False):
        """`unit`: length of Blender's unit in the library's scene.

        opens_measured: read the nodes in measured groups instead of their models."""
        self.owner = owner
        self.notes = notes
        self.opens_measured = opens_measured
        self.compiler = Compiler(self, unit)
        self.steps_left = _MOST_STEPS  # shaders that may still be read

    def number(self, plug):
        """Value or color of an input that may vary, and its Picture, CornerColors, Computed or None."""
        if plug is None:
            return 0.0, None
        if is_constant(plug):
            return own_value(plug), None
        fed = fed_by(plug)
        value = _single(numbers_of(plug.socket))
        try:
            return value, self._source_of(fed, plug)
        except UnsupportedError as reason:
            self.note_link(plug, f" ({reason})")
            return value, None

    def value(self, plug):
        """Value or color of an input that cannot vary; notes a link."""
        value, picture = self.number(plug)
        if picture is not None:
            self.note_link(plug)
        return value

    def _source_of(self, fed, plug):
        """What an output that feeds an input provides; raises UnsupportedError."""
        is_number = isinstance(plug.socket.default_value, (int, float))
        kind = "number" if is_number else "color"
        given, *passed, _asked = types_between(plug)
        if set(passed) - {given}:  # converted on the way
            return self.compiler.computed(plug, kind)
        if fed.node.bl_idname in ("ShaderNodeVertexColor", "ShaderNodeAttribute"):
            return corner_colors_of(fed, is_number)
        if fed.node.bl_idname == "ShaderNodeTexImage" and self._is_on_uv_map(fed):
            return picture_of(fed, self.owner, self.notes)
        return self.compiler.computed(plug, kind)

    @staticmethod
    def _is_on_uv_map(fed):
        """Whether an Image Texture needs no program."""
        try:
            uv_placement(fed)
        except UnsupportedError:
            return False
        return True

    def note(self, plug, sentence):
        self.notes.add(f"{self.owner}: node '{plug.node.name}': {sentence}")

    def note_link(self, plug, reason="", used="the value of the input"):
        self.note(plug, f"the link to '{plug.socket.name}' is not supported{reason}; {used} is used.")


def is_constant(plug):
    """Whether nothing but a Value or RGB node feeds the input."""
    fed = fed_by(plug)
    return fed is None or fed.node.bl_idname in ("ShaderNodeValue", "ShaderNodeRGB")


def own_value(plug):
    """Float, or color triple, of an input that nothing feeds but a Value or RGB node."""
    return _single(own_numbers(plug))


def _single(numbers):
    return numbers[0] if len(numbers) == 1 else numbers
