"""Attributes of meshes in the place of colors and numbers of materials."""

import math

import bpy
import numpy as np

from parity import stage
from parity.case import ParityTest
from parity.shaders import Tree, image

COLUMNS, ROWS = 6, 4


class Attributes(ParityTest):
    """A wall of squares under a white sky."""

    def setUp(self):
        super().setUp()
        stage.camera((0, -6, 0), (math.pi / 2, 0, 0))
        stage.world()
        self.material = bpy.data.materials.new("Painted")
        self.tree = Tree(self.material)
        points = [(x / 2 - 1.5, 0, z / 2 - 1) for z in range(ROWS + 1) for x in range(COLUMNS + 1)]
        corners = np.array([0, 1, COLUMNS + 2, COLUMNS + 1])
        faces = [
            tuple(int(c) for c in corners + z * (COLUMNS + 1) + x)
            for z in range(ROWS)
            for x in range(COLUMNS)
        ]
        self.wall = stage.mesh(points, faces, self.material)

    def _paint(self, kind, domain, name="paint", field="color", low=0.0, seed=1):
        attribute = self.wall.data.attributes.new(name, kind, domain)
        random = np.random.default_rng(seed)
        size = 1 if field == "value" else 4
        values = random.uniform(low, 1, (len(attribute.data), size))
        for element, value in zip(attribute.data, values, strict=True):
            setattr(element, field, value if size > 1 else value[0])

    def _color_attribute(self, name="paint", output="Color"):
        settings = {"layer_name": name}
        return self.tree.node("ShaderNodeVertexColor", output, settings)

    def _attribute(self, name="paint", output="Color"):
        return self.tree.node("ShaderNodeAttribute", output, {"attribute_name": name})

    def test_colors(self):
        self.tree.end(self.tree.diffuse(self._color_attribute()))
        for kind, words in (("FLOAT_COLOR", "floats"), ("BYTE_COLOR", "bytes")):
            for domain, of in (("POINT", "points"), ("CORNER", "corners")):
                with self.subTest(kind=kind, domain=domain):
                    self._paint(kind, domain)
                    self.assert_parity(f"Color Attribute: {words} of {of}")
                    self.wall.data.attributes.remove(self.wall.data.attributes["paint"])

    def test_the_one_that_renders(self):
        for i in range(3):
            self._paint("FLOAT_COLOR", "POINT", f"paint {i}", seed=i)
        self.wall.data.color_attributes.render_color_index = 1
        self.tree.end(self.tree.diffuse(self._color_attribute("")))
        self.assert_parity("Color Attribute: the one that renders")

    def test_attribute_node(self):
        self._paint("FLOAT_COLOR", "FACE")
        self.tree.end(self.tree.diffuse(self._attribute()))
        self.assert_parity("Attribute: colors of faces")

    def test_numbers(self):
        """A number as a color, an alpha as the factor of a mix, colors in a Transparent BSDF."""
        self._paint("FLOAT", "POINT", "gray", "value")
        self._paint("BYTE_COLOR", "CORNER")
        mixed = self.tree.mix(
            self._color_attribute(output="Alpha"),
            self.tree.diffuse(self._attribute("gray", "Fac")),
            self.tree.transparent(self._color_attribute()),
        )
        self.tree.end(mixed)
        self.assert_parity("Attribute: numbers, factors, transparency")

    def test_beside_pictures(self):
        """Emission whose color is an attribute and whose strength is an image."""
        layer = self.wall.data.uv_layers.new(name="UVMap")
        corners = [self.wall.data.vertices[loop.vertex_index].co for loop in self.wall.data.loops]
        layer.data.foreach_set("uv", np.array([(c.x / 3, c.z / 2) for c in corners], np.float32).ravel())
        self._paint("FLOAT_COLOR", "CORNER")
        self.tree.end(self.tree.emission(self._color_attribute(), self.tree.picture(image(3))))
        self.assert_parity("Color Attribute: emission, beside an image")

    def test_uv_map(self):
        """As a color, and as the number that an output gives of two."""
        layer = self.wall.data.uv_layers.new(name="dense")
        layer.data.foreach_set("uv", np.random.default_rng(5).uniform(0, 1, 2 * len(layer.data)))
        glow = self.tree.emission(self._attribute("dense", "Vector"), self._attribute("dense", "Alpha"))
        self.tree.end(self.tree.mix(self._attribute("dense", "Fac"), glow, self.tree.diffuse()))
        self.assert_parity("Attribute: a UV map")

    def test_missing(self):
        """Black as a color; the alpha of an Attribute node is 1."""
        self._paint("FLOAT_COLOR", "POINT")
        self.tree.end(
            self.tree.mix(
                0.3,
                self.tree.emission(self._color_attribute("none"), self._attribute("none", "Alpha")),
                self.tree.emission((0.2, 0.4, 0.8), self._attribute("none", "Alpha")),
            )
        )
        stage.ground()
        self.assert_parity("Attribute: missing")


class GlowingAttributes(ParityTest):
    """A ground under squares that glow in colors of their faces."""

    def test_light(self):
        stage.ground(12, 0.6)
        stage.camera((0, -6, 6), (0.78, 0, 0), 45)
        bpy.context.scene.world = None
        material = bpy.data.materials.new("Glow")
        tree = Tree(material)
        tree.end(tree.emission(tree.node("ShaderNodeVertexColor", 0, {"layer_name": "paint"}), 8.0))
        faces, points = [], []
        for i in range(4):
            x, y = 1.5 * (i % 2) - 0.75, 1.5 * (i // 2) - 0.75
            faces.append(tuple(range(4 * i, 4 * i + 4)))
            points += [(x + a, y + b, 1.5) for a, b in ((-0.3, -0.3), (0.3, -0.3), (0.3, 0.3), (-0.3, 0.3))]
        squares = stage.mesh(points, faces, material, "Squares")
        squares.visible_camera = False
        paint = squares.data.attributes.new("paint", "FLOAT_COLOR", "CORNER")
        colors = ((1, 0.1, 0.1, 1), (0.1, 1, 0.1, 1), (0, 0, 0, 1), (0.2, 0.2, 1, 1))
        for corner, value in enumerate(paint.data):
            value.color = colors[corner // 4]
        self.assert_parity("Color Attribute: glowing surfaces")
