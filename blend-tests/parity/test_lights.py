"""Lights: how much arrives where, and how soft."""

import math

from parity import stage
from parity.case import NEVER, BoxTest, ParityTest


class Lights(BoxTest):
    def test_sun(self):
        stage.lamp("SUN", 3.0, rotation=(0.6, 0.3, 0), angle=0.0)
        self.assert_parity("Sun: sharp")

    def test_sun_angle(self):
        stage.lamp("SUN", 3.0, rotation=(0.6, 0.3, 0), angle=0.2)
        self.assert_parity("Sun: angle 11 degrees")

    def test_wide_sun(self):
        """Cycles before 4.0 makes the rim of a sun brighter than its middle."""
        stage.lamp("SUN", 3.0, rotation=(0.6, 0.3, 0), angle=math.radians(90))
        self.assert_approximate("Sun: angle 90 degrees", 6.0, exact=((4, 0), NEVER))

    def test_color(self):
        stage.lamp("SUN", 3.0, rotation=(0.6, 0.3, 0), angle=0.0, color=(1.0, 0.5, 0.2))
        self.assert_parity("Light: color")

    def test_emission_node(self):
        """Multiplies what the lamp is; without one it is dark."""
        lamp = stage.lamp("POINT", 300, (1, 0.5, 3), shadow_soft_size=0.0, color=(1.0, 0.8, 0.6))
        emission = self._tree(lamp).nodes["Emission"]
        emission.inputs["Color"].default_value = (0.2, 0.9, 0.5, 1)
        emission.inputs["Strength"].default_value = 1.5
        self._tree(stage.lamp("POINT", 900, (-2, 0.5, 3), shadow_soft_size=0.0)).links.clear()
        self.assert_parity("Light: Emission node, and none")

    def test_nodes(self):
        """Constants through other nodes. Under the lamp it is three times as bright as in the mean."""
        tree = self._tree(stage.lamp("POINT", 300, (1, 0.5, 3), shadow_soft_size=0.0))
        body, falloff = tree.nodes.new("ShaderNodeBlackbody"), tree.nodes.new("ShaderNodeLightFalloff")
        double = tree.nodes.new("ShaderNodeMath")
        body.inputs["Temperature"].default_value, double.operation = 3000, "MULTIPLY"
        double.inputs[0].default_value, double.inputs[1].default_value = 0.6, 2.0
        emission = tree.nodes["Emission"]
        for source, socket in (
            (double.outputs[0], falloff.inputs["Strength"]),
            (falloff.outputs["Quadratic"], emission.inputs["Strength"]),
            (body.outputs[0], emission.inputs["Color"]),
        ):
            tree.links.new(source, socket)
        self.assert_approximate("Light: Blackbody, Math and Light Falloff nodes", 3.0)

    def _tree(self, lamp):
        lamp.data.use_nodes = True
        return lamp.data.node_tree

    def test_shown(self):
        lamp = stage.lamp("POINT", 60, (0.8, 0.6, 2), shadow_soft_size=0.3)
        lamp.visible_camera = True
        self.assert_ignored("Light: shown to the camera", "Light 'Lamp': showing it to the camera is not")

    def test_negative(self):
        """Lights of less than no power take away light of others."""
        stage.world((0.5, 0.5, 0.5))
        stage.lamp("SUN", 3.0, rotation=(0.6, 0.3, 0), angle=0.0)
        stage.lamp("SUN", -0.5, rotation=(-0.4, 0.3, 0), angle=0.2)
        stage.lamp("POINT", -30, (1, 0.5, 3), shadow_soft_size=0.0)
        stage.lamp("SPOT", -60, (-1, 1, 3), shadow_soft_size=0.3, spot_size=1.5)
        stage.lamp("AREA", -20, (-1, -1, 3), shape="SQUARE", size=1.0)
        self.assert_parity("Light: negative power")

    def test_point(self):
        stage.lamp("POINT", 300, (1, 0.5, 3), shadow_soft_size=0.0)
        self.assert_parity("Point: sharp")

    def test_point_size(self):
        stage.lamp("POINT", 300, (1, 0.5, 3), shadow_soft_size=0.2)
        self.assert_parity("Point: radius 0.2 m at 3 m")

    def test_large_point(self):
        stage.lamp("POINT", 300, (1, 0.5, 3), shadow_soft_size=1.0)
        self.assert_parity("Point: radius 1 m at 3 m")

    def test_spot(self):
        stage.lamp(
            "SPOT", 300, (1, 0.5, 4), (0.3, 0.2, 0), shadow_soft_size=0.0, spot_size=0.9, spot_blend=0.0
        )
        self.assert_parity("Spot: size")

    def test_spot_blend(self):
        stage.lamp(
            "SPOT", 300, (1, 0.5, 4), (0.3, 0.2, 0), shadow_soft_size=0.0, spot_size=1.2, spot_blend=0.6
        )
        self.assert_parity("Spot: blend")

    def test_spot_radius(self):
        stage.lamp(
            "SPOT", 300, (1, 0.5, 4), (0.3, 0.2, 0), shadow_soft_size=0.3, spot_size=1.2, spot_blend=0.3
        )
        self.assert_parity("Spot: radius 0.3 m at 4 m")

    def test_scaled_spot(self):
        spot = stage.lamp("SPOT", 300, (1, 0.5, 4), shadow_soft_size=0.0, spot_size=0.9, spot_blend=0.5)
        spot.scale = (2, 1, 1)
        self.assert_parity("Spot: scale of its object")

    def test_sheared_spot(self):
        spot = stage.lamp(
            "SPOT", 300, (0, 0, 4), (0.5, 0.2, 0), shadow_soft_size=0.0, spot_size=0.9, spot_blend=0.5
        )
        stage.shear(spot, (1, 2, 0.8), (0.1, 0, 0.3))
        # The light tree of 3.5 and newer takes some of what a sheared spot lights for dark.
        if hasattr(self.scene.cycles, "use_light_tree"):
            self.scene.cycles.use_light_tree = False
        self.assert_parity("Spot: sheared by an unevenly scaled parent")

    def test_sheared_sun(self):
        stage.shear(stage.lamp("SUN", 3.0, rotation=(0.6, 0.3, 0), angle=0.1), (1, 2, 0.5), (0.3, 0.2, 0.5))
        self.assert_parity("Sun: sheared by an unevenly scaled parent")

    def test_no_shadow(self):
        lamp = stage.lamp("POINT", 300, (1, 0.5, 3), shadow_soft_size=0.2)
        if hasattr(lamp.data.cycles, "cast_shadow"):
            lamp.data.cycles.cast_shadow = False
        else:
            lamp.data.use_shadow = False
        self.assert_parity("Light: casts no shadow")

    def test_shadow_of_eevee(self):
        """Cycles 3.4 has a switch of its own."""
        lamp = stage.lamp("POINT", 300, (1, 0.5, 3), shadow_soft_size=0.2).data
        if not (hasattr(lamp.cycles, "cast_shadow") and hasattr(lamp, "use_shadow")):
            self.skipTest("one switch for all engines")
        lamp.use_shadow = False
        self.assert_parity("Light: casts no shadow in EEVEE")

    def test_many(self):
        for i in range(12):
            x, y = 2.5 * math.cos(i), 2.0 * math.sin(2 * i)
            stage.lamp("POINT", 20 + 5 * i, (x, y, 1.5), shadow_soft_size=0.0)
        self.assert_parity("Light: twelve points")


class LightsInView(ParityTest):
    """The camera looks at the lamp itself, and sees nothing of it."""

    def setUp(self):
        super().setUp()
        stage.ground(12, 0.6)
        stage.camera((0, -8, 2), (math.radians(80), 0, 0), 50)

    def test_area(self):
        stage.lamp("AREA", 50, (0, 0, 1.5), (-1.2, 0, 0), shape="RECTANGLE", size=2.0, size_y=1.0)
        self.assert_parity("Light before the camera: area")

    def test_sun(self):
        stage.lamp("SUN", 1.0, rotation=(math.radians(-85), 0, 0), angle=0.15)
        self.assert_parity("Light before the camera: sun")
