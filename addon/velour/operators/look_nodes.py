"""Math nodes that apply a group's inputs to an approximation, as core/approximation_look does."""

import math


class LookNodes:
    """Adds nodes to a tree; every method returns the output socket of the last one."""

    def __init__(self, tree, source):
        """`source`: the Group Input node."""
        self._tree, self._source = tree, source
        self._count = 0
        stops = self.math("POWER", 2.0, source.outputs["Exposure"])
        self.gain = self.vector("SCALE", source.outputs["Tint"], scale=stops)
        self._brightness = self.vector("DOT_PRODUCT", self.gain, (1 / 3,) * 3, output="Value")
        offset = source.outputs.get("Roughness Offset")  # not of BTFs
        # Squared GGX alpha of the offset.
        self._spread = self.math("POWER", offset, 4.0) if offset else 0.0

    def color(self, color):
        """A color, or its socket, times the gain; at most 1."""
        return self.vector("MINIMUM", self.vector("MULTIPLY", self.gain, color), (1.0,) * 3)

    def weight(self, value):
        return self.math("MULTIPLY", self._brightness, value, clamp=True)

    def tint(self, tint, metallic):
        """A specular tint, which already contains the gain for the metallic part."""
        relative = self.vector("SCALE", self.gain, scale=self.math("DIVIDE", 1.0, self._brightness))
        shares = (tuple(t * share for t in tint) for share in (1 - metallic, metallic))
        return self.vector("MULTIPLY_ADD", relative, *shares)

    def roughness(self, roughness):
        """A roughness, or its socket, plus the offset: squared alphas add."""
        is_socket = hasattr(roughness, "is_output")
        square = self.math("POWER", roughness, 4.0) if is_socket else roughness**4
        return self.math("POWER", self.math("ADD", self._spread, square), 0.25)

    def anisotropic(self, roughness, anisotropic):
        """Roughness and anisotropy of a highlight; Blender's alphas are r^2 / aspect and r^2 aspect."""
        aspect = math.sqrt(1 - 0.9 * anisotropic)
        wide, narrow = (
            self.math("ADD", self._spread, roughness**4 * factor) for factor in (1 / aspect**2, aspect**2)
        )
        ratio = self.math("POWER", self.math("DIVIDE", narrow, wide), 0.5)
        mean = self.math("POWER", self.math("MULTIPLY", wide, narrow), 0.125)
        return mean, self.math("MULTIPLY_ADD", ratio, -1 / 0.9, 1 / 0.9)

    def turns(self, offset):
        """The Rotation input as a number of turns from 0 to 1, plus `offset`."""
        turns = self.math("MULTIPLY_ADD", self._source.outputs["Rotation"], 1 / math.tau, offset)
        return self.math("FRACT", turns)

    def math(self, operation, *values, clamp=False):
        node = self._add("ShaderNodeMath", operation)
        node.use_clamp = clamp
        return self._fed(node, values, "Value")

    def vector(self, operation, *values, scale=None, output="Vector"):
        node = self._add("ShaderNodeVectorMath", operation)
        if scale is not None:
            self._tree.links.new(scale, node.inputs["Scale"])
        return self._fed(node, values, output)

    def _add(self, idname, operation):
        node = self._tree.nodes.new(idname)
        node.operation = operation
        node.hide = True
        node.location = -700 + 180 * (self._count % 3), -700 - 50 * (self._count // 3)
        self._count += 1
        return node

    def _fed(self, node, values, output):
        for socket, value in zip(node.inputs, values, strict=False):
            if hasattr(value, "is_output"):
                self._tree.links.new(value, socket)
            else:
                socket.default_value = value
        return node.outputs[output]
