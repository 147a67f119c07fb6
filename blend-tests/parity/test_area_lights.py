"""Area lights: shapes, and how far they spread."""

import math

import bpy

from parity import stage
from parity.case import BoxTest
from parity.shaders import Tree


class AreaLights(BoxTest):
    def test_square(self):
        stage.lamp("AREA", 100, (1, 0.5, 3), (0.3, 0.2, 0), shape="SQUARE", size=1.0)
        self.assert_parity("Area: square")

    def test_rectangle(self):
        lamp = stage.lamp("AREA", 100, (1, 0.5, 3), (0.3, 0.2, 0.4), shape="RECTANGLE", size=2.0, size_y=0.3)
        lamp.scale = (0.7, 1.5, 1)
        self.assert_parity("Area: rectangle, scaled")

    def test_disk(self):
        stage.lamp("AREA", 100, (1, 0.5, 3), (0.3, 0.2, 0), shape="DISK", size=1.0)
        self.assert_parity("Area: disk")

    def test_ellipse(self):
        stage.lamp("AREA", 100, (1, 0.5, 3), (0.3, 0.2, 0.4), shape="ELLIPSE", size=2.0, size_y=0.5)
        self.assert_parity("Area: ellipse")

    def test_spread(self):
        stage.lamp("AREA", 100, (1, 0.5, 3), (0.3, 0.2, 0), shape="SQUARE", size=0.5, spread=math.radians(60))
        self.assert_parity("Area: spread 60 degrees")

    def test_narrow_spread(self):
        stage.lamp("AREA", 100, (0, 0, 3), shape="DISK", size=1.5, spread=math.radians(25))
        self.assert_parity("Area: spread 25 degrees", samples=4, seen=12)  # few blocks have its light

    def test_multiple_importance(self):
        """Without it, clear glass does not show the light, but a rough surface does."""
        lamp = stage.lamp("AREA", 100, (1, 0.5, 3), (0.3, 0.2, 0), shape="SQUARE", size=1.0)
        lamp.data.cycles.use_multiple_importance_sampling = False
        tree = Tree(bpy.data.objects["Ground"].data.materials[0])
        glass = tree.node("ShaderNodeBsdfGlass", settings={"distribution": "GGX"}, Roughness=0.0)
        for name, shader in (("clear glass", glass), ("rough metal", tree.glossy(0.5))):
            with self.subTest(name):
                tree.end(tree.add(tree.diffuse((0.1, 0.2, 0.1)), shader))
                self.assert_parity(f"Area: no Multiple Importance, {name}", samples=2)

    def test_sheared_square(self):
        lamp = stage.lamp("AREA", 100, (0, 0, 2), (0, math.radians(45), 0), shape="SQUARE", size=1.0)
        stage.shear(lamp, (1, 1, 2))
        self.assert_parity("Area: sheared by an unevenly scaled parent")

    def test_parallelograms(self):
        """Cycles samples them as rectangles, about another center."""
        for scale, rotation in (((1, 2, 1), (0, 0, math.radians(45))), ((1, 1, 2), (0.6, 0.5, 0))):
            lamp = stage.lamp("AREA", 100, (0, 0, 3), rotation, shape="SQUARE", size=1.0)
            stage.shear(lamp, scale)
            self.assert_approximate(f"Area: square sheared to a parallelogram, {scale}", 100)
            lamp.hide_render = True

    def test_sheared_ellipse(self):
        lamp = stage.lamp("AREA", 100, (0, 0, 3), (0.3, 0.2, 0.4), shape="ELLIPSE", size=1.0, size_y=0.6)
        stage.shear(lamp, (1, 2, 0.5), (0.3, 0.2, 0.5))
        # Cycles draws rays to the sheared disk; its rays from surfaces meet one that faces along its axis.
        self.assert_parity("Area: ellipse, sheared", up_to=20)

    def test_mirrored_area(self):
        lamp = stage.lamp("AREA", 100, (1, 0.5, 3), (0.3, 0.2, 0), shape="SQUARE", size=1.0)
        lamp.scale = (-1, 1, 1)
        self.assert_parity("Area: mirrored")
