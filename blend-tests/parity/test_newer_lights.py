"""What lights have since Blender 4.5: temperature, exposure, and power that grows with their area."""

import bpy

from parity import stage
from parity.case import BoxTest

_NEW = ("use_temperature", "exposure", "normalize")


class NewerLights(BoxTest):
    def setUp(self):
        if not all(name in bpy.types.Light.bl_rna.properties for name in _NEW):
            self.skipTest("lights have temperature, exposure and Normalize since Blender 4.5")
        super().setUp()

    def test_temperature_and_exposure(self):
        lamp = stage.lamp("POINT", 80, (1, 0.5, 3), shadow_soft_size=0.2, exposure=1.5)
        lamp.data.use_temperature, lamp.data.temperature = True, 3200
        self.assert_parity("Light: temperature and exposure")

    def test_temperature_beside_color(self):
        lamp = stage.lamp("SPOT", 1600, (1, 0.5, 4), (0.3, 0.2, 0), color=(1.0, 0.8, 0.5), exposure=-2.0)
        lamp.data.use_temperature, lamp.data.temperature = True, 15000
        self.assert_parity("Light: temperature beside a color, negative exposure")

    def test_ember(self):
        """Redder than any mixture of the primaries."""
        lamp = stage.lamp("SUN", 1.0, rotation=(0.6, 0.3, 0), angle=0.0)
        lamp.data.use_temperature, lamp.data.temperature = True, 1000
        self.assert_parity("Light: temperature of 1000 K")

    def test_area(self):
        lamp = stage.lamp("AREA", 60, (1, 0.5, 3), shape="RECTANGLE", size=1.0, size_y=0.5, normalize=False)
        lamp.scale = (1.5, 0.8, 2.0)
        self.assert_parity("Light: rectangle, not normalized, scaled")

    def test_disk(self):
        stage.lamp("AREA", 100, (1, 0.5, 3), (0.3, 0.2, 0), shape="DISK", size=0.8, normalize=False)
        self.assert_parity("Light: disk, not normalized")

    def test_point(self):
        lamp = stage.lamp("POINT", 600, (1, 0.5, 3), shadow_soft_size=0.2, normalize=False)
        lamp.scale = (2, 2, 2)
        self.assert_parity("Light: point, not normalized, scaled")

    def test_point_without_radius(self):
        stage.lamp("POINT", 75, (1, 0.5, 3), shadow_soft_size=0.0, normalize=False)
        self.assert_parity("Light: point without radius, not normalized")

    def test_spot(self):
        stage.lamp("SPOT", 300, (1, 0.5, 4), (0.3, 0.2, 0), shadow_soft_size=0.3, normalize=False)
        self.assert_parity("Light: spot, not normalized")

    def test_sun(self):
        stage.lamp("SUN", 100, rotation=(0.6, 0.3, 0), angle=0.2, normalize=False)
        self.assert_parity("Light: sun, not normalized")

    def test_sharp_sun(self):
        stage.lamp("SUN", 3.0, rotation=(0.6, 0.3, 0), angle=0.0, normalize=False)
        self.assert_parity("Light: sharp sun, not normalized")
