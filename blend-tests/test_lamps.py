"""Settings of lights: of this Blender, and those of newer ones, by stand-ins that have them."""

import types
from unittest import mock

import bpy
from mathutils import Matrix

from support import inputs, scenes
from support.blender import BlenderTest


def _lights():
    return inputs.module("export.lights")


def _lamp(**newer):
    return types.SimpleNamespace(energy=3.0, color=(1.0, 0.5, 0.25), **newer)


class NewerLights(BlenderTest):
    def test_plain(self):
        """The control: without those settings nothing is done."""
        self.assertEqual(_lights().power(_lamp(), Matrix()), 3.0)
        self.assertEqual(_lights().tinted(_lamp()), (1.0, 0.5, 0.25))
        off = _lamp(use_temperature=False, temperature_color=(9, 9, 9), exposure=0.0, normalize=True)
        self.assertEqual(_lights().power(off, Matrix()), 3.0)
        self.assertEqual(_lights().tinted(off), (1.0, 0.5, 0.25))

    def test_exposure_counts_stops(self):
        self.assertEqual(_lights().power(_lamp(exposure=2.0), Matrix()), 12.0)
        self.assertEqual(_lights().power(_lamp(exposure=-1.0), Matrix()), 1.5)

    def test_temperature_tints(self):
        lamp = _lamp(use_temperature=True, temperature_color=(2.0, 1.0, 0.4))
        self.assertEqual(_lights().tinted(lamp), (2.0, 0.5, 0.1))

    def test_power_that_is_not_normalized_grows_with_the_area(self):
        place = Matrix.Scale(3.0, 4)
        lamp = _lamp(normalize=False, area=lambda matrix_world: 2.0 * matrix_world.to_scale().x ** 2)
        self.assertAlmostEqual(_lights().power(lamp, place), 3.0 * 18.0, places=4)

    def test_points_with_a_radius_are_spheres_since_4_0(self):
        """The option of 4.1 makes disks of them again, which older ones always are."""
        for is_older, settings, sphere in (
            (True, {}, 0),
            (False, {}, 1),
            (False, {"use_soft_falloff": True}, 0),
            (False, {"use_soft_falloff": False}, 1),
        ):
            lamp = _lamp(shadow_soft_size=0.1, spot_size=1.0, spot_blend=0.5, **settings)
            with (
                self.subTest(is_older=is_older, **settings),
                mock.patch.object(_lights(), "_OLDER_LAMPS", is_older),
            ):
                self.assertEqual(_lights()._point(lamp, Matrix())[2]["sphere"], sphere)
                self.assertEqual(_lights()._spot(lamp, Matrix())[2]["sphere"], sphere)

    def test_cones_are_scaled_with_objects(self):
        uneven = Matrix.Diagonal((2.0, -3.0, 4.0, 1.0))
        self.assertEqual(_lights().cone_scale(uneven), (0.5, 0.75))
        self.assertEqual(_lights().cone_scale(Matrix.Scale(7.0, 4)), (1.0, 1.0))
        self.assertEqual(_lights().cone_scale(Matrix.Diagonal((2.0, 1.0, 0.0, 1.0))), (1.0, 1.0))


class ThisBlender(BlenderTest):
    """A plane under one lamp."""

    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=16, size=16)
        scenes.add_camera()
        scenes.add_plane(scenes.diffuse_material(), size=20)
        scenes.set_world((0.01, 0.01, 0.01))
        self.lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "SUN"))
        self.scene.collection.objects.link(self.lamp)

    def _level(self):
        return float(scenes.middle(scenes.render(self.folder))[0])

    def test_newer_settings(self):
        """Where they are there, they do what they say."""
        if not hasattr(self.lamp.data, "exposure"):
            self.skipTest("lights have neither exposure nor temperature before Blender 4.5")
        plain = self._level()
        self.lamp.data.exposure = 1.0
        self.assert_close((self._level() - 0.01) / (plain - 0.01), 2.0, 0.02)
        self.lamp.data.exposure, self.lamp.data.use_temperature = 0.0, True
        self.lamp.data.temperature = 3000.0
        red, _green, blue = scenes.middle(scenes.render(self.folder))
        self.assertGreater(red, 2.0 * blue)

    def test_area_of_zero_scale(self):
        area = self.lamp.data = bpy.data.lights.new("Area", "AREA")
        area.energy = 100.0
        self.lamp.location.z = 3.0
        lit = self._level()
        self.lamp.scale.x = 0.0
        dark = self._level()
        self.assertGreater(lit, 2.0 * dark)
        self.assert_close(dark, 0.01, 1e-3)
